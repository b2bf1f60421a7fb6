use stickslip_figure::pictures::atlas;
use stickslip_tracer::VertexKind;

use crate::examples::{atlases, traced};
use crate::svg::{count_in, texts, texts_in};

const END: &str = "switch at the end of contact";
const STICK: &str = "graze while sticking";
const SLIP: &str = "graze while sliding";
const TOP: &str = "uppermost boundary, closed form";

fn has(texts: &[String], entry: &str) -> bool {
    texts.iter().any(|text| text == entry)
}

#[test]
fn the_legend_of_a_large_window_names_everything() {
    let made = &atlases().large;
    let svg = atlas::draw(made);
    let texts = texts(&svg);
    let limits = "κn = (nπ/2tc)2, limits of boundaries for vanishing ψ, n odd and even";
    for entry in [END, STICK, SLIP, "crossing", "other vertex", TOP, limits] {
        assert!(has(&texts, entry), "{entry} in {texts:?}");
    }
    let crossings =
        made.regions.vertices().iter().filter(|vertex| vertex.kind == VertexKind::Crossing);
    // Each is a square with an edge.
    assert_eq!(count_in(&svg, "crossings", "rect"), 2 * crossings.count());
    assert_eq!(count_in(&svg, "other-vertices", "rect"), 2);
    assert_eq!(count_in(&svg, "limits", "polygon"), 6);
    assert!(texts_in(&svg, "regions").len() >= 6);
}

#[test]
fn the_legend_names_only_what_is_in_the_window() {
    let texts_of = |kappa, psi| texts(&atlas::draw(&traced(kappa, psi, 0.0)));
    let crossing = texts(&atlas::draw(&atlases().crossing));
    assert!(has(&crossing, END) && has(&crossing, STICK) && has(&crossing, "crossing"));
    assert_eq!(crossing[0], "4 boundaries, 4 regions with their numbers of switches, a = 0");
    for entry in [SLIP, "other vertex", TOP] {
        assert!(!has(&crossing, entry), "{entry} in {crossing:?}");
    }
    assert!(!crossing.iter().any(|text| text.starts_with("κn")));

    let one = texts_of((7.5, 8.0), (0.8, 0.9));
    assert!(has(&one, END) && !has(&one, STICK) && !has(&one, "crossing"));
    assert_eq!(one[0], "1 boundary, 2 regions with their numbers of switches, a = 0");

    let none = texts(&atlas::draw(&atlases().empty));
    assert_eq!(none[0], "0 boundaries, 1 region with its number of switches, a = 0");
    assert!(![END, STICK, SLIP, TOP, "crossing"].iter().any(|entry| has(&none, entry)));

    let top = texts_of((5.0, 5.5), (1.95, 2.05));
    assert!(has(&top, TOP) && has(&top, END));

    // The only limit is that of n = 3.
    let limit = texts_of((5.5, 6.5), (0.04, 0.06));
    let entry = "κn = (nπ/2tc)2, limits of boundaries for vanishing ψ, n odd";
    assert!(has(&limit, entry), "{limit:?}");
}

#[test]
fn damped_atlases_have_no_closed_forms() {
    let texts = texts(&atlas::draw(&atlases().damped));
    assert!(texts[0].ends_with("a = 0.05"), "{texts:?}");
    assert!(!has(&texts, TOP) && !texts.iter().any(|text| text.starts_with("κn")));
}

#[test]
fn boundaries_have_their_kinds_and_points() {
    let made = &atlases().crossing;
    let boundaries = atlas::boundaries(made);
    assert_eq!(boundaries.len(), 4);
    for ((kind, points), curve) in boundaries.iter().zip(made.regions.curves()) {
        assert_eq!(*kind, curve.margin);
        assert!(points.len() >= curve.nodes.len());
    }
}
