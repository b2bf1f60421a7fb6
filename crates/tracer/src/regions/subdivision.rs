//! The subdivision of a window into regions, made from curves and vertices.

use crate::cubic::Cubic;
use crate::curve::{Curve, Node, Vertex};
use crate::regions::abscissae::Abscissae;
use crate::regions::arrangement::crossing::Crossings;
use crate::regions::arrangement::faces::Faces;
use crate::regions::arrangement::piece::{Edge, Piece};
use crate::regions::arrangement::slabs::Slabs;
use crate::regions::arrangement::union::DisjointSets;
use crate::regions::finding::{Euler, Finding, SubdivisionError};
use crate::regions::frame::frame;
use crate::regions::interior;
use crate::regions::region::{Region, find_disagreements, regions};
use crate::window::{Point, Window};

/// A window of the plane, divided by curves into regions.
///
/// ```
/// use stickslip_tracer::{Curve, Node, Point, Vertex, VertexKind, Window};
/// use stickslip_tracer::regions::{Location, Subdivision};
///
/// // A straight boundary from the lower side of the window to the upper side.
/// let ends = [Point::new(0.5, 0.0), Point::new(0.5, 1.0)];
/// let curve = Curve {
///     margin: "m",
///     sides: ["left", "right"],
///     nodes: ends.map(|point| Node { point, tangent: Point::new(0.0, 1.0) }).to_vec(),
///     ends: Some([0, 1]),
/// };
/// let vertices = ends.map(|point| Vertex { point, kind: VertexKind::WindowEdge, margins: vec!["m"] });
/// let window = Window { low: Point::new(0.0, 0.0), high: Point::new(2.0, 1.0) };
/// let plane = Subdivision::new(window, vec![curve], vertices.to_vec(), 1e-10)?;
/// assert!(plane.findings().is_empty());
/// assert_eq!(plane.regions().len(), 2);
/// let Location::Region(region) = plane.locate(&Point::new(0.2, 0.3)) else { panic!("inside") };
/// assert_eq!(plane.regions()[region].label, Some("left"));
/// assert_eq!(plane.regions()[region].area, 0.5);
/// # Ok::<(), stickslip_tracer::regions::SubdivisionError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Subdivision<Label, Margin> {
    pub(crate) window: Window,
    pub(crate) tolerance: f64,
    pub(crate) curves: Vec<Curve<Label, Margin>>,
    vertices: Vec<Vertex<Margin>>,
    regions: Vec<Region<Label>>,
    findings: Vec<Finding<Label>>,
    euler: Euler,
    pub(crate) slabs: Slabs,
    /// The curves in their order, then the parts of the window's boundary.
    pub(crate) edges: Vec<Edge>,
    pub(crate) faces: Faces,
}

