//! One step on buffers, with the arithmetic of [`Step`](crate::Step) in the same order, so that
//! both give the same bits.

use crate::dynamic::dense::DynamicDense;
use crate::method::{INTERIOR_NODES, MAX_STAGES, Method, Tableau, add_product};

/// A right-hand side: it writes the slope at a time and a state. Steps dispatch it at run time,
/// which slices hardly notice, and so are compiled once for each method.
pub(crate) trait Field: Fn(f64, &[f64], &mut [f64]) {}

impl<F: Fn(f64, &[f64], &mut [f64])> Field for F {}

/// Components that are summed together, in registers.
const BLOCK: usize = 16;

/// Where a step starts.
#[derive(Clone, Copy)]
pub(crate) struct Origin<'a> {
    pub(crate) s: f64,
    pub(crate) y: &'a [f64],
    /// What rounding has cut off from `y`.
    pub(crate) rest: &'a [f64],
    pub(crate) slope: &'a [f64],
}

/// The buffers of a step. Its stages stay, so that dense output needs only its own.
pub(crate) struct Step {
    /// The number of components.
    n: usize,
    /// The size of the step.
    pub(crate) h: f64,
    /// The state at the end.
    pub(crate) y1: Vec<f64>,
    /// What rounding has cut off from the state at the end.
    pub(crate) rest: Vec<f64>,
    /// The estimated error relative to the tolerances, as [`Step::error`](crate::Step::error).
    pub(crate) error: f64,
    /// The slopes at the stages, one after another.
    k: Vec<f64>,
    /// The states at the [`INTERIOR_NODES`], one after another.
    interior: Vec<f64>,
    /// The coefficients of the dense output.
    r: Vec<f64>,
    /// The state at a stage; later the error of the components.
    stage: Vec<f64>,
    /// The coarse error of the components.
    coarse: Vec<f64>,
    /// Whether the slope at the end is known, and the dense output.
    finished: bool,
    dense: bool,
}

impl Step {
    pub(crate) fn new(n: usize) -> Self {
        let room = |rows: usize| vec![0.0; rows * n];
        Self {
            n,
            h: 0.0,
            y1: room(1),
            rest: room(1),
            error: 0.0,
            k: room(MAX_STAGES),
            interior: room(INTERIOR_NODES.len()),
            r: room(8),
            stage: room(1),
            coarse: room(1),
            finished: false,
            dense: false,
        }
    }

    /// Takes a step of size `h`, without its error and its interior.
    pub(crate) fn take_end<M: Method>(&mut self, field: &dyn Field, from: Origin<'_>, h: f64) {
        let tableau: &'static Tableau = const { &M::TABLEAU };
        let Self { n, k, stage, interior, y1, rest, .. } = self;
        let n = *n;
        k[..n].copy_from_slice(from.slope);
        for i in 1..M::STAGES {
            let weights = &tableau.a[i];
            let (known, new) = k.split_at_mut(i * n);
            weighted_sums(weights, known, n, i - 1, |c, sum| stage[c] = from.y[c] + sum * h);
            let newest = h * weights[i - 1];
            for (y, &k) in stage.iter_mut().zip(&known[(i - 1) * n..]) {
                *y = add_product(*y, k, newest);
            }
            if let Some(stages) = M::INTERIOR_STAGES {
                for (row, at) in stages.into_iter().enumerate() {
                    if at == i {
                        interior[row * n..(row + 1) * n].copy_from_slice(stage);
                    }
                }
            }
            field(from.s + tableau.c[i] * h, stage, &mut new[..n]);
        }
        weighted_sums(&tableau.b, k, n, M::STAGES, |c, sum| {
            let rise = add_product(from.rest[c], sum, h);
            y1[c] = from.y[c] + rise;
            rest[c] = rise - (y1[c] - from.y[c]);
        });
        (self.h, self.finished, self.dense) = (h, false, false);
    }

    /// Takes a step of size `h` with an estimate of its error.
    pub(crate) fn take<M: Method>(
        &mut self,
        field: &dyn Field,
        from: Origin<'_>,
        h: f64,
        (rtol, atol): (f64, f64),
    ) {
        self.take_end::<M>(field, from, h);
        if M::ERROR_USES_END {
            self.finish::<M>(field, from);
        }
        let tableau: &'static Tableau = const { &M::TABLEAU };
        let used = M::STAGES + usize::from(M::ERROR_USES_END);
        let Self { n, k, stage: fine, coarse, y1, .. } = self;
        let n = *n;
        weighted_sums(&tableau.error, k, n, used, |c, sum| fine[c] = sum);
        weighted_sums(&tableau.coarse_error, k, n, used, |c, sum| coarse[c] = sum);
        let (mut fine_sum, mut coarse_sum) = (0.0, 0.0);
        for i in 0..n {
            if fine[i] == 0.0 && coarse[i] == 0.0 {
                continue;
            }
            let (start, end) = (from.y[i].abs(), y1[i].abs());
            let weight = 1.0 / (atol + rtol * if start > end { start } else { end });
            fine_sum += (fine[i] * weight) * (fine[i] * weight);
            coarse_sum += (coarse[i] * weight) * (coarse[i] * weight);
        }
        let blend = fine_sum + 0.01 * coarse_sum;
        self.error = if blend == 0.0 {
            0.0
        } else if blend < f64::INFINITY {
            h.abs() * fine_sum / (n as f64 * blend).sqrt()
        } else {
            // The root mean square is out of the range of doubles.
            (0..n).filter(|&i| fine[i] != 0.0).fold(0.0, |most, i| {
                let scale = atol + rtol * from.y[i].abs().max(y1[i].abs());
                let error = fine[i].abs() * h.abs() / scale;
                // NaN stays.
                if error <= most { most } else { error }
            })
        };
    }

