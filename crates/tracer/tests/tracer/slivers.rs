//! Regions much thinner than a cell of the grid, with the same label on both sides.

use stickslip_tracer::{Family, FreeRun, Point, TraceOptions, trace};

use crate::any::any;
use crate::guards::{Failed, Label, Margin, SQUARE};

/// A region between a line and a curve above it. Each of the two has a margin that runs on its own
/// side of the region have, as far as the region reaches.
struct Sliver {
    /// The height of the region over x; negative beyond its ends.
    height: fn(f64) -> f64,
}

impl Sliver {
    /// The margins of the line, which is positive below, and of the curve, positive above.
    fn margins(&self, point: &Point) -> Option<[f64; 2]> {
        let above = point.y - 0.1 - 0.3 * point.x;
        let height = (self.height)(point.x);
        (height > 0.0).then_some([-above, above - height])
    }
}

impl Family for Sliver {
    type Label = Label;
    type Margin = Margin;
    type Error = Failed;

    fn label(&self, point: &Point) -> Result<Label, Failed> {
        let within = |margins: [f64; 2]| margins.iter().all(|margin| *margin < 0.0);
        Ok(vec![self.margins(point).is_some_and(within)])
    }

    fn margin(&self, point: &Point, (margin, _): &Margin) -> Result<Option<f64>, Failed> {
        Ok(self.margins(point).map(|margins| margins[*margin]))
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<Label, Margin>, Failed> {
        let margins = self
            .margins(point)
            .into_iter()
            .flat_map(|margins| margins.into_iter().enumerate().filter(|(_, value)| *value >= 0.0))
            .map(|(index, value)| ((index, Vec::new()), value));
        Ok(FreeRun { label: self.label(point)?, margins: margins.collect() })
    }
}

/// The numbers of curves and of vertices inside the window.
fn found(height: fn(f64) -> f64) -> [usize; 2] {
    let network = trace(&any(Sliver { height }), &SQUARE, &TraceOptions::default()).unwrap();
    assert_eq!(network.unresolved, []);
    let vertices = network.vertices.iter().filter(|vertex| !vertex.kind.is_on_window()).count();
    [network.curves.len(), vertices]
}

#[test]
fn a_wedge_that_leaves_the_window_is_found_from_its_edge() {
    assert_eq!(found(|x| 1e-3 * (x - 0.9)), [2, 1]);
    assert_eq!(found(|x| 1e-6 * (x - 0.9)), [2, 1]);
}

#[test]
fn a_lens_between_the_places_of_the_grid_is_found() {
    assert_eq!(found(|x| 1e-3 * (0.25 - x * x)), [2, 2]);
    assert_eq!(found(|x| 1e-5 * (0.01 - (x - 0.2).powi(2))), [2, 2]);
}

#[test]
fn a_strip_across_the_window_is_found() {
    assert_eq!(found(|_| 1e-4), [2, 0]);
    assert_eq!(found(|_| 1e-7), [2, 0]);
}
