//! A slip phase: the friction has its limit L, and the spring waits to fall behind it.
//!
//! On side s the spring would leave the limit at the rate G = κ s w − c L − L̇, with c = b a. From
//! s ẇ = −L and L̈ + a L̇ + L = 0 follows
//!
//! ```text
//! Ġ = −P     P = (κ − 1) L + (c − a) L̇
//! ```
//!
//! P is an oscillation like L, and vanishes at most once in a stage. G is monotone on both sides of
//! that: it falls through 0 at most once, and whether it does is seen at the end of the part on
//! which it falls.

use stickslip_contact::Side;
use stickslip_contact::numerics::root::Jet;

use super::Linear;
use super::normal::{Moment, Motion, Place, Stage};

/// A slip phase.
pub struct Slip<'a> {
    linear: &'a Linear,
    pub stage: Stage,
    pub start: Moment,
    pub side: Side,
    /// w at the start.
    pub velocity: f64,
    /// G at the start.
    excess: f64,
    motion: Motion,
    drive: Drive,
}

/// P, and its integral up to a constant.
#[derive(Clone, Copy, Debug)]
pub struct Drive {
    /// P.
    pub value: f64,
    /// Ṗ.
    pub rate: f64,
    /// −∫ P dt, apart from a constant: Ṗ + a P.
    pub integral: f64,
}

impl<'a> Slip<'a> {
    /// The phase that starts with the velocity `velocity`, where the spring would leave its limit
    /// at the rate `excess` ≥ 0.
    pub fn new(
        linear: &'a Linear,
        (stage, start): (Stage, Moment),
        side: Side,
        velocity: f64,
        excess: f64,
    ) -> Self {
        let motion = linear.normal.at(stage, &start);
        let drive = linear.drive(&motion);
        Self { linear, stage, start, side, velocity, excess, motion, drive }
    }

    /// The end of its stage.
    pub fn end(&self) -> Place {
        self.linear.end(&self.start, self.stage)
    }

    /// w at a place.
    pub fn velocity_at(&self, place: Place) -> f64 {
        let (s, p) = self.basis(place.since);
        let impulse = self.motion.limit * s + self.motion.rate * p;
        self.velocity - self.side.sign() * impulse
    }

    /// The response of the normal oscillator, and its integral.
    fn basis(&self, since: f64) -> (f64, f64) {
        let oscillator = &self.linear.normal.oscillator;
        let response = oscillator.after(since);
        (response.s, oscillator.position_integral(since, &response))
    }

    /// G and its rates.
    fn excess_at(&self, place: Place) -> Jet {
        let (s, p) = self.basis(place.since);
        let Drive { value, integral, .. } = self.drive;
        let moment = self.start.after(place);
        let (limit, slope) = self.linear.normal.limit(self.stage, &moment);
        let here = self.linear.drive_of(limit, slope);
        Jet {
            value: self.excess - (value * s + integral * p),
            slope: -here.value,
            curvature: -here.rate,
        }
    }

    /// The size of G's rounding.
    fn rounding(&self, place: Place) -> f64 {
        let (limit, slope) = self.linear.normal.limit(self.stage, &self.start.after(place));
        let Linear { kappa, dashpot, .. } = *self.linear;
        let sizes =
            [kappa * self.velocity, kappa * self.velocity_at(place), dashpot * limit, slope];
        super::ROUNDING * sizes.into_iter().map(f64::abs).sum::<f64>()
    }

    /// The place at which G falls through 0, and the contact begins to stick.
    pub fn onset(&self) -> Option<Place> {
        let begin = Place { since: 0.0, left: self.start.left };
        let turn = self.linear.turn(&self.start, self.stage);
        let ends = turn.into_iter().chain([self.end()]);
        let mut from = begin;
        for to in ends {
            let middle = 0.5 * (from.since + to.since);
            let middle = Place { since: middle, left: self.start.left - middle };
            let falls = self.excess_at(middle).slope < 0.0;
            if falls && self.excess_at(to).value < -self.rounding(to) {
                if from.since == 0.0 && self.excess <= 0.0 {
                    return Some(from);
                }
                let guess = self.excess / self.drive.value;
                return Some(super::falling(&self.start, [from, to], guess, |place| {
                    self.excess_at(place)
                }));
            }
            from = to;
        }
        None
    }
}