    /// Makes the slope at the end known. Returns the evaluations of the right-hand side.
    pub(crate) fn finish<M: Method>(&mut self, field: &dyn Field, from: Origin<'_>) -> usize {
        if self.finished {
            return 0;
        }
        let last = M::STAGES * self.n;
        field(from.s + self.h, &self.y1, &mut self.k[last..last + self.n]);
        self.finished = true;
        1
    }

    /// The slope at the end, which is known.
    pub(crate) fn slope_at_end<M: Method>(&self) -> &[f64] {
        &self.k[M::STAGES * self.n..(M::STAGES + 1) * self.n]
    }

    /// Makes the dense output known. Returns the evaluations of the right-hand side.
    pub(crate) fn extend<M: Method>(&mut self, field: &dyn Field, from: Origin<'_>) -> usize {
        if self.dense {
            return 0;
        }
        let mut count = self.finish::<M>(field, from);
        let tableau: &'static Tableau = const { &M::TABLEAU };
        let Self { n, h, k, stage, y1, r, .. } = self;
        let (n, h) = (*n, *h);
        for i in M::STAGES + 1..M::DENSE_STAGES {
            let (known, new) = k.split_at_mut(i * n);
            weighted_sums(&tableau.a[i], known, n, i, |c, sum| stage[c] = from.y[c] + sum * h);
            field(from.s + tableau.c[i] * h, stage, &mut new[..n]);
            count += 1;
        }
        let f1 = &k[M::STAGES * n..];
        for c in 0..n {
            let rise = y1[c] - from.y[c];
            let bend = k[c] * h - rise;
            r[c] = from.y[c];
            r[n + c] = rise;
            r[2 * n + c] = bend;
            r[3 * n + c] = rise - f1[c] * h - bend;
        }
        for (i, row) in tableau.dense.iter().enumerate().take(M::DENSE_DEGREE - 3) {
            let r = &mut r[(4 + i) * n..];
            weighted_sums(row, k, n, M::DENSE_STAGES, |c, sum| r[c] = sum * h);
        }
        self.dense = true;
        count
    }

    /// The dense output, which is known.
    pub(crate) fn dense<M: Method>(&self, s: f64) -> DynamicDense<'_> {
        DynamicDense { s, h: self.h, n: self.n, degree: M::DENSE_DEGREE, r: &self.r }
    }

    /// Makes the states at the [`INTERIOR_NODES`] known. Returns the evaluations of the right-hand
    /// side.
    pub(crate) fn fill_interior<M: Method>(
        &mut self,
        field: &dyn Field,
        from: Origin<'_>,
    ) -> usize {
        if M::INTERIOR_STAGES.is_some() {
            return 0;
        }
        let count = self.extend::<M>(field, from);
        let (n, s) = (self.n, from.s);
        let mut interior = std::mem::take(&mut self.interior);
        for (row, theta) in INTERIOR_NODES.into_iter().enumerate() {
            self.dense::<M>(s).write(theta, &mut interior[row * n..(row + 1) * n]);
        }
        self.interior = interior;
        count
    }

    /// The state at an interior node.
    pub(crate) fn interior(&self, row: usize) -> &[f64] {
        &self.interior[row * self.n..(row + 1) * self.n]
    }

    /// The states at all nodes.
    pub(crate) fn nodes<'a>(&'a self, from: Origin<'a>) -> [&'a [f64]; 6] {
        let inner = |row: usize| self.interior(row);
        [from.y, inner(0), inner(1), inner(2), inner(3), &self.y1]
    }
}

/// The sums over the first `count` stages, each times its weight, given to `put` component by
/// component.
fn weighted_sums(
    weights: &[f64; MAX_STAGES],
    k: &[f64],
    n: usize,
    count: usize,
    mut put: impl FnMut(usize, f64),
) {
    let mut first = 0;
    while first < n {
        let length = BLOCK.min(n - first);
        let mut sums = [0.0; BLOCK];
        for (j, &weight) in weights.iter().enumerate().take(count) {
            if weight != 0.0 {
                let stage = &k[j * n + first..j * n + first + length];
                for (sum, &k) in sums.iter_mut().zip(stage) {
                    *sum = add_product(*sum, k, weight);
                }
            }
        }
        for (i, &sum) in sums.iter().enumerate().take(length) {
            put(first + i, sum);
        }
        first += length;
    }
}
