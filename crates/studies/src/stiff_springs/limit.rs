//! The limit of stiff springs, ε_t → 0, from full collisions without damping.
//!
//! At fixed κ the final velocity oscillates with ψ, between zeros where a switch falls on the end
//! of contact. The height of these oscillations is the [`envelope`]. It tends to κ^{−5/4} times
//! [`inner::peak`](stickslip_model::limits::inner::peak), and is the same for all of them. All
//! maxima are found by Brent's method from a bracket, on collisions of the exact engine. Along κ at
//! fixed ψ the oscillation would change its height while it passes, and its maxima would lie beside
//! the envelope.

use std::f64::consts::PI;

use stickslip_model::exact;
use stickslip_model::limits::largest;
use stickslip_model::{Collision, Contact, InvalidValue};

use crate::error::StudyError;
use crate::search::{highest, root};

/// (5/4)^{3/5}, the largest value of x^{3/2}: the factor that the bound (27) of Schwager, Becker
/// and Pöschel (2008) lacks.
///
/// The spring's limit reaches (5/4)^{3/5}/κ. With 1/κ instead, as printed in (25), a spring that is
/// let go from its limit reaches the velocity 1/√κ, and |ε_t| ≤ 1/(ψ√κ).
pub const BOUND_FACTOR: f64 = largest::FORCE;

/// The largest of the final velocities around a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crest {
    /// Scaled stiffness κ.
    pub kappa: f64,
    /// The impact ratio ψ of the maximum.
    pub psi: f64,
    /// |w_final|.
    pub velocity: f64,
    /// √κ · (time left) where the last stick phase starts; NaN if there is none.
    pub last_onset: f64,
    /// √κ · (duration of the last stick phase); NaN if there is none.
    pub last_stick: f64,
    /// Number of switches.
    pub switch_count: usize,
}

/// The largest |w_final| between the two zeros of w_final(ψ) around `psi`, at stiffness `kappa`
/// without damping.
///
/// Only a local maximum is found, the next one uphill from `psi`. From about κ = 2 on there is only
/// one between two zeros. |w_final| then has a relative error of about 1e-14, and ψ has half as
/// many correct digits.
///
/// Cost: about 25 collisions.
///
/// ```
/// use stickslip_model::limits::inner;
/// use stickslip_studies::stiff_springs::limit;
///
/// let [high, low] = [0.5, 1.5].map(|psi| limit::envelope(1e6, psi).unwrap().velocity);
/// assert!((high / low - 1.0).abs() < 1e-12);
/// assert!((high * 1e6_f64.powf(1.25) / inner::peak().velocity - 1.0).abs() < 2e-7);
/// ```
///
/// # Errors
/// [`StudyError::Settings`] unless κ > 0 and 0 < ψ < 2: from ψ = 2 on nothing oscillates; also if
/// the search fails. [`StudyError::Exact`] if κ is more than the exact engine takes.
pub fn envelope(kappa: f64, psi: f64) -> Result<Crest, StudyError> {
    envelope_within(kappa, psi, SMOOTH)
}

fn envelope_within(kappa: f64, psi: f64, tolerance: f64) -> Result<Crest, StudyError> {
    let start = collide(kappa, require_inside(psi)?)?;
    let side = 1.0_f64.copysign(start.final_velocity);
    let height = |psi| collide(kappa, psi).map(|collision| side * collision.final_velocity);
    let bracket = climb(kappa, psi, height)?;
    crest(kappa, highest(bracket, tolerance, height)?)
}

/// The distance in ψ between two zeros of w_final around `psi` for a stiff spring, π x^{3/2}/√κ at
/// the first switch.
///
/// The first stick phase starts where v = 1 − ψ. This moment moves by dψ/x^{3/2} with ψ, and half a
/// swing lasts π/√κ.
pub fn oscillation(kappa: f64, psi: f64) -> f64 {
    PI * (1.25 * psi * (2.0 - psi)).powf(0.6) / kappa.sqrt()
}

/// The largest |ε_t| of all ψ from `lowest` to 2 at stiffness `kappa`, which is at least about 2,
/// without damping.
///
/// The oscillations of |w_final| are equally high, except for lower ones next to ψ = 0. Those of
/// |ε_t| = |w_final|/ψ therefore fall with ψ, and maxima are looked for from `lowest` on until none
/// can be higher. Cost: about 30 collisions.
///
/// # Errors
/// As [`envelope`].
pub fn largest_restitution(kappa: f64, lowest: f64) -> Result<Crest, StudyError> {
    let lowest = require_inside(lowest)?;
    let height = |psi| collide(kappa, psi).map(|collision| collision.eps_t().abs());
    // No oscillation is higher than the last one, which lasts to ψ = 2, has two switches and costs
    // next to nothing. Its top is 12.5 κ^{−5/4} below ψ = 2.
    let last = (2.0 - 12.5 * kappa.powf(-1.25)).clamp(1.0, 2.0_f64.next_down());
    let ceiling = 1.001 * envelope(kappa, last)?.velocity;
    let mut best = (lowest, height(lowest)?);
    let (mut before, mut here) = (best, best);
    while here.0 < 2.0 && ceiling > best.1 * here.0 {
        let psi = (here.0 + eighth(kappa, here.0)).max(here.0.next_up()).min(2.0);
        let next = (psi, height(psi)?);
        // `before` and `here` are equal at first, which finds a maximum just above the lowest ψ.
        if here.1 >= before.1.max(next.1) {
            let psi = highest((before.0, next.0), SMOOTH, height)?;
            let found = (psi, height(psi)?);
            best = if found.1 > best.1 { found } else { best };
        }
        (before, here) = (here, next);
    }
    crest(kappa, best.0)
}

