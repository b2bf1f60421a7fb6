//! An atlas as GeoJSON, for programs that draw maps.

use geojson::{Feature, FeatureCollection, Geometry, JsonObject};
use serde_json::json;
use stickslip_tracer::regions::{CurveSide, OutlinePart};

use super::document::AtlasDocument;
use super::regions::CollisionAtlas;
use crate::chart::Chart;

/// A closed line of points (κ, ψ), or a piece of one.
type Ring = Vec<[f64; 2]>;

/// An atlas as GeoJSON: its regions, its boundaries and its vertices, in this order.
///
/// The coordinates are (κ, ψ).
pub fn geojson(atlas: &CollisionAtlas) -> FeatureCollection {
    document_geojson(atlas, &AtlasDocument::new(atlas))
}

/// As [`geojson()`], of an atlas with its document.
pub fn document_geojson(atlas: &CollisionAtlas, document: &AtlasDocument) -> FeatureCollection {
    let lines = atlas.polylines();
    let regions = document.regions.iter().map(|region| {
        let properties = json!({
            "feature": "region",
            "id": region.id,
            "switch_count": region.switching.switch_count,
            "itinerary": region.switching.itinerary,
            "area_share": region.area_share,
        });
        feature(polygons(atlas, &lines, region.id), properties)
    });
    let boundaries = document.boundaries.iter().zip(&lines).map(|(boundary, line)| {
        let properties = json!({
            "feature": "boundary",
            "id": boundary.id,
            "kind": boundary.kind,
            "below_switch_count": boundary.below.switch_count,
            "below_itinerary": boundary.below.itinerary,
            "above_switch_count": boundary.above.switch_count,
            "above_itinerary": boundary.above.itinerary,
        });
        feature(Geometry::new_line_string(line.iter().copied()), properties)
    });
    let vertices = document.vertices.iter().map(|vertex| {
        let kind = vertex.kind.name();
        let properties = json!({ "feature": "vertex", "id": vertex.id, "kind": kind });
        feature(Geometry::new_point([vertex.kappa, vertex.psi]), properties)
    });
    FeatureCollection::new(regions.chain(boundaries).chain(vertices))
}

fn feature(geometry: Geometry, properties: serde_json::Value) -> Feature {
    let properties = match properties {
        serde_json::Value::Object(properties) => properties,
        _ => JsonObject::new(),
    };
    Feature { geometry: Some(geometry), properties: Some(properties), ..Feature::default() }
}

/// A region as one polygon with holes, or as several polygons that touch at vertices.
fn polygons(atlas: &CollisionAtlas, lines: &[Ring], region: usize) -> Geometry {
    let rings = atlas.regions.outlines(region).into_iter();
    let rings = rings.map(|outline| ring(atlas.plane.chart(), lines, &outline));
    let (around, holes): (Vec<Ring>, Vec<Ring>) = rings.partition(|ring| area(ring) > 0.0);
    let single = around.len() == 1;
    let mut polygons: Vec<Vec<Ring>> = around.into_iter().map(|ring| vec![ring]).collect();
    for hole in holes {
        let [a, b] = [hole[0], hole[1]];
        let inside = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
        if let Some(own) = polygons.iter_mut().find(|own| single || contains(&own[0], inside)) {
            own.push(hole);
        }
    }
    if single {
        Geometry::new_polygon(polygons.swap_remove(0))
    } else {
        Geometry::new_multi_polygon(polygons)
    }
}

/// The closed line along an outline.
fn ring(chart: &Chart, lines: &[Ring], outline: &[OutlinePart]) -> Ring {
    let mut points = Ring::new();
    for stretch in outline {
        // Each stretch begins with the last point of the one before.
        points.pop();
        match *stretch {
            OutlinePart::Curve(curve, CurveSide::Left) => points.extend(&lines[curve]),
            OutlinePart::Curve(curve, CurveSide::Right) => points.extend(lines[curve].iter().rev()),
            OutlinePart::Window(ends) => {
                points.extend(ends.iter().map(|end| chart.parameters(end)));
            }
        }
    }
    points.pop();
    points.extend(points.first().copied());
    points
}

/// The area of a ring, positive if the ring runs counterclockwise.
fn area(ring: &[[f64; 2]]) -> f64 {
    let origin = ring[0];
    let from_origin = |point: [f64; 2]| [point[0] - origin[0], point[1] - origin[1]];
    let triangle = |pair: &[[f64; 2]]| {
        let [[a, b], [c, d]] = [from_origin(pair[0]), from_origin(pair[1])];
        0.5 * (a * d - b * c)
    };
    ring.windows(2).map(triangle).sum()
}

/// Whether a point is inside a ring: a ray to the right then crosses the ring an odd number of
/// times.
fn contains(ring: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let crosses = |pair: &&[[f64; 2]]| {
        let [[a, b], [c, d]] = [pair[0], pair[1]];
        (b > y) != (d > y) && x < a + (y - b) / (d - b) * (c - a)
    };
    ring.windows(2).filter(crosses).count() % 2 == 1
}
