//! What a collision adds up: the work of sliding, and the reversals of the motion.

use super::slide::SlipPhase;
use super::trajectory::{Half, Moment, NormalMotion};
use crate::result::EnergyLedger;

/// The running account of a collision.
#[derive(Debug, Default)]
pub struct Account {
    /// ∫ F (s·w − dL/dt) dt over the slip phases so far, apart from κL²/2 at the last end.
    sliding: f64,
    /// Sign changes of the tangential velocity so far.
    pub reversals: usize,
}

impl Account {
    /// Enters a slip phase up to `end`, where the normal motion is at `point` and s·w is
    /// `velocity`.
    ///
    /// With F dt = −dv and s·w linear in v, ∫ F s·w dt is the impulse times the mean of s·w.
    pub fn slip(&mut self, sliding: &SlipPhase, end: Moment, point: NormalMotion, velocity: f64) {
        let impulse = match (sliding.start.half, end.half) {
            (Half::Compression, Half::Compression) => point.deficit - sliding.deficit,
            (Half::Decompression, _) => sliding.deficit - point.deficit,
            (Half::Compression, Half::Decompression) => 2.0 - sliding.deficit - point.deficit,
        };
        self.sliding += 0.5 * impulse * (sliding.velocity + velocity);
        self.reversals += usize::from((sliding.velocity > 0.0) != (velocity > 0.0));
    }

    /// Enters a stick phase, over which L goes from `stuck` to `released`.
    ///
    /// ∫ F dL over the slip phases is minus the change of κL²/2 over the stick phases, as L is 0
    /// at both ends of contact.
    pub fn stick(&mut self, kappa: f64, stuck: f64, released: f64) {
        self.sliding += 0.5 * kappa * (released - stuck) * (released + stuck);
    }

    /// The ledger of a collision without damping that starts with w = `psi` and ends with w =
    /// `final_velocity`.
    pub fn ledger(&self, psi: f64, final_velocity: f64) -> EnergyLedger {
        EnergyLedger {
            tangential_initial: 0.5 * psi * psi,
            tangential_final: 0.5 * final_velocity * final_velocity,
            sliding: self.sliding,
            spring_left: 0.0,
            normal_initial: 0.5,
            normal_final: 0.5,
            damping: 0.0,
            compression_left: 0.0,
        }
    }
}
