use stickslip_model::Reduction;
use stickslip_plane::atlas::{
    AtlasDocument, AtlasDocumentError, BoundaryEnd, CollisionAtlas, MismatchFields, RatioRange,
    SCHEMA,
};
use stickslip_plane::{Range, sealed};

use crate::windows::{crossing, empty, frame, traced};

/// The atlas as it comes back from its JSON.
fn through_json(verified: &CollisionAtlas) -> CollisionAtlas {
    let json = serde_json::to_string(&AtlasDocument::new(verified)).unwrap();
    let document: AtlasDocument = serde_json::from_str(&json).unwrap();
    assert_eq!(document, AtlasDocument::new(verified));
    CollisionAtlas::try_from(document).unwrap()
}

#[test]
fn an_atlas_comes_back_bit_for_bit() {
    for verified in [crossing(), empty()] {
        let read = through_json(verified);
        // Numbers in debug output have all their digits.
        assert_eq!(format!("{read:?}"), format!("{verified:?}"));
    }
}

#[test]
fn a_document_has_the_names_of_its_schema() {
    let json = serde_json::to_value(AtlasDocument::new(crossing())).unwrap();
    let keys = |value: &serde_json::Value| {
        value.as_object().unwrap().keys().cloned().collect::<Vec<_>>().join(" ")
    };
    assert_eq!(json["schema"], SCHEMA);
    assert_eq!(
        keys(&json),
        "schema window tolerance boundaries vertices extrema regions verification"
    );
    assert_eq!(keys(&json["window"]), "kappa psi damping");
    assert_eq!(
        keys(&json["boundaries"][0]),
        "id kind below above points tangents start end vertices"
    );
    assert_eq!(keys(&json["boundaries"][0]["below"]), "switch_count itinerary");
    assert_eq!(keys(&json["vertices"][0]), "id kind kappa psi boundaries");
    assert_eq!(keys(&json["regions"][0]), "id switch_count itinerary sample area_share boundaries");
    assert_eq!(
        keys(&json["verification"]),
        "agrees method euler random_points near_points tried undecided mismatches unresolved \
         findings untried_boundaries share_tried share_wrong_bound"
    );
    assert_eq!(keys(&json["verification"]["euler"]), "vertices edges faces components holds");
    let words = |list: &str, name: &str| {
        let entries = json[list].as_array().unwrap().iter();
        let mut words: Vec<_> = entries.map(|entry| entry[name].as_str().unwrap()).collect();
        words.sort_unstable();
        words.dedup();
        words
    };
    assert_eq!(words("boundaries", "kind"), ["end-of-contact", "stick-graze"]);
    assert_eq!(words("boundaries", "start"), ["vertex", "window"]);
    assert_eq!(words("vertices", "kind"), ["crossing", "window-edge"]);
}

/// One of the two regions is thinner than the tolerance.
#[test]
fn an_atlas_with_a_thin_region_comes_back() {
    let verified = traced(frame((1.5684, 1.5686), (0.9999, 1.0)));
    assert_eq!(verified.regions.findings().len(), 1);
    assert_eq!(through_json(&verified).regions.regions().len(), 2);
}

#[test]
fn a_window_in_impact_ratios_keeps_them_in_the_file() {
    let reduction = Reduction { mu: 0.4, alpha: 2.0 / 7.0 };
    let ratio = RatioRange { range: Range { low: 3.5, high: 4.2 }, reduction };
    let mut verified = empty().clone();
    verified.ratio = Some(ratio);
    let document = AtlasDocument::new(&verified);
    assert_eq!(document.window.ratio, Some([3.5, 4.2]));
    assert_eq!((document.window.mu, document.window.alpha), (Some(0.4), Some(2.0 / 7.0)));
    assert_eq!(through_json(&verified).frame(), frame((5.0, 6.0), (2.5, 3.0)));
}

#[test]
fn ends_of_boundaries_are_on_the_window_or_at_the_crossing() {
    let document = AtlasDocument::new(crossing());
    let ends = document.boundaries.iter().flat_map(|boundary| [boundary.start, boundary.end]);
    let at_vertex = ends.filter(|end| *end == BoundaryEnd::Vertex).count();
    assert_eq!(at_vertex, 4);
}

/// What the reader says of the document of the crossing after `change`.
fn refused(change: impl FnOnce(&mut AtlasDocument)) -> (AtlasDocumentError, String) {
    let mut document = AtlasDocument::new(crossing());
    change(&mut document);
    let error = CollisionAtlas::try_from(document).unwrap_err();
    let text = error.to_string();
    (error, text)
}

