//! The error to expect of a collision, and how far its itinerary is from changing.

use stickslip_contact::{Collision, Regime};
use stickslip_exact::exact;

use super::error::CollisionError;
use super::{Engine, Tolerances};

/// How good a collision is.
///
/// The spring and its limit form a system that never lets two motions move apart: for contacts with
/// the same normal motion, the norm √(w² + κy²) of their difference never grows. Therefore errors
/// and distances from other switches are comparable, both as velocities in units of ψ.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Estimate {
    /// The error of ε_t to expect: 999 of 1000 errors are below it.
    pub eps_t_error: f64,
    /// Part of ψ, at most 1, by which w would have to differ, at any moment, for another itinerary.
    /// Up to 0.1, the itinerary is the same for all ψ that are nearer than this, relative to ψ;
    /// above, this holds to its order of magnitude only.
    pub distance: f64,
    /// Whether the itinerary is certain: the second opinion has the same one, and the distance is
    /// above the larger of `eps_t_error` and 100 tolerances, since errors of w may be larger at
    /// some moment than what is left at the end.
    pub certain: bool,
}

/// How many times the difference from a second opinion the error may be. The second opinion is
/// better than the first: this covers what its own error takes away from the difference.
const SAFETY: f64 = 3.0;

/// How many tolerances the velocity may be off. Over the range of docs/validation.md, ε_t is off by
/// at most 40 with Dormand–Prince 8(5,3) and 70 with 5(4).
const MOST_TOLERANCES: f64 = 100.0;
/// The stiffness κ above which there are more, as √κ.
const MEASURED: f64 = 1e6;
/// The least tolerance that counts: below it rounding does.
const LEAST_TOLERANCE: f64 = 1e-14;

impl Engine {
    /// The error to expect of `collision`, which this engine has computed, by a second opinion: the
    /// exact solution. Rounding is added, also that of the exact solution itself.
    ///
    /// Cost: 1.3 exact collisions, and one more after an integration.
    ///
    /// ```
    /// use stickslip_model::{Contact, Engine, Tolerances};
    ///
    /// let contact = Contact::new(63.0, 0.5, 0.01)?;
    /// let engine = Engine::Dopri5(Tolerances { rtol: 1e-6, atol: 1e-6 });
    /// let (rough, _) = engine.collide(contact)?;
    /// let (fine, _) = Engine::Auto.collide(contact)?;
    /// let estimate = engine.estimate(&rough)?;
    /// let error = (rough.eps_t() - fine.eps_t()).abs();
    /// assert!(error < estimate.eps_t_error && estimate.eps_t_error < 10.0 * error);
    /// assert!(estimate.certain && rough.itinerary() == fine.itinerary());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`Self::collide`].
    pub fn estimate(&self, collision: &Collision) -> Result<Estimate, CollisionError> {
        let contact = collision.contact;
        contact.require_paper("the estimate")?;
        let engine = self.resolved(&contact);
        let distance = exact::distance(&contact)?;
        let (difference, agrees) = match engine {
            Self::Exact | Self::Auto => (0.0, true),
            Self::Dop853(_) | Self::Dopri5(_) => {
                let exact = exact::collide(contact)?;
                let difference = (collision.eps_t() - exact.eps_t()).abs();
                (difference, collision.itinerary() == exact.itinerary())
            }
        };
        let eps_t_error = SAFETY * difference + rounding(collision);
        let most = MOST_TOLERANCES * (contact.kappa() / MEASURED).max(1.0).sqrt();
        let of_steps = engine
            .tolerances()
            .map_or(0.0, |Tolerances { rtol, atol }| most * rtol.max(atol).max(LEAST_TOLERANCE));
        let certain = agrees && distance > eps_t_error.max(of_steps);
        Ok(Estimate { eps_t_error, distance, certain })
    }
}

/// What rounding makes of ε_t: a few units in its last place, and the rounding of the angle by
/// which the spring swings.
fn rounding(collision: &Collision) -> f64 {
    let omega = collision.contact.kappa().sqrt();
    let psi = collision.contact.psi();
    // The start counts as a switch with the velocity ψ and no elongation.
    let switches = collision.switches.iter();
    let begins = switches
        .clone()
        .map(|switch| (switch.to, switch.time, switch.velocity.hypot(omega * switch.spring) / psi));
    let ends = switches.map(|switch| switch.time).chain([collision.contact_time]);
    let phases = std::iter::once((collision.start, 0.0, 1.0)).chain(begins).zip(ends);
    let swings = phases.filter(|((regime, ..), _)| *regime == Regime::Stick);
    let angles: f64 = swings.map(|((_, begin, speed), end)| omega * (end - begin) * speed).sum();
    // With damping the normal motion is a sum over pieces.
    let units = if collision.contact.damping() > 0.0 { 8.0 } else { 4.0 };
    f64::EPSILON * (units + collision.eps_t().abs() + 2.0 * angles)
}
