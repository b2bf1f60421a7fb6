//! Statements on how large ε_t and the spring may become: 12, 13, 14, 15, 25.

use std::f64::consts::PI;

use rayon::prelude::*;
use stickslip_model::exact;
use stickslip_model::limits::{coulomb, largest};
use stickslip_model::spheres::{BodyPair, Surface};
use stickslip_studies::paper::{
    LEAST_EPS_T_2, MOST_RATIO_3, MOST_STIFFNESS, MOST_VELOCITY_M_PER_S, MU, Reading, STEEL,
    STEEL_RADIUS_M, STEEL_STIFFNESS_KG_PER_S2, psi,
};
use stickslip_studies::search::{Optimum, maximum, maximum_near};

use super::statement::{Evidence, StatementFinding, StatementVerdict, Stop};
use super::statement::{digits, each, geometric};
use super::subject::Subject;
use crate::error::ReproductionError;

/// 12: the spring's elongation is at most μ/(ακ) (25), so that |ε_t| ≤ (g_n/g_t) μ/(α√κ) (26, 27).
pub fn largest(subject: &Subject) -> Result<StatementFinding, Stop> {
    const CLOSE: f64 = 1e-9;
    let elongation =
        |[kappa, psi]: [f64; 2]| Ok(kappa * subject.spring.largest_elongation(kappa, psi)?);
    let velocity = |[kappa, psi]: [f64; 2]| {
        let collision = subject.collide(kappa, psi, 0.0)?;
        // Without a reversal sliding alone has slowed the motion, of which (26) says nothing.
        let bounded = if collision.reversals > 0 { collision.final_velocity.abs() } else { 0.0 };
        Ok(kappa.sqrt() * bounded)
    };
    let spring = worst(&elongation)?;
    let speed = worst(&velocity)?;
    let still_sliding = subject.collide(0.1, 10.0, 0.0)?;
    let unreversed = 0.1_f64.sqrt() * still_sliding.final_velocity;
    let evidence = Evidence::default()
        .number("largest elongation over μ/(ακ)", spring.value)
        .number("κ there", spring.at[0])
        .number("ψ there", spring.at[1])
        .number("largest force (5/4)^(3/5)", largest::FORCE)
        .number("largest |ε_t| over the bound (27) after a reversal", speed.value)
        .number("κ there (27)", speed.at[0])
        .number("ψ there (27)", speed.at[1])
        .number("ε_t over the bound (27) at κ = 0.1, ψ = 10", unreversed)
        .count("switches there", still_sliding.switches.len())
        .count("reversals there", still_sliding.reversals);
    let explanation = format!(
        "In units of μ/(ακ) the elongation reaches {:.6}: while sliding it is the scaled force \
         x^(3/2), which is (5/4)^(3/5) = {:.6} at the largest compression. |ε_t| reaches {:.6} times \
         (27) at κ = {:.4}, ψ = {:.4} (the best of 60 x 60 places in κ from 0.01 to 1e4 and ψ from \
         0.01 to 3, then Nelder and Mead), {} the bound with that factor. Where the motion does not \
         reverse, small κ exceeds both: {unreversed:.3} at κ = 0.1, ψ = 10. The bounds count as kept \
         up to 1 + {CLOSE:e}.",
        spring.value,
        largest::FORCE,
        speed.value,
        speed.at[0],
        speed.at[1],
        if speed.value <= largest::FORCE { "within" } else { "beyond" },
    );
    let kept = spring.value.max(speed.value) <= 1.0 + CLOSE;
    Ok(StatementFinding::new(StatementVerdict::of(kept), evidence, explanation))
}

