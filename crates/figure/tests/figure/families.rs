use std::convert::Infallible;

use stickslip_figure::pictures::family::{Captions, draw};
use stickslip_tracer::{Family, FreeRun, Point, Surveyor, Watch, Window};

use crate::svg::{hints, texts, texts_in};

/// A guard that fires inside a circle, and one that fires below a line.
struct Shapes;

impl Family for Shapes {
    type Label = usize;
    type Margin = usize;
    type Error = Infallible;

    fn label(&self, point: &Point) -> Result<usize, Infallible> {
        Ok(10 * usize::from(point.norm() < 0.5) + usize::from(point.y < 0.1))
    }
    fn margin(&self, point: &Point, margin: &usize) -> Result<Option<f64>, Infallible> {
        Ok(Some(if *margin == 0 { point.norm() - 0.5 } else { point.y - 0.1 }))
    }
    fn free_run(&self, point: &Point) -> Result<FreeRun<usize, usize>, Infallible> {
        let margins = vec![(0, point.norm() - 0.5), (1, point.y - 0.1)];
        Ok(FreeRun { label: self.label(point)?, margins })
    }
}

#[test]
fn an_atlas_of_any_family_has_a_picture() {
    let window = Window { low: Point::new(-1.0, -1.0), high: Point::new(1.0, 1.0) };
    let captions = Captions {
        title: "two shapes",
        axes: ["length in m", "height in m"],
        kinds: &["circle", "line", "nothing"],
        kind: &|margin| *margin,
        text: &|label: &usize| label.to_string(),
        hint: &|label: &usize| format!("shape {label}"),
    };
    let atlas = Surveyor::default().atlas(&Shapes, &window).unwrap();
    let svg = draw(&atlas, &captions);
    let all = texts(&svg);
    for text in ["two shapes", "length in m", "height in m", "circle", "line", "crossing"] {
        assert!(all.iter().any(|own| own == text), "{text} in {all:?}");
    }
    assert!(!all.iter().any(|own| own == "nothing" || own == "unresolved"), "{all:?}");
    let mut labels = texts_in(&svg, "regions");
    labels.sort();
    assert_eq!(labels, ["0", "1", "10", "11"]);
    let mut shown = hints(&svg);
    shown.sort();
    assert_eq!(shown, ["shape 0", "shape 1", "shape 10", "shape 11"]);

    // Nothing is known of a survey that was cancelled.
    let watch = Watch::SILENT.cancelled_by(&|| true);
    let begun = Surveyor { watch, ..Surveyor::default() }.atlas(&Shapes, &window).unwrap();
    let svg = draw(&begun, &captions);
    assert_eq!(
        (texts_in(&svg, "regions"), hints(&svg)),
        (vec!["?".into()], vec!["in doubt".into()])
    );
}