#[test]
fn another_layout_is_refused() {
    let (error, text) = refused(|document| document.schema = "stickslip.atlas/2".to_owned());
    assert_eq!(error, AtlasDocumentError::Schema { found: "stickslip.atlas/2".to_owned() });
    assert_eq!(text, r#"schema = "stickslip.atlas/2": expected "stickslip.atlas/1""#);
}

#[test]
fn an_atlas_against_which_something_speaks_is_refused() {
    let (error, text) = refused(|document| {
        document.verification.agrees = false;
        document.verification.mismatches = vec![MismatchFields {
            kappa: 18.5,
            psi: 0.6,
            region: 2,
            expected: "+o-".to_owned(),
            found: "+".to_owned(),
            near_boundary: false,
        }];
    });
    let objection = "1 mismatches, 0 unresolved, 0 findings, 0 points without a label; the first: \
                     kappa = 18.5, psi = 0.6 has +, its region 2 +o-";
    assert_eq!(error, AtlasDocumentError::Doubtful { objection: objection.to_owned() });
    assert!(text.contains(objection), "{text}");
    let (error, _) = refused(|document| document.verification.agrees = false);
    let objection = "0 mismatches, 0 unresolved, 0 findings, 0 points without a label; the first: \
                     Euler's formula does not hold";
    assert_eq!(error, AtlasDocumentError::Doubtful { objection: objection.to_owned() });
}

#[test]
fn an_empty_or_negative_window_is_refused() {
    for [low, high] in
        [[0.0, 20.0], [-1.0, 20.0], [20.0, 20.0], [20.0, 18.0], [18.0, f64::INFINITY]]
    {
        let (error, _) = refused(|document| document.window.kappa = [low, high]);
        assert_eq!(error, AtlasDocumentError::Window { name: "kappa", low, high });
        let (error, text) = refused(|document| document.window.psi = [low, high]);
        assert_eq!(error, AtlasDocumentError::Window { name: "psi", low, high });
        let expected =
            format!("window.psi = [{low:?}, {high:?}]: expected [LO, HI] with 0 < LO < HI");
        assert_eq!(text, expected);
    }
    let (error, _) = refused(|document| document.window.damping = -0.1);
    assert_eq!(error, AtlasDocumentError::Damping { damping: -0.1 });
    let (error, text) = refused(|document| document.window.psi = [0.55, 0.55 + 1e-8]);
    assert!(matches!(error, AtlasDocumentError::Values(_)), "{text}");
    assert!(text.starts_with("window: the window is too narrow: "), "{text}");
}

#[test]
fn a_tolerance_out_of_range_is_refused() {
    for tolerance in [0.0, -1e-10, 1.1e-6] {
        let (error, _) = refused(|document| document.tolerance = tolerance);
        assert_eq!(error, AtlasDocumentError::Tolerance { tolerance });
    }
    let (error, _) = refused(|document| document.tolerance = f64::NAN);
    assert!(matches!(error, AtlasDocumentError::Tolerance { .. }));
}

#[test]
fn entries_out_of_place_are_refused() {
    let (error, _) = refused(|document| document.boundaries[1].id = 7);
    assert_eq!(error, AtlasDocumentError::Id { list: "boundaries", index: 1, id: 7 });
    let (error, _) = refused(|document| document.vertices[0].id = 1);
    assert_eq!(error, AtlasDocumentError::Id { list: "vertices", index: 0, id: 1 });
    let (error, text) = refused(|document| document.regions.swap(2, 3));
    assert_eq!(error, AtlasDocumentError::Id { list: "regions", index: 2, id: 3 });
    assert_eq!(text, "regions[2].id = 3; expected 2, its place in the list");
}

#[test]
fn points_that_no_collision_can_have_are_refused() {
    let point =
        |place: &str, kappa, psi| AtlasDocumentError::Point { place: place.to_owned(), kappa, psi };
    let (error, _) = refused(|document| document.boundaries[1].points[0] = [-18.0, 0.6]);
    assert_eq!(error, point("boundaries[1].points[0]", -18.0, 0.6));
    let (error, _) = refused(|document| {
        let vertex = &mut document.vertices[2];
        (vertex.kappa, vertex.psi) = (18.0, 0.0);
    });
    assert_eq!(error, point("vertices[2]", 18.0, 0.0));
    let (error, text) = refused(|document| document.regions[0].sample = [0.0, 0.6]);
    assert_eq!(error, point("regions[0].sample", 0.0, 0.6));
    assert_eq!(text, "regions[0].sample: kappa = 0.0, psi = 0.6; expected numbers above 0");
}

#[test]
fn a_boundary_with_too_few_points_or_tangents_is_refused() {
    let points = AtlasDocument::new(crossing()).boundaries[0].points.len();
    let (error, _) = refused(|document| {
        document.boundaries[0].points.truncate(1);
        document.boundaries[0].tangents.truncate(1);
    });
    assert_eq!(error, AtlasDocumentError::Tangents { boundary: 0, points: 1, tangents: 1 });
    let (error, _) = refused(|document| document.boundaries[0].tangents.truncate(points - 1));
    assert_eq!(error, AtlasDocumentError::Tangents { boundary: 0, points, tangents: points - 1 });
}

#[test]
fn what_is_not_an_itinerary_is_refused() {
    for (switch_count, itinerary) in [(1, "+o-"), (0, ""), (2, "+x-"), (1, "+-"), (2, "+oo")] {
        let switching = |place: &str| AtlasDocumentError::Switching {
            place: place.to_owned(),
            switch_count,
            itinerary: itinerary.to_owned(),
        };
        let (error, _) = refused(|document| {
            let side = &mut document.boundaries[0].below;
            (side.switch_count, side.itinerary) = (switch_count, itinerary.to_owned());
        });
        assert_eq!(error, switching("boundaries[0].below"));
        let (error, _) = refused(|document| {
            let side = &mut document.boundaries[1].above;
            (side.switch_count, side.itinerary) = (switch_count, itinerary.to_owned());
        });
        assert_eq!(error, switching("boundaries[1].above"));
        let (error, _) = refused(|document| {
            let region = &mut document.regions[1].switching;
            (region.switch_count, region.itinerary) = (switch_count, itinerary.to_owned());
        });
        assert_eq!(error, switching("regions[1]"));
    }
}

#[test]
fn boundaries_that_make_no_regions_are_refused() {
    let (error, text) = refused(|document| document.boundaries[0].vertices = Some([0, 99]));
    assert!(matches!(error, AtlasDocumentError::Subdivision(_)), "{text}");
    assert!(text.starts_with("the boundaries make no regions: "), "{text}");
    let (error, text) = refused(|document| document.boundaries[0].tangents[0] = [0.6, 0.6]);
    assert!(matches!(error, AtlasDocumentError::Subdivision(_)), "{text}");
}

#[test]
fn boundaries_that_contradict_each_other_are_refused() {
    let (error, text) = refused(|document| {
        let boundary = &mut document.boundaries[0];
        std::mem::swap(&mut boundary.below, &mut boundary.above);
    });
    assert!(matches!(error, AtlasDocumentError::Finding(_)), "{text}");
    assert!(text.starts_with("the boundaries do not fit together: "), "{text}");
}

#[test]
fn regions_that_the_boundaries_do_not_make_are_refused() {
    let (error, _) = refused(|document| document.regions.truncate(3));
    assert_eq!(error, AtlasDocumentError::Regions { listed: 3, made: 4 });
    let (error, _) = refused(|document| {
        let sample = document.regions[0].sample;
        document.regions[0].sample = document.regions[1].sample;
        document.regions[1].sample = sample;
    });
    assert_eq!(error, AtlasDocumentError::Region { region: 0 });
    let (error, text) = refused(|document| {
        document.regions[3].switching = document.regions[0].switching.clone();
    });
    assert_eq!(error, AtlasDocumentError::Region { region: 3 });
    assert_eq!(text, "regions[3] is not what the boundaries around it say");
}

#[test]
fn a_sealed_document_that_has_changed_is_noticed_wherever_it_has() {
    let text = sealed::to_string(&AtlasDocument::new(crossing())).unwrap();
    assert_eq!(sealed::check(text.as_bytes()), Ok(()));
    // The layout of the text does not matter.
    let value: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(sealed::check(serde_json::to_string_pretty(&value).unwrap().as_bytes()), Ok(()));
    assert_eq!(value["digests"].as_object().unwrap().len(), value.as_object().unwrap().len() - 1);
    let mut documents = 0;
    // Another digit, letter or mark: the text is no document any more, the same one, or refused.
    for place in (0..text.len()).step_by(7) {
        let mut bytes = text.clone().into_bytes();
        bytes[place] = if bytes[place] == b'7' { b'4' } else { b'7' };
        let Ok(changed) = serde_json::from_slice::<serde_json::Value>(&bytes) else { continue };
        documents += 1;
        assert_eq!(sealed::check(&bytes).is_ok(), changed == value, "at byte {place}");
    }
    assert!(documents > 100, "{documents} documents");
    let mut more = value.clone();
    more["note"] = "checked by hand".into();
    let damaged = sealed::check(more.to_string().as_bytes()).unwrap_err();
    assert_eq!(damaged.name, "note");
    let mut less = value;
    less.as_object_mut().unwrap().remove("extrema");
    let damaged = sealed::check(less.to_string().as_bytes()).unwrap_err();
    assert_eq!(damaged.name, "extrema");
}
