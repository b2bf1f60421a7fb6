//! How the document of an atlas is made.

use stickslip_model::Law;
use stickslip_tracer::{Curve, Node, tracing::Extremum};

use super::layout::{
    AtlasDocument, BoundaryEnd, BoundaryFields, ExtremalParameter, ExtremumFields, RegionFields,
    SCHEMA, Switching, VertexFields, WindowFields, in_order,
};
use crate::atlas::boundary::BoundaryKind;
use crate::atlas::frame::Frame;
use crate::atlas::regions::{CollisionAtlas, switch_count};
use crate::chart::Chart;

impl AtlasDocument {
    /// The document of an atlas of κ and ψ.
    pub fn new(atlas: &CollisionAtlas) -> Self {
        let CollisionAtlas { plane, tolerance, regions, extrema, report, .. } = atlas;
        let chart = plane.chart();
        let boundaries = regions.curves().iter().enumerate();
        Self {
            schema: SCHEMA.to_owned(),
            window: WindowFields::new(&atlas.frame()),
            chart: (*chart != Chart::PLAIN).then_some(*chart),
            tolerance: *tolerance,
            boundaries: boundaries
                .map(|(id, curve)| BoundaryFields::new(atlas, id, curve))
                .collect(),
            vertices: vertices(atlas),
            extrema: extrema.iter().map(|one| ExtremumFields::new(chart, one)).collect(),
            regions: (0..regions.regions().len()).map(|id| RegionFields::new(atlas, id)).collect(),
            verification: report.clone(),
        }
    }
}

impl WindowFields {
    pub(crate) fn new(frame: &Frame) -> Self {
        Self {
            kappa: [frame.kappa.low, frame.kappa.high],
            psi: [frame.psi.low, frame.psi.high],
            damping: frame.damping,
            law: (frame.law != Law::PAPER).then_some(frame.law),
            tangential_damping: (frame.tangential_damping != 0.0)
                .then_some(frame.tangential_damping),
            ratio: frame.ratio.map(|ratio| [ratio.range.low, ratio.range.high]),
            mu: frame.ratio.map(|ratio| ratio.reduction.mu),
            alpha: frame.ratio.map(|ratio| ratio.reduction.alpha),
        }
    }
}

impl BoundaryFields {
    fn new(atlas: &CollisionAtlas, id: usize, curve: &Curve<String, BoundaryKind>) -> Self {
        let [below, above] = in_order(&curve.nodes, curve.sides.each_ref());
        let vertices = atlas.regions.vertices();
        let place = |end: usize| match curve.ends.map(|ends| vertices[ends[end]].kind) {
            None => BoundaryEnd::Closed,
            Some(kind) if kind.is_on_window() => BoundaryEnd::Window,
            Some(_) => BoundaryEnd::Vertex,
        };
        let point = |node: &Node| atlas.plane.sheet().snapped(&node.point);
        Self {
            id,
            kind: curve.margin,
            below: Switching::new(below),
            above: Switching::new(above),
            points: curve.nodes.iter().map(point).collect(),
            tangents: curve.nodes.iter().map(|node| node.tangent.into()).collect(),
            start: place(0),
            end: place(1),
            vertices: curve.ends,
        }
    }
}

/// All vertices, each with the boundaries that start or end there.
fn vertices(atlas: &CollisionAtlas) -> Vec<VertexFields> {
    let CollisionAtlas { plane, regions, .. } = atlas;
    let mut ending = vec![Vec::new(); regions.vertices().len()];
    for (id, curve) in regions.curves().iter().enumerate() {
        for vertex in curve.ends.into_iter().flatten() {
            if ending[vertex].last() != Some(&id) {
                ending[vertex].push(id);
            }
        }
    }
    let vertices = regions.vertices().iter().zip(ending).enumerate();
    vertices
        .map(|(id, (vertex, boundaries))| {
            let [kappa, psi] = plane.sheet().snapped(&vertex.point);
            VertexFields { id, kind: vertex.kind, kappa, psi, boundaries }
        })
        .collect()
}

impl ExtremumFields {
    fn new(chart: &Chart, extremum: &Extremum) -> Self {
        let [kappa, psi] = chart.parameters(&extremum.point);
        let of = if extremum.axis == 0 { ExtremalParameter::Kappa } else { ExtremalParameter::Psi };
        Self { boundary: extremum.curve, of, kappa, psi }
    }
}

impl RegionFields {
    fn new(atlas: &CollisionAtlas, id: usize) -> Self {
        let region = &atlas.regions.regions()[id];
        let mut boundaries: Vec<usize> = region.boundary.iter().map(|side| side.0).collect();
        boundaries.sort_unstable();
        boundaries.dedup();
        Self {
            id,
            switching: Switching::new(atlas.itinerary(id)),
            sample: atlas.plane.parameters(&region.sample),
            area_share: region.area / atlas.regions.window().area(),
            boundaries,
        }
    }
}

impl Switching {
    fn new(itinerary: &str) -> Self {
        Self { switch_count: switch_count(itinerary), itinerary: itinerary.to_owned() }
    }
}
