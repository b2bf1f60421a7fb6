//! The last slip of a contact, and the switches before it, where they are too short for the
//! integrator.
//!
//! While the spring sticks, its limit L = F/κ falls to |y| before it falls to 0 at the end of
//! contact: the last phase is slip. With a soft spring after a small impact this slip is shorter
//! than the rounding of the state. The spring is then known far better than its limit, and the time
//! τ that is left follows from the spring: the force near the end is F = τ^{3/2} without damping
//! and F = u|v|τ with it.

use stickslip_contact::phase::Phase;
use stickslip_contact::regularized::Regularized;
use stickslip_contact::regularized::components::{STATE, U};
use stickslip_contact::{Regime, Side};
use stickslip_solver::State;

/// Part of the time scale at the end of contact below which τ is computed from the spring. There
/// the terms after the leading one are below 1e-8 of τ, and so is an integrated τ's error by
/// rounding elsewhere.
const SHORT: f64 = 1e-8;

/// The time left until the end of contact, whose state is `end`, when the last slip begins with the
/// elongation `spring` and has the integrated `length`; `None` if that time is not short.
pub(crate) fn time_left(
    system: &Regularized,
    end: &State<STATE>,
    spring: f64,
    length: f64,
) -> Option<f64> {
    let pull = system.contact().kappa() * spring.abs();
    let a = system.contact().damping();
    let (u, v) = (end[U], system.compression_rate(end).abs());
    let (left, scale) = if a > 0.0 {
        // The force changes from τ to τ^{3/2} on the scale a, and its rate changes at the rate a u.
        (pull / (u * v), a.min(1.0 / (a * u)))
    } else {
        (pull.cbrt().powi(2), 1.0)
    };
    // The spring is also small where a slip begins with the contact, and lasts to its end.
    (left.max(0.5 * length) < SHORT * scale).then_some(left)
}

/// A stick phase just before the end of a contact.
pub(crate) struct LastStick {
    /// Its side: the side of the slip that turned round.
    pub side: Side,
    /// The time left and the spring's elongation at its start and at its end.
    pub ends: [(f64, f64); 2],
}

/// The stick phase with which a contact without damping ends that has been in `slip` up to its
/// `end`, where the body moves away from the side of the slip; `None` if it moves to that side.
///
/// A slip on side s that has turned round, s w < 0, sticks once more at u₀ = (2/3)κ|w|, where its
/// limit u³/κ falls as fast as w. That place may be too close to u = 0 for the integrator to
/// resolve it. Before the end v is −1 and the spring is too slow to change w: it reaches its limit
/// on the other side at u₀/2.
pub(crate) fn stick(system: &Regularized, slip: Phase, end: &State<STATE>) -> Option<LastStick> {
    let Phase { regime, side, .. } = slip;
    let (contact, w) = (system.contact(), system.velocity(end));
    if regime != Regime::Slip || contact.damping() > 0.0 || side.sign() * w >= 0.0 {
        return None;
    }
    let start = contact.kappa() * w.abs() / 1.5;
    let moment = |side: Side, u: f64| (u * u, side.sign() * u * u * u / contact.kappa());
    Some(LastStick { side, ends: [moment(side, start), moment(side.opposite(), 0.5 * start)] })
}

/// The slip, on the side of the spring, that follows a stick phase at whose end the contact ends to
/// rounding.
pub(crate) fn after(phase: Phase, spring: f64) -> Phase {
    assert!(phase.regime == Regime::Stick, "slip lasts to the end of contact by itself");
    let side = if spring == 0.0 {
        phase.side
    } else if spring > 0.0 {
        Side::Positive
    } else {
        Side::Negative
    };
    phase.after(side != phase.side)
}