/// The largest `value` over κ from 0.01 to 10⁴ and ψ from 0.01 to 3.
fn worst(
    value: &(impl Fn([f64; 2]) -> Result<f64, ReproductionError> + Sync),
) -> Result<Optimum<[f64; 2]>, ReproductionError> {
    const PLACES: usize = 60;
    let kappas = geometric(0.01, 1e4, PLACES);
    let psis = (1..=PLACES).map(|i| 3.0 * i as f64 / PLACES as f64);
    let grid: Vec<_> =
        kappas.flat_map(|kappa| psis.clone().map(move |psi| [kappa, psi, 0.0])).collect();
    let values = each(&grid, |&[kappa, psi, _]| value([kappa, psi]))?;
    let best = (0..grid.len()).max_by(|&a, &b| values[a].total_cmp(&values[b])).unwrap_or(0);
    let start = [grid[best][0].ln(), grid[best][1]];
    let inside =
        |[x, psi]: [f64; 2]| [x.clamp(0.01_f64.ln(), 1e4_f64.ln()).exp(), psi.clamp(0.01, 3.0)];
    let found = maximum_near(start, [0.1, 0.03], |at| value(inside(at)))?;
    Ok(Optimum { at: inside(found.at), value: found.value })
}

/// 13: ε_t vanishes as the spring becomes stiff.
pub fn stiff(subject: &Subject) -> Result<StatementFinding, Stop> {
    const EACH: usize = 32;
    const SMALL: f64 = 0.01;
    const DECADES: [f64; 4] = [1e2, 1e3, 1e4, 1e5];
    let mut evidence = Evidence::default();
    let mut largest = Vec::new();
    for kappa in DECADES {
        // Over one turn of the spring's phase √κ t_c, at ψ inside the range that has switches.
        let turn = 2.0 * PI / exact::CONTACT_TIME;
        let tried: Vec<_> = (0..EACH * EACH)
            .map(|i| {
                let phase = (i / EACH) as f64 / EACH as f64;
                let psi = 0.3 + 1.4 * (i % EACH) as f64 / EACH as f64;
                [(kappa.sqrt() + turn * phase).powi(2), psi, 0.0]
            })
            .collect();
        let velocities = each(&tried, |&[kappa, psi, _]| {
            Ok(subject.collide(kappa, psi, 0.0)?.final_velocity.abs())
        })?;
        let most = velocities.into_iter().fold(0.0, f64::max);
        evidence = evidence
            .number(format!("largest |w| at the end from κ = {kappa:e} on"), most)
            .number(format!("the same times κ^(5/4), {kappa:e}"), most * kappa.powf(1.25));
        largest.push(most);
    }
    let exponent = (largest[3] / largest[2]).log10();
    let evidence = evidence
        .count("collisions at each κ", EACH * EACH)
        .number("exponent between the last two", exponent);
    let explanation = format!(
        "The largest w at the end, ψ ε_t, of {} collisions with ψ from 0.3 to 1.7 over a turn of the \
         spring's phase falls from {:.2e} at κ = 100 to {:.2e} at 1e5. Over the last decade the \
         exponent is {}, where (27) has −1/2. The largest w counts as vanishing if it falls \
         from each decade to the next and ends below {SMALL}.",
        EACH * EACH,
        largest[0],
        largest[3],
        digits(exponent, 3)
    );
    let falls = largest.windows(2).all(|pair| pair[1] < pair[0]) && largest[3] < SMALL;
    Ok(StatementFinding::new(StatementVerdict::of(falls), evidence, explanation))
}

