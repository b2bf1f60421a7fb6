//! An atlas read back from its file.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use stickslip_tracer::{Curve, Location, Node, Point, Subdivision, Vertex};

use super::boundary::{Kind, in_order};
use super::document::{BoundaryFields, Document, Switching, WindowFields};
use super::frame::traced;
use super::{Atlas, Frame, switch_count};
use crate::error::Failure;
use crate::json_input;
use crate::range::Range;
use crate::schema::ATLAS;

impl Atlas {
    /// Reads `path`.
    ///
    /// # Errors
    /// [`Failure::Input`]: it cannot be read, is no atlas, or one that does not fit together.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let unusable = |reason: String| Failure::input(path, reason);
        let text = fs::read(path).map_err(|error| unusable(format!("cannot be read: {error}")))?;
        let schema: Schema = json_input::parse(&text).map_err(unusable)?;
        if schema.schema != ATLAS {
            return Err(unusable(format!(
                "schema is {:?}; expected {ATLAS:?}, which stickslip trace writes",
                schema.schema
            )));
        }
        let document: Document = json_input::parse(&text).map_err(unusable)?;
        Self::new(document).map_err(unusable)
    }

    fn new(document: Document) -> Result<Self, String> {
        let Document { window, tolerance, boundaries, vertices, regions, verification, .. } =
            document;
        if let Some(objection) = verification.objection() {
            return Err(format!(
                "verification: {objection}; expected an atlas against which nothing speaks"
            ));
        }
        let frame = frame(&window)?;
        if !(tolerance > 0.0 && tolerance <= 1e-6) {
            return Err(format!("tolerance = {tolerance:?}: expected above 0 to 1e-6"));
        }
        frame.require_wide().map_err(|reason| format!("window: {reason}"))?;
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
        let map = Subdivision::new(frame.window(), curves, corners, frame.resolution(tolerance))
            .map_err(|error| format!("the boundaries make no regions: {error}"))?;
        if let Some(finding) = map.findings().first() {
            return Err(format!("the boundaries do not fit together: {finding}"));
        }
        if regions.len() != map.regions().len() {
            return Err(format!(
                "regions has {} entries, and the boundaries make {} regions; expected one for each",
                regions.len(),
                map.regions().len()
            ));
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
                return Err(format!("regions[{index}] is not what the boundaries around it say"));
            }
            if around.is_none() {
                unbounded.insert(index, itinerary);
            }
        }
        Ok(Self { frame, tolerance, map, unbounded })
    }
}

/// What is read before the rest.
#[derive(serde::Deserialize)]
struct Schema {
    schema: String,
}

fn frame(window: &WindowFields) -> Result<Frame, String> {
    let range = |name: &str, [low, high]: [f64; 2]| {
        if low > 0.0 && low < high {
            return Ok(Range { low, high });
        }
        Err(format!("window.{name} = [{low:?}, {high:?}]: expected [LO, HI] with 0 < LO < HI"))
    };
    if window.damping < 0.0 {
        return Err(format!("window.damping = {:?}: expected 0 or above", window.damping));
    }
    let (kappa, psi) = (range("kappa", window.kappa)?, range("psi", window.psi)?);
    Ok(Frame { kappa, psi, ratio: None, damping: window.damping })
}

fn curve(index: usize, boundary: &BoundaryFields) -> Result<Curve<String, Kind>, String> {
    require_id("boundaries", index, boundary.id)?;
    let (points, tangents) = (&boundary.points, &boundary.tangents);
    if points.len() < 2 || points.len() != tangents.len() {
        return Err(format!(
            "boundaries[{index}] has {} points and {} tangents; expected at least two, and as \
             many of both",
            points.len(),
            tangents.len()
        ));
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
fn checked(switching: Switching, place: impl Fn() -> String) -> Result<String, String> {
    let Switching { switch_count: count, itinerary } = switching;
    let phases = itinerary.as_bytes();
    let known = !phases.is_empty() && phases.iter().all(|phase| b"+o-".contains(phase));
    let alternating = phases.windows(2).all(|pair| (pair[0] == b'o') != (pair[1] == b'o'));
    if known && alternating && switch_count(&itinerary) == count {
        return Ok(itinerary);
    }
    Err(format!(
        "{}: switch_count {count} and itinerary {itinerary:?} do not fit; expected o in turns \
         with + or -, one for each phase, one more than there are switches",
        place()
    ))
}

/// A point (κ, ψ) in traced coordinates.
fn positive([kappa, psi]: [f64; 2], place: impl Fn() -> String) -> Result<Point, String> {
    if kappa > 0.0 && psi > 0.0 {
        return Ok(traced([kappa, psi]));
    }
    Err(format!("{}: kappa = {kappa:?}, psi = {psi:?}; expected numbers above 0", place()))
}

fn require_id(list: &str, index: usize, id: usize) -> Result<(), String> {
    if id == index {
        return Ok(());
    }
    Err(format!("{list}[{index}].id = {id}; expected {index}, its place in the list"))
}
