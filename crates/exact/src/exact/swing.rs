//! The motion of the spring in a stick phase, compared with its limit.

use stickslip_contact::numerics::double_double::DoubleDouble;

use super::moment::{At, Moment, Motion, Spring};
use super::normal::{StickPhase, Trajectory};
use super::onset::Onset;
use super::slide::Slide;

/// One stick phase, in the orientation in which it starts on side +1: y = A cos θ, where θ grows at
/// the rate ω = √κ.
#[derive(Debug)]
pub struct Swing<'t, T: Trajectory> {
    /// The normal motion.
    pub path: &'t T,
    /// The spring.
    pub spring: Spring,
    /// The moments at which P changes its sign, if it falls through 0 anywhere.
    pub turns: Option<[Moment; 2]>,
    /// The moment at which the phase starts.
    pub start: At<T::Motion>,
    /// y at the start, where it is equal to the limit L.
    pub elongation: f64,
    /// w at the start, with twice the digits.
    pub velocity: DoubleDouble,
    /// The amplitude A.
    pub amplitude: f64,
    /// The angle from the start to the first y = 0, between 0 and π. It is −π for a phase with
    /// which the contact starts, so that its first half swing has the number [`AT_IMPACT`].
    pub first_zero: f64,
    /// The number of the half swing with which the phase starts.
    pub first: u32,
    /// The series of D just after the start, for a phase that may be very short.
    onset: Option<Onset>,
}

/// The number of the half swing with which a contact starts, if it starts in stick. It is on side
/// +1, and the spring is 0 at its start, as on every half swing but number 0.
pub const AT_IMPACT: u32 = 2;

/// The spring and its limit at one moment of a half swing, on which q = ±y is positive.
#[derive(Clone, Copy, Debug)]
pub struct Gap {
    /// The gap D = L − q.
    pub value: f64,
    /// dD/dt.
    pub rate: f64,
    /// d²D/dt².
    pub acceleration: f64,
    /// The elongation q.
    pub q: f64,
    /// dq/dt.
    pub q_rate: f64,
}

impl Gap {
    /// W = L q̇ − L̇ q, which has the sign of the rate of q/L. It is computed from D, which may be
    /// known far better than L and q are.
    pub fn turning(&self) -> f64 {
        self.q_rate * self.value - self.q * self.rate
    }
}

impl<'t, T: Trajectory> Swing<'t, T> {
    /// The phase that starts at `start`, where w is `velocity`, after slip.
    pub fn new(slide: &Slide<'t, T>, start: At<T::Motion>, velocity: DoubleDouble) -> Self {
        let &Slide { path, spring, turns, .. } = slide;
        let elongation = start.motion.limit(&spring);
        let across = velocity.0 / spring.omega;
        Self {
            path,
            spring,
            turns,
            start,
            elongation,
            velocity,
            amplitude: elongation.hypot(across),
            first_zero: elongation.atan2(-across),
            first: 0,
            onset: Onset::new(path, &spring, &start, velocity.0, turns),
        }
    }

    /// The phase with which the contact starts.
    pub fn at_impact(slide: &Slide<'t, T>, psi: f64) -> Self {
        let &Slide { path, spring, turns, .. } = slide;
        Self {
            path,
            spring,
            turns,
            start: path.at(Moment::START),
            elongation: 0.0,
            velocity: DoubleDouble(psi, 0.0),
            amplitude: psi / spring.omega,
            first_zero: -std::f64::consts::PI,
            first: AT_IMPACT,
            onset: None,
        }
    }

    /// How the phase starts.
    pub fn phase(&self) -> StickPhase {
        StickPhase { spring: self.spring, start: self.start.moment, velocity: self.velocity }
    }

    /// Time from the start until `at`.
    pub fn elapsed(&self, at: &At<T::Motion>) -> f64 {
        self.path.elapsed(&self.start, at)
    }

    /// y and w a time `tau` after the start.
    pub fn motion(&self, tau: f64) -> (f64, f64) {
        let omega = self.spring.omega;
        let (sin, cos) = (omega * tau).sin_cos();
        (
            self.elongation * cos + self.velocity.0 / omega * sin,
            self.velocity.0 * cos - self.elongation * omega * sin,
        )
    }

    /// The gap on half swing `k` at `at`.
    pub fn gap(&self, k: u32, at: &At<T::Motion>) -> Gap {
        let tau = self.elapsed(at);
        let sign = half_swing_sign(k);
        let (y, w) = self.motion(tau);
        let (q, q_rate) = (sign * y, sign * w);
        let limit = at.motion.limit(&self.spring);
        let (value, rate) = (limit - q, at.motion.limit_rate(&self.spring) - q_rate);
        let pull = at.motion.pull(&self.spring);
        let plain = Gap { value, rate, acceleration: pull - self.spring.kappa * value, q, q_rate };
        let Some((value, rate, acceleration)) = self.onset.and_then(|onset| onset.gap(tau)) else {
            return plain;
        };
        if k == 0 {
            return Gap { value, rate, acceleration, ..plain };
        }
        // L + y = 2L − (L − y)
        let limit_rate = plain.rate + q_rate;
        let limit_acceleration = pull - self.spring.kappa * limit;
        Gap {
            value: 2.0 * limit - value,
            rate: 2.0 * limit_rate - rate,
            acceleration: 2.0 * limit_acceleration - acceleration,
            ..plain
        }
    }

    /// Whether [`Swing::gap`] is a series at `at`, and therefore free of cancellation.
    pub fn is_onset(&self, k: u32, at: &At<T::Motion>) -> bool {
        k == 0 && self.onset.is_some_and(|onset| self.elapsed(at) <= onset.reach)
    }

    /// The moment an angle `past_zero` after the first y = 0, at most [`Moment::END`].
    pub fn moment_at_angle(&self, past_zero: f64) -> Moment {
        self.moment_near_angle(past_zero, 1e-6)
    }

    /// As [`Self::moment_at_angle`], with an error of the angle below `slack`.
    pub fn moment_near_angle(&self, past_zero: f64, slack: f64) -> Moment {
        let duration = (self.first_zero + past_zero) / self.spring.omega;
        if duration < self.path.contact_time() {
            self.path.after(&self.start, duration, slack / self.spring.omega)
        } else {
            Moment::END
        }
    }
}

/// The side of half swing `k` relative to the side on which the phase starts: (−1)^k.
pub fn half_swing_sign(k: u32) -> f64 {
    if k.is_multiple_of(2) { 1.0 } else { -1.0 }
}