/// 14: in the range (30) ε_t is close to zero.
pub fn close_to_zero(subject: &Subject) -> Result<StatementFinding, Stop> {
    /// What counts as close, and how much larger than (27) demands the ratio is.
    const CLOSE: f64 = 0.1;
    const MUCH: f64 = 3.0;
    const PLACES: usize = 400;
    let kappas: Vec<f64> = geometric(3.0, 3e4, 25).collect();
    let mut evidence = Evidence::default();
    let mut largest = Vec::new();
    for &kappa in &kappas {
        let low = MUCH / kappa.sqrt();
        let size =
            |psi| Ok::<_, ReproductionError>(subject.collide(kappa, psi, 0.0)?.eps_t().abs());
        let psis: Vec<f64> = geometric(low, 2.0, PLACES).collect();
        let most = maximum(&psis, size)?.value;
        evidence = evidence.number(format!("largest |ε_t| at κ = {}", digits(kappa, 3)), most);
        largest.push(most);
    }
    let close = largest.iter().rposition(|&most| most > CLOSE).map_or(0, |last| last + 1);
    let explanation = format!(
        "(30) is taken as the range in which (27) is small and pure sliding has not begun, μ/(α√κ) ≪ \
         g_t/g_n < 2μ/α, with {MUCH} for ≪: ψ from {MUCH}/√κ to 2. The largest |ε_t| there, of \
         {PLACES} ψ and golden section around the best, is {} at κ = {} and {} at {}. \
         Close to zero is taken as up to {CLOSE}.",
        digits(largest[0], 3),
        digits(kappas[0], 1),
        digits(largest[kappas.len() - 1], 4),
        digits(kappas[kappas.len() - 1], 0)
    );
    Ok(match close {
        0 => StatementFinding::new(StatementVerdict::Holds, evidence, explanation),
        n if n < kappas.len() => StatementFinding::under(
            format!("from κ = {} on, of those tried", digits(kappas[n], 1)),
            evidence,
            explanation,
        ),
        _ => StatementFinding::new(StatementVerdict::DoesNotHold, evidence, explanation),
    })
}

/// 15: in max(const, 1 − 2/ψ) const = 0 is the only sensible choice.
pub fn pragmatic(subject: &Subject) -> Result<StatementFinding, Stop> {
    const COLUMNS: usize = 200;
    const ROWS: usize = 175;
    /// The gain that makes another choice sensible.
    const GAIN: f64 = 0.05;
    let mut evidence = Evidence::default();
    let mut sensible = [false; 2];
    let mut sentences = Vec::new();
    for (kappa, sensible) in Reading::kappas(MOST_STIFFNESS).into_iter().zip(&mut sensible) {
        let cell = |i: usize| {
            let part = |place: usize, of: usize| (place as f64 + 0.5) / of as f64;
            let ratio = MOST_RATIO_3 * part(i / COLUMNS, ROWS);
            [kappa * part(i % COLUMNS, COLUMNS), psi(ratio), 0.0]
        };
        let cells: Vec<_> = (0..COLUMNS * ROWS).map(cell).collect();
        let eps_t = each(&cells, |&[k, psi, _]| Ok(subject.collide(k, psi, 0.0)?.eps_t()))?;
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
        let constants: Vec<f64> =
            (-100..=50).map(|hundredth| 0.01 * f64::from(hundredth)).collect();
        let best =
            maximum(&constants, |constant| Ok::<_, ReproductionError>(-mean_square(constant)))?;
        evidence = evidence
            .number(format!("root mean square error of 0 for κ up to {kappa}"), zero)
            .number(format!("largest error of 0 for κ up to {kappa}"), zero_most)
            .number(format!("best constant for κ up to {kappa}"), best.at)
            .number(format!("its root mean square error for κ up to {kappa}"), -best.value)
            .number(format!("its largest error for κ up to {kappa}"), most(best.at));
        *sensible = zero <= -best.value * (1.0 + GAIN);
        sentences.push(format!(
            "Over κ up to {kappa} and g_t/g_n up to {MOST_RATIO_3} the constant 0 has a root mean \
             square error of {} and is off by {} at most; the best constant, {}, has {}. ",
            digits(zero, 4),
            digits(zero_most, 3),
            digits(best.at, 4),
            digits(-best.value, 4)
        ));
    }
    let explanation = format!(
        "{}Each is over {COLUMNS} x {ROWS} cells at μ = 0.4, α = 2/7. The statement counts as true if \
         the error of the best constant is less than {:.0} % smaller than that of 0.",
        sentences.concat(),
        100.0 * GAIN
    );
    let [printed, axis] = sensible;
    Ok(StatementFinding::by_reading([printed && axis, axis], evidence, explanation))
}

