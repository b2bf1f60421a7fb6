//! Networks of families whose boundaries are known in closed form.

use std::convert::Infallible;
use std::f64::consts::TAU;

use stickslip_tracer::{
    Curve, Family, FreeRun, Network, Point, TraceError, TraceOptions, Tracer, VertexKind, Window,
    trace,
};

/// One guard a function, asked in order: it fires where the function is negative. A margin's
/// itinerary is what the guards before it did; the free run leaves the margins of those that did
/// not fire.
struct Guards(Vec<fn(&Point) -> f64>);

type Label = Vec<bool>;
type Margin = (usize, Vec<bool>);

impl Family for Guards {
    type Label = Label;
    type Margin = Margin;
    type Error = Infallible;

    fn label(&self, point: &Point) -> Result<Label, Infallible> {
        Ok(self.0.iter().map(|function| function(point) < 0.0).collect())
    }

    fn margin(&self, point: &Point, margin: &Margin) -> Result<Option<f64>, Infallible> {
        Ok(Some(self.0[margin.0](point)))
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<Label, Margin>, Infallible> {
        let label = self.label(point)?;
        let margins = (0..self.0.len())
            .filter(|&i| !label[i])
            .map(|i| ((i, label[..i].to_vec()), self.0[i](point)))
            .collect();
        Ok(FreeRun { label, margins })
    }
}

const SQUARE: Window = Window { low: Point::new(-1.0, -1.0), high: Point::new(1.0, 1.0) };

/// The functions are exact to rounding, so nothing is noise.
fn exact() -> TraceOptions {
    TraceOptions { noise: 1e-16, ..TraceOptions::default() }
}

fn traced(functions: Vec<fn(&Point) -> f64>, window: &Window) -> Network<Label, Margin> {
    let network = trace(&Guards(functions), window, &exact()).unwrap();
    assert_eq!(network.unresolved, []);
    for curve in &network.curves {
        let pair = &curve.nodes;
        assert!(pair.len() > 1);
        if let Some([start, end]) = curve.ends {
            assert!((pair[0].point - network.vertices[start].point).norm() < 1e-10);
            assert!((pair[pair.len() - 1].point - network.vertices[end].point).norm() < 1e-10);
        } else {
            assert_eq!(pair[0], pair[pair.len() - 1]);
        }
    }
    network
}

/// The cubic of a piece at θ, handles as for an arc of a circle.
fn cubic<M>(curve: &Curve<Label, M>, piece: usize, theta: f64) -> Point {
    let (a, d) = (curve.nodes[piece], curve.nodes[piece + 1]);
    let half = (0.5 * (1.0 + a.tangent.dot(&d.tangent).min(1.0))).sqrt();
    let handle = 2.0 / 3.0 * (d.point - a.point).norm() / (1.0 + half);
    let (b, c) = (a.point + a.tangent * handle, d.point - d.tangent * handle);
    let rest = 1.0 - theta;
    a.point * rest.powi(3)
        + b * (3.0 * rest * rest * theta)
        + c * (3.0 * rest * theta * theta)
        + d.point * theta.powi(3)
}

/// Asserts that nodes are within 1e-12 and the cubics between them within 2e-10 of the curve with
/// this signed distance.
fn assert_on<M>(curve: &Curve<Label, M>, distance: impl Fn(&Point) -> f64) {
    let (mut nodes, mut pieces) = (0.0_f64, 0.0_f64);
    for node in &curve.nodes {
        nodes = nodes.max(distance(&node.point).abs());
    }
    for piece in 0..curve.nodes.len() - 1 {
        for i in 1..20 {
            let point = cubic(curve, piece, f64::from(i) / 20.0);
            pieces = pieces.max(distance(&point).abs());
        }
    }
    assert!(nodes < 1e-12, "nodes {nodes:e}");
    assert!(pieces < 2e-10, "pieces {pieces:e}");
}

fn length<M>(curve: &Curve<Label, M>) -> f64 {
    (0..curve.nodes.len() - 1)
        .flat_map(|piece| (0..32).map(move |i| (piece, f64::from(i) / 32.0)))
        .map(|(piece, theta)| {
            (cubic(curve, piece, theta + 1.0 / 32.0) - cubic(curve, piece, theta)).norm()
        })
        .sum()
}

fn has_vertex(network: &Network<Label, Margin>, kind: VertexKind, x: f64, y: f64) {
    let place = Point::new(x, y);
    let found = network
        .vertices
        .iter()
        .any(|vertex| vertex.kind == kind && (vertex.point - place).norm() < 1e-10);
    assert!(found, "{kind:?} at {x}, {y} is not in {:?}", network.vertices);
}

fn circle(x: f64, y: f64, radius: f64) -> impl Fn(&Point) -> f64 {
    move |p| (p - Point::new(x, y)).norm() - radius
}

#[test]
fn a_closed_circle() {
    let network = traced(vec![|p| (p - Point::new(0.1, 0.2)).norm_squared() - 0.25], &SQUARE);
    assert_eq!((network.curves.len(), network.vertices.len()), (1, 0));
    let curve = &network.curves[0];
    assert_eq!(curve.ends, None);
    assert_on(curve, circle(0.1, 0.2, 0.5));
    assert!((length(curve) - TAU * 0.5).abs() < 1e-5);
    let runs = network.statistics.free_runs + network.statistics.prescribed_runs;
    assert!(curve.nodes.len() < 100, "{}", curve.nodes.len());
    assert!(runs < 2500, "{runs}");
}

/// The places where the curves of `functions` are extremal, by coordinate, in the order of the
/// other coordinate.
fn extrema(functions: Vec<fn(&Point) -> f64>) -> [Vec<Point>; 2] {
    let family = Guards(functions);
    let mut tracer = Tracer::new(&family, &SQUARE, &exact()).unwrap();
    tracer.explore().unwrap();
    let found = tracer.extrema().unwrap();
    [0, 1].map(|axis| {
        let of_axis = found.iter().filter(|extremum| extremum.axis == axis);
        let mut points: Vec<Point> = of_axis.map(|extremum| extremum.point).collect();
        points.sort_by(|one, other| (one.x + one.y).total_cmp(&(other.x + other.y)));
        points
    })
}

fn assert_at(points: &[Point], expected: &[[f64; 2]]) {
    assert_eq!(points.len(), expected.len(), "{points:?}");
    for (point, expected) in points.iter().zip(expected) {
        let off = (point - Point::from(*expected)).norm();
        assert!(off < 1e-9, "{point:?}, not {expected:?}: {off:e}");
    }
}

#[test]
fn a_circle_has_two_extrema_in_each_coordinate() {
    let [x, y] = extrema(vec![|p| (p - Point::new(0.1, 0.2)).norm_squared() - 0.25]);
    assert_at(&x, &[[-0.4, 0.2], [0.6, 0.2]]);
    assert_at(&y, &[[0.1, -0.3], [0.1, 0.7]]);
    // In pieces between two vertices it has as many.
    let [x, y] =
        extrema(vec![|p| (p - Point::new(0.1, 0.2)).norm_squared() - 0.25, |p| p.x - p.y + 0.05]);
    assert_at(&x, &[[-0.4, 0.2], [0.6, 0.2]]);
    assert_at(&y, &[[0.1, -0.3], [0.1, 0.7]]);
}

/// A small circle with a gradient that varies; its node of least x may be an extremum itself.
#[test]
fn extrema_of_a_small_circle() {
    let [x, y] = extrema(vec![|p| {
        (4.0 * p.x + p.y).exp() * ((p - Point::new(0.123, 0.456)).norm_squared() - 1e-6)
    }]);
    assert_at(&x, &[[0.122, 0.456], [0.124, 0.456]]);
    assert_at(&y, &[[0.123, 0.455], [0.123, 0.457]]);
}

#[test]
fn straight_lines_have_no_extrema_nor_have_inflections() {
    let lines: Vec<fn(&Point) -> f64> =
        vec![|p| p.x - 0.2 + 1e-13 * (1e5 * p.y).sin(), |p| p.y + 0.3, |p| {
            p.y - 0.4 - (p.x - 0.6).powi(3)
        }];
    assert!(extrema(lines).iter().all(Vec::is_empty));
}

#[test]
fn crossing_circles() {
    let network = traced(
        vec![|p| (p - Point::new(-0.3, 0.0)).norm_squared() - 0.25, |p| {
            (p - Point::new(0.3, 0.0)).norm_squared() - 0.25
        }],
        &SQUARE,
    );
    assert_eq!((network.curves.len(), network.vertices.len()), (4, 2));
    has_vertex(&network, VertexKind::Crossing, 0.0, 0.4);
    has_vertex(&network, VertexKind::Crossing, 0.0, -0.4);
    for curve in &network.curves {
        let x = if curve.margin.0 == 0 { -0.3 } else { 0.3 };
        assert_on(curve, circle(x, 0.0, 0.5));
    }
}

#[test]
fn circles_that_touch() {
    let network = traced(
        vec![|p| (p - Point::new(-0.4, 0.1)).norm_squared() - 0.16, |p| {
            (p - Point::new(0.3, 0.1)).norm_squared() - 0.09
        }],
        &SQUARE,
    );
    assert_eq!((network.curves.len(), network.vertices.len()), (2, 1));
    has_vertex(&network, VertexKind::Crossing, 0.0, 0.1);
    for curve in &network.curves {
        assert_eq!(curve.ends, Some([0, 0]));
        let (x, radius) = if curve.margin.0 == 0 { (-0.4, 0.4) } else { (0.3, 0.3) };
        assert_on(curve, circle(x, 0.1, radius));
    }
}

#[test]
fn a_circle_that_touches_from_inside() {
    let network = traced(
        vec![|p| (p - Point::new(0.0, 0.1)).norm_squared() - 0.36, |p| {
            (p - Point::new(0.3, 0.1)).norm_squared() - 0.09
        }],
        &SQUARE,
    );
    assert_eq!((network.curves.len(), network.vertices.len()), (2, 1));
    has_vertex(&network, VertexKind::Crossing, 0.6, 0.1);
}

#[test]
fn a_cusp() {
    let network = traced(
        vec![|p| (p.y - 0.1) * (p.y - 0.1) - (p.x + 0.2) * (p.x + 0.2) * (p.x + 0.2)],
        &SQUARE,
    );
    assert_eq!((network.curves.len(), network.vertices.len()), (2, 3));
    has_vertex(&network, VertexKind::Degenerate, -0.2, 0.1);
    has_vertex(&network, VertexKind::WindowEdge, 0.9_f64.powf(2.0 / 3.0) - 0.2, 1.0);
    has_vertex(&network, VertexKind::WindowEdge, 1.1_f64.powf(2.0 / 3.0) - 0.2, -1.0);
}

#[test]
fn a_figure_of_eight() {
    let network = traced(
        vec![|p| {
            let (x, y) = (p.x - 0.05, p.y + 0.03);
            (x * x + y * y).powi(2) - 0.5 * (x * x - y * y)
        }],
        &SQUARE,
    );
    assert_eq!((network.curves.len(), network.vertices.len()), (2, 1));
    has_vertex(&network, VertexKind::Degenerate, 0.05, -0.03);
    for curve in &network.curves {
        // The value over the length of the gradient is the distance to first order. Where the
        // gradient is below 1e-4, rounding of 1e-16 allows no better than 1e-12.
        let distance = |p: &Point| {
            let (x, y) = (p.x - 0.05, p.y + 0.03);
            let square = x * x + y * y;
            let gradient = Point::new(4.0 * square * x - x, 4.0 * square * y + y);
            (square * square - 0.5 * (x * x - y * y)) / gradient.norm().max(1e-4)
        };
        assert_on(curve, distance);
    }
}

#[test]
fn a_small_island() {
    let network = traced(
        vec![|p| {
            let (x, y) = (p.x - 0.123, p.y - 0.456);
            x * x + y * y + 0.3 * x * y * y - 1e-6
        }],
        &SQUARE,
    );
    assert_eq!((network.curves.len(), network.vertices.len()), (1, 0));
    assert_eq!(network.curves[0].ends, None);
    assert!((length(&network.curves[0]) - TAU * 1e-3).abs() < 1e-8);
}

/// Two circles of radius 0.5 overlap in a lens 1e-7 thick and 4e-4 long, which lies between nodes
/// of either.
#[test]
fn a_thin_lens() {
    let network = traced(
        vec![|p| (p - Point::new(-0.5, 0.03)).norm_squared() - 0.25, |p| {
            (p - Point::new(0.5 - 1e-7, 0.03)).norm_squared() - 0.25
        }],
        &Window { low: Point::new(-1.1, -1.0), high: Point::new(1.1, 1.0) },
    );
    assert_eq!((network.curves.len(), network.vertices.len()), (4, 2));
    for curve in &network.curves {
        let x = if curve.margin.0 == 0 { -0.5 } else { 0.5 - 1e-7 };
        assert_on(curve, circle(x, 0.03, 0.5));
    }
    let half = (0.25 - (0.5 - 0.5e-7_f64).powi(2)).sqrt();
    for y in [0.03 + half, 0.03 - half] {
        has_vertex(&network, VertexKind::Crossing, -0.5e-7, y);
    }
}

#[test]
fn parallel_lines_a_millionth_apart() {
    let network = traced(vec![|p| p.y - 0.3 * p.x, |p| p.y - 0.3 * p.x - 1e-6], &SQUARE);
    assert_eq!((network.curves.len(), network.vertices.len()), (2, 4));
    has_vertex(&network, VertexKind::WindowEdge, -1.0, -0.3);
    has_vertex(&network, VertexKind::WindowEdge, 1.0, 0.3 + 1e-6);
}

#[test]
fn a_line_through_a_corner() {
    let network = traced(vec![|p| p.y - 0.5 * p.x + 0.5], &SQUARE);
    assert_eq!((network.curves.len(), network.vertices.len()), (1, 2));
    has_vertex(&network, VertexKind::WindowEdge, 1.0, 0.0);
    has_vertex(&network, VertexKind::WindowCorner, -1.0, -1.0);
    assert!((length(&network.curves[0]) - 5.0_f64.sqrt()).abs() < 1e-10);
}

/// A guard h(θ) = a + (b − θ)² on a phase 0 ≤ θ ≤ 1 that fires where it falls through zero, and
/// then fires back where it rises again, with a = y + x/5 and b = 1 + x/2: its minimum leaves the
/// phase through the end at x = 0.
struct Dip;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum DipMargin {
    /// The minimum, before any firing.
    Minimum,
    /// The value at the end, before any firing.
    End,
    /// Minus the value at the end after one firing.
    Back,
}

impl Dip {
    fn shape(point: &Point) -> (f64, f64) {
        (point.y + 0.2 * point.x, 1.0 + 0.5 * point.x)
    }
}

impl Family for Dip {
    type Label = u8;
    type Margin = DipMargin;
    type Error = Infallible;

