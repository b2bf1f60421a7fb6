//! A slip phase: while sliding on side s, s·w − v is constant.

use stickslip_contact::numerics::double_double::DoubleDouble;

use super::moment::{At, Half, Moment, Motion, Spring};

/// The start of a slip phase, in the orientation of its side.
#[derive(Clone, Copy, Debug)]
pub struct SlipPhase {
    /// The moment at which it starts.
    pub start: Moment,
    /// |v − v₀| at the start, where v₀ is the velocity at the nearer end of contact.
    pub deficit: f64,
    /// s·w at the start.
    pub velocity: f64,
    /// The whole change of v during contact.
    impulse: f64,
}

impl SlipPhase {
    /// The slip phase that starts at `start` with s·w = `velocity`, in a contact that changes v by
    /// `impulse` in all.
    pub fn new<M: Motion>(impulse: f64, start: &At<M>, velocity: f64) -> Self {
        let deficit = start.motion.deficit();
        Self { start: start.moment, deficit, velocity, impulse }
    }

    /// s·w at a later moment of the phase.
    pub fn velocity_at<M: Motion>(&self, at: &At<M>) -> DoubleDouble {
        match at.moment.half {
            Half::Compression => DoubleDouble::sum(self.at_start(), -at.motion.deficit()),
            Half::Decompression => DoubleDouble::sum(self.at_end(), at.motion.deficit()),
        }
    }

    /// s·w carried back to the start of contact.
    pub fn at_start(&self) -> f64 {
        match self.start.half {
            Half::Compression => self.velocity + self.deficit,
            Half::Decompression => self.at_end() + self.impulse,
        }
    }

    /// s·w carried on to the end of contact.
    pub fn at_end(&self) -> f64 {
        match self.start.half {
            Half::Compression => self.at_start() - self.impulse,
            Half::Decompression => self.velocity - self.deficit,
        }
    }

    /// The change of v from the start until `end`.
    pub fn impulse_until<M: Motion>(&self, end: &At<M>) -> f64 {
        let deficit = end.motion.deficit();
        match (self.start.half, end.moment.half) {
            (Half::Compression, Half::Compression) => deficit - self.deficit,
            (Half::Decompression, _) => self.deficit - deficit,
            (Half::Compression, Half::Decompression) => self.impulse - self.deficit - deficit,
        }
    }

    /// The guard g = s·w − dL/dt at `at`.
    pub fn guard<M: Motion>(&self, spring: &Spring, at: &At<M>) -> f64 {
        let (carried, change) = match at.moment.half {
            Half::Compression => (self.at_start(), -at.motion.deficit()),
            Half::Decompression => (self.at_end(), at.motion.deficit()),
        };
        carried + (change - at.motion.limit_rate(spring))
    }
}
