//! Margins with errors, and strips that are thinner than runs can tell.

use stickslip_tracer::{Family, FreeRun, Point, Surveyor};

use crate::any::any;
use crate::guards::{Failed, Label, Margin, SQUARE};
use crate::roots::{GRAZE, Grazes, Grazing, PLACE, SECOND};

/// An error of a run: below 1e-13, another one at each point, and always the same there.
fn error(point: &Point, margin: usize) -> f64 {
    let mut hash = margin as u64;
    for bits in point.iter().map(|part| part.to_bits()) {
        hash = (hash ^ bits).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29);
    }
    let part = (hash.wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 11) as f64 / (1_u64 << 53) as f64;
    1e-13 * (2.0 * part - 1.0)
}

/// A guard grazes at r = 0 and fires behind. A second event fires where its margin
/// s (u + α √−r) is positive, which is known with an error.
struct Root {
    slope: f64,
    steepness: f64,
}

impl Grazes for Root {
    fn value(&self, point: &Point, margin: usize) -> Option<f64> {
        let from = point - PLACE;
        let (u, v) = (0.95 * from.x + 0.3 * from.y, 0.95 * from.y - 0.3 * from.x);
        let r = v + 0.3 * u * u;
        match margin {
            GRAZE => Some(r + error(point, GRAZE)),
            _ => (r < 0.0)
                .then(|| self.slope * (u + self.steepness * (-r).sqrt()) + error(point, SECOND)),
        }
    }
}

/// The secant method for the place ends where its steps are errors of the runs.
#[test]
fn a_boundary_with_errors_begins_on_that_of_a_graze() {
    for slope in [1.0, 0.1, 0.01] {
        for steepness in [0.3, 3.0, 10.0] {
            let family = Grazing(Root { slope, steepness });
            let atlas = Surveyor::default().atlas(&any(&family), &SQUARE).unwrap();
            assert!(atlas.agrees(), "{slope} {steepness}: {:?}", atlas.objection());
            assert_eq!(atlas.plane.curves().len(), 3, "{slope} {steepness}");
            let vertices = atlas.plane.vertices().iter();
            let off = vertices.map(|vertex| (vertex.point - PLACE).norm()).fold(f64::NAN, f64::min);
            assert!(off < 1e-8, "{slope} {steepness}: {off:e}");
        }
    }
}

/// Two boundaries that touch as a line and a curve of fourth order do, and a third one that crosses
/// both there. The strip between the first two is thinner than runs can tell up to 1.8e-3 from
/// there.
struct Fourth;

impl Family for Fourth {
    type Label = Label;
    type Margin = Margin;
    type Error = Failed;

    fn label(&self, point: &Point) -> Result<Label, Failed> {
        Ok((0..3).map(|margin| Self::value(point, margin) < 0.0).collect())
    }

    fn margin(&self, point: &Point, (margin, _): &Margin) -> Result<Option<f64>, Failed> {
        Ok(Some(Self::value(point, *margin)))
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<Label, Margin>, Failed> {
        let label = self.label(point)?;
        let margins = (0..3).map(|margin| ((margin, Vec::new()), Self::value(point, margin)));
        Ok(FreeRun { label, margins: margins.collect() })
    }
}

impl Fourth {
    fn value(point: &Point, margin: usize) -> f64 {
        let from = point - PLACE;
        let (u, v) = (0.95 * from.x + 0.3 * from.y, 0.95 * from.y - 0.3 * from.x);
        match margin {
            0 => v + 0.2 * u * u,
            1 => v + 0.2 * u * u - u.powi(4),
            _ => u + 0.4 * v,
        }
    }
}

/// A branch along the strip stalls at the vertex where the other one has found the two to touch.
#[test]
fn boundaries_that_touch_in_fourth_order_end_at_one_vertex() {
    let atlas = Surveyor::default().atlas(&any(Fourth), &SQUARE).unwrap();
    assert!(atlas.agrees(), "{:?}", atlas.objection());
    assert_eq!(atlas.plane.regions().len(), 6);
}
