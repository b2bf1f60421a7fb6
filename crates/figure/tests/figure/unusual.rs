//! Ranges, places and texts that show nothing, or not all: pictures are XML and PNG all the same.

use roxmltree::Document;
use stickslip_figure::canvas::panel::{Edge, Panel, Scale};
use stickslip_figure::canvas::shape::{Rectangle, Stroke};
use stickslip_figure::canvas::svg::{Anchor, Words};
use stickslip_figure::pictures::chart::{self, ChartAxis, LineChart, Mark, Series, Shape};
use stickslip_figure::pictures::map::{self, MapAxis, MapPanel, MapValues};
use stickslip_figure::{FigureError, Svg, png};

const NAN: f64 = f64::NAN;
const INFINITY: f64 = f64::INFINITY;
const LINE: Stroke = Stroke::full("#000000", 1.0);
const POINTS: [(f64, f64); 6] =
    [(0.5, 0.5), (NAN, 0.0), (1.0, INFINITY), (0.2, 0.1), (0.3, 0.3), (1e308, -1e308)];

const RANGES: [(f64, f64); 14] = [
    (0.0, 1.0),
    (1.0, 0.0),
    (1.0, 1.0),
    (0.0, 0.0),
    (NAN, 1.0),
    (0.0, NAN),
    (0.0, INFINITY),
    (-INFINITY, INFINITY),
    (-1e300, 1e300),
    (-1.7e308, 1.7e308),
    (1e-320, 2e-320),
    (1e-300, 1e300),
    (1e15, 1e15 + 1.0),
    (1.0, 1.0 + 1e-15),
];

fn assert_sound(svg: &Svg, case: &str) {
    let document = svg.document();
    Document::parse(&document).unwrap_or_else(|error| panic!("{case}: {error}"));
    assert!(!document.contains("NaN") && !document.contains("inf\""), "{case}: {document}");
    assert!(document.len() < 50_000, "{case}: {}", document.len());
    png(svg).unwrap_or_else(|error| panic!("{case}: {error}"));
}

#[test]
fn axes_with_any_range_are_drawn_or_left_empty() {
    let frame = Rectangle { left: 60.0, top: 10.0, width: 300.0, height: 200.0 };
    for range in RANGES {
        for scale in [Scale::Linear, Scale::Logarithmic] {
            let case = format!("{range:?} {scale:?}");
            let mut svg = Svg::new(400.0, 300.0, "a <title> & more\u{0}");
            let panel = Panel { frame, x: range, y: range, scales: (scale, scale) };
            for edge in [Edge::Left, Edge::Right, Edge::Bottom] {
                panel.ticks(&mut svg, edge, true);
                panel.name(&mut svg, edge, 20.0, "a^(b_{c}");
            }
            panel.curve(&mut svg, POINTS, LINE);
            panel.span(&mut svg, (NAN, 1.0), "#000000");
            panel.horizontal(&mut svg, INFINITY, LINE);
            assert_sound(&svg, &case);

            let axis = ChartAxis { name: "x_(t", range, scale };
            let mark = Some(Mark { shape: Shape::Cross, colour: "#000000" });
            let series =
                Series { name: "all".to_owned(), points: POINTS.into(), line: Some(LINE), mark };
            let chart = LineChart { title: "", x: axis, y: axis, series: vec![series] };
            assert_sound(&chart::draw(&chart), &case);
        }
    }
}

#[test]
fn ticks_at_steps_that_are_none_are_left_out() {
    let frame = Rectangle { left: 60.0, top: 10.0, width: 300.0, height: 200.0 };
    let scales = (Scale::Linear, Scale::Linear);
    let panel = Panel { frame, x: (0.0, 1.0), y: (0.0, 1.0), scales };
    for (step, drawn) in
        [(0.0, false), (-0.1, false), (NAN, false), (1e-9, false), (INFINITY, false), (0.1, true)]
    {
        let mut svg = Svg::new(400.0, 300.0, "");
        panel.ticks_every(&mut svg, Edge::Left, step);
        assert_eq!(svg.document().contains("<line"), drawn, "{step}");
    }
}

#[test]
fn what_has_no_place_is_not_drawn_and_interrupts_lines() {
    let mut svg = Svg::new(100.0, 100.0, "");
    let nowhere = Rectangle { left: NAN, top: 0.0, width: 1.0, height: 1.0 };
    svg.fill(nowhere, "#000000");
    svg.outline(nowhere, LINE);
    svg.image(nowhere, "");
    svg.disc((NAN, 0.0), 1.0, "#000000");
    svg.ring((0.0, INFINITY), 1.0, LINE);
    svg.line((0.0, 0.0), (NAN, 1.0), LINE);
    svg.words((NAN, 1.0), Words::new("x", 10.0, Anchor::Start));
    svg.polyline([(NAN, NAN)], LINE);
    let empty = svg.document();
    assert_eq!(empty.matches('<').count(), 5, "{empty}");
    svg.polyline([(0.0, 0.0), (9.0, 9.0), (NAN, 1.0), (20.0, 9.0), (30.0, 9.0)], LINE);
    assert_eq!(svg.document().matches("<polyline").count(), 2);
}

#[test]
fn a_map_needs_axes() {
    let axis = |range| MapAxis { name: "x", range };
    for range in [(1.0, 1.0), (2.0, 1.0), (NAN, 1.0), (0.0, INFINITY)] {
        let map = MapPanel {
            heading: "",
            horizontal: axis((0.0, 1.0)),
            vertical: axis(range),
            columns: 1,
            rows: 1,
            values: MapValues::Restitution(&[0.5]),
            lines: Vec::new(),
            points: Vec::new(),
        };
        let error = map::draw("", &[map]).unwrap_err();
        assert!(matches!(error, FigureError::Range { .. }), "{error}");
        assert!(error.to_string().contains("expected two finite numbers"), "{error}");
    }
}

#[test]
fn a_picture_without_a_size_is_no_png() {
    for (width, height) in [(0.0, 0.0), (-1.0, 5.0), (NAN, 1.0), (1e9, 1e9)] {
        assert!(png(&Svg::new(width, height, "x")).is_err(), "{width} {height}");
    }
}
