use stickslip_figure::pictures::stack::draw;
use stickslip_plane::atlas::Frame;
use stickslip_plane::progress::SILENT;
use stickslip_plane::{Range, stack};

use crate::svg::{count_in, texts};

/// In this window two regions are born, and once only neighbours change.
#[test]
fn every_change_is_drawn_over_the_damping_and_at_its_place() {
    let range = |low, high| Range { low, high };
    let frame = Frame::new(range(5.0, 20.0), range(0.2, 2.5), 0.0);
    let dampings = [0.0, 0.05, 0.2, 0.4];
    let made = stack::stack(frame, &dampings, frame.tolerances().usual, SILENT).unwrap();
    let svg = draw(&made);
    let texts = texts(&svg);
    assert_eq!(texts[0], "Atlases at 4 scaled dampings a, 3 changes of the regions between them");
    for text in ["a = 0", "a = 0.05", "a = 0.4", "7 regions", "9 regions"] {
        assert!(texts.iter().any(|own| own == text), "{text} in {texts:?}");
    }
    for row in ["a region is born: 2", "a region dies: 0", "neighbours change: 1"] {
        assert!(texts.iter().any(|own| own == row), "{row} in {texts:?}");
    }
    assert_eq!(count_in(&svg, "changes", "line"), 3);
    assert_eq!(count_in(&svg, "places", "circle"), 3);
}
