//! The state along a step as polynomials with bounds of their errors, for enclosures.
//!
//! There are three paths. The *quick* one is a quintic through the six states that a step knows
//! already, and costs no right-hand side. The *dense* one is the dense output; its error vanishes
//! at both ends of the step with its slope. The *local* one is an expansion about a place of the
//! step, from a step of the method to that place. On a short part of the step its error is of the
//! size of rounding.

use crate::events::quick::{NODES, expand};
use crate::method::{Dense, State, Step};
use crate::number::{Enclosure, Interval};

/// The largest number of terms.
const TERMS: usize = 8;

/// The factor by which the error of the dense output may exceed its last term. A value that is too
/// large costs steps of the method. One that is too small would make decisions wrong.
const SAFETY: f64 = 4.0;

/// The part of the error of a path that a local one may have, to be of use.
const NEARER: f64 = 1.0 / 16.0;

/// The rounding of a polynomial, relative to the sum of its terms.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// A component of the state along a step.
#[derive(Clone, Copy)]
struct Component {
    /// The coefficients of powers of the step fraction.
    terms: [f64; TERMS],
    /// The sum of the terms beyond the constant one.
    size: f64,
    /// A bound for the error of the polynomial.
    error: f64,
    /// A bound for the rounding of the state at the end of the step.
    rounding: f64,
}

/// The state along a step.
pub(crate) struct Path<const N: usize> {
    s: f64,
    h: f64,
    components: [Component; N],
    kind: Kind,
}

/// How a path is made, which says how its error varies.
#[derive(Clone, Copy)]
enum Kind {
    Quick,
    Dense,
    /// The step fraction in the middle, and the distance from there to the ends.
    Local(f64, f64),
}

/// Bounds of an error and of its first two derivatives.
#[derive(Clone, Copy)]
struct Band([f64; 3]);

impl<const N: usize> Path<N> {
    /// The path along the six states of a step. The part `trust` of the next-to-last term counts
    /// as error.
    pub(crate) fn quick(step: &Step<N>, trust: f64) -> Self {
        let [a, b, c, d] = &step.interior;
        let states = [&step.y0, a, b, c, d, &step.y1];
        let components = std::array::from_fn(|i| {
            let values = states.map(|state| state[i]);
            let (terms, error) = expand(&values, trust);
            let mut all = [0.0; TERMS];
            all[..NODES.len()].copy_from_slice(&terms);
            Component::new(all, error, values[0].abs().max(values[5].abs()))
        });
        Self { s: step.s, h: step.h, components, kind: Kind::Quick }
    }

    /// The path along the dense output of a step.
    pub(crate) fn dense(dense: &Dense<N>) -> Self {
        let components = std::array::from_fn(|i| {
            let (terms, last) = dense.terms(i);
            let ends = terms[0].abs().max(terms.iter().sum::<f64>().abs());
            Component::new(terms, SAFETY * last, ends)
        });
        Self { s: dense.start(), h: dense.size(), components, kind: Kind::Dense }
    }

    /// The path between two step fractions from the state `y` in the middle, with its first and
    /// second derivatives by the time. The result is `None` if it is not much more accurate than
    /// this path.
    pub(crate) fn local(
        &self,
        (low, high): (f64, f64),
        [y, slope, bend]: [&State<N>; 3],
    ) -> Option<Self> {
        let (middle, radius) = (0.5 * (low + high), 0.5 * (high - low));
        let mut better = true;
        let components = std::array::from_fn(|i| {
            let from = &self.components[i];
            let about = from.about(middle);
            let beyond = about[3..].iter().rev().fold(0.0, |sum, c| sum * radius + c.abs());
            let error = beyond * radius.powi(3);
            // Steps of the method to neighbouring places do not follow the right-hand side exactly.
            let error = SAFETY * error + 8.0 * from.error * radius;
            let Band([present, ..]) = from.band(low, high, self.kind);
            let mut terms = [0.0; TERMS];
            terms[..3].copy_from_slice(&[y[i], self.h * slope[i], 0.5 * self.h * self.h * bend[i]]);
            let local = Component::new(terms, error, y[i].abs());
            better &= local.error <= NEARER * present || local.error <= local.rounding;
            local
        });
        let kind = Kind::Local(middle, radius);
        better.then_some(Self { s: self.s, h: self.h, components, kind })
    }