impl<Label: Clone + Ord, Margin> Subdivision<Label, Margin> {
    /// The regions into which `curves` divide `window`.
    ///
    /// `tolerance` is the accuracy of the curves, which are interpolated, and of the vertices. A
    /// vertex that is closer than this to the window's boundary lies on the boundary, unless a
    /// curve that stays as close to the boundary leads there. A closed curve may repeat its first
    /// node as its last node. Inconsistencies become [`Finding`]s. Without findings the regions are
    /// exactly the regions of the curves. Time and memory grow as the number of cubic pieces times
    /// the number of curves over one abscissa.
    ///
    /// # Errors
    /// The input has no meaning: a number is not finite, an index is out of range, or the window
    /// has no area.
    pub fn new(
        window: Window,
        curves: Vec<Curve<Label, Margin>>,
        vertices: Vec<Vertex<Margin>>,
        tolerance: f64,
    ) -> Result<Self, SubdivisionError> {
        SubdivisionError::check(&window, &curves, &vertices, tolerance)?;
        let mut findings = Vec::new();
        let places = curves.iter().flat_map(|curve| curve.nodes.iter().map(|node| node.point.x));
        let places = places.chain(vertices.iter().map(|vertex| vertex.point.x));
        let abscissae = Abscissae::new(window.low.x, window.high.x, places);
        let mut points: Vec<Point> = vertices.iter().map(|vertex| vertex.point).collect();
        for point in &mut points {
            point.x = abscissae.of(point.x);
        }
        let around = frame(&window, &curves, &vertices, tolerance, &mut points, &mut findings);
        let mut pieces = Vec::new();
        let mut edges = Vec::with_capacity(curves.len() + around.len());
        for (index, curve) in curves.iter().enumerate() {
            let start = pieces.len();
            for cubic in cubics(index, curve, &points, &abscissae, tolerance, &mut findings) {
                Piece::of(index, cubic, &mut pieces);
            }
            if pieces.len() == start {
                return Err(SubdivisionError::NoLength { curve: index });
            }
            edges.push(Edge { ends: curve.ends, pieces: start..pieces.len() });
        }
        for (i, &from) in around.iter().enumerate() {
            let to = around[(i + 1) % around.len()];
            let start = pieces.len();
            Piece::of(edges.len(), Cubic::line(points[from], points[to]), &mut pieces);
            edges.push(Edge { ends: Some([from, to]), pieces: start..pieces.len() });
        }
        let slabs = Slabs::new(pieces);
        let reach = 2.0 * tolerance;
        let faces = Faces::new(&slabs, &edges, curves.len()..edges.len(), reach);
        let size = window.high - window.low;
        let crossings = Crossings {
            slabs: &slabs,
            edges: &edges,
            tolerance,
            rounding: 1e-14 * (size.y + window.low.y.abs() + window.high.y.abs()),
            steepest: 1e6 * size.y / size.x,
        };
        let named = |edge: usize| (edge < curves.len()).then_some(edge);
        findings.extend(
            crossings
                .find()
                .into_iter()
                .map(|(pair, point)| Finding::Crossing { curves: pair.map(named), point }),
        );
        let regions = regions(&curves, &slabs, &edges, &faces, &window.low);
        let euler = euler(&edges, points.len(), faces.count);
        let mut plane = Self {
            window,
            tolerance,
            curves,
            vertices,
            regions,
            findings,
            euler,
            slabs,
            edges,
            faces,
        };
        interior::place_samples(&mut plane.regions, &plane.slabs, &plane.edges, &plane.faces);
        plane.find_inconsistencies();
        Ok(plane)
    }

    /// As [`Self::new`], without the curves that have no length at this tolerance. The result also
    /// has their indices among `curves`, in order.
    ///
    /// # Errors
    /// As [`Self::new`], except [`SubdivisionError::NoLength`].
    pub fn leaving_out(
        window: Window,
        curves: &[Curve<Label, Margin>],
        vertices: &[Vertex<Margin>],
        tolerance: f64,
    ) -> Result<(Self, Vec<usize>), SubdivisionError>
    where
        Margin: Clone,
    {
        let mut kept = curves.to_vec();
        let mut left_out = Vec::new();
        loop {
            match Self::new(window, kept.clone(), vertices.to_vec(), tolerance) {
                Err(SubdivisionError::NoLength { curve }) => {
                    kept.remove(curve);
                    // Curves are refused in their order.
                    left_out.push(curve + left_out.len());
                }
                made => return Ok((made?, left_out)),
            }
        }
    }

    /// Gives each region that no curve bounds the label that `label` finds at its sample point.
    pub fn label_rest(&mut self, label: impl Fn(&Point) -> Option<Label>) {
        for region in self.regions.iter_mut().filter(|region| region.label.is_none()) {
            region.label = label(&region.sample);
        }
    }

    /// Adds the findings about ends, sides and labels of curves, and about regions.
    fn find_inconsistencies(&mut self) {
        let mut degrees = vec![0_usize; self.vertices.len() + 4];
        for end in self.edges.iter().filter_map(|edge| edge.ends).flatten() {
            degrees[end] += 1;
        }
        for (index, curve) in self.curves.iter().enumerate() {
            for vertex in curve.ends.into_iter().flatten().filter(|&vertex| degrees[vertex] == 1) {
                self.findings.push(Finding::Dangling { curve: index, vertex });
            }
            let regions = self.faces.of_edges[index];
            if regions[0] == regions[1] || regions.contains(&None) {
                self.findings.push(Finding::SidesNotApart { curve: index, regions });
            }
        }
        for (index, region) in self.regions.iter().enumerate() {
            if self.is_thin(index) {
                self.findings.push(Finding::Thin { region: index, clearance: region.clearance });
            }
            find_disagreements(index, region, &self.curves, &mut self.findings);
        }
        if !self.euler.holds() {
            self.findings.push(Finding::Euler(self.euler));
        }
    }
}

