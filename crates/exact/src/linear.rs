//! The exact engine for linear contacts: F = x + a v with a spring of constant stiffness.
//!
//! Normal motion, limit and spring are damped oscillators, each with two constants, and everything
//! between two switches has a closed form. Whether a phase ends, and where, is decided by the signs
//! of a few numbers on intervals on which a function is monotone, or has one minimum: nothing is
//! searched by sampling. The laws are those of [`solves`]: `gran/hooke/history` of LAMMPS and
//! others of [`presets`](stickslip_contact::presets).
//!
//! Nothing is shared with the integrator, nor with [`exact`](crate::exact) but the search for a
//! root in a bracket: this is a second opinion, which `Engine::Auto` of
//! `stickslip-model` does not choose. Its `Engine::Exact` is this engine where [`solves`] holds.
//!
//! Source files in reading order: `oscillator`, `normal` the motion of the overlap, `slip` and
//! `stick` the ends of phases, with their proofs, `run` a collision.

use stickslip_contact::numerics::root::{Jet, bracketed};
use stickslip_contact::{Collision, Contact, CoulombTest, Damping, Normal as Elastic, Tangential};

use crate::domain;
use crate::exact::ExactError;
use normal::{Moment, Motion, Normal, Place, Stage};
use oscillator::Oscillator;
use slip::Drive;

mod normal;
mod oscillator;
mod run;
mod slip;
mod stick;

/// How many times ε the sum of the sizes of its terms a number may be off.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// A number, but 0 where it may be the rounding of numbers of this size.
fn unless_rounding(value: f64, size: f64) -> f64 {
    if value.abs() <= ROUNDING * size { 0.0 } else { value }
}

/// Whether a contact is linear: its normal force is F = x + a v, or x without damping, and the
/// stiffness of its spring is constant, its history not rescaled, and Coulomb's limit holds for
/// spring and dashpot together, with one coefficient of friction.
pub fn solves(contact: &Contact) -> bool {
    let law = contact.law();
    law.normal == Elastic::Linear
        && law.tangential == Tangential::Constant
        && law.remembers()
        && !law.rescaled
        && law.friction.is_constant()
        && (law.coulomb_test == CoulombTest::Total
            || contact.damping() * contact.tangential_damping() == 0.0)
        && (contact.damping() == 0.0 || law.damping == Damping::Linear)
}

/// The collision of a linear contact from its closed form.
///
/// Against 180 contacts with 24 digits, κ from 0.01 to 400, ε_t is within 1e-15 max(1, √κ) and the
/// times of switches within 4e-15; ε_n and the contact time have relative errors below 1e-15.
///
/// The itinerary is right unless one of its switches, or the lack of one, is due to a difference
/// within rounding: a spring that touches its limit and does not exceed it by more is not a switch.
/// A force that begins at its limit sticks first, if only for no time. Damping at which the
/// oscillators do not oscillate is included.
///
/// ```
/// use stickslip_contact::{Contact, presets};
/// use stickslip_exact::linear;
///
/// let law = presets::find("gran/hooke/history").ok_or("no such law")?.law;
/// let contact = |psi| Contact::new(3.0, psi, 0.0)?.with_law(law, 0.0);
/// // In gross sliding ε_t = 1 − (1 + ε_n)/ψ.
/// let sliding = linear::collide(contact(4.0)?)?;
/// assert_eq!(sliding.itinerary(), "+");
/// assert!((sliding.eps_t() - 0.5).abs() < 1e-15);
/// // With κψ ≤ 1 the spring holds at first.
/// let sticking = linear::collide(contact(0.3)?)?;
/// assert_eq!(sticking.itinerary(), "o-");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`ExactError::Law`] unless [`solves`]; [`ExactError::Domain`] unless κ is from 1e-60 to 1e10, ψ
/// from 1e-60 to 1e60 and the damping 0 or from 1e-60 to 1e4, or to 1.9999 where the normal force
/// may attract; [`ExactError::TooManySwitches`] as [`exact::collide`](crate::exact::collide).
pub fn collide(contact: Contact) -> Result<Collision, ExactError> {
    let mut collision = Collision::before(contact);
    collide_into(contact, &mut collision)?;
    Ok(collision)
}

