//! How an atlas is read back from its document.

use stickslip_model::Contact;
use stickslip_tracer::{
    Curve, Node, Point, Vertex,
    regions::{Finding, Location, Subdivision},
    tracing::Extremum,
};

use super::error::AtlasDocumentError;
use super::layout::{
    AtlasDocument, BoundaryFields, ExtremalParameter, ExtremumFields, RegionFields, SCHEMA,
    Switching, VertexFields, WindowFields, in_order,
};
use crate::atlas::boundary::BoundaryKind;
use crate::atlas::frame::Frame;
use crate::atlas::regions::{CollisionAtlas, Regions, switch_count};
use crate::chart::{Chart, Range};
use crate::family::CollisionPlane;

impl TryFrom<AtlasDocument> for CollisionAtlas {
    type Error = AtlasDocumentError;

    /// Reads an atlas back. The regions are made from the boundaries, as when the atlas was traced.
    /// The impact ratios of the window are not kept.
    ///
    /// # Errors
    /// [`AtlasDocumentError`]: the document contradicts itself, or its verification found something
    /// that speaks against it.
    fn try_from(document: AtlasDocument) -> Result<Self, AtlasDocumentError> {
        if document.schema != SCHEMA {
            return Err(AtlasDocumentError::Schema { found: document.schema });
        }
        if let Some(objection) = document.verification.objection() {
            return Err(AtlasDocumentError::Doubtful { objection });
        }
        let (frame, tolerance) = (frame(&document.window)?, document.tolerance);
        if !(tolerance > 0.0 && tolerance <= 1e-6) {
            return Err(AtlasDocumentError::Tolerance { tolerance });
        }
        let chart = document.chart.unwrap_or(Chart::PLAIN);
        let plane = frame.plane()?.with_chart(chart);
        plane.sheet().require_wide(plane.names())?;
        require_chart(&plane)?;
        let curves = document.boundaries.iter().enumerate();
        let curves = curves.map(|(index, boundary)| curve(&chart, index, boundary));
        let curves = curves.collect::<Result<Vec<_>, _>>()?;
        let vertices = document.vertices.iter().enumerate();
        let vertices = vertices.map(|(index, fields)| vertex(&chart, index, fields));
        let vertices = vertices.collect::<Result<Vec<_>, _>>()?;
        let nodes = curves.iter().flat_map(|curve| &curve.nodes);
        let resolution = plane.sheet().resolution_of(nodes, tolerance);
        let mut regions = Subdivision::new(plane.window(), curves, vertices, resolution)?;
        // Thin regions were found there by collisions, or there would be an objection above.
        let is_thin = |finding: &&Finding<_>| matches!(finding, Finding::Thin { .. });
        if let Some(finding) = regions.findings().iter().find(|finding| !is_thin(finding)) {
            return Err(AtlasDocumentError::Finding(finding.clone()));
        }
        require_regions(&chart, &regions, &document.regions)?;
        if let Some(whole) = document.regions.first() {
            regions.label_rest(|_| Some(whole.switching.itinerary.clone()));
        }
        let extrema = document.extrema.iter().map(|one| extremum(&chart, one)).collect();
        let report = document.verification;
        Ok(Self { plane, ratio: None, tolerance, regions, extrema, report })
    }
}

/// The window; impact ratios are not read.
fn frame(window: &WindowFields) -> Result<Frame, AtlasDocumentError> {
    let range = |name, [low, high]: [f64; 2]| {
        if low > 0.0 && low < high && high.is_finite() {
            return Ok(Range { low, high });
        }
        Err(AtlasDocumentError::Window { name, low, high })
    };
    if !(0.0..f64::INFINITY).contains(&window.damping) {
        return Err(AtlasDocumentError::Damping { damping: window.damping });
    }
    let (kappa, psi) = (range("kappa", window.kappa)?, range("psi", window.psi)?);
    let law = window.law.unwrap_or_default();
    let tangential_damping = window.tangential_damping.unwrap_or(0.0);
    Contact::new(kappa.low, psi.low, window.damping)
        .and_then(|contact| contact.with_law(law, tangential_damping))?;
    Ok(Frame { law, tangential_damping, ..Frame::new(kappa, psi, window.damping) })
}

/// Refuses a chart that does not map the window onto an area.
fn require_chart(plane: &CollisionPlane) -> Result<(), AtlasDocumentError> {
    let (window, chart) = (plane.window(), plane.chart());
    let extent = window.extent();
    let corners = [window.low, window.high];
    let finite = corners.iter().all(|corner| corner.iter().all(|part| part.is_finite()));
    let numbers = [chart.kappa, chart.width, chart.spread, chart.height];
    if finite && extent.min() > 0.0 && numbers.iter().all(|&number| number > 0.0) {
        return Ok(());
    }
    Err(AtlasDocumentError::Chart(*chart))
}

