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

use super::moment::{At, Half, Moment, Motion, Spring};
use super::normal::Trajectory;
use super::slip::SlipPhase;

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
        meets.then(|| self.path.meeting(&self.spring, sliding, sliding.start, turn))
    }

    /// The moment at which the slip phase turns into stick, if it does and if it has not done so
    /// before the first turn.
    pub fn onset_after_turn(&self, sliding: &SlipPhase) -> Option<Moment> {
        (self.end_margin(sliding) < 0.0).then(|| {
            let low = self.turns.map_or(sliding.start, |[_, turn]| sliding.start.or_later(turn));
            self.path.meeting(&self.spring, sliding, low, Moment::END)
        })
    }

    /// The guard g at `at`.
    pub fn guard(&self, sliding: &SlipPhase, at: &At<T::Motion>) -> f64 {
        sliding.guard(&self.spring, at)
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
