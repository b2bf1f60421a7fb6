use stickslip_figure::FigureError;
use stickslip_figure::pictures::map::{self, MapPanel, MapValues};
use stickslip_model::Engine;

use crate::examples::{grid, panel, restitution};
use crate::svg::{texts, texts_in};

/// The labels of the scale of a map with `values`, from the lower end to the upper one.
fn scale(values: &[f64; 12]) -> Vec<String> {
    texts_in(&map::draw("a map", &[panel(MapValues::Restitution(values))]).unwrap(), "scale")
}

#[test]
fn a_scale_of_both_signs_has_round_ends_and_zero() {
    let mut values = [0.0; 12];
    (values[0], values[1]) = (-0.0213, 0.01);
    assert_eq!(
        scale(&values),
        [
            "−0.025", "−0.020", "−0.015", "−0.010", "−0.005", "0", "0.005", "0.010", "0.015",
            "0.020", "0.025"
        ]
    );
    (values[0], values[1]) = (-0.5, 0.83);
    let labels = scale(&values);
    assert_eq!([&labels[0], &labels[5], &labels[10]], ["−1.0", "0", "1.0"]);
}

#[test]
fn a_scale_without_negative_values_starts_at_zero() {
    let mut values = [0.0; 12];
    values[5] = 0.97;
    let labels = scale(&values);
    assert_eq!(labels.len(), 11);
    assert_eq!([&labels[0], &labels[10]], ["0", "1.0"]);
    values[6] = -1e-9;
    assert_eq!(scale(&values)[0], "−1.0");
}

#[test]
fn very_small_values_have_their_power_of_ten_in_the_heading() {
    let texts = texts(&restitution(2e-4));
    let heading = "tangential restitution εt (×10−4)";
    assert_eq!(texts.iter().filter(|text| *text == heading).count(), 2);
}

#[test]
fn regions_of_a_grid_are_labelled_with_the_numbers_in_the_key() {
    let svg = grid((0.0, 70.0), (0.0, 2.9), Engine::Exact);
    let counts = texts_in(&svg, "counts");
    assert_eq!(counts, ["0", "2", "4", "6", "8"]);
    let regions = texts_in(&svg, "regions");
    assert!(regions.len() >= 4 && regions.iter().all(|label| counts.contains(label)));
    assert_eq!(texts(&svg)[0], "40 × 30 collisions, a = 0");
}

#[test]
fn a_map_without_cells_or_with_other_values_is_refused() {
    for (columns, rows, values) in [(0, 3, 0), (4, 0, 0), (4, 3, 11), (usize::MAX, 2, 12)] {
        let all = [0.5; 12];
        let panel = MapPanel { columns, rows, ..panel(MapValues::Restitution(&all[..values])) };
        let error = map::draw("a map", &[panel]).unwrap_err();
        let FigureError::Cells { columns: c, rows: r, values: v } = error else {
            panic!("{error}")
        };
        assert_eq!((c, r, v), (columns, rows, values));
    }
    let counts = [2; 12];
    let panel = MapPanel { columns: 5, ..panel(MapValues::Switches(&counts)) };
    let error = map::draw("a map", &[panel]).unwrap_err().to_string();
    assert!(error.starts_with("a map of 5 × 3 cells with 12 values; expected"), "{error}");
}
