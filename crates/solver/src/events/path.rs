//! The state along a step as polynomials with bounds of their errors, for enclosures.
//!
//! There are three paths. The *quick* one is a quintic through the six states that a step knows
//! already, and costs no right-hand side. The *dense* one is the dense output; its error vanishes
//! at both ends of the step with its slope. The *local* one is an expansion about a place of the
//! step, from a step of the method to that place. On a short part of the step its error is of the
//! size of rounding.

use crate::events::quick::{NODES, each, expand};
use crate::lists::{List, Shape};
use crate::method::{DenseOf, StepOf, Store};
use stickslip_number::{Enclosure, Interval};

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
pub(crate) struct Path<F: Shape> {
    n: usize,
    read: F::Read,
    s: f64,
    h: f64,
    /// The coefficients of powers of the step fraction.
    terms: [F::Of<f64>; TERMS],
    /// The sums of the terms beyond the constant one.
    size: F::Of<f64>,
    /// Bounds for the errors of the polynomials.
    error: F::Of<f64>,
    /// Bounds for the rounding of the state at the end of the step.
    rounding: F::Of<f64>,
    kind: Kind,
}

/// A path about the middle of a part of the step.
pub(crate) struct Part<F: Shape> {
    pub(crate) low: f64,
    pub(crate) high: f64,
    /// The coefficients about the middle.
    terms: [F::Of<f64>; TERMS],
}

/// How a path is made, which says how its error varies.
#[derive(Clone, Copy)]
enum Kind {
    Quick,
    Dense,
    /// The step fraction in the middle, and the distance from there to the ends.
    Local(f64, f64),
}

impl<F: Shape> Path<F> {
    fn new(
        (s, h): (f64, f64),
        terms: [F::Of<f64>; TERMS],
        error: F::Of<f64>,
        ends: &F::Of<f64>,
        kind: Kind,
        read: F::Read,
    ) -> Self {
        let n = ends.parts().len();
        let size = each::<F>(n, |i| terms[1..].iter().map(|term| term[i].abs()).sum());
        let rounding = each::<F>(n, |i| 2.0 * f64::EPSILON * ends[i]);
        Self { n, read, s, h, terms, size, error, rounding, kind }
    }

    /// The path along the six states of a step. The part `trust` of the next-to-last term counts
    /// as error.
    pub(crate) fn quick<V: Store>(step: &StepOf<V>, trust: f64, read: F::Read) -> Self {
        let n = F::count(&read, step.y0.size());
        let [a, b, c, d] = &step.interior;
        let states = [&step.y0, a, b, c, d, &step.y1];
        let (quintic, error) = expand::<F>(n, |node, i| states[node][F::place(&read, i)], trust);
        let [a, b, c, d, e, f] = quintic;
        let none = || each::<F>(n, |_| 0.0);
        let terms = [a, b, c, d, e, f, none(), none()];
        let ends = each::<F>(n, |i| {
            let i = F::place(&read, i);
            states[0][i].abs().max(states[5][i].abs())
        });
        Self::new((step.s, step.h), terms, error, &ends, Kind::Quick, read)
    }

    /// The path along the dense output of a step.
    pub(crate) fn dense<V: Store>(dense: &DenseOf<V>, read: F::Read) -> Self {
        let n = F::count(&read, dense.r[0].size());
        let none = |_| each::<F>(n, |_| 0.0);
        let (mut terms, mut error, mut ends) =
            (std::array::from_fn::<_, TERMS, _>(none), none(0), none(0));
        for i in 0..n {
            let (along, last) = dense.terms(F::place(&read, i));
            ends[i] = along[0].abs().max(along.iter().sum::<f64>().abs());
            error[i] = SAFETY * last;
            for (term, along) in terms.iter_mut().zip(along) {
                term[i] = along;
            }
        }
        Self::new((dense.start(), dense.size()), terms, error, &ends, Kind::Dense, read)
    }

