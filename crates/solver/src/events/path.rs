//! The state along a step as polynomials with bounds of their errors, for enclosures.
//!
//! There are three paths. The *quick* one is a quintic through the six states that a step knows
//! already, and costs no right-hand side. The *dense* one is the dense output; its error vanishes
//! at both ends of the step with its slope. The *local* one is an expansion about a place of the
//! step, from a step of the method to that place. On a short part of the step its error is of the
//! size of rounding.

use crate::events::quick::{NODES, each, expand};
use crate::method::{Dense, State, Step};
use crate::number::{Enclosure, Interval};

/// The largest number of terms.
const TERMS: usize = 8;

/// The factor by which the error of the dense output may exceed its last term. A value that is too
/// large costs steps of the method. One that is too small would make decisions wrong.
pub(crate) const SAFETY: f64 = 4.0;

/// The part of the error of a path that a local one may have, to be of use.
const NEARER: f64 = 1.0 / 16.0;

/// The rounding of a polynomial, relative to the sum of its terms.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// The state along a step.
///
/// Terms and bounds lie component beside component, so that all components are computed at once.
pub(crate) struct Path<const N: usize> {
    s: f64,
    h: f64,
    /// The coefficients of powers of the step fraction.
    terms: [[f64; N]; TERMS],
    /// The sums of the terms beyond the constant one.
    size: [f64; N],
    /// Bounds for the errors of the polynomials.
    error: [f64; N],
    /// Bounds for the rounding of the state at the end of the step.
    rounding: [f64; N],
    kind: Kind,
}

/// A path about the middle of a part of the step.
pub(crate) struct Part<'a, const N: usize> {
    path: &'a Path<N>,
    low: f64,
    high: f64,
    /// The coefficients about the middle.
    terms: [[f64; N]; TERMS],
}

/// How a path is made, which says how its error varies.
#[derive(Clone, Copy)]
enum Kind {
    Quick,
    Dense,
    /// The step fraction in the middle, and the distance from there to the ends.
    Local(f64, f64),
}

impl<const N: usize> Path<N> {
    fn new(
        (s, h): (f64, f64),
        terms: [[f64; N]; TERMS],
        error: [f64; N],
        ends: [f64; N],
        kind: Kind,
    ) -> Self {
        let size = each(|i| terms[1..].iter().map(|term| term[i].abs()).sum());
        let rounding = ends.map(|end| 2.0 * f64::EPSILON * end);
        Self { s, h, terms, size, error, rounding, kind }
    }

    /// The path along the six states of a step. The part `trust` of the next-to-last term counts
    /// as error.
    pub(crate) fn quick(step: &Step<N>, trust: f64) -> Self {
        let [a, b, c, d] = &step.interior;
        let states = [&step.y0, a, b, c, d, &step.y1].map(|state| each(|i| state[i]));
        let (quintic, error) = expand(&states, trust);
        let mut terms = [[0.0; N]; TERMS];
        terms[..NODES.len()].copy_from_slice(&quintic);
        let ends = each(|i| states[0][i].abs().max(states[5][i].abs()));
        Self::new((step.s, step.h), terms, error, ends, Kind::Quick)
    }

    /// The path along the dense output of a step.
    pub(crate) fn dense(dense: &Dense<N>) -> Self {
        let (mut terms, mut error, mut ends) = ([[0.0; N]; TERMS], [0.0; N], [0.0; N]);
        for i in 0..N {
            let (along, last) = dense.terms(i);
            ends[i] = along[0].abs().max(along.iter().sum::<f64>().abs());
            error[i] = SAFETY * last;
            for (term, along) in terms.iter_mut().zip(along) {
                term[i] = along;
            }
        }
        Self::new((dense.start(), dense.size()), terms, error, ends, Kind::Dense)
    }

    /// The path between two step fractions from the state `y` in the middle, with its first and
    /// second derivatives by the time. The result tells whether only rounding is left of its
    /// error. It is `None` if the path is not much more accurate than `self`.
    pub(crate) fn local(
        &self,
        (low, high): (f64, f64),
        [y, slope, bend]: [&State<N>; 3],
    ) -> Option<(Self, bool)> {
        let (middle, radius) = (0.5 * (low + high), 0.5 * (high - low));
        let about = self.about::<TERMS>(middle);
        let error = each(|i| {
            let beyond = about[3..].iter().rev().fold(0.0, |sum, c| sum * radius + c[i].abs());
            let error = beyond * radius.powi(3);
            // Steps of the method to neighbouring places do not follow the right-hand side exactly.
            SAFETY * error + 8.0 * self.error[i] * radius
        });
        let mut terms = [[0.0; N]; TERMS];
        terms[0] = each(|i| y[i]);
        terms[1] = each(|i| self.h * slope[i]);
        terms[2] = each(|i| 0.5 * self.h * self.h * bend[i]);
        let ends = terms[0].map(f64::abs);
        let kind = Kind::Local(middle, radius);
        let local = Self::new((self.s, self.h), terms, error, ends, kind);
        let [present, ..] = self.band(low, high);
        let exact = |i: usize| local.error[i] <= local.rounding[i];
        let better = (0..N).all(|i| local.error[i] <= NEARER * present[i] || exact(i));
        let all_exact = (0..N).all(exact);
        better.then_some((local, all_exact))
    }

