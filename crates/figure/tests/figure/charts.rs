use stickslip_figure::Svg;
use stickslip_figure::canvas::panel::Scale;
use stickslip_figure::pictures::chart::{self, LineChart, Series};

use crate::examples::{axis, powers, series};
use crate::svg::texts;

fn chart(series: Vec<Series>) -> Svg {
    let (x, y) = (axis((0.0, 1.0), Scale::Linear), axis((0.0, 1.0), Scale::Linear));
    chart::draw(&LineChart { title: "a chart", x, y, series })
}

#[test]
fn the_legend_names_series_with_something_to_see() {
    let inside = [(0.2, 0.2), (0.4, 0.4)];
    let svg = chart(vec![
        series("inside", &inside),
        series("empty", &[]),
        series("outside", &[(2.0, 0.5), (0.5, -1.0)]),
        series("without values", &[(0.5, f64::NAN), (f64::INFINITY, 0.5)]),
        series("partly inside", &[(0.5, 0.5), (2.0, 2.0)]),
        series("", &inside),
        Series { mark: None, ..series("line", &inside) },
        // A line needs two points beside each other.
        Series { mark: None, ..series("no line", &[(0.5, 0.5), (2.0, 2.0), (0.6, 0.6)]) },
        Series { line: None, ..series("marks", &[(0.5, 0.5)]) },
        Series { line: None, mark: None, ..series("nothing", &inside) },
    ]);
    let texts = texts(&svg);
    assert_eq!(texts[..5], ["a chart", "inside", "partly inside", "line", "marks"]);
    assert!(texts[5].parse::<f64>().is_ok(), "labels of the axis follow: {texts:?}");
}

#[test]
fn hidden_entries_leave_no_gap() {
    let named = |count: usize| {
        let visible = series("inside", &[(0.5, 0.5)]);
        chart(vec![visible; count]).document()
    };
    let height = |document: &str| {
        let rest = document.split("height=\"").nth(1).unwrap();
        rest.split('"').next().unwrap().parse::<f64>().unwrap()
    };
    let hidden = chart(vec![series("inside", &[(0.5, 0.5)]), series("a", &[]), series("b", &[])]);
    assert_eq!(height(&hidden.document()), height(&named(1)));
    assert_eq!(height(&named(1)), height(&named(2)));
    assert!(height(&named(2)) < height(&named(3)));
}

#[test]
fn labels_of_a_logarithmic_axis_are_written_in_one_way() {
    let svg = powers((2e-4, 0.3), (1e-3, 1e4));
    let texts = texts(&svg);
    let below = texts.iter().filter(|text| text.contains("10−"));
    assert_eq!(below.count(), 10, "2×10−4 to 2×10−1: {texts:?}");
    assert!(
        ["0.001", "0.01", "0.1", "1", "10", "100", "1000", "10000"]
            .iter()
            .all(|label| texts.iter().any(|text| text == label))
    );
}
