//! The slip phase, and where it turns into a stick phase.
//!
//! While sliding on side s, s·w − v is constant, and the phase ends where g = s·w − dL/dt falls
//! through 0. As dg/dt is −P, g falls where P = κL + L̈ is positive. At the end of contact it is;
//! going back from there it changes its sign at the second turn, and again at the first one, if
//! the trajectory has [turns](Trajectory::turns). There are three cases:
//!
//! - The phase ends before the first turn if it starts before it and g is negative there.
//! - Otherwise it ends after the second turn if g is negative at the end of contact.
//! - Otherwise it lasts to the end of contact.

use super::normal::{At, Half, Moment, Motion, Spring, Trajectory};
use crate::numerics::double_double::DoubleDouble;

/// The properties that all slip phases of one collision share.
#[derive(Debug)]
pub struct Slide<'t, T> {
    /// The normal motion.
    pub path: &'t T,
    /// The tangential spring.
    pub spring: Spring,
    /// The moments at which P changes its sign, if it falls through 0 anywhere.
    pub turns: Option<[Moment; 2]>,
    /// g − s·w at the first turn, with s·w carried to the end of contact from which it is counted.
    rest: f64,
    /// −dL/dt at the end of contact.
    end_rate: f64,
}

/// The start of a slip phase, in the orientation of its side.
#[derive(Clone, Copy, Debug)]
pub struct SlipPhase {
    /// The moment at which it starts.
    pub start: Moment,
    /// |v − v₀| at the start, v₀ being that of the nearer end of contact.
    pub deficit: f64,
    /// s·w at the start.
    pub velocity: f64,
    /// The whole change of v during contact.
    impulse: f64,
}

impl SlipPhase {
    /// The slip phase that starts at `start` with s·w = `velocity`.
    pub fn new<T: Trajectory>(path: &T, start: &At<T::Motion>, velocity: f64) -> Self {
        let deficit = start.motion.deficit();
        Self { start: start.moment, deficit, velocity, impulse: path.impulse() }
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
}

impl<'t, T: Trajectory> Slide<'t, T> {
    /// The slip phases with a spring of the stiffness `kappa`.
    pub fn new(path: &'t T, kappa: f64) -> Self {
        let spring = Spring::new(kappa);
        let turns = path.turns(&spring);
        let rest = turns.map_or(0.0, |[turn, _]| {
            let motion = path.motion(turn);
            let rate = motion.limit_rate(&spring);
            match turn.half {
                Half::Compression => -(motion.deficit() + rate),
                Half::Decompression => motion.deficit() - rate,
            }
        });
        let end_rate = -path.motion(Moment::END).limit_rate(&spring);
        Self { path, spring, turns, rest, end_rate }
    }

    /// The spring's limit L at `at`.
    pub fn limit(&self, at: &At<T::Motion>) -> f64 {
        at.motion.limit(&self.spring)
    }

    /// The moment at which the slip phase turns into stick; `None` if it lasts to the end of
    /// contact.
    pub fn stick_onset(&self, sliding: &SlipPhase) -> Option<Moment> {
        self.onset_before_turn(sliding).or_else(|| self.onset_after_turn(sliding))
    }

    /// The moment at which the slip phase turns into stick before the first turn, if it does.
    pub fn onset_before_turn(&self, sliding: &SlipPhase) -> Option<Moment> {
        let [turn, _] = self.turns?;
        let meets = self.turn_margin(sliding)? < 0.0;
        meets.then(|| self.path.meeting(self, sliding, sliding.start, turn))
    }

    /// The moment at which the slip phase turns into stick, if it does and if it has not done so
    /// before the first turn.
    pub fn onset_after_turn(&self, sliding: &SlipPhase) -> Option<Moment> {
        (self.end_margin(sliding) < 0.0).then(|| {
            let low = self.turns.map_or(sliding.start, |[_, turn]| sliding.start.or_later(turn));
            self.path.meeting(self, sliding, low, Moment::END)
        })
    }

    /// The guard g at `at`.
    pub fn guard(&self, sliding: &SlipPhase, at: &At<T::Motion>) -> f64 {
        let (carried, change) = match at.moment.half {
            Half::Compression => (sliding.at_start(), -at.motion.deficit()),
            Half::Decompression => (sliding.at_end(), at.motion.deficit()),
        };
        carried + (change - at.motion.limit_rate(&self.spring))
    }

    /// The largest s·w at impact with which g is not positive at the first turn, if there is one in
    /// the compression.
    pub fn highest(&self) -> Option<f64> {
        self.turns.is_some().then_some(-self.rest)
    }

    /// g at the first turn, if the phase starts before it.
    pub fn turn_margin(&self, sliding: &SlipPhase) -> Option<f64> {
        let [turn, _] = self.turns?;
        let carried = match turn.half {
            Half::Compression => sliding.at_start(),
            Half::Decompression => sliding.at_end(),
        };
        sliding.start.is_before(turn).then_some(carried + self.rest)
    }

    /// g at the end of contact.
    pub fn end_margin(&self, sliding: &SlipPhase) -> f64 {
        sliding.at_end() + self.end_rate
    }
}
