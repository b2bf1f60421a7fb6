//! Statements on how large ε_t and the spring may become: 12, 13, 14, 15.

use std::f64::consts::PI;

use rayon::prelude::*;
use stickslip_model::{coulomb, landmarks};

use super::search::{Extremum, maximum, maximum_near};
use super::statement::{Evidence, Finding, Verdict};
use super::subject::{ALPHA, MU, Subject, geometric};
use crate::error::Failure;

/// 12: the spring's elongation is at most μ/(ακ) (25), so that |ε_t| ≤ (g_n/g_t) μ/(α√κ) (26, 27).
pub fn largest(subject: &Subject) -> Result<Finding, Failure> {
    const CLOSE: f64 = 1e-9;
    let elongation = |[kappa, psi]: [f64; 2]| Ok(kappa * subject.largest_spring(kappa, psi)?);
    let velocity = |[kappa, psi]: [f64; 2]| {
        let collision = subject.collide(kappa, psi, 0.0)?;
        // Before a reversal the motion is what sliding has left, of which (26) says nothing.
        let bounded = if collision.reversals > 0 { collision.final_velocity.abs() } else { 0.0 };
        Ok(kappa.sqrt() * bounded)
    };
    let spring = worst(&elongation)?;
    let speed = worst(&velocity)?;
    let still_sliding = subject.collide(0.1, 10.0, 0.0)?;
    let unreversed = 0.1_f64.sqrt() * still_sliding.final_velocity;
    let evidence = Evidence::default()
        .number("largest elongation over mu/(alpha kappa)", spring.value)
        .number("kappa there", spring.at[0])
        .number("psi there", spring.at[1])
        .number("largest force (5/4)^(3/5)", landmarks::LARGEST_FORCE)
        .number("largest |eps_t| over the bound (27) after a reversal", speed.value)
        .number("kappa there (27)", speed.at[0])
        .number("psi there (27)", speed.at[1])
        .number("eps_t over the bound (27) at kappa = 0.1, psi = 10", unreversed)
        .count("switches there", still_sliding.switches.len())
        .count("reversals there", still_sliding.reversals);
    let explanation = format!(
        "In units of mu/(alpha kappa) the elongation reaches {:.6}: while sliding it is the scaled force x^(3/2), which is (5/4)^(3/5) = \
         {:.6} at the largest compression. |eps_t| reaches {:.6} times (27) at kappa = {:.4}, psi = {:.4} (the best of 60 x 60 places in \
         kappa from 0.01 to 1e4 and psi from 0.01 to 3, then Nelder and Mead), within the bound with that factor if it is below. Where \
         the motion does not reverse, small kappa exceeds both: {unreversed:.3} at kappa = 0.1, psi = 10. The bounds count as kept up to \
         1 + {CLOSE:e}.",
        spring.value,
        landmarks::LARGEST_FORCE,
        speed.value,
        speed.at[0],
        speed.at[1]
    );
    let kept = spring.value.max(speed.value) <= 1.0 + CLOSE;
    Ok(Finding::new(Verdict::of(kept), evidence, explanation))
}

/// The largest `value` over κ from 0.01 to 10⁴ and ψ from 0.01 to 3.
fn worst(
    value: &(impl Fn([f64; 2]) -> Result<f64, Failure> + Sync),
) -> Result<Extremum<[f64; 2]>, Failure> {
    const PLACES: usize = 60;
    let kappas = geometric(0.01, 1e4, PLACES);
    let psis = (1..=PLACES).map(|i| 3.0 * i as f64 / PLACES as f64);
    let grid: Vec<_> =
        kappas.flat_map(|kappa| psis.clone().map(move |psi| [kappa, psi, 0.0])).collect();
    let values = Subject::each(&grid, |[kappa, psi, _]| value([kappa, psi]))?;
    let best = (0..grid.len()).max_by(|&a, &b| values[a].total_cmp(&values[b])).unwrap_or(0);
    let start = [grid[best][0].ln(), grid[best][1]];
    let inside =
        |[x, psi]: [f64; 2]| [x.clamp(0.01_f64.ln(), 1e4_f64.ln()).exp(), psi.clamp(0.01, 3.0)];
    let found = maximum_near(start, [0.1, 0.03], |at| value(inside(at)))?;
    Ok(Extremum { at: inside(found.at), value: found.value })
}