/// The curve of a boundary in traced coordinates.
fn curve(
    chart: &Chart,
    index: usize,
    boundary: &BoundaryFields,
) -> Result<Curve<String, BoundaryKind>, AtlasDocumentError> {
    require_id("boundaries", index, boundary.id)?;
    let (points, tangents) = (&boundary.points, &boundary.tangents);
    if points.len() < 2 || points.len() != tangents.len() {
        let (points, tangents) = (points.len(), tangents.len());
        return Err(AtlasDocumentError::Tangents { boundary: index, points, tangents });
    }
    let mut nodes = Vec::with_capacity(points.len());
    for (place, (point, tangent)) in points.iter().zip(tangents).enumerate() {
        let point = positive(chart, *point, || format!("boundaries[{index}].points[{place}]"))?;
        nodes.push(Node { point, tangent: Point::from(*tangent) });
    }
    let below = checked(boundary.below.clone(), || format!("boundaries[{index}].below"))?;
    let above = checked(boundary.above.clone(), || format!("boundaries[{index}].above"))?;
    let sides = in_order(&nodes, [below, above]);
    Ok(Curve { margin: boundary.kind, sides, nodes, ends: boundary.vertices })
}

/// The vertex in traced coordinates.
fn vertex(
    chart: &Chart,
    index: usize,
    vertex: &VertexFields,
) -> Result<Vertex<BoundaryKind>, AtlasDocumentError> {
    require_id("vertices", index, vertex.id)?;
    let point = positive(chart, [vertex.kappa, vertex.psi], || format!("vertices[{index}]"))?;
    Ok(Vertex { point, kind: vertex.kind, margins: Vec::new() })
}

/// The point at which a boundary turns back, in traced coordinates.
fn extremum(chart: &Chart, fields: &ExtremumFields) -> Extremum {
    let point = chart.point(fields.kappa, fields.psi);
    Extremum {
        curve: fields.boundary,
        axis: usize::from(fields.of == ExtremalParameter::Psi),
        point,
    }
}

/// Refuses a list of other regions than the boundaries make.
fn require_regions(
    chart: &Chart,
    regions: &Regions,
    listed: &[RegionFields],
) -> Result<(), AtlasDocumentError> {
    if listed.len() != regions.regions().len() {
        let (listed, made) = (listed.len(), regions.regions().len());
        return Err(AtlasDocumentError::Regions { listed, made });
    }
    for (index, region) in listed.iter().enumerate() {
        require_id("regions", index, region.id)?;
        let itinerary = checked(region.switching.clone(), || format!("regions[{index}]"))?;
        let sample = positive(chart, region.sample, || format!("regions[{index}].sample"))?;
        let made = &regions.regions()[index];
        let fits = made.label.as_ref().is_none_or(|around| *around == itinerary);
        let is_there = match regions.locate(&sample) {
            Location::Region(found) => found == index,
            Location::OnBoundary { curve, .. } => {
                let is_thin = made.clearance <= regions.tolerance();
                is_thin && regions.regions_beside(curve).contains(&Some(index))
            }
            Location::Outside => false,
        };
        if !fits || !is_there {
            return Err(AtlasDocumentError::Region { region: index });
        }
    }
    Ok(())
}

/// The itinerary, if it is one and has as many switches as the count says.
fn checked(switching: Switching, place: impl Fn() -> String) -> Result<String, AtlasDocumentError> {
    let Switching { switch_count: count, itinerary } = switching;
    let phases = itinerary.as_bytes();
    let known = !phases.is_empty() && phases.iter().all(|phase| b"+o-".contains(phase));
    let alternating = phases.windows(2).all(|pair| (pair[0] == b'o') != (pair[1] == b'o'));
    if known && alternating && switch_count(&itinerary) == count {
        return Ok(itinerary);
    }
    Err(AtlasDocumentError::Switching { place: place(), switch_count: count, itinerary })
}

/// A point (κ, ψ) in traced coordinates.
fn positive(
    chart: &Chart,
    [kappa, psi]: [f64; 2],
    place: impl Fn() -> String,
) -> Result<Point, AtlasDocumentError> {
    if kappa > 0.0 && psi > 0.0 {
        return Ok(chart.point(kappa, psi));
    }
    Err(AtlasDocumentError::Point { place: place(), kappa, psi })
}

/// Refuses an entry whose `id` is not its index.
fn require_id(list: &'static str, index: usize, id: usize) -> Result<(), AtlasDocumentError> {
    if id == index {
        return Ok(());
    }
    Err(AtlasDocumentError::Id { list, index, id })
}
