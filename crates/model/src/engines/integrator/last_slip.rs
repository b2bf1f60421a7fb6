//! The last slip of a contact, where it is too short for the integrator.
//!
//! While the spring sticks, its limit L = F/κ falls to |y| before it falls to 0 at the end of
//! contact: the last phase is slip. With a soft spring after a small impact this slip is shorter
//! than the rounding of the state. The spring is then known far better than its limit, and the time
//! τ that is left follows from the spring: the force near the end is F = τ^{3/2} without damping
//! and F = u|v|τ with it.

use stickslip_solver::State;

use crate::laws::phase::{Phase, Regime, Side};
use crate::laws::regularized::Regularized;
use crate::laws::regularized::components::{STATE, U};

/// Part of the time scale at the end of contact below which τ is computed from the spring. There
/// the terms after the leading one are below 1e-8 of τ, and so is an integrated τ's error by
/// rounding elsewhere.
const SHORT: f64 = 1e-8;

/// The time left until the end of contact, whose state is `end`, when the last slip begins with the
/// elongation `spring`; `None` if that time is not short.
pub(crate) fn time_left(system: &Regularized, end: &State<STATE>, spring: f64) -> Option<f64> {
    let pull = system.contact().kappa() * spring.abs();
    let a = system.contact().damping();
    let (u, v) = (end[U], system.compression_rate(end).abs());
    let (left, scale) = if a > 0.0 {
        // The force changes from τ to τ^{3/2} on the scale a, and its rate changes at the rate a u.
        (pull / (u * v), a.min(1.0 / (a * u)))
    } else {
        (pull.cbrt().powi(2), 1.0)
    };
    (left < SHORT * scale).then_some(left)
}

/// The slip, on the side of the spring, that follows a stick phase at whose end the contact ends to
/// rounding.
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
