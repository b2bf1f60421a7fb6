//! Statements on pure Coulomb sliding: 1, 9, 10, 11, and the numbers of footnote 2: 16.

use std::f64::consts::PI;

use fastrand::Rng;
use stickslip_model::exact;
use stickslip_model::limits::coulomb::{self, NormalLaw};
use stickslip_model::spheres::{BodyPair, Surface};
use stickslip_studies::paper::{
    self, Reading, STEEL, STEEL_RADIUS_M, STEEL_STIFFNESS_KG_PER_S2, STIFFNESS,
};
use stickslip_studies::search::change;

use super::statement::{Evidence, StatementFinding, StatementVerdict, Stop};
use super::statement::{digits, each, geometric};
use super::subject::Subject;
use crate::error::ReproductionError;

/// 1: the closed form, whatever the normal law.
pub fn closed_form(_: &Subject) -> Result<StatementFinding, Stop> {
    const EACH: usize = 60;
    const CLOSE: f64 = 1e-10;
    let mut random = Rng::with_seed(1);
    let mut tried = Vec::new();
    for half_powers in [0, 1, 2] {
        for damping in [0.0, 0.05, 0.2, 0.6] {
            let law = NormalLaw { half_powers, damping };
            tried.extend((0..EACH).map(|_| (law, 0.1 + 5.9 * random.f64())));
        }
    }
    let slid = each(&tried, |&(law, psi)| {
        let sliding = coulomb::slide(law, psi)
            .map_err(|source| ReproductionError::Sliding { psi, source })?;
        Ok(((sliding.eps_t - coulomb::restitution(psi, sliding.eps_n)).abs(), sliding.eps_n))
    })?;
    let largest = slid.iter().map(|slid| slid.0).fold(0.0, f64::max);
    let least = slid.iter().map(|slid| slid.1).fold(1.0, f64::min);
    let evidence = Evidence::default()
        .count("contacts integrated", tried.len())
        .number("largest difference of ε_t from the formula", largest)
        .number("smallest ε_n among them", least);
    let explanation = format!(
        "{} random contacts with the normal forces x^(n/2)(x + a dx/dt), n = 0, 1, 2, and a = 0, 0.05, \
         0.2, 0.6 were integrated with Coulomb friction alone. With the ε_n of each, the formula is \
         met to {largest:.1e} (it counts as met up to {CLOSE:e}). Sliding changes w by the normal \
         impulse 1 + ε_n, whatever the law.",
        tried.len()
    );
    Ok(StatementFinding::new(StatementVerdict::of(largest < CLOSE), evidence, explanation))
}

/// 9: no switch above g_t/g_n = 3 but for very small κ.
pub fn above_three(subject: &Subject) -> Result<StatementFinding, Stop> {
    const RATIO: f64 = 3.0;
    /// What counts as very small.
    const SMALL: f64 = 1.0;
    let psi = paper::psi(RATIO);
    let switches =
        |kappa| Ok::<_, ReproductionError>(!subject.collide(kappa, psi, 0.0)?.switches.is_empty());
    let limit = change(0.001, Reading::Axis.kappa(STIFFNESS), switches)?;
    let mut random = Rng::with_seed(9);
    let above: Vec<_> = (0..20_000)
        .map(|_| [limit * (1e4 / limit).powf(random.f64()), psi * 50_f64.powf(random.f64()), 0.0])
        .collect();
    let switching = each(&above, |&[kappa, psi, _]| {
        Ok(usize::from(!subject.collide(kappa, psi, 0.0)?.switches.is_empty()))
    })?;
    let switching: usize = switching.iter().sum();
    let evidence = Evidence::default()
        .number("κ below which there are switches at g_t/g_n = 3", limit)
        .number("ψ of pure sliding there, closed form", exact::top_boundary(limit))
        .number("ψ at g_t/g_n = 3", psi)
        .count("random collisions above both limits", above.len())
        .count("of them with switches", switching);
    let explanation = format!(
        "With μ = 0.4, α = 2/7 and g_t/g_n = 3, collisions switch only for κ below {}, and none of \
         {} random ones above in both did (κ to 1e4, g_t/g_n to 150). The number 3 belongs to that μ \
         and α: the boundary is ψ = (g_t/g_n) α/μ, {} here. Very small is taken as below {SMALL}.",
        digits(limit, 6),
        above.len(),
        digits(psi, 4)
    );
    if switching > 0 || limit > SMALL {
        return Ok(StatementFinding::new(StatementVerdict::DoesNotHold, evidence, explanation));
    }
    Ok(StatementFinding::under(format!("κ above {}", digits(limit, 4)), evidence, explanation))
}

