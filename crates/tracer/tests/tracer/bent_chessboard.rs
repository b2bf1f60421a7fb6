//! A bent chessboard: two families of lines that cross, as many as one likes, in closed form.

use std::convert::Infallible;

use stickslip_tracer::{Atlas, AtlasOptions, Family, FreeRun, Point, Window};

/// The field of a point has the integer parts of two functions as its numbers.
struct Board {
    side: f64,
}

impl Board {
    fn value(&self, point: &Point, (axis, level): (usize, i64)) -> f64 {
        let bent =
            [point.x + 0.1 * (3.0 * point.y + 1.0).sin(), point.y + 0.1 * (4.0 * point.x).cos()];
        self.side * bent[axis] - level as f64
    }
}

impl Family for Board {
    type Label = [i64; 2];
    /// One of the two functions, and the integer that it has on the line.
    type Margin = (usize, i64);
    type Error = Infallible;

    #[expect(clippy::cast_possible_truncation)]
    fn label(&self, point: &Point) -> Result<[i64; 2], Infallible> {
        Ok([0, 1].map(|axis| self.value(point, (axis, 0)).floor() as i64))
    }

    fn margin(&self, point: &Point, line: &(usize, i64)) -> Result<Option<f64>, Infallible> {
        Ok(Some(self.value(point, *line)))
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<[i64; 2], (usize, i64)>, Infallible> {
        let label = self.label(point)?;
        let lines = [0, 1].into_iter().flat_map(|axis| [0, 1].map(|on| (axis, label[axis] + on)));
        let margins = lines.map(|line| (line, self.value(point, line))).collect();
        Ok(FreeRun { label, margins })
    }
}

/// Lines have inflections, where an error that is looked for at one place of a cubic can hide. A
/// line was then found a second time beside itself.
#[test]
fn bent_chessboards_are_complete() {
    let window = Window { low: Point::new(0.0, 0.0), high: Point::new(1.0, 1.0) };
    // Curves and regions, counted by Euler's formula from the lines and their crossings.
    for (side, [curves, regions]) in [(5.0, [60, 37]), (8.0, [144, 82])] {
        let atlas = Atlas::of(&Board { side }, &window, &AtlasOptions::default()).unwrap();
        assert_eq!(atlas.objection(), None);
        assert_eq!([atlas.plane.curves().len(), atlas.plane.regions().len()], [curves, regions]);
    }
}