/// 25: ε_t of the steel spheres of Figure 2 is negative at small g_t, down to -0.6.
pub fn steel(subject: &Subject) -> Result<StatementFinding, Stop> {
    /// A row of the figure that is seen has at least so much of its axis.
    const SEEN: f64 = 1.0 / 400.0;
    /// Over these g_n, ε_t has about eleven minima; smaller g_n need smaller g_t.
    const PLACES: usize = 200;
    const LEAST_M_PER_S: f64 = 0.25 * MOST_VELOCITY_M_PER_S;
    let surface = Surface {
        friction: MU,
        tangential_stiffness_kg_per_s2: STEEL_STIFFNESS_KG_PER_S2,
        damping_time_s: 0.0,
    };
    let pair = BodyPair::equal_spheres(STEEL_RADIUS_M, &STEEL, &surface)?;
    let normals: Vec<f64> = geometric(LEAST_M_PER_S, MOST_VELOCITY_M_PER_S, PLACES).collect();
    // The smallest ε_t at a g_t, as the maximum of -ε_t, and the g_n there.
    let deepest = |tangential: f64| {
        maximum(&normals, |normal| {
            let contact = pair.impact(normal, tangential)?.contact;
            Ok::<_, ReproductionError>(
                -subject.collide(contact.kappa(), contact.psi(), 0.0)?.eps_t(),
            )
        })
    };
    // The centre of the lowest row that is seen, and a g_t at which the spring hardly ever yields.
    let lowest = 0.5 * SEEN * MOST_VELOCITY_M_PER_S;
    let on_the_map = -deepest(lowest)?.value;
    let (mut reached, mut missed) = (1e-3 * lowest, lowest);
    let first = deepest(reached)?;
    let mut at = first.at;
    while missed / reached > 1.0 + 1e-6 {
        let middle = (reached * missed).sqrt();
        let found = deepest(middle)?;
        if -found.value <= LEAST_EPS_T_2 {
            (reached, at) = (middle, found.at);
        } else {
            missed = middle;
        }
    }
    let contact = pair.impact(at, reached)?.contact;
    let rows = (1..u32::MAX).find(|&rows| 0.5 * MOST_VELOCITY_M_PER_S / f64::from(rows) <= reached);
    let rows = rows.unwrap_or(u32::MAX);
    let evidence = Evidence::default()
        .number("largest g_t at which ε_t is -0.6, in m/s", reached)
        .number("g_n there, in m/s", at)
        .number("κ there", contact.kappa())
        .number("ψ there", contact.psi())
        .number("ψ κ^(5/4) there", contact.psi() * contact.kappa().powf(1.25))
        .number("smallest ε_t at g_t = 0.25 m/s", on_the_map)
        .count("rows of equal cells up to 200 m/s of which the lowest one shows it", rows as usize);
    let explanation = format!(
        "At each g_t the smallest ε_t was looked for over {PLACES} g_n from {LEAST_M_PER_S} to \
         {MOST_VELOCITY_M_PER_S} m/s, with golden section around the best. At g_t = {lowest} m/s, the \
         lowest row of a map of 400 rows, it is {on_the_map:.3}; it falls with g_t, and is \
         {LEAST_EPS_T_2} at g_t = {reached:.4} m/s, g_n = {at:.1} m/s. Since w at the end falls as \
         κ^(-5/4), this g_t falls as g_n^(3/2). A map up to {MOST_VELOCITY_M_PER_S} m/s shows it from \
         {rows} rows on. It counts as seen in the figure if 400 rows show it.",
    );
    if -first.value > LEAST_EPS_T_2 {
        return Ok(StatementFinding::new(StatementVerdict::DoesNotHold, evidence, explanation));
    }
    if on_the_map <= LEAST_EPS_T_2 {
        return Ok(StatementFinding::new(StatementVerdict::Holds, evidence, explanation));
    }
    let condition = format!("up to g_t = {reached:.3} m/s, on a map of {rows} rows or more");
    Ok(StatementFinding::under(condition, evidence, explanation))
}