/// 10: the limit of pure sliding lies below 2μ/α.
pub fn true_limit(subject: &Subject) -> Result<StatementFinding, Stop> {
    const CLOSE: f64 = 1e-9;
    let mut evidence = Evidence::default();
    let (mut lowest, mut highest, mut from_formula) = (f64::INFINITY, 0.0_f64, 0.0_f64);
    let [printed, axis] = Reading::kappas(STIFFNESS);
    for kappa in [0.58, 1.0, 5.0, printed, axis, 1000.0] {
        let psi = top(subject, kappa, 0.3, 10.0)?;
        evidence = evidence.number(format!("ψ of pure sliding at κ = {kappa}"), psi);
        (lowest, highest) = (lowest.min(psi), highest.max(psi));
        from_formula = from_formula.max((psi / exact::top_boundary(kappa) - 1.0).abs());
    }
    let below = top(subject, 0.3, 0.3, 100.0)?;
    match subject.lines() {
        Ok(lines) => {
            for line in lines {
                let name = format!("the same traced, κ = {}", line.kappa);
                evidence = evidence.number(name, line.top());
            }
        }
        // Bisection has found the boundary without them.
        Err(Stop::Open(_)) => {}
        Err(failed) => return Err(failed),
    }
    let evidence = evidence
        .number("ψ of pure sliding at κ = 0.3", below)
        .number("largest relative difference from the closed form", from_formula)
        .number(
            "largest g_t/g_n of pure sliding from κ = 0.58 on, μ = 0.4, α = 2/7",
            paper::ratio(highest),
        );
    let there = if lowest < highest {
        format!("lies between {lowest} and {highest}")
    } else {
        format!("is {lowest}")
    };
    let explanation = format!(
        "The ψ above which the count of switches is 0 was bisected to rounding; 2μ/α is ψ = 2. From κ \
         = 0.58 to 1000 it {there}, and at κ = 0.3 it is {}. The closed \
         form is 2 from κ = 0.5701 on and rises below. The statement counts as true if the limit is \
         below 2 by more than {CLOSE:e} at all of them.",
        digits(below, 6)
    );
    Ok(StatementFinding::new(StatementVerdict::of(highest < 2.0 - CLOSE), evidence, explanation))
}

/// 11: for small κ there is always a switch.
pub fn vertical_line(subject: &Subject) -> Result<StatementFinding, Stop> {
    const HIGHEST: f64 = 1e5;
    let mut evidence = Evidence::default();
    let mut tops = Vec::new();
    let mut from_formula = 0.0_f64;
    for kappa in [0.001, 0.003, 0.01, 0.03, 0.1, 0.3] {
        if !subject.collide(kappa, HIGHEST, 0.0)?.switches.is_empty() {
            continue;
        }
        let psi = top(subject, kappa, 0.3, HIGHEST)?;
        evidence = evidence.number(format!("ψ of pure sliding at κ = {kappa}"), psi);
        from_formula = from_formula.max((psi / exact::top_boundary(kappa) - 1.0).abs());
        tops.push((kappa, psi));
    }
    let [first, second, ..] = tops.as_slice() else {
        let explanation = format!("Up to ψ = {HIGHEST:e} there is a switch at every small κ.");
        return Ok(StatementFinding::new(StatementVerdict::Holds, evidence, explanation));
    };
    let slope = (second.1 / first.1).ln() / (second.0 / first.0).ln();
    let evidence = evidence
        .number("slope d ln ψ/d ln κ between the first two", slope)
        .number("κψ at the first", first.0 * first.1)
        .number("largest relative difference from the closed form", from_formula);
    let explanation = format!(
        "At each κ a ψ was found above which there is no switch. The boundary is not a vertical line, \
         but a curve with slope {slope:.4} in logarithms; κψ is {:.5} at κ = {}.",
        first.0 * first.1,
        first.0
    );
    Ok(StatementFinding::new(StatementVerdict::DoesNotHold, evidence, explanation))
}

