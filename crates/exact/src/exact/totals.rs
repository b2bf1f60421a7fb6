//! Totals over the phases of a collision: the work of sliding, and the reversals of the motion.

use stickslip_contact::EnergyLedger;

use super::moment::{At, Motion};
use super::slip::SlipPhase;

/// The totals over the phases so far.
#[derive(Debug, Default)]
pub struct Totals {
    /// ∫ F (s·w − dL/dt) dt over the slip phases, apart from κL²/2 at the end of the last one.
    sliding: f64,
    /// Sign changes of the tangential velocity.
    pub reversals: usize,
}

impl Totals {
    /// Adds a slip phase up to `end`, where s·w is `velocity`.
    ///
    /// With F dt = −dv and s·w linear in v, ∫ F s·w dt is the impulse times the mean of s·w.
    pub fn slip<M: Motion>(&mut self, sliding: &SlipPhase, end: &At<M>, velocity: f64) {
        self.sliding += 0.5 * sliding.impulse_until(end) * (sliding.velocity + velocity);
        self.reversals += usize::from((sliding.velocity > 0.0) != (velocity > 0.0));
    }

    /// Adds a stick phase, during which L changes from `stuck` to `released`.
    ///
    /// As L is 0 at both ends of contact, ∫ F dL over the slip phases is minus the change of κL²/2
    /// over the stick phases.
    pub fn stick(&mut self, kappa: f64, stuck: f64, released: f64) {
        self.sliding += 0.5 * kappa * (released - stuck) * (released + stuck);
    }

    /// The energy ledger of a collision whose w is `psi` at the start and `final_velocity` at the
    /// end, with the energy of its normal motion.
    pub fn ledger(&self, psi: f64, final_velocity: f64, normal: EnergyLedger) -> EnergyLedger {
        EnergyLedger {
            tangential_initial: 0.5 * psi * psi,
            tangential_final: 0.5 * final_velocity * final_velocity,
            sliding: self.sliding,
            spring_left: 0.0,
            ..normal
        }
    }
}
