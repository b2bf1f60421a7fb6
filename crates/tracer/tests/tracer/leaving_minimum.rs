//! A minimum that leaves its phase through the end, where three curves meet.

use std::convert::Infallible;

use stickslip_tracer::{Family, FreeRun, Point, trace};

use crate::guards::{SQUARE, exact};

/// A guard h(θ) = a + (b − θ)² on a phase 0 ≤ θ ≤ 1, with a = y + x/5 and b = 1 + x/2. It fires
/// where it falls through zero, and fires back where it rises again. At x = 0 its minimum leaves
/// the phase through the end.
struct Dip;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum DipMargin {
    /// The minimum before the guard fires.
    Minimum,
    /// The value at the end if the guard has not fired.
    End,
    /// Minus the value at the end if the guard has fired once.
    Back,
}

impl Dip {
    fn shape(point: &Point) -> (f64, f64) {
        (point.y + 0.2 * point.x, 1.0 + 0.5 * point.x)
    }
}

impl Family for Dip {
    type Label = u8;
    type Margin = DipMargin;
    type Error = Infallible;

    fn label(&self, point: &Point) -> Result<u8, Infallible> {
        let (a, b) = Self::shape(point);
        let end = a + (1.0 - b).powi(2);
        Ok(if end < 0.0 {
            1
        } else if b < 1.0 && a < 0.0 {
            2
        } else {
            0
        })
    }

    fn margin(&self, point: &Point, margin: &DipMargin) -> Result<Option<f64>, Infallible> {
        let (a, b) = Self::shape(point);
        let end = a + (1.0 - b).powi(2);
        Ok(match margin {
            DipMargin::Minimum => (b < 1.0).then_some(a),
            DipMargin::End => Some(end),
            DipMargin::Back => (a < 0.0 && b - (-a).sqrt() < 1.0).then_some(-end),
        })
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<u8, DipMargin>, Infallible> {
        let label = self.label(point)?;
        let known: &[DipMargin] = match label {
            0 => &[DipMargin::Minimum, DipMargin::End],
            1 => &[DipMargin::Back],
            _ => &[],
        };
        let mut margins = Vec::new();
        for margin in known {
            margins.extend(self.margin(point, margin)?.map(|value| (*margin, value)));
        }
        Ok(FreeRun { label, margins })
    }
}

#[test]
fn a_minimum_that_leaves_through_the_end() {
    let network = trace(&Dip, &SQUARE, &exact()).unwrap();
    assert_eq!(network.unresolved, []);
    assert_eq!((network.curves.len(), network.vertices.len()), (3, 4));
    // The place is approached from one side only. The measured error is 1.9e-10.
    assert!(network.vertices.iter().any(|vertex| vertex.point.norm() < 4e-10));
    for curve in &network.curves {
        let height = |p: &Point| {
            let (a, b) = Dip::shape(p);
            if curve.margin == DipMargin::Minimum { a } else { a + (1.0 - b).powi(2) }
        };
        let inner = &curve.nodes[1..curve.nodes.len() - 1];
        assert!(inner.iter().all(|node| height(&node.point).abs() < 1e-12));
    }
}
