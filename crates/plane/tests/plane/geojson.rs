use geojson::GeometryValue;
use stickslip_plane::atlas::geojson;

use crate::windows::crossing;

#[test]
fn regions_boundaries_and_vertices_are_features() {
    let verified = crossing();
    let collection = geojson(verified);
    let regions = &verified.regions;
    let kinds: Vec<_> = collection
        .features
        .iter()
        .map(|feature| feature.property("feature").unwrap().as_str().unwrap())
        .collect();
    let count = |kind: &str| kinds.iter().filter(|found| **found == kind).count();
    assert_eq!(count("region"), regions.regions().len());
    assert_eq!(count("boundary"), regions.curves().len());
    assert_eq!(count("vertex"), regions.vertices().len());
    assert!(
        kinds.is_sorted_by_key(|kind| ["region", "boundary", "vertex"]
            .iter()
            .position(|k| k == kind))
    );
}

#[test]
fn polygons_of_the_regions_cover_the_window() {
    let collection = geojson(crossing());
    let mut covered = 0.0;
    for feature in &collection.features {
        let Some(GeometryValue::Polygon { coordinates: rings }) =
            feature.geometry.as_ref().map(|geometry| &geometry.value)
        else {
            continue;
        };
        let ring = &rings[0];
        assert_eq!(ring.first(), ring.last());
        let doubled: f64 =
            ring.windows(2).map(|pair| pair[0][0] * pair[1][1] - pair[1][0] * pair[0][1]).sum();
        assert!(doubled > 0.0, "a ring runs counterclockwise");
        covered += 0.5 * doubled;
    }
    assert!((covered - 3.0 * 0.1).abs() < 1e-9, "{covered}");
}