/// 13: ε_t vanishes as the spring becomes stiff.
pub fn stiff(subject: &Subject) -> Result<Finding, Failure> {
    const EACH: usize = 32;
    const SMALL: f64 = 0.01;
    const DECADES: [f64; 4] = [1e2, 1e3, 1e4, 1e5];
    let mut evidence = Evidence::default();
    let mut largest = Vec::new();
    for kappa in DECADES {
        // A turn of the spring's phase √κ t_c, at ψ between the two ends of the range in which there are switches.
        let turn = 2.0 * PI / landmarks::CONTACT_TIME;
        let tried: Vec<_> = (0..EACH * EACH)
            .map(|i| {
                let phase = (i / EACH) as f64 / EACH as f64;
                let psi = 0.3 + 1.4 * (i % EACH) as f64 / EACH as f64;
                [(kappa.sqrt() + turn * phase).powi(2), psi, 0.0]
            })
            .collect();
        let velocities = Subject::each(&tried, |[kappa, psi, _]| {
            Ok(subject.collide(kappa, psi, 0.0)?.final_velocity.abs())
        })?;
        let most = velocities.into_iter().fold(0.0, f64::max);
        evidence = evidence
            .number(format!("largest |w| at the end from kappa = {kappa:e} on"), most)
            .number(format!("the same times kappa^(5/4), {kappa:e}"), most * kappa.powf(1.25));
        largest.push(most);
    }
    let exponent = (largest[3] / largest[2]).log10();
    let evidence = evidence
        .count("collisions at each kappa", EACH * EACH)
        .number("exponent between the last two", exponent);
    let explanation = format!(
        "The largest w at the end, psi eps_t, of {} collisions with psi from 0.3 to 1.7 over a turn of the spring's phase falls from \
         {:.2e} at kappa = 100 to {:.2e} at 1e5, with the exponent {exponent:.3} over the last decade: (27) has -1/2. It counts as \
         vanishing if it falls from each decade to the next and ends below {SMALL}.",
        EACH * EACH,
        largest[0],
        largest[3]
    );
    let falls = largest.windows(2).all(|pair| pair[1] < pair[0]) && largest[3] < SMALL;
    Ok(Finding::new(Verdict::of(falls), evidence, explanation))
}

/// 14: in the range (30) ε_t is close to zero.
pub fn close_to_zero(subject: &Subject) -> Result<Finding, Failure> {
    /// What counts as close, and how much larger than (27) demands the ratio is.
    const CLOSE: f64 = 0.1;
    const MUCH: f64 = 3.0;
    const PLACES: usize = 400;
    let kappas: Vec<f64> = geometric(3.0, 3e4, 25).collect();
    let mut evidence = Evidence::default();
    let mut largest = Vec::new();
    for &kappa in &kappas {
        let low = MUCH / kappa.sqrt();
        let size = |psi: f64| Ok(subject.collide(kappa, psi, 0.0)?.eps_t().abs());
        let psis: Vec<f64> = geometric(low, 2.0, PLACES).collect();
        let tried: Vec<_> = psis.iter().map(|&psi| [kappa, psi, 0.0]).collect();
        let sizes = Subject::each(&tried, |[_, psi, _]| size(psi))?;
        let best = (0..PLACES).max_by(|&a, &b| sizes[a].total_cmp(&sizes[b])).unwrap_or(0);
        let (from, to) = (psis[best.saturating_sub(1)], psis[(best + 1).min(PLACES - 1)]);
        let most = maximum(from, to, size)?.value.max(sizes[best]);
        evidence = evidence.number(format!("largest |eps_t| at kappa = {kappa:.3}"), most);
        largest.push(most);
    }
    let close = largest.iter().rposition(|&most| most > CLOSE).map_or(0, |last| last + 1);
    let explanation = format!(
        "(30) is taken as the range in which (27) is small and pure sliding has not begun, mu/(alpha sqrt(kappa)) << g_t/g_n < 2mu/alpha, \
         with {MUCH} for <<: psi from {MUCH}/sqrt(kappa) to 2. The largest |eps_t| there, of {PLACES} psi and golden section around the \
         best, is {:.3} at kappa = {:.1} and {:.4} at {:.0}. Close to zero is taken as up to {CLOSE}.",
        largest[0],
        kappas[0],
        largest[kappas.len() - 1],
        kappas[kappas.len() - 1]
    );
    Ok(match close {
        0 => Finding::new(Verdict::Holds, evidence, explanation),
        n if n < kappas.len() => {
            Finding::under(format!("from kappa = {:.1} on", kappas[n]), evidence, explanation)
        }
        _ => Finding::new(Verdict::DoesNotHold, evidence, explanation),
    })
}

