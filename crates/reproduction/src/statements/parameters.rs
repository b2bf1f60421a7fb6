//! Statement 2, on the number of parameters.

use fastrand::Rng;
use stickslip_model::CollisionFailure;
use stickslip_model::regularized::END;
use stickslip_model::spheres::{BodyPair, Material, Surface};
use stickslip_solver::Outcome;
use stickslip_studies::three_parameters::ThreeParameters;

use super::spring::Spring;
use super::statement::{Evidence, StatementFinding, StatementVerdict, Stop};
use super::statement::{each, random};
use super::subject::Subject;
use crate::error::ReproductionError;

/// 2: three independent parameters; these are κ, g_t/g_n and μ/α.
pub fn three(subject: &Subject) -> Result<StatementFinding, Stop> {
    const CLOSE: f64 = 1e-9;
    let mut draw = Rng::with_seed(2);
    let contacts = random(1000, 2, false);
    let cases: Vec<_> = contacts
        .iter()
        .map(|&[kappa, psi, _]| [kappa, psi, 0.05 * 60_f64.powf(draw.f64())])
        .collect();
    let differences = each(&cases, |&[kappa, psi, friction]| {
        let reference = subject.collide(kappa, psi, 0.0)?.eps_t();
        let reset = subject.spring == Spring::Reset;
        let eps_t = ended(&ThreeParameters { reset, kappa, friction }, psi)?;
        Ok((eps_t - reference).abs() * psi)
    })?;
    let largest = differences.into_iter().fold(0.0, f64::max);

    let mut in_si = 0.0_f64;
    for &[kappa, psi, _] in &contacts {
        let (target_kappa, target_psi) = scaled_back(&mut draw, kappa, psi)?;
        in_si = in_si.max((target_kappa / kappa - 1.0).abs()).max((target_psi / psi - 1.0).abs());
    }
    // Both of them are needed.
    let spread = |cases: &[[f64; 3]]| -> Result<f64, ReproductionError> {
        let eps_t = each(cases, |&[k, p, _]| Ok(subject.collide(k, p, 0.0)?.eps_t()))?;
        let [low, high] = eps_t
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &e| [low.min(e), high.max(e)]);
        Ok(high - low)
    };
    let over_kappa = spread(&[1.0, 2.0, 4.0, 8.0, 16.0].map(|kappa| [kappa, 0.5, 0.0]))?;
    let over_psi = spread(&[0.2, 0.5, 0.8, 1.1, 1.4].map(|psi| [5.0, psi, 0.0]))?;
    let evidence = Evidence::default()
        .count("random triples of κ, g_t/g_n and μ/α", cases.len())
        .number("largest difference of w at equal κ and ψ", largest)
        .number("largest relative error of κ and ψ from random spheres in SI units", in_si)
        .number("spread of ε_t over κ at ψ = 0.5", over_kappa)
        .number("spread of ε_t over ψ at κ = 5", over_psi);
    let explanation = format!(
        "The scaled equations with κ, g_t/g_n and μ/α were integrated for {} random triples. Their w at \
         the end, in units of μ/α, differs by {largest:.1e} at most from that with κ and ψ = (g_t/g_n) \
         α/μ alone: spring and velocity may be measured in units of μ/α. Two parameters suffice if \
         this difference is below {CLOSE:e}. Both are needed, since ε_t varies by {over_kappa:.2} with \
         κ and by {over_psi:.2} with ψ. Damping adds one.",
        cases.len()
    );
    let two = largest < CLOSE && in_si < CLOSE && over_kappa.min(over_psi) > 0.01;
    Ok(StatementFinding::new(StatementVerdict::of(!two), evidence, explanation))
}

/// κ and ψ of spheres in SI units that are chosen to have `kappa` and `psi`.
fn scaled_back(draw: &mut Rng, kappa: f64, psi: f64) -> Result<(f64, f64), ReproductionError> {
    let mut between = |low: f64, high: f64| low * (high / low).powf(draw.f64());
    let material = Material {
        young_modulus_pa: between(1e6, 1e12),
        poisson_ratio: between(0.1, 0.5),
        density_kg_per_m3: between(500.0, 2e4),
    };
    let friction = between(0.05, 1.0);
    let surface = Surface { friction, tangential_stiffness_kg_per_s2: 1.0, damping_time_s: 0.0 };
    let soft = BodyPair::equal_spheres(between(1e-4, 1.0), &material, &surface)?;
    let soft = BodyPair { alpha: between(0.1, 1.0), ..soft };
    let normal_m_per_s = between(1e-3, 100.0);
    let tangential_m_per_s = psi * normal_m_per_s * friction / soft.alpha;
    // κ is proportional to the stiffness.
    let unit = soft.impact(normal_m_per_s, tangential_m_per_s)?.contact.kappa();
    let surface = Surface { tangential_stiffness_kg_per_s2: kappa / unit, ..surface };
    let pair = BodyPair { surface, ..soft };
    let impact = pair.impact(normal_m_per_s, tangential_m_per_s)?;
    Ok((impact.contact.kappa(), impact.contact.psi()))
}

/// ε_t of a collision in three parameters, which must end with the contact.
fn ended(system: &ThreeParameters, psi: f64) -> Result<f64, ReproductionError> {
    let kappa = system.kappa;
    let found = system.eps_t(psi);
    let found = found.map_err(|source| CollisionFailure { kappa, psi, damping: 0.0, source })?;
    match found {
        (eps_t, Outcome::EndedByGuard { guard: END }) => Ok(eps_t),
        (_, outcome) => Err(ReproductionError::Unended { kappa, psi, outcome }),
    }
}
