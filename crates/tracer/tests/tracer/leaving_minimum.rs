//! A minimum that leaves its phase through the end, where three curves meet.

use stickslip_tracer::{Family, FreeRun, Point, trace};

use crate::any::any;
use crate::guards::{Failed, Label, Margin, SQUARE, exact};

/// A guard h(θ) = a + (b − θ)² on a phase 0 ≤ θ ≤ 1, with a = y + x/5 and b = 1 + x/2. It fires
/// where it falls through zero, and fires back where it rises again. At x = 0 its minimum leaves
/// the phase through the end.
struct Dip;

/// The margin that is the minimum before the guard fires.
const MINIMUM: usize = 0;
/// The margin that is the value at the end if the guard has not fired.
const END: usize = 1;
/// The margin that is minus the value at the end if the guard has fired once.
const BACK: usize = 2;

impl Dip {
    fn shape(point: &Point) -> (f64, f64) {
        (point.y + 0.2 * point.x, 1.0 + 0.5 * point.x)
    }
}

impl Family for Dip {
    /// Whether the guard fires, and whether it fires back.
    type Label = Label;
    type Margin = Margin;
    type Error = Failed;

    fn label(&self, point: &Point) -> Result<Label, Failed> {
        let (a, b) = Self::shape(point);
        let end = a + (1.0 - b).powi(2);
        let back = end >= 0.0 && b < 1.0 && a < 0.0;
        Ok(vec![end < 0.0 || back, back])
    }

    fn margin(&self, point: &Point, (margin, _): &Margin) -> Result<Option<f64>, Failed> {
        let (a, b) = Self::shape(point);
        let end = a + (1.0 - b).powi(2);
        Ok(match *margin {
            MINIMUM => (b < 1.0).then_some(a),
            END => Some(end),
            _ => (a < 0.0 && b - (-a).sqrt() < 1.0).then_some(-end),
        })
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<Label, Margin>, Failed> {
        let label = self.label(point)?;
        let known: &[usize] = match label[..] {
            [false, _] => &[MINIMUM, END],
            [true, false] => &[BACK],
            _ => &[],
        };
        let mut margins = Vec::new();
        for index in known {
            let margin = (*index, Vec::new());
            margins.extend(self.margin(point, &margin)?.map(|value| (margin, value)));
        }
        Ok(FreeRun { label, margins })
    }
}

#[test]
fn a_minimum_that_leaves_through_the_end() {
    let network = trace(&any(Dip), &SQUARE, &exact()).unwrap();
    assert_eq!(network.unresolved, []);
    assert_eq!((network.curves.len(), network.vertices.len()), (3, 4));
    // The place is approached from one side only. The measured error is 1.9e-10.
    assert!(network.vertices.iter().any(|vertex| vertex.point.norm() < 4e-10));
    for curve in &network.curves {
        let height = |p: &Point| {
            let (a, b) = Dip::shape(p);
            if curve.margin.0 == MINIMUM { a } else { a + (1.0 - b).powi(2) }
        };
        let inner = &curve.nodes[1..curve.nodes.len() - 1];
        assert!(inner.iter().all(|node| height(&node.point).abs() < 1e-12));
    }
}