    /// Bounds for the time and the state between two step fractions, with their derivatives by the
    /// step fraction.
    pub(crate) fn over(&self, low: f64, high: f64) -> (Enclosure, [Enclosure; N]) {
        let range = Interval::new(low, high);
        let time = Enclosure {
            value: Interval::point(self.s).plus(range.scaled(self.h)),
            slope: Interval::point(self.h),
            bend: Interval::ZERO,
        };
        (time, self.components.map(|component| component.over(low, high, self.kind)))
    }
}

impl Component {
    fn new(terms: [f64; TERMS], error: f64, ends: f64) -> Self {
        let size = terms[1..].iter().map(|term| term.abs()).sum();
        Self { terms, size, error, rounding: 2.0 * f64::EPSILON * ends }
    }

    /// The bounds of the error between two step fractions.
    fn band(&self, low: f64, high: f64, kind: Kind) -> Band {
        let (left, right) = (high, 1.0 - low);
        let (e, r) = (self.error, self.rounding);
        let near = left.min(right);
        let truncation = match kind {
            // Markov's inequality for polynomials of degree 5.
            Kind::Quick => [e * (50.0 * left).min(1.0), 50.0 * e, 800.0 * e],
            // The error is at most of the size of 16 θ²(1−θ)² times `error`.
            Kind::Dense => {
                [e * (16.0 * near * near).min(1.0), e * (32.0 * near).min(4.0), 32.0 * e]
            }
            // It is of third order.
            Kind::Local(_, radius) => [e, 3.0 * e / radius, 6.0 * e / (radius * radius)],
        };
        let rounding = [r * (4.0 * left * left).min(1.0), r * (8.0 * left).min(8.0), 16.0 * r];
        let polynomial = ROUNDING * self.size;
        Band([
            truncation[0] + rounding[0] + polynomial * left,
            truncation[1] + rounding[1] + 8.0 * polynomial,
            truncation[2] + rounding[2] + 64.0 * polynomial,
        ])
    }

    /// The coefficients about `middle`.
    fn about(&self, middle: f64) -> [f64; TERMS] {
        // Repeated division by θ − middle.
        let mut c = self.terms;
        for first in 0..TERMS - 1 {
            for k in (first..TERMS - 1).rev() {
                c[k] += middle * c[k + 1];
            }
        }
        c
    }

    /// The component between two step fractions, by its expansion about the middle.
    fn over(&self, low: f64, high: f64, kind: Kind) -> Enclosure {
        let (middle, radius) = (0.5 * (low + high), 0.5 * (high - low));
        let c = self.about(match kind {
            Kind::Local(origin, _) => middle - origin,
            _ => middle,
        });
        // The remainders beyond the first derivatives.
        let (mut value, mut slope, mut bend) = (0.0, 0.0, 0.0);
        for (k, c) in c.iter().enumerate().skip(1).rev() {
            let (n, c) = (k as f64, c.abs());
            value = (value + c) * radius;
            slope = slope * radius + if k > 1 { n * c } else { 0.0 };
            bend = if k > 1 {
                bend * radius + if k > 2 { n * (n - 1.0) * c } else { 0.0 }
            } else {
                bend
            };
        }
        let Band(band) = self.band(low, high, kind);
        let around = |middle: f64, radius: f64| Interval::around(middle, radius);
        let wide = 1.0 + 64.0 * f64::EPSILON;
        Enclosure {
            value: around(c[0], wide * (value + band[0])),
            slope: around(c[1], wide * (slope + band[1])),
            bend: around(2.0 * c[2], wide * (bend + band[2])),
        }
    }
}