/// 15: in max(const, 1 − 2/ψ) const = 0 is the only sensible choice.
pub fn pragmatic(subject: &Subject) -> Result<Finding, Failure> {
    const COLUMNS: usize = 200;
    const ROWS: usize = 175;
    const RATIO: f64 = 3.5;
    /// What counts as no other choice: the best constant, and what it gains.
    const NEAR: f64 = 0.05;
    const GAIN: f64 = 0.1;
    let mut evidence = Evidence::default();
    let mut sensible = [false; 2];
    let mut sentences = String::new();
    for (kappa, sensible) in [20.0, 20.0 / ALPHA].into_iter().zip(&mut sensible) {
        let cell = |i: usize| {
            let part = |place: usize, of: usize| (place as f64 + 0.5) / of as f64;
            let psi = RATIO * part(i / COLUMNS, ROWS) * ALPHA / MU;
            [kappa * part(i % COLUMNS, COLUMNS), psi, 0.0]
        };
        let cells: Vec<_> = (0..COLUMNS * ROWS).map(cell).collect();
        let eps_t = Subject::each(&cells, |[k, psi, _]| Ok(subject.collide(k, psi, 0.0)?.eps_t()))?;
        let errors = |constant: f64| -> Vec<f64> {
            let error = |(eps_t, cell): (&f64, &[f64; 3])| {
                eps_t - coulomb::pragmatic(cell[1], 1.0, constant)
            };
            eps_t.par_iter().zip(&cells).map(error).collect()
        };
        let mean_square = |constant: f64| {
            let errors = errors(constant);
            (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt()
        };
        let most = |constant: f64| errors(constant).iter().fold(0.0_f64, |m, e| m.max(e.abs()));
        let (zero, zero_most) = (mean_square(0.0), most(0.0));
        let best = maximum(-1.0, 0.5, |constant| Ok(-mean_square(constant)))?;
        evidence = evidence
            .number(format!("root mean square error of 0 for kappa up to {kappa}"), zero)
            .number(format!("largest error of 0 for kappa up to {kappa}"), zero_most)
            .number(format!("best constant for kappa up to {kappa}"), best.at)
            .number(format!("its root mean square error for kappa up to {kappa}"), -best.value)
            .number(format!("its largest error for kappa up to {kappa}"), most(best.at));
        *sensible = best.at.abs() <= NEAR && zero <= -best.value * (1.0 + GAIN);
        sentences += &format!(
            "Over kappa up to {kappa} and g_t/g_n up to {RATIO} the constant 0 has a root mean square error of {zero:.4} and is off by \
             {zero_most:.3} at most; the best constant, {:.4}, has {:.4}. ",
            best.at, -best.value
        );
    }
    let explanation = format!(
        "{sentences}Each is over {COLUMNS} x {ROWS} cells at mu = 0.4, alpha = 2/7. The statement counts as true if the best constant is \
         within {NEAR} of 0 and gains less than {:.0} %.",
        100.0 * GAIN
    );
    Ok(match sensible {
        [true, true] => Finding::new(Verdict::Holds, evidence, explanation),
        [false, true] => {
            let condition = "if the figures' kappa is alpha times that of (24)".to_owned();
            Finding::under(condition, evidence, explanation)
        }
        _ => Finding::new(Verdict::DoesNotHold, evidence, explanation),
    })
}