/// By how much collisions exceed the bound (27) as it is printed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Excess {
    /// The collision with the largest √κ|w_final|, which is at most 1 by the printed bound.
    pub worst: Crest,
    /// This largest √κ|w_final|.
    pub ratio: f64,
    /// The stiffnesses between which some ψ exceeds the bound.
    pub kappa: (f64, f64),
}

/// How far √κ|w_final| exceeds 1, and where, on the oscillation of ψ around 1.
///
/// The maximum lies where the spring touches its limit without sliding (κ = 1.52, ψ = 1.00):
/// w_final(ψ) has a kink there.
///
/// # Errors
/// As [`envelope`].
pub fn excess() -> Result<Excess, StudyError> {
    // The maximum and the two ends are known to lie between these values of ln κ.
    let [low, middle, high] = [1.0_f64, 1.5, 3.0].map(f64::ln);
    let top = |log: f64| envelope_within(log.exp(), 1.0, SHARP);
    let ratio = |log: f64| top(log).map(|crest| (0.5 * log).exp() * crest.velocity);
    let log = highest((low, high), SMOOTH, ratio)?;
    let above = |log| ratio(log).map(|ratio| ratio - 1.0);
    let kappa = (root((low, middle), above)?.exp(), root((middle, high), above)?.exp());
    Ok(Excess { worst: top(log)?, ratio: ratio(log)?, kappa })
}

fn require_inside(psi: f64) -> Result<f64, StudyError> {
    InvalidValue::check("psi", psi, "a number above 0 and below 2", psi > 0.0 && psi < 2.0)?;
    Ok(psi)
}

/// The contact without damping.
pub(super) fn contact(kappa: f64, psi: f64) -> Result<Contact, StudyError> {
    InvalidValue::check("kappa", kappa, "a finite number above 0", kappa > 0.0)?;
    Ok(Contact::new(kappa, psi, 0.0)?)
}

fn collide(kappa: f64, psi: f64) -> Result<Collision, StudyError> {
    Ok(exact::collide(contact(kappa, psi)?)?)
}

fn crest(kappa: f64, psi: f64) -> Result<Crest, StudyError> {
    let collision = collide(kappa, psi)?;
    let [last_onset, last_stick] = match collision.switches[..] {
        [.., stick, slip] => [stick.time_left, stick.time_left - slip.time_left],
        _ => [f64::NAN; 2],
    }
    .map(|time| kappa.sqrt() * time);
    Ok(Crest {
        kappa,
        psi,
        velocity: collision.final_velocity.abs(),
        last_onset,
        last_stick,
        switch_count: collision.switches.len(),
    })
}

/// An eighth of an oscillation, in ψ.
fn eighth(kappa: f64, psi: f64) -> f64 {
    0.125 * oscillation(kappa, psi)
}

/// An interval with a maximum of `height` inside, reached from `psi` uphill in steps of an eighth
/// of an oscillation.
fn climb(
    kappa: f64,
    psi: f64,
    height: impl Fn(f64) -> Result<f64, StudyError>,
) -> Result<(f64, f64), StudyError> {
    let above = |psi: f64| (psi + eighth(kappa, psi)).min(2.0);
    let below = |psi: f64| (psi - eighth(kappa, psi)).max(0.5 * psi);
    let start = height(psi)?;
    let uphill = height(above(psi))? > start;
    let onwards = |psi: f64| if uphill { above(psi) } else { below(psi) };
    let (mut before, mut here, mut value) = (psi, onwards(psi), height(onwards(psi))?);
    if value <= start {
        return Ok((below(psi), above(psi)));
    }
    loop {
        let next = onwards(here);
        let next_value = height(next)?;
        if next_value <= value {
            return Ok((before.min(next), before.max(next)));
        }
        (before, here, value) = (here, next, next_value);
    }
}

/// The tolerance of a search, in parts of its interval, where a maximum is smooth: the height has
/// all its digits this close to it.
const SMOOTH: f64 = 1e-8;
/// The tolerance where the maximum is a kink.
const SHARP: f64 = 1e-14;
