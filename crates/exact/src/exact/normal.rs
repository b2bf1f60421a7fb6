//! The normal motion of a collision, which does not feel the tangential one: the interface behind
//! which the exact engine finds every normal law.
//!
//! A [`Trajectory`] is the compression as a function of time, and what follows from it for the
//! spring's limit L = F/κ. [`undamped`] is the closed form without damping, [`viscoelastic`] the
//! expansion with it. The decisions need little of the normal motion: that L has one maximum, and
//! where P = κL + L̈ changes its sign. They are compiled once for each trajectory, without dynamic
//! dispatch. A further law with a tangential spring of constant stiffness is a further trajectory.

use std::fmt::Debug;

use stickslip_contact::EnergyLedger;
use stickslip_contact::numerics::double_double::DoubleDouble;
use stickslip_contact::numerics::root::{Jet, bracketed};

use super::moment::{At, Half, Moment, Motion, Spring};
use super::slip::SlipPhase;

pub mod undamped;
pub mod viscoelastic;

/// Number of Taylor coefficients in [`Trajectory::limit_series`].
pub const ORDER: usize = 18;

/// The start of a stick phase that follows slip: the spring is at its limit.
#[derive(Clone, Copy, Debug)]
pub struct StickPhase {
    /// The tangential spring.
    pub spring: Spring,
    /// The moment at which the phase starts.
    pub start: Moment,
    /// w at the start, with twice the digits.
    pub velocity: DoubleDouble,
}

/// The normal motion of a collision.
///
/// The decisions of the exact engine rest on what every trajectory must have: L is 0 at the end of
/// contact, it rises to one maximum and falls, and the sign of P alternates and is + at the end. It
/// changes to + at most twice.
pub trait Trajectory: Debug + Sized {
    /// The normal motion at a moment.
    type Motion: Motion;

    /// Whether the contact starts in slip: the limit rises more slowly than the spring.
    const STARTS_IN_SLIP: bool;

    /// Whether [`Self::refined_exit`] improves anything.
    const REFINES: bool;

    /// The normal motion at `moment`.
    fn motion(&self, moment: Moment) -> Self::Motion;

    /// `moment` with the normal motion there.
    fn at(&self, moment: Moment) -> At<Self::Motion> {
        At { moment, motion: self.motion(moment) }
    }

    /// The root coordinates, from the start and from the end of contact, of the moment at which the
    /// halves meet.
    fn middle(&self) -> [f64; 2];
    /// The unit of time in scaled time; the unit of κ is its inverse square, and the unit of
    /// lengths is itself.
    fn time_unit(&self) -> f64 {
        1.0
    }
    /// The coefficient of normal restitution.
    fn restitution(&self) -> f64;
    /// The energy of the normal motion; the other entries are 0.
    fn energy(&self) -> EnergyLedger;
    /// Duration of the contact.
    fn contact_time(&self) -> f64;
    /// The whole change of v, from 1 at the start to that at the end.
    fn impulse(&self) -> f64;

    /// Time between `at` and the end of the contact from which it is counted.
    fn near_time(&self, at: &At<Self::Motion>) -> f64;
    /// Time from `from` until `to`, exact to rounding within one half.
    fn elapsed(&self, from: &At<Self::Motion>, to: &At<Self::Motion>) -> f64;
    /// The rate dt/dr of time along the root coordinate, and d²t/dr².
    fn time_along_root(&self, at: &At<Self::Motion>) -> [f64; 2];
    /// The moment a time `duration` ≥ 0 after `from`, at most [`Moment::END`], with an error below
    /// `slack`.
    fn after(&self, from: &At<Self::Motion>, duration: f64, slack: f64) -> Moment;
    /// The moment a time `duration` ≥ 0 before `until`, at least [`Moment::START`], with an error
    /// below `slack`.
    fn before(&self, until: &At<Self::Motion>, duration: f64, slack: f64) -> Moment;

    /// The start and end of a time during which F > `force`: nearly all of it, or none if a spring
    /// with the frequency `omega` swings a few times only.
    fn above(&self, force: f64, omega: f64) -> Option<[Moment; 2]>;
    /// Roughly the first moment at which a spring that starts with the velocity `psi` reaches its
    /// limit.
    fn exit_after_impact(&self, spring: &Spring, psi: f64) -> Option<Moment>;
    /// Roughly the last moment at which F is `force`, which may be too large for any.
    fn last_time_at(&self, force: f64) -> Option<Moment>;
    /// The last two zeros of P, if P falls through 0 anywhere: where it falls, and where it rises
    /// again.
    fn turns(&self, spring: &Spring) -> Option<[Moment; 2]>;
    /// How far beyond the end of contact, in the root coordinate, the motion is continued: there L
    /// is negative and has passed its minimum, or this is as far as the expansion is good.
    fn beyond_end(&self) -> f64;
    /// The moment at which both [`Self::turns`] meet, as κ is increased.
    fn split(&self) -> Moment;

    /// The moment at which a slip phase turns into stick: the only zero of g between `low`, where
    /// g > 0, and `high`, where g < 0.
    fn meeting(&self, spring: &Spring, sliding: &SlipPhase, low: Moment, high: Moment) -> Moment;

    /// The moment `end` of a stick phase, improved beside a graze, where L − sign·y falls through 0
    /// at the slow `rate`.
    fn refined_exit(&self, stick: &StickPhase, sign: f64, end: Moment, rate: f64) -> Moment;

    /// Time around `at` within which the Taylor series of L converges.
    fn series_radius(&self, at: &At<Self::Motion>) -> f64;
    /// The Taylor coefficients of F around `at` in powers of time.
    fn force_series(&self, at: &At<Self::Motion>) -> [f64; ORDER];

    /// Time from the start of contact until `at`.
    fn time(&self, at: &At<Self::Motion>) -> f64 {
        match at.moment.half {
            Half::Compression => self.near_time(at),
            Half::Decompression => self.contact_time() - self.near_time(at),
        }
    }

    /// Time from `at` until the end of contact.
    fn time_left(&self, at: &At<Self::Motion>) -> f64 {
        match at.moment.half {
            Half::Compression => self.contact_time() - self.near_time(at),
            Half::Decompression => self.near_time(at),
        }
    }
}

/// The derivatives of a function in time as derivatives in the root coordinate.
pub fn along_root<T: Trajectory>(
    path: &T,
    at: &At<T::Motion>,
    value: f64,
    rate: f64,
    acceleration: f64,
) -> Jet {
    let [time_per_root, bend] = path.time_along_root(at);
    Jet {
        value,
        slope: rate * time_per_root,
        curvature: acceleration * time_per_root * time_per_root + rate * bend,
    }
}

/// The root between `low`, where f > 0, and `high`, where f < 0, which may be in different halves.
pub fn root_between<T: Trajectory>(
    path: &T,
    mut low: Moment,
    mut high: Moment,
    guess: Option<Moment>,
    f: impl Fn(&At<T::Motion>) -> Jet,
) -> Moment {
    if low.half != high.half {
        let [early, late] = path.middle();
        let middle = Moment { half: Half::Decompression, root: late };
        if f(&path.at(middle)).value < 0.0 {
            high = Moment { half: Half::Compression, root: early };
        } else {
            low = middle;
        }
    }
    let half = low.half;
    let guess = match guess {
        Some(moment) if moment.half == half => moment.root,
        _ => 0.5 * (low.root + high.root),
    };
    let root = bracketed(low.root, high.root, guess, |root| f(&path.at(Moment { half, root })));
    Moment { half, root }
}
