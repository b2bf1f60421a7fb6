//! The motion of the spring in a stick phase, compared with its limit.

use super::limit::pull;
use super::onset::Onset;
use super::slide::Slide;
use super::trajectory::{CONTACT_TIME, Moment, NormalMotion};
use crate::numerics::double_double::DoubleDouble;

/// One stick phase, in the orientation in which it starts on side +1: y = A cos θ, where θ grows at
/// the rate ω = √κ.
#[derive(Clone, Copy, Debug)]
pub struct Swing {
    /// Scaled stiffness κ.
    pub kappa: f64,
    /// ω = √κ.
    pub omega: f64,
    /// b = 3/(2κ).
    pub bend: f64,
    /// The moment at which the phase starts.
    pub start: Moment,
    /// y at the start, where it is equal to the limit L.
    pub elongation: f64,
    /// w at the start, with twice the digits.
    pub velocity: DoubleDouble,
    /// The amplitude A.
    pub amplitude: f64,
    /// The angle from the start to the first y = 0, between 0 and π.
    pub first_zero: f64,
    /// The series of D just after the start, for a phase that may be very short.
    onset: Option<Onset>,
}

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

impl Swing {
    /// The phase that starts at `start`, where the normal motion is `normal` and w is `velocity`.
    pub fn new(slide: &Slide, start: Moment, normal: NormalMotion, velocity: DoubleDouble) -> Self {
        let kappa = slide.kappa;
        let omega = kappa.sqrt();
        let elongation = normal.u * normal.u * normal.u / kappa;
        let across = velocity.0 / omega;
        Self {
            kappa,
            omega,
            bend: slide.bend,
            start,
            elongation,
            velocity,
            amplitude: elongation.hypot(across),
            first_zero: elongation.atan2(-across),
            onset: slide
                .crest
                .and_then(|crest| Onset::new(kappa, start, normal, velocity.0, crest.root)),
        }
    }

    /// y and w a time `tau` after the start.
    pub fn motion(&self, tau: f64) -> (f64, f64) {
        let (sin, cos) = (self.omega * tau).sin_cos();
        (
            self.elongation * cos + self.velocity.0 / self.omega * sin,
            self.velocity.0 * cos - self.elongation * self.omega * sin,
        )
    }

    /// The gap on half swing `k` at `moment`, where the normal motion is `normal`.
    pub fn gap(&self, k: u32, moment: Moment, normal: NormalMotion) -> Gap {
        let tau = self.start.time_until(moment);
        let sign = half_swing_sign(k);
        let (y, w) = self.motion(tau);
        let (q, q_rate) = (sign * y, sign * w);
        if k == 0
            && let Some((value, rate, acceleration)) = self.onset.and_then(|onset| onset.gap(tau))
        {
            return Gap { value, rate, acceleration, q, q_rate };
        }
        let NormalMotion { u, v, .. } = normal;
        let value = u * u * u / self.kappa - q;
        Gap {
            value,
            rate: self.bend * u * v - q_rate,
            acceleration: pull(self.bend, u) - self.kappa * value,
            q,
            q_rate,
        }
    }

    /// Whether [`Swing::gap`] is a series at `moment`, and therefore free of cancellation.
    pub fn is_onset(&self, k: u32, moment: Moment) -> bool {
        k == 0 && self.onset.is_some_and(|onset| self.start.time_until(moment) <= onset.reach)
    }

    /// The moment an angle `past_zero` after the first y = 0, at most [`Moment::END`].
    pub fn moment_at_angle(&self, past_zero: f64) -> Moment {
        let duration = (self.first_zero + past_zero) / self.omega;
        if duration < CONTACT_TIME { self.start.after(duration) } else { Moment::END }
    }
}

/// The side of half swing `k` relative to the side on which the phase starts: (−1)^k.
pub fn half_swing_sign(k: u32) -> f64 {
    if k.is_multiple_of(2) { 1.0 } else { -1.0 }
}