/// The ψ between `low` and `high` above which there is no switch.
fn top(subject: &Subject, kappa: f64, low: f64, high: f64) -> Result<f64, Stop> {
    let switches =
        |psi| Ok::<_, ReproductionError>(!subject.collide(kappa, psi, 0.0)?.switches.is_empty());
    let psi = change(low, high, switches)?;
    // Bisection finds one change. Whether it is the last one is tried.
    for other in geometric(psi * (1.0 + 1e-6), 1e3 * psi, 500) {
        if switches(other)? {
            let reason =
                format!("κ = {kappa}: there are switches at ψ = {other}, above their end at {psi}");
            return Err(Stop::Open(reason));
        }
    }
    Ok(psi)
}

/// 16: the numbers of footnote 2.
pub fn footnote_2(_: &Subject) -> Result<StatementFinding, Stop> {
    const PRINTED: f64 = 1.109e5;
    const FRICTION: f64 = 0.5;
    const SPEED_M_PER_S: f64 = 20.0;
    const CLOSE: f64 = 1e-3;
    let formula = |young_modulus_pa: f64, factor: f64| {
        let density = STEEL.density_kg_per_m3;
        let stiffness = young_modulus_pa / (1.0 - STEEL.poisson_ratio.powi(2));
        let fifth = factor / 243.0
            * PI.powi(3)
            * density.powi(3)
            * STEEL_RADIUS_M.powi(10)
            * stiffness.powi(2)
            * SPEED_M_PER_S.powi(6);
        FRICTION * fifth.powf(0.2)
    };
    let surface = Surface {
        friction: FRICTION,
        tangential_stiffness_kg_per_s2: STEEL_STIFFNESS_KG_PER_S2,
        damping_time_s: 0.0,
    };
    let impact = BodyPair::equal_spheres(STEEL_RADIUS_M, &STEEL, &surface)
        .and_then(|pair| pair.impact(SPEED_M_PER_S, 1.0))?;
    let force_n = impact.largest_normal_force_n();
    let as_printed = formula(210e6, 250.0);
    let [with_gpa, corrected] =
        [250.0, 31.25].map(|factor| formula(STEEL.young_modulus_pa, factor));
    let off = |value: f64| (value / PRINTED - 1.0).abs();
    let evidence = Evidence::default()
        .number("printed μ F_n in N", PRINTED)
        .number("μ F_n with Y = 210 MPa and the factor 250, in N", as_printed)
        .number("μ F_n with Y = 210 GPa and the factor 250, in N", with_gpa)
        .number("μ F_n with Y = 210 GPa and the factor 31.25, in N", corrected)
        .number("largest F_n of the collision, from its energy, in N", force_n)
        .number(
            "elongation at k_t = 1e12 kg/s², in m",
            FRICTION * force_n / STEEL_STIFFNESS_KG_PER_S2,
        );
    let explanation = format!(
        "The printed number counts as reproduced within {CLOSE:e}. It is off by {:.2e} from the formula \
         with the printed Y = 210 MPa, and by {:.1e} with Y = 210 GPa and the factor 250. The energy of \
         the compression gives F_n = {force_n:.5e} N, for which the factor must be 31.25 (μ F_n = \
         {corrected:.4e} N), and an elongation of {:.4} µm at k_t = 1e12 kg/s².",
        off(as_printed),
        off(with_gpa),
        1e6 * FRICTION * force_n / STEEL_STIFFNESS_KG_PER_S2
    );
    Ok(StatementFinding::new(StatementVerdict::of(off(as_printed) < CLOSE), evidence, explanation))
}