    /// The part between two step fractions.
    pub(crate) fn part(&self, low: f64, high: f64) -> Part<'_, N> {
        let middle = 0.5 * (low + high);
        let terms = match self.kind {
            Kind::Quick => self.about::<{ NODES.len() }>(middle),
            Kind::Dense => self.about::<TERMS>(middle),
            Kind::Local(origin, _) => self.about::<3>(middle - origin),
        };
        Part { path: self, low, high, terms }
    }

    /// The first `K` coefficients about `middle`. The others are zero.
    #[inline(always)]
    fn about<const K: usize>(&self, middle: f64) -> [[f64; N]; TERMS] {
        // Repeated division by θ − middle.
        let mut c = self.terms;
        for first in 0..K - 1 {
            for k in (first..K - 1).rev() {
                c[k] = each(|i| c[k][i] + middle * c[k + 1][i]);
            }
        }
        c
    }

    /// The bounds of the errors between two step fractions, and of their first two derivatives.
    #[inline(always)]
    fn band(&self, low: f64, high: f64) -> [[f64; N]; 3] {
        let (left, right) = (high, 1.0 - low);
        let near = left.min(right);
        let truncation = match self.kind {
            // Markov's inequality for polynomials of degree 5.
            Kind::Quick => [(50.0 * left).min(1.0), 50.0, 800.0],
            // The error is at most of the size of 16 θ²(1−θ)² times `error`.
            Kind::Dense => [(16.0 * near * near).min(1.0), (32.0 * near).min(4.0), 32.0],
            // It is of third order.
            Kind::Local(_, radius) => [1.0, 3.0 / radius, 6.0 / (radius * radius)],
        };
        let rounding = [(4.0 * left * left).min(1.0), (8.0 * left).min(8.0), 16.0];
        let polynomial = [left, 8.0, 64.0].map(|factor| ROUNDING * factor);
        std::array::from_fn(|k| {
            each(|i| {
                truncation[k] * self.error[i]
                    + rounding[k] * self.rounding[i]
                    + polynomial[k] * self.size[i]
            })
        })
    }
}

impl<const N: usize> Part<'_, N> {
    /// Bounds for the time and the state, with their derivatives by the step fraction.
    pub(crate) fn whole(&self) -> (Enclosure, [Enclosure; N]) {
        let radius = 0.5 * (self.high - self.low);
        let c = &self.terms;
        // The remainders beyond the first derivatives.
        let mut remainders = [[0.0; N]; 3];
        for k in (1..TERMS).rev() {
            let n = k as f64;
            for i in 0..N {
                let c = c[k][i].abs();
                let [value, slope, bend] = &mut remainders;
                value[i] = (value[i] + c) * radius;
                if k > 1 {
                    slope[i] = (slope[i] + n * c) * radius;
                }
                if k > 2 {
                    bend[i] = (bend[i] + n * (n - 1.0) * c) * radius;
                }
            }
        }
        self.around(self.low, self.high, &remainders)
    }

    /// The same bounds in the middle alone.
    pub(crate) fn centre(&self) -> (Enclosure, [Enclosure; N]) {
        let middle = 0.5 * (self.low + self.high);
        self.around(middle, middle, &[[0.0; N]; 3])
    }

    #[inline(always)]
    fn around(
        &self,
        low: f64,
        high: f64,
        remainders: &[[f64; N]; 3],
    ) -> (Enclosure, [Enclosure; N]) {
        let Path { s, h, .. } = *self.path;
        let time = Enclosure {
            value: Interval::point(s).plus(Interval::new(low, high).scaled(h)),
            slope: Interval::point(h),
            bend: Interval::ZERO,
        };
        let band = self.path.band(low, high);
        let [value, slope, bend, ..] = &self.terms;
        let middles = [*value, *slope, bend.map(|bend| 2.0 * bend)];
        let (mut lower, mut upper) = ([[0.0; N]; 3], [[0.0; N]; 3]);
        for k in 0..3 {
            let radius: [f64; N] = each(|i| {
                let radius = (1.0 + 64.0 * f64::EPSILON) * (remainders[k][i] + band[k][i]);
                // It contains the rounding of the bounds. A constant has none.
                if radius == 0.0 { 0.0 } else { radius + f64::EPSILON * middles[k][i].abs() }
            });
            lower[k] = each(|i| middles[k][i] - radius[i]);
            upper[k] = each(|i| middles[k][i] + radius[i]);
        }
        let mut state = [time; N];
        for (i, component) in state.iter_mut().enumerate() {
            let [value, slope, bend] = [0, 1, 2].map(|k| Interval::new(lower[k][i], upper[k][i]));
            *component = Enclosure { value, slope, bend };
        }
        (time, state)
    }
}
