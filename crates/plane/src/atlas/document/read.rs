//! An atlas read back from its document.

use std::collections::BTreeMap;

use stickslip_tracer::{
    Curve, Finding, Location, Node, Point, Subdivision, SubdivisionError, Vertex,
};

use super::boundary::Kind;
use super::document::{BoundaryFields, Document, Switching, WindowFields, in_order};
use super::frame::{Frame, TooNarrow, traced};
use super::regions::{Atlas, switch_count};
use crate::range::Range;

/// Why a document is not an atlas. Places are named as in the document: `boundaries[3].points[0]`.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DocumentError {
    /// The verification found something that speaks against the atlas.
    #[error("verification: {objection}; expected an atlas against which nothing speaks")]
    Doubtful {
        /// What it found.
        objection: String,
    },
    /// An interval of the window is empty.
    #[error("window.{name} = [{low:?}, {high:?}]: expected [LO, HI] with 0 < LO < HI")]
    Window {
        /// The field.
        name: &'static str,
        /// Its lower end.
        low: f64,
        /// Its upper end.
        high: f64,
    },
    /// The damping is negative.
    #[error("window.damping = {damping:?}: expected 0 or above")]
    Damping {
        /// Its value.
        damping: f64,
    },
    /// The accuracy is out of its range.
    #[error("tolerance = {tolerance:?}: expected above 0 to 1e-6")]
    Tolerance {
        /// Its value.
        tolerance: f64,
    },
    /// The window is too narrow.
    #[error("window: {0}")]
    Narrow(#[from] TooNarrow),
    /// An entry of a list has another place than its `id` says.
    #[error("{list}[{index}].id = {id}; expected {index}, its place in the list")]
    Id {
        /// The list.
        list: &'static str,
        /// The place of the entry.
        index: usize,
        /// Its `id`.
        id: usize,
    },
    /// A point has a coordinate that is not above 0.
    #[error("{place}: kappa = {kappa:?}, psi = {psi:?}; expected numbers above 0")]
    Point {
        /// The place in the document.
        place: String,
        /// κ of the point.
        kappa: f64,
        /// ψ of the point.
        psi: f64,
    },
    /// A boundary has too few points, or not one tangent for each.
    #[error(
        "boundaries[{boundary}] has {points} points and {tangents} tangents; expected at least two, \
         and as many of both"
    )]
    Tangents {
        /// The index of the boundary.
        boundary: usize,
        /// The number of its points.
        points: usize,
        /// The number of its tangents.
        tangents: usize,
    },
    /// A number of switches and an itinerary contradict each other.
    #[error(
        "{place}: switch_count {switch_count} and itinerary {itinerary:?} do not fit; expected o in \
         turns with + or -, one for each phase, one more than there are switches"
    )]
    Switching {
        /// The place in the document.
        place: String,
        /// The number of switches.
        switch_count: usize,
        /// The itinerary.
        itinerary: String,
    },
    /// The boundaries do not divide the window.
    #[error("the boundaries make no regions: {0}")]
    Subdivision(#[from] SubdivisionError),
    /// The boundaries contradict each other.
    #[error("the boundaries do not fit together: {0}")]
    Finding(Finding<String>),
    /// There are more or fewer regions than the boundaries make.
    #[error(
        "regions has {listed} entries, and the boundaries make {made} regions; expected one for each"
    )]
    Regions {
        /// The number of entries.
        listed: usize,
        /// The number of regions.
        made: usize,
    },
    /// A region contradicts the boundaries around it.
    #[error("regions[{region}] is not what the boundaries around it say")]
    Region {
        /// The index of the region.
        region: usize,
    },
}

impl TryFrom<Document> for Atlas {
    type Error = DocumentError;

