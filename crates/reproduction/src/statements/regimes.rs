//! Statements on the regimes of a contact: 3, 4, 5, 17, 18, 20.

use stickslip_model::{Collision, Regime};

use super::statement::{Evidence, StatementFinding, StatementVerdict, Stop};
use super::statement::{each, random};
use super::subject::Subject;
use crate::error::ReproductionError;

/// The number of random collisions that are tried.
const TRIED: usize = 10_000;

/// 3: the contact starts with sliding.
pub fn start(subject: &Subject) -> Result<StatementFinding, Stop> {
    let sliding = |seed, damped| -> Result<(usize, usize), ReproductionError> {
        let tried = random(TRIED, seed, damped);
        let expected = tried.iter().filter(|contact| slides_first(contact)).count();
        let found = each(&tried, |&[kappa, psi, damping]| {
            Ok(subject.integrate(kappa, psi, damping)?.start == Regime::Slip)
        })?;
        Ok((expected, found.into_iter().filter(|&slip| slip).count()))
    };
    let (undamped, undamped_found) = sliding(31, false)?;
    let (damped, damped_found) = sliding(32, true)?;
    let evidence = Evidence::default()
        .count("random collisions without damping", TRIED)
        .count("of them with the spring above the limit at first", undamped)
        .count("integrated so", undamped_found)
        .count("random collisions with damping", TRIED)
        .count("of them with the spring above the limit at first (damped)", damped)
        .count("integrated so (damped)", damped_found);
    let explanation = format!(
        "As t falls to 0, the spring's pull κψ t was compared with the limit t^(3/2) + a t^(1/2). Its \
         share of the limit grows without end in {undamped} of {TRIED} random collisions without \
         damping. It vanishes in {} of {TRIED} with a from 0.001 to 1, which start with the spring.",
        TRIED - damped
    );
    if undamped != undamped_found || damped != damped_found {
        return Err(Stop::Open("the integration starts in another regime".to_owned()));
    }
    Ok(match (undamped == TRIED, damped == TRIED) {
        (true, true) => StatementFinding::new(StatementVerdict::Holds, evidence, explanation),
        (true, false) => {
            StatementFinding::under("without damping".to_owned(), evidence, explanation)
        }
        _ => StatementFinding::new(StatementVerdict::DoesNotHold, evidence, explanation),
    })
}

/// Whether the spring, if it followed the motion from the first touch, would be above its limit at
/// once.
fn slides_first([kappa, psi, damping]: &[f64; 3]) -> bool {
    let share = |t: f64| kappa * psi * t / (t.sqrt() * (t + damping));
    share(1e-24) > share(1e-20)
}

/// 4: the contact ends with sliding.
pub fn end(subject: &Subject) -> Result<StatementFinding, Stop> {
    let last = each(&random(TRIED, 4, false), |&[kappa, psi, damping]| {
        let collision = subject.integrate(kappa, psi, damping)?;
        let left = collision.switches.last().map_or(collision.contact_time, |last| last.time_left);
        Ok((last_regime(&collision), left))
    })?;
    let sticking = last.iter().filter(|(regime, _)| *regime == Regime::Stick).count();
    let shortest = last.iter().map(|(_, left)| *left).fold(f64::INFINITY, f64::min);
    let evidence = Evidence::default()
        .count("random collisions without damping", TRIED)
        .count("of them ending with the spring", sticking)
        .number("shortest last sliding, scaled time", shortest);
    let explanation = format!(
        "{sticking} of {TRIED} random collisions end with the spring. The limit falls to 0 at the end. \
         Only a spring at rest with no elongation, as with g_t = 0, stays below it. The shortest last \
         sliding took {shortest:.1e}."
    );
    Ok(StatementFinding::new(StatementVerdict::of(sticking == 0), evidence, explanation))
}

/// 5: the number of switches is even.
pub fn parity(subject: &Subject) -> Result<StatementFinding, Stop> {
    let odd = |seed, damped| -> Result<usize, ReproductionError> {
        let odd = each(&random(TRIED, seed, damped), |&[kappa, psi, damping]| {
            Ok(subject.integrate(kappa, psi, damping)?.switches.len() % 2)
        })?;
        Ok(odd.into_iter().sum())
    };
    let (undamped, damped) = (odd(51, false)?, odd(52, true)?);
    let evidence = Evidence::default()
        .count("random collisions without damping", TRIED)
        .count("of them with an odd number of switches", undamped)
        .count("random collisions with damping", TRIED)
        .count("of them with an odd number of switches (damped)", damped);
    let explanation = format!(
        "{undamped} of {TRIED} random collisions without damping and {damped} of {TRIED} with a from \
         0.001 to 1 have an odd number of switches: with damping the contact starts with the spring \
         and ends with sliding."
    );
    Ok(match (undamped, damped) {
        (0, 0) => StatementFinding::new(StatementVerdict::Holds, evidence, explanation),
        (0, _) => StatementFinding::under("without damping".to_owned(), evidence, explanation),
        _ => StatementFinding::new(StatementVerdict::DoesNotHold, evidence, explanation),
    })
}

