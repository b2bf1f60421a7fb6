//! How accurate are margins of the exact engine from one place to the next?
//!
//! In windows of 2e-6 in ln κ and ln ψ a margin is all but straight. What third differences along a
//! line of 41 places show is its error, and divided by its slope the error of its zero in the
//! logarithms. Contacts are random: κ over a decade below each limit, ψ from 0.01 to 2. The zero
//! must be known to 1e-15 √κ, and to 1e-14 for κ up to 100.
//!
//! Run with `cargo run --release -p validation --example margin_errors`. It takes 15 s.

use std::error::Error;

use fastrand::Rng;
use stickslip::plane::CollisionPlane;
use stickslip::tracer::{Family, Point};

/// Half the width and the height of a window in the logarithms.
const HALF: f64 = 1e-6;
/// The number of places along a line.
const PLACES: u32 = 41;

/// The errors of the zeros of all margins of a contact, in the logarithms of κ and ψ.
fn errors(kappa: f64, psi: f64, damping: f64) -> Result<Vec<f64>, Box<dyn Error>> {
    let around = |value: f64| (value * (1.0 - HALF), value * (1.0 + HALF));
    let plane = CollisionPlane::new(around(kappa), around(psi), damping)?;
    let (family, window) = (plane.family(), plane.window());
    let centre: Point = 0.5 * (window.low + window.high);
    let mut errors = Vec::new();
    for (margin, _) in family.free_run(&centre)?.margins {
        let (mut error, mut slope) = (0.0_f64, Point::zeros());
        for axis in 0..2 {
            let mut values = Vec::new();
            for place in 0..PLACES {
                let mut point = centre;
                point[axis] += 0.3
                    * window.extent()[axis]
                    * (f64::from(2 * place) / f64::from(PLACES - 1) - 1.0);
                values.extend(family.margin(&point, &margin)?);
            }
            if values.len() < PLACES as usize {
                slope = Point::zeros();
                break;
            }
            // The third differences of independent errors are √20 times as large.
            let third = |four: &[f64]| (four[3] - four[0] - 3.0 * (four[2] - four[1])).powi(2);
            let squares: f64 = values.windows(4).map(third).sum();
            error = error.max((squares / 20.0 / f64::from(PLACES - 3)).sqrt());
            slope[axis] = (values[values.len() - 1] - values[0]) / (1.2 * HALF);
        }
        if slope != Point::zeros() {
            errors.push(error / slope.norm());
        }
    }
    Ok(errors)
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut random = Rng::with_seed(5);
    println!("| damping | κ up to | margins | half below | worst |\n|---|---|---|---|---|");
    for damping in [0.0, 1e-6, 1e-3, 0.1, 1.0, 10.0] {
        for stiffest in [1e-2, 1.0, 1e2, 1e3, 1e4, 1e5_f64] {
            let mut all = Vec::new();
            for _ in 0..60 {
                let kappa = stiffest * 10_f64.powf(-random.f64());
                all.extend(errors(kappa, 0.01 * 200_f64.powf(random.f64()), damping)?);
            }
            all.sort_by(f64::total_cmp);
            let (half, worst) = (all[all.len() / 2], all[all.len() - 1]);
            println!("| {damping:e} | {stiffest:e} | {} | {half:.1e} | {worst:.1e} |", all.len());
            assert!(worst < (1e-15 * stiffest.sqrt()).max(1e-14), "{damping:e}, {stiffest:e}");
        }
    }
    Ok(())
}