    /// Reads an atlas back; regions are made anew from the boundaries, as when it was traced.
    ///
    /// # Errors
    /// [`DocumentError`]: the document does not fit together, or its verification found something
    /// that speaks against it.
    fn try_from(document: Document) -> Result<Self, DocumentError> {
        let Document { window, tolerance, boundaries, vertices, regions, verification, .. } =
            document;
        if let Some(objection) = verification.objection() {
            return Err(DocumentError::Doubtful { objection });
        }
        let frame = frame(&window)?;
        if !(tolerance > 0.0 && tolerance <= 1e-6) {
            return Err(DocumentError::Tolerance { tolerance });
        }
        frame.require_wide()?;
        let curves = boundaries
            .iter()
            .enumerate()
            .map(|(index, boundary)| curve(index, boundary))
            .collect::<Result<Vec<_>, _>>()?;
        let mut corners = Vec::with_capacity(vertices.len());
        for (index, vertex) in vertices.iter().enumerate() {
            require_id("vertices", index, vertex.id)?;
            let place = || format!("vertices[{index}]");
            let point = positive([vertex.kappa, vertex.psi], place)?;
            corners.push(Vertex { point, kind: vertex.kind.into(), margins: Vec::new() });
        }
        let map = Subdivision::new(frame.window(), curves, corners, frame.resolution(tolerance))?;
        if let Some(finding) = map.findings().first() {
            return Err(DocumentError::Finding(finding.clone()));
        }
        if regions.len() != map.regions().len() {
            let (listed, made) = (regions.len(), map.regions().len());
            return Err(DocumentError::Regions { listed, made });
        }
        let mut unbounded = BTreeMap::new();
        for (index, region) in regions.into_iter().enumerate() {
            require_id("regions", index, region.id)?;
            let place = || format!("regions[{index}]");
            let itinerary = checked(region.switching, place)?;
            let sample = positive(region.sample, || format!("regions[{index}].sample"))?;
            let around = &map.regions()[index].label;
            let fits = around.as_ref().is_none_or(|around| *around == itinerary);
            if !fits || map.locate(&sample) != Location::Region(index) {
                return Err(DocumentError::Region { region: index });
            }
            if around.is_none() {
                unbounded.insert(index, itinerary);
            }
        }
        Ok(Self { frame, tolerance, regions: map, unbounded })
    }
}

fn frame(window: &WindowFields) -> Result<Frame, DocumentError> {
    let range = |name, [low, high]: [f64; 2]| {
        if low > 0.0 && low < high {
            return Ok(Range { low, high });
        }
        Err(DocumentError::Window { name, low, high })
    };
    if window.damping < 0.0 {
        return Err(DocumentError::Damping { damping: window.damping });
    }
    let (kappa, psi) = (range("kappa", window.kappa)?, range("psi", window.psi)?);
    Ok(Frame { kappa, psi, ratio: None, damping: window.damping })
}

fn curve(index: usize, boundary: &BoundaryFields) -> Result<Curve<String, Kind>, DocumentError> {
    require_id("boundaries", index, boundary.id)?;
    let (points, tangents) = (&boundary.points, &boundary.tangents);
    if points.len() < 2 || points.len() != tangents.len() {
        let (points, tangents) = (points.len(), tangents.len());
        return Err(DocumentError::Tangents { boundary: index, points, tangents });
    }
    let mut nodes = Vec::with_capacity(points.len());
    for (place, (point, tangent)) in points.iter().zip(tangents).enumerate() {
        let point = positive(*point, || format!("boundaries[{index}].points[{place}]"))?;
        nodes.push(Node { point, tangent: Point::from(*tangent) });
    }
    let below = checked(boundary.below.clone(), || format!("boundaries[{index}].below"))?;
    let above = checked(boundary.above.clone(), || format!("boundaries[{index}].above"))?;
    let sides = in_order(&nodes, [below, above]);
    Ok(Curve { margin: boundary.kind, sides, nodes, ends: boundary.vertices })
}

/// The itinerary, whose length must fit the count.
fn checked(switching: Switching, place: impl Fn() -> String) -> Result<String, DocumentError> {
    let Switching { switch_count: count, itinerary } = switching;
    let phases = itinerary.as_bytes();
    let known = !phases.is_empty() && phases.iter().all(|phase| b"+o-".contains(phase));
    let alternating = phases.windows(2).all(|pair| (pair[0] == b'o') != (pair[1] == b'o'));
    if known && alternating && switch_count(&itinerary) == count {
        return Ok(itinerary);
    }
    Err(DocumentError::Switching { place: place(), switch_count: count, itinerary })
}

/// A point (κ, ψ) in traced coordinates.
fn positive([kappa, psi]: [f64; 2], place: impl Fn() -> String) -> Result<Point, DocumentError> {
    if kappa > 0.0 && psi > 0.0 {
        return Ok(traced([kappa, psi]));
    }
    Err(DocumentError::Point { place: place(), kappa, psi })
}

fn require_id(list: &'static str, index: usize, id: usize) -> Result<(), DocumentError> {
    if id == index {
        return Ok(());
    }
    Err(DocumentError::Id { list, index, id })
}