    /// The path between two step fractions from the state `y` in the middle, with its first and
    /// second derivatives by the time. The result says whether only rounding is left of the error,
    /// and is `None` if the path is not much more accurate than `self`.
    pub(crate) fn local(
        &self,
        (low, high): (f64, f64),
        [y, slope, bend]: [&[f64]; 3],
    ) -> Option<(Self, bool)> {
        let (middle, radius) = (0.5 * (low + high), 0.5 * (high - low));
        let about = self.about::<TERMS>(middle);
        let error = each::<F>(self.n, |i| {
            let beyond = about[3..].iter().rev().fold(0.0, |sum, c| sum * radius + c[i].abs());
            let error = beyond * radius.powi(3);
            // Steps of the method to neighbouring places do not follow the right-hand side exactly.
            SAFETY * error + 8.0 * self.error[i] * radius
        });
        let n = self.n;
        let mut terms: [F::Of<f64>; TERMS] = std::array::from_fn(|_| each::<F>(n, |_| 0.0));
        terms[0] = each::<F>(n, |i| y[F::place(&self.read, i)]);
        terms[1] = each::<F>(n, |i| self.h * slope[F::place(&self.read, i)]);
        terms[2] = each::<F>(n, |i| 0.5 * self.h * self.h * bend[F::place(&self.read, i)]);
        let ends = each::<F>(n, |i| y[F::place(&self.read, i)].abs());
        let kind = Kind::Local(middle, radius);
        let local = Self::new((self.s, self.h), terms, error, &ends, kind, self.read.clone());
        let [present, ..] = self.band(low, high);
        let exact = |i: usize| local.error[i] <= local.rounding[i];
        let better = (0..self.n).all(|i| local.error[i] <= NEARER * present[i] || exact(i));
        let all_exact = (0..self.n).all(exact);
        better.then_some((local, all_exact))
    }

    /// The part between two step fractions.
    pub(crate) fn part(&self, low: f64, high: f64) -> Part<F> {
        let middle = 0.5 * (low + high);
        let terms = match self.kind {
            Kind::Quick => self.about::<{ NODES.len() }>(middle),
            Kind::Dense => self.about::<TERMS>(middle),
            Kind::Local(origin, _) => self.about::<3>(middle - origin),
        };
        Part { low, high, terms }
    }

    /// The first `K` coefficients about `middle`. The others are zero.
    #[inline(always)]
    fn about<const K: usize>(&self, middle: f64) -> [F::Of<f64>; TERMS] {
        // Repeated division by θ − middle.
        let mut c = self.terms.clone();
        for first in 0..K - 1 {
            for k in (first..K - 1).rev() {
                let (low, high) = c.split_at_mut(k + 1);
                for i in 0..self.n {
                    low[k][i] += middle * high[0][i];
                }
            }
        }
        c
    }

    /// The bounds of the errors between two step fractions, and of their first two derivatives.
    #[inline(always)]
    fn band(&self, low: f64, high: f64) -> [F::Of<f64>; 3] {
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
            each::<F>(self.n, |i| {
                truncation[k] * self.error[i]
                    + rounding[k] * self.rounding[i]
                    + polynomial[k] * self.size[i]
            })
        })
    }
}

impl<F: Shape> Part<F> {
    /// Bounds for the time and the state, with their derivatives by the step fraction.
    pub(crate) fn whole(&self, path: &Path<F>) -> (Enclosure, F::Of<Enclosure>) {
        let radius = 0.5 * (self.high - self.low);
        let c = &self.terms;
        // The remainders beyond the first derivatives.
        let n_all = path.n;
        let none = || each::<F>(n_all, |_| 0.0);
        let mut remainders = [none(), none(), none()];
        for k in (1..TERMS).rev() {
            let n = k as f64;
            for i in 0..n_all {
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
        self.around(path, (self.low, self.high), &remainders)
    }

    /// The same bounds in the middle alone.
    pub(crate) fn centre(&self, path: &Path<F>) -> (Enclosure, F::Of<Enclosure>) {
        let middle = 0.5 * (self.low + self.high);
        let none = || each::<F>(path.n, |_| 0.0);
        self.around(path, (middle, middle), &[none(), none(), none()])
    }

    #[inline(always)]
    fn around(
        &self,
        path: &Path<F>,
        (low, high): (f64, f64),
        remainders: &[F::Of<f64>; 3],
    ) -> (Enclosure, F::Of<Enclosure>) {
        let &Path { s, h, n, .. } = path;
        let time = Enclosure {
            value: Interval::point(s).plus(Interval::new(low, high).scaled(h)),
            slope: Interval::point(h),
            bend: Interval::ZERO,
        };
        let band = path.band(low, high);
        let factors = [1.0, 1.0, 2.0];
        let none = || each::<F>(n, |_| 0.0);
        let (mut lower, mut upper) = ([none(), none(), none()], [none(), none(), none()]);
        for k in 0..3 {
            let middles = &self.terms[k];
            for i in 0..n {
                let radius = (1.0 + 64.0 * f64::EPSILON) * (remainders[k][i] + band[k][i]);
                let middle = factors[k] * middles[i];
                // It contains the rounding of the bounds. A constant has none.
                let radius = if radius == 0.0 { 0.0 } else { radius + f64::EPSILON * middle.abs() };
                lower[k][i] = middle - radius;
                upper[k][i] = middle + radius;
            }
        }
        let mut state = F::Of::<Enclosure>::of(n, time);
        for (i, component) in state.parts_mut().iter_mut().enumerate() {
            let [value, slope, bend] = [0, 1, 2].map(|k| Interval::new(lower[k][i], upper[k][i]));
            *component = Enclosure { value, slope, bend };
        }
        (time, state)
    }
}