    fn label(&self, point: &Point) -> Result<u8, Infallible> {
        let (a, b) = Self::shape(point);
        let end = a + (1.0 - b).powi(2);
        Ok(if end < 0.0 {
            1
        } else if b < 1.0 && a < 0.0 {
            2
        } else {
            0
        })
    }

    fn margin(&self, point: &Point, margin: &DipMargin) -> Result<Option<f64>, Infallible> {
        let (a, b) = Self::shape(point);
        let end = a + (1.0 - b).powi(2);
        Ok(match margin {
            DipMargin::Minimum => (b < 1.0).then_some(a),
            DipMargin::End => Some(end),
            DipMargin::Back => (a < 0.0 && b - (-a).sqrt() < 1.0).then_some(-end),
        })
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<u8, DipMargin>, Infallible> {
        let label = self.label(point)?;
        let known: &[DipMargin] = match label {
            0 => &[DipMargin::Minimum, DipMargin::End],
            1 => &[DipMargin::Back],
            _ => &[],
        };
        let mut margins = Vec::new();
        for margin in known {
            margins.extend(self.margin(point, margin)?.map(|value| (*margin, value)));
        }
        Ok(FreeRun { label, margins })
    }
}

#[test]
fn a_minimum_that_leaves_through_the_end() {
    let network = trace(&Dip, &SQUARE, &exact()).unwrap();
    assert_eq!(network.unresolved, []);
    assert_eq!((network.curves.len(), network.vertices.len()), (3, 4));
    // The place is solved for from one side only; 1.9e-10 was measured.
    assert!(network.vertices.iter().any(|vertex| vertex.point.norm() < 4e-10));
    for curve in &network.curves {
        let height = |p: &Point| {
            let (a, b) = Dip::shape(p);
            if curve.margin == DipMargin::Minimum { a } else { a + (1.0 - b).powi(2) }
        };
        let inner = &curve.nodes[1..curve.nodes.len() - 1];
        assert!(inner.iter().all(|node| height(&node.point).abs() < 1e-12));
    }
}

/// A plane full of circles of many sizes, asked in order.
struct Circles(Vec<[f64; 3]>);

impl Family for Circles {
    type Label = Label;
    type Margin = Margin;
    type Error = Infallible;