/// As [`collide`], into a collision whose memory is used again.
///
/// # Errors
/// As [`collide`]; `collision` then contains the switches found so far.
pub fn collide_into(contact: Contact, collision: &mut Collision) -> Result<(), ExactError> {
    collision.reset(contact);
    if !solves(&contact) {
        return Err(ExactError::Law);
    }
    let linear = Linear::new(&contact);
    domain::linear(&contact, linear.normal.attracts)?;
    run::run(&linear, collision)
}

/// The constants of a contact.
#[derive(Clone, Copy, Debug)]
struct Linear {
    /// The normal motion.
    normal: Normal,
    /// The motion in stick.
    spring: Oscillator,
    kappa: f64,
    /// c = b a.
    dashpot: f64,
    /// κ − 1 and c − a, the factors of P.
    contrast: [f64; 2],
    /// A bound on all rates.
    fast: f64,
}

impl Linear {
    fn new(contact: &Contact) -> Self {
        let (kappa, damping) = (contact.kappa(), contact.damping());
        let normal = Normal::new(contact);
        let dashpot = contact.tangential_damping() * damping;
        let spring = Oscillator::new(dashpot, kappa);
        let contrast = [kappa - 1.0, damping * (contact.tangential_damping() - 1.0)];
        let fast = spring.fast.max(normal.oscillator.fast);
        Self { normal, spring, kappa, dashpot, contrast, fast }
    }

    /// P where the limit and its slope are given.
    fn drive_of(&self, limit: f64, slope: f64) -> Drive {
        let [stiffness, damping] = self.contrast;
        // L̈ = −a L̇ − L.
        let bend = -self.normal.oscillator.damping * slope - limit;
        Drive {
            value: stiffness * limit + damping * slope,
            rate: stiffness * slope + damping * bend,
            integral: f64::NAN,
        }
    }

    /// P at a moment.
    fn drive(&self, motion: &Motion) -> Drive {
        let [stiffness, damping] = self.contrast;
        let Motion { limit, slope, rate } = *motion;
        let integral = stiffness * rate - damping * limit;
        Drive { integral, ..self.drive_of(limit, slope) }
    }

    /// Where P vanishes in the rest of a stage.
    fn turn(&self, start: &Moment, stage: Stage) -> Option<Place> {
        let [stiffness, damping] = self.contrast;
        self.normal.zero_of(stiffness, damping, start, stage)
    }

    /// The end of a stage, in a phase that starts at `start`.
    fn end(&self, start: &Moment, stage: Stage) -> Place {
        match stage {
            Stage::Main => Place { since: start.left, left: 0.0 },
            Stage::Tail => Place { since: start.left + self.normal.rest, left: -self.normal.rest },
        }
    }
}

/// The place between `above`, where f > 0, and `below` behind it, where f < 0, at which f vanishes.
/// The derivatives of f are rates in time. The first time that is tried is `guess`.
fn falling(
    start: &Moment,
    [above, below]: [Place; 2],
    guess: f64,
    f: impl Fn(Place) -> Jet,
) -> Place {
    let since = |since: f64| Place { since, left: start.left - since };
    let from_start =
        |end: Place| since(bracketed(above.since, end.since, guess, |time| f(since(time))));
    // The tail begins where the force vanishes: there the time since then is known.
    if start.left <= 0.0 || below.since <= below.left {
        return from_start(below);
    }
    let from_end = |begin: Place| {
        let left = |left: f64| Place { since: start.left - left, left };
        left(bracketed(begin.left, below.left, start.left - guess, |time| {
            let Jet { value, slope, curvature } = f(left(time));
            Jet { value, slope: -slope, curvature }
        }))
    };
    if above.since >= above.left {
        return from_end(above);
    }
    let middle = since(0.5 * start.left);
    let Jet { value, .. } = f(middle);
    if value > 0.0 {
        from_end(middle)
    } else if value < 0.0 {
        from_start(middle)
    } else {
        middle
    }
}
