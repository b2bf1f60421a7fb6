//! Friction that decays with the velocity, with the derivatives that gaps need.

use stickslip_solver::Number;

use crate::law::Friction;
use crate::phase::Side;

/// The coefficient of friction μ(w) over μ(0): rest + excess·e^(−rate |[`W`](super::W)|).
#[derive(Clone, Copy, Debug)]
pub(super) struct Decay {
    rest: f64,
    excess: f64,
    rate: f64,
}

impl Decay {
    /// How this friction decays with the velocity in a `unit`; none if it is constant.
    pub fn new(friction: &Friction, unit: f64) -> Option<Self> {
        let Friction { dynamic, decay } = *friction;
        let decays = !friction.is_constant();
        decays.then_some(Self { rest: dynamic, excess: 1.0 - dynamic, rate: decay * unit })
    }

    /// The excess at a velocity with the sign `heading`, and the exponent's slope.
    #[inline(always)]
    pub fn excess_at<T: Number>(&self, heading: Side, w: T) -> (T, f64) {
        let slope = -self.rate * heading.sign();
        ((w * slope).exp() * self.excess, slope)
    }

    /// μ(w)/μ(0).
    #[inline(always)]
    pub fn share<T: Number>(&self, heading: Side, w: T) -> T {
        self.excess_at(heading, w).0 + self.rest
    }

    /// The same with its first two derivatives, where those of [`W`](super::W) are given.
    #[inline(always)]
    pub fn jet<T: Number>(&self, heading: Side, Jet(w, dw, ddw): Jet<T>) -> Jet<T> {
        let (excess, slope) = self.excess_at(heading, w);
        let bend = (dw * dw * slope + ddw) * slope;
        Jet(excess + self.rest, excess * dw * slope, excess * bend)
    }
}

/// A quantity and its first two derivatives with respect to s.
#[derive(Clone, Copy)]
pub(crate) struct Jet<T>(pub T, pub T, pub T);

/// The product of two quantities, with derivatives.
#[inline(always)]
pub(crate) fn product<T: Number>(Jet(a, a1, a2): Jet<T>, Jet(b, b1, b2): Jet<T>) -> Jet<T> {
    Jet(a * b, a1 * b + a * b1, a2 * b + a1 * b1 * 2.0 + a * b2)
}