    fn label(&self, point: &Point) -> Result<Label, Infallible> {
        Ok((0..self.0.len()).map(|i| self.value(i, point) < 0.0).collect())
    }

    fn margin(&self, point: &Point, margin: &Margin) -> Result<Option<f64>, Infallible> {
        Ok(Some(self.value(margin.0, point)))
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<Label, Margin>, Infallible> {
        let label = self.label(point)?;
        let margins =
            (0..self.0.len()).map(|i| ((i, label[..i].to_vec()), self.value(i, point))).collect();
        Ok(FreeRun { label, margins })
    }
}

impl Circles {
    fn value(&self, index: usize, point: &Point) -> f64 {
        let [x, y, radius] = self.0[index];
        // A little of everything, so that nothing is exact by accident; noise as of a run.
        let noise = 1e-14 * (1e9 * (point.x + 3.7 * point.y)).sin();
        ((point - Point::new(x, y)).norm_squared() - radius * radius) * (0.3 * point.x).exp()
            + noise
    }
}

/// Euler's formula for random circles: the curves between crossings and the crossings are those
/// that geometry tells.
#[test]
fn random_circles() {
    let mut state = 7_u64;
    let mut random = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    for case in 0..100 {
        let circles: Vec<[f64; 3]> = (0..9)
            .map(|_| [1.2 * random() - 0.6, 1.2 * random() - 0.6, 0.05 + 0.34 * random()])
            .collect();
        let mut crossings = vec![0; circles.len()];
        let mut vertices = 0;
        for i in 0..circles.len() {
            for j in 0..i {
                let ([a, b, r], [c, d, q]) = (circles[i], circles[j]);
                let distance = (a - c).hypot(b - d);
                if distance < r + q && distance > (r - q).abs() {
                    vertices += 2;
                    crossings[i] += 2;
                    crossings[j] += 2;
                }
            }
        }
        let curves: usize = crossings.iter().map(|&count| usize::max(count, 1)).sum();
        let network = trace(&Circles(circles.clone()), &SQUARE, &TraceOptions::default()).unwrap();
        assert_eq!(network.unresolved, [], "case {case}");
        let found = (network.curves.len(), network.vertices.len());
        assert_eq!(found, (curves, vertices), "case {case}: {circles:?}");
        for curve in &network.curves {
            let [x, y, radius] = circles[curve.margin.0];
            assert_on(curve, circle(x, y, radius));
        }
    }
}

#[test]
fn bad_input_is_named() {
    let family = Guards(vec![|p| p.x]);
    let options = TraceOptions { max_step: 0.5, ..exact() };
    let error = trace(&family, &SQUARE, &options).unwrap_err();
    assert_eq!(error.to_string(), "max_step is 0.5, expected above 0 to 0.25");
    let empty = Window { low: Point::new(0.0, 0.0), high: Point::new(1.0, 0.0) };
    let error = trace(&family, &empty, &exact()).unwrap_err();
    assert_eq!(error, TraceError::Window { window: empty });
    let nothing = Guards(vec![|p| if p.x > 0.5 { f64::NAN } else { 1.0 }]);
    let error = trace(&nothing, &SQUARE, &exact()).unwrap_err();
    assert!(matches!(error, TraceError::NotANumber { point } if point.x > 0.5));
}

/// The work of a trace is part of what it promises: 9.3 runs a node, the search for seeds included,
/// where nothing special happens.
#[test]
fn runs_of_a_trace() {
    let plain = |cells| {
        let options = TraceOptions { cells, ..exact() };
        let family = Guards(vec![|p| p.y - 0.2 * (4.0 * p.x).sin() - 0.1 * p.x * p.x]);
        trace(&family, &SQUARE, &options).unwrap()
    };
    let network = plain(2);
    assert_eq!(network.curves.len(), 1);
    let work = network.statistics;
    let runs = work.free_runs + work.prescribed_runs;
    assert!(runs < 10 * work.nodes, "{runs} runs for {} nodes", work.nodes);
}