/// 17: with damping some collisions end with the spring.
pub fn damped_end(subject: &Subject) -> Result<StatementFinding, Stop> {
    let tried = random(2 * TRIED, 17, true);
    let last = each(&tried, |&[kappa, psi, damping]| {
        let collision = subject.integrate(kappa, psi, damping)?;
        let left = collision.switches.last().map_or(f64::NAN, |last| last.time_left);
        // F = u(u² + a v) is 0 at the end: u² = −a v, v̇ = 0 and Ḟ = u v.
        let root = (damping * collision.eps_n).sqrt();
        Ok((last_regime(&collision), left, root * collision.eps_n))
    })?;
    let sticking = last.iter().filter(|(regime, ..)| *regime == Regime::Stick).count();
    let shortest = last.iter().map(|(_, left, _)| *left).fold(f64::INFINITY, f64::min);
    let slowest = last.iter().map(|(.., rate)| *rate).fold(f64::INFINITY, f64::min);
    let evidence = Evidence::default()
        .count("random collisions with damping", tried.len())
        .count("of them ending with the spring", sticking)
        .number("shortest last sliding, scaled time", shortest)
        .number("slowest fall of the limit force at the end, scaled", slowest);
    let explanation = format!(
        "{sticking} of {} random collisions with a from 0.001 to 1 end with the spring. The limit falls \
         to 0 at a finite rate (x^(1/2) |v|, {slowest:.1e} at least), so that the spring would have to \
         come to elongation 0 at that very moment. This happens only on curves in the plane of κ and \
         ψ, which random collisions do not meet.",
        tried.len()
    );
    Ok(StatementFinding::new(StatementVerdict::of(sticking > 0), evidence, explanation))
}

/// 18: damping changes quantities, but not how a collision goes.
pub fn damping(subject: &Subject) -> Result<StatementFinding, Stop> {
    const SMALL: f64 = 1e-6;
    let tried = random(2000, 18, false);
    let compared = each(&tried, |&[kappa, psi, _]| {
        let without = subject.integrate(kappa, psi, 0.0)?;
        let with = subject.integrate(kappa, psi, SMALL)?;
        let odd = (with.switches.len() + without.switches.len()) % 2 == 1;
        Ok((with.start != without.start, odd, (with.eps_t() - without.eps_t()).abs() * psi))
    })?;
    let starts = compared.iter().filter(|(start, ..)| *start).count();
    let parities = compared.iter().filter(|(_, odd, _)| *odd).count();
    let largest = compared.iter().map(|(.., change)| *change).fold(0.0, f64::max);
    let evidence = Evidence::default()
        .count("random collisions, without damping and with a = 1e-6", tried.len())
        .count("of them that start in another regime", starts)
        .count("of them whose numbers of switches differ by an odd number", parities)
        .number("largest change of w at the end", largest);
    let explanation = format!(
        "With a = {SMALL:e} instead of 0, {starts} of {} random collisions start in another regime and \
         {parities} have a number of switches that differs by an odd number, while w changes by \
         {largest:.1e} at most. Quantities change little, but the contact starts in another way.",
        tried.len()
    );
    Ok(StatementFinding::new(StatementVerdict::of(starts + parities == 0), evidence, explanation))
}

/// 20: energy is lost only while sliding.
pub fn energy(subject: &Subject) -> Result<StatementFinding, Stop> {
    const CLOSE: f64 = 1e-9;
    let ledgers = each(&random(TRIED, 20, false), |&[kappa, psi, damping]| {
        let collision = subject.integrate(kappa, psi, damping)?;
        let energy = |index: usize| {
            let switch = collision.switches[index];
            0.5 * switch.velocity * switch.velocity + 0.5 * kappa * switch.spring * switch.spring
        };
        let on_spring = |index: usize| (energy(index + 1) - energy(index)).abs();
        let sticking = (0..collision.switches.len() / 2).map(|pair| on_spring(2 * pair));
        let initial = collision.energy.tangential_initial;
        let unbalanced = collision.energy.tangential_unbalanced().abs() / initial;
        Ok([sticking.fold(0.0, f64::max) / initial, unbalanced, collision.energy.sliding / initial])
    })?;
    let largest = |entry: usize| ledgers.iter().map(|ledger| ledger[entry]).fold(0.0, f64::max);
    let (sticking, unbalanced) = (largest(0), largest(1));
    let least = ledgers.iter().map(|ledger| ledger[2]).fold(f64::INFINITY, f64::min);
    let evidence = Evidence::default()
        .count("random collisions without damping", TRIED)
        .number("largest change of energy over a phase of the spring, of that at impact", sticking)
        .number("largest part of the energy that sliding does not explain", unbalanced)
        .number("smallest part of the energy taken by sliding", least)
        .number("largest part of the energy taken by sliding", largest(2));
    let explanation = format!(
        "In {TRIED} random collisions kinetic energy and spring together change by at most \
         {sticking:.1e} of the energy at impact while the spring acts. What sliding takes explains the \
         loss to {unbalanced:.1e}. Both count as nothing up to {CLOSE:e}."
    );
    Ok(StatementFinding::new(
        StatementVerdict::of(sticking.max(unbalanced) < CLOSE),
        evidence,
        explanation,
    ))
}

fn last_regime(collision: &Collision) -> Regime {
    collision.switches.last().map_or(collision.start, |last| last.to)
}
