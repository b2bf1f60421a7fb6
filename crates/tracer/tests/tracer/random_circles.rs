//! Random circles: the curves and vertices that geometry tells.

use stickslip_tracer::{Family, FreeRun, Point, TraceOptions, trace};

use crate::any::any;
use crate::guards::{Failed, Label, Margin, SQUARE, assert_on, circle};

/// Circles (x, y, radius) of many sizes. A guard fires inside each, in their order.
struct Circles(Vec<[f64; 3]>);

impl Family for Circles {
    type Label = Label;
    type Margin = Margin;
    type Error = Failed;

    fn label(&self, point: &Point) -> Result<Label, Failed> {
        Ok((0..self.0.len()).map(|i| self.value(i, point) < 0.0).collect())
    }

    fn margin(&self, point: &Point, margin: &Margin) -> Result<Option<f64>, Failed> {
        Ok(Some(self.value(margin.0, point)))
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<Label, Margin>, Failed> {
        let label = self.label(point)?;
        let margins =
            (0..self.0.len()).map(|i| ((i, label[..i].to_vec()), self.value(i, point))).collect();
        Ok(FreeRun { label, margins })
    }
}

impl Circles {
    fn value(&self, index: usize, point: &Point) -> f64 {
        let [x, y, radius] = self.0[index];
        // A gradient that varies, so that nothing is exact by accident, and the noise of a run.
        let noise = 1e-14 * (1e9 * (point.x + 3.7 * point.y)).sin();
        ((point - Point::new(x, y)).norm_squared() - radius * radius) * (0.3 * point.x).exp()
            + noise
    }
}

/// The numbers of curves and of vertices are those of the circles and their crossings.
#[test]
fn random_circles() {
    let mut state = 7_u64;
    let mut random = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    for case in 0..100 {
        let circles: Vec<[f64; 3]> = (0..9)
            .map(|_| [1.2 * random() - 0.6, 1.2 * random() - 0.6, 0.05 + 0.34 * random()])
            .collect();
        let mut crossings = vec![0; circles.len()];
        let mut vertices = 0;
        for i in 0..circles.len() {
            for j in 0..i {
                let ([a, b, r], [c, d, q]) = (circles[i], circles[j]);
                let distance = (a - c).hypot(b - d);
                if distance < r + q && distance > (r - q).abs() {
                    vertices += 2;
                    crossings[i] += 2;
                    crossings[j] += 2;
                }
            }
        }
        let curves: usize = crossings.iter().map(|&count| usize::max(count, 1)).sum();
        let network =
            trace(&any(Circles(circles.clone())), &SQUARE, &TraceOptions::default()).unwrap();
        assert_eq!(network.unresolved, [], "case {case}");
        let found = (network.curves.len(), network.vertices.len());
        assert_eq!(found, (curves, vertices), "case {case}: {circles:?}");
        for curve in &network.curves {
            let [x, y, radius] = circles[curve.margin.0];
            assert_on(curve, circle(x, y, radius));
        }
    }
}
