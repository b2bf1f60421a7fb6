//! The last slip of a contact, where it is too short for the integrator.
//!
//! While the spring sticks, its limit L = F/κ falls to 0 at the end of contact, and before that to
//! |y|: the last phase is slip. With a soft spring after a small impact it is shorter than rounding
//! of the state. The spring is then known far better than its limit, and so is the time τ that is
//! left: the force near the end is F = τ^{3/2} without damping, and with it F = u|v|τ.

use stickslip_solver::State;

use crate::laws::phase::{Phase, Regime, Side};
use crate::laws::regularized::Regularized;
use crate::laws::regularized::components::{STATE, U, V};

/// Part of the time scale at the end of contact below which τ comes from the spring: what the
/// leading term leaves out, and what rounding of the state leaves of an integrated τ, are both
/// below 1e-8 of τ.
const SHORT: f64 = 1e-8;

/// The time that is left to a spring of elongation `spring` whose slip lasts to the end of contact
/// at `end`, if it is short.
pub(crate) fn time_left(system: &Regularized, end: &State<STATE>, spring: f64) -> Option<f64> {
    let pull = system.contact().kappa() * spring.abs();
    let a = system.contact().damping();
    let (u, v) = (end[U], end[V].abs());
    let (left, scale) = if a > 0.0 {
        // The force turns from τ to τ^{3/2} on the scale a, and its rate changes at the rate a u.
        (pull / (u * v), a.min(1.0 / (a * u)))
    } else {
        (pull.cbrt().powi(2), 1.0)
    };
    (left < SHORT * scale).then_some(left)
}

/// The slip that follows a stick phase to whose end the contact lasts, to rounding: on the side of
/// the spring.
pub(crate) fn after(phase: Phase, spring: f64) -> Phase {
    debug_assert!(phase.regime == Regime::Stick, "slip lasts to the end of contact by itself");
    let side = if spring == 0.0 {
        phase.side
    } else if spring > 0.0 {
        Side::Positive
    } else {
        Side::Negative
    };
    phase.after(side != phase.side)
}