impl<Label, Margin> Subdivision<Label, Margin> {
    /// The window.
    #[must_use]
    pub fn window(&self) -> &Window {
        &self.window
    }

    /// Whether a region is not wider than the tolerance.
    pub(crate) fn is_thin(&self, region: usize) -> bool {
        self.regions[region].clearance <= self.tolerance
    }

    /// The accuracy of curves and vertices.
    #[must_use]
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// The curves, as given.
    #[must_use]
    pub fn curves(&self) -> &[Curve<Label, Margin>] {
        &self.curves
    }

    /// The vertices, as given.
    #[must_use]
    pub fn vertices(&self) -> &[Vertex<Margin>] {
        &self.vertices
    }

    /// The regions.
    #[must_use]
    pub fn regions(&self) -> &[Region<Label>] {
        &self.regions
    }

    /// The regions on the left and on the right of a curve; `None` is the outside of the window.
    /// Only a curve with findings has the outside on one of its sides.
    #[must_use]
    pub fn regions_beside(&self, curve: usize) -> [Option<usize>; 2] {
        self.faces.of_edges[curve]
    }

    /// The inconsistencies of curves and vertices.
    #[must_use]
    pub fn findings(&self) -> &[Finding<Label>] {
        &self.findings
    }

    /// The counts of Euler's formula.
    #[must_use]
    pub fn euler(&self) -> Euler {
        self.euler
    }

    /// The curves and the vertices, without the regions.
    #[must_use]
    pub fn into_parts(self) -> (Vec<Curve<Label, Margin>>, Vec<Vertex<Margin>>) {
        (self.curves, self.vertices)
    }
}

/// The cubics of a curve, with its ends at its vertices.
fn cubics<Label, Margin>(
    index: usize,
    curve: &Curve<Label, Margin>,
    points: &[Point],
    abscissae: &Abscissae,
    tolerance: f64,
    findings: &mut Vec<Finding<Label>>,
) -> Vec<Cubic> {
    let mut nodes = curve.nodes.clone();
    for node in &mut nodes {
        node.point.x = abscissae.of(node.point.x);
    }
    let last = nodes.len() - 1;
    if let Some(ends) = curve.ends {
        for (node, vertex) in [0, last].into_iter().zip(ends) {
            let distance = (nodes[node].point - points[vertex]).norm();
            if distance > tolerance {
                findings.push(Finding::EndAway { curve: index, vertex, distance });
            }
            nodes[node].point = points[vertex];
        }
    } else if nodes[0].point != nodes[last].point {
        nodes.push(nodes[0]);
    }
    nodes
        .windows(2)
        .map(|pair: &[Node]| {
            let mut cubic = Cubic::between(&pair[0], &pair[1]);
            let [first, last] = [0, 3].map(|end| cubic.points[end].x);
            // The handles of a vertical piece differ by rounding too.
            if first == last && abscissae.is_straight(&cubic) {
                for point in &mut cubic.points {
                    point.x = first;
                }
            }
            cubic
        })
        .collect()
}

/// The counts of Euler's formula. A closed curve counts as an edge with one vertex.
fn euler(edges: &[Edge], points: usize, regions: usize) -> Euler {
    let closed = edges.iter().filter(|edge| edge.ends.is_none()).count();
    let mut sets = DisjointSets::new(points);
    let mut used = vec![false; points];
    for [from, to] in edges.iter().filter_map(|edge| edge.ends) {
        sets.unite(from, to);
        (used[from], used[to]) = (true, true);
    }
    let roots = (0..points).filter(|&point| used[point] && sets.least(point) == point).count();
    Euler {
        vertices: used.iter().filter(|&&used| used).count() + closed,
        edges: edges.len(),
        faces: regions + 1,
        components: roots + closed,
    }
}
