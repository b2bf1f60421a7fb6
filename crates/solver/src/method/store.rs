//! How a state is stored: side by side in an array of fixed dimension, or in a buffer.
//!
//! Everything that computes with states writes them in place, so that it is compiled for both. An
//! array is lent by copying it, which costs nothing once it is compiled; a buffer is lent by moving
//! it, so that nothing is allocated. Stages and scratch are separate locals. In one struct they
//! would stay in memory, which costs 20 to 44 % of a step.

use std::fmt::Debug;
use std::ops::{Index, IndexMut};

use crate::method::state::{Columns, add_multiple, add_product, combine};
use crate::method::tableau::MAX_STAGES;

/// The stages of a step, and room beside them.
#[derive(Clone, Debug)]
pub struct Stages<V> {
    k: [V; MAX_STAGES],
    rooms: [V; 3],
    r: [V; 8],
}

/// The weights of stages.
type Weights = [f64; MAX_STAGES];

/// A state, as steps and events compute with it. It is implemented for states of fixed dimension
/// and for buffers, and not meant for other types.
///
/// What lives during one call is lent and given back: an array is lent as a new one, which the
/// compiler dissolves, and a buffer is moved, so that nothing is allocated on a step.
pub trait Store: Clone + Debug + PartialEq + Index<usize, Output = f64> + IndexMut<usize> {
    /// What a step keeps of its stages: nothing, or all of them.
    type Kept: Clone + Debug;
    /// Whether the stages are kept.
    const KEEPS: bool;
    /// Up to this dimension the components are moved one by one to see what rounding does.
    const FEW: usize;

    /// Room for a state of dimension `n`.
    #[must_use]
    fn room(n: usize) -> Self;
    /// The dimension.
    fn size(&self) -> usize;
    /// The components.
    fn parts(&self) -> &[f64];
    /// The components.
    fn parts_mut(&mut self) -> &mut [f64];
    /// Makes this the same state.
    fn set(&mut self, other: &Self);

    /// Lends a state, whose value is lost.
    #[must_use]
    fn lend(&mut self) -> Self;
    /// Gives it back.
    fn back(&mut self, lent: Self);

    /// Room for the stages of a step of dimension `n`.
    fn keep(n: usize) -> Self::Kept;
    /// Lends the stages, each of which must be written before it is read.
    fn lend_stages(kept: &mut Self::Kept) -> [Self; MAX_STAGES];
    /// Gives the stages back.
    fn stages_back(kept: &mut Self::Kept, stages: [Self; MAX_STAGES]);
    /// Lends one of three states.
    fn lend_room(kept: &mut Self::Kept, which: usize) -> Self;
    /// Gives one of three states back.
    fn room_back(kept: &mut Self::Kept, which: usize, lent: Self);
    /// Lends coefficients of a dense output.
    fn lend_dense(kept: &mut Self::Kept) -> [Self; 8];
    /// Gives the coefficients of a dense output back.
    fn dense_back(kept: &mut Self::Kept, lent: [Self; 8]);

    /// The sum of the first `count` stages, each times its weight.
    fn weighted(to: &mut Self, weights: &Weights, k: &[Self; MAX_STAGES], count: usize);
    /// h times that, added to `y0`.
    fn scaled_sums(
        to: &mut Self,
        y0: Option<&Self>,
        weights: (&Weights, usize),
        k: &[Self; MAX_STAGES],
        h: f64,
    );
    /// The state at stage `I`. The newest stage is added last, by few operations, since each stage
    /// waits for the one before it.
    fn stage<const I: usize>(
        to: &mut Self,
        y0: &Self,
        weights: &Weights,
        k: &[Self; MAX_STAGES],
        h: f64,
    );
    /// The state at the end, and what rounding cuts off from it.
    fn end(
        to: (&mut Self, &mut Self),
        from: (&Self, &Self),
        weights: (&Weights, usize),
        k: &[Self; MAX_STAGES],
        h: f64,
    );

    /// Replaces each component by a function of it and of the components of other states.
    #[inline(always)]
    fn each<const K: usize>(to: &mut Self, of: [&Self; K], f: impl Fn(f64, [f64; K]) -> f64) {
        let n = to.size();
        let (to, of) = (&mut to.parts_mut()[..n], of.map(|of| &of.parts()[..n]));
        for i in 0..n {
            to[i] = f(to[i], of.map(|of| of[i]));
        }
    }

    /// to = y + slope·by
    #[inline(always)]
    fn shifted(to: &mut Self, y: &Self, slope: &Self, by: f64) {
        let parts = to.parts_mut().iter_mut().zip(y.parts()).zip(slope.parts());
        for ((to, y), slope) in parts {
            *to = y + slope * by;
        }
    }

    /// y += slope·by
    #[inline(always)]
    fn shift(&mut self, slope: &Self, by: f64) {
        for (y, slope) in self.parts_mut().iter_mut().zip(slope.parts()) {
            *y += slope * by;
        }
    }
}

impl<const N: usize, const Q: usize> Store for Columns<N, Q> {
    type Kept = ();
    const KEEPS: bool = false;
    const FEW: usize = usize::MAX;

    #[inline(always)]
    fn room(_: usize) -> Self {
        Self::zeros()
    }
    #[inline(always)]
    fn size(&self) -> usize {
        N * Q
    }
    #[inline(always)]
    fn parts(&self) -> &[f64] {
        self.data.0.as_flattened()
    }
    #[inline(always)]
    fn parts_mut(&mut self) -> &mut [f64] {
        self.data.0.as_flattened_mut()
    }
    #[inline(always)]
    fn set(&mut self, other: &Self) {
        *self = *other;
    }
    #[inline(always)]
    fn lend(&mut self) -> Self {
        Self::zeros()
    }
    #[inline(always)]
    fn back(&mut self, _: Self) {}
    #[inline(always)]
    fn keep(_: usize) {}
    #[inline(always)]
    fn lend_stages((): &mut ()) -> [Self; MAX_STAGES] {
        [Self::zeros(); MAX_STAGES]
    }
    #[inline(always)]
    fn stages_back((): &mut (), _: [Self; MAX_STAGES]) {}
    #[inline(always)]
    fn lend_room((): &mut (), _: usize) -> Self {
        Self::zeros()
    }
    #[inline(always)]
    fn room_back((): &mut (), _: usize, _: Self) {}
    #[inline(always)]
    fn lend_dense((): &mut ()) -> [Self; 8] {
        [Self::zeros(); 8]
    }
    #[inline(always)]
    fn dense_back((): &mut (), _: [Self; 8]) {}

    #[inline(always)]
    fn weighted(to: &mut Self, weights: &Weights, k: &[Self; MAX_STAGES], count: usize) {
        *to = combine(weights, k, count);
    }
    #[inline(always)]
    fn scaled_sums(
        to: &mut Self,
        y0: Option<&Self>,
        (weights, count): (&Weights, usize),
        k: &[Self; MAX_STAGES],
        h: f64,
    ) {
        let sums = combine(weights, k, count) * h;
        *to = y0.map_or(sums, |y0| y0 + sums);
    }
    #[inline(always)]
    fn stage<const I: usize>(
        to: &mut Self,
        y0: &Self,
        weights: &Weights,
        k: &[Self; MAX_STAGES],
        h: f64,
    ) {
        let early = y0 + combine(weights, k, I - 1) * h;
        *to = add_multiple(&early, &k[I - 1], h * weights[I - 1]);
    }
    #[inline(always)]
    fn end(
        (y1, rest1): (&mut Self, &mut Self),
        (y0, rest): (&Self, &Self),
        (weights, count): (&Weights, usize),
        k: &[Self; MAX_STAGES],
        h: f64,
    ) {
        let rise = add_multiple(rest, &combine(weights, k, count), h);
        let end = y0 + rise;
        *y1 = end;
        *rest1 = rise - (end - y0);
    }
}

/// Components that are summed together, in registers.
const BLOCK: usize = 16;

impl Store for Vec<f64> {
    type Kept = Stages<Self>;
    const KEEPS: bool = true;
    const FEW: usize = 8;

    fn room(n: usize) -> Self {
        vec![0.0; n]
    }
    fn size(&self) -> usize {
        self.len()
    }
    fn parts(&self) -> &[f64] {
        self
    }
    fn parts_mut(&mut self) -> &mut [f64] {
        self
    }
    fn set(&mut self, other: &Self) {
        self.clone_from(other);
    }
    fn lend(&mut self) -> Self {
        std::mem::take(self)
    }
    fn back(&mut self, lent: Self) {
        *self = lent;
    }
    fn keep(n: usize) -> Stages<Self> {
        let room = || vec![0.0; n];
        Stages {
            k: std::array::from_fn(|_| room()),
            rooms: [room(), room(), room()],
            r: std::array::from_fn(|_| room()),
        }
    }
    fn lend_stages(kept: &mut Stages<Self>) -> [Self; MAX_STAGES] {
        std::mem::take(&mut kept.k)
    }
    fn stages_back(kept: &mut Stages<Self>, stages: [Self; MAX_STAGES]) {
        kept.k = stages;
    }
    fn lend_room(kept: &mut Stages<Self>, which: usize) -> Self {
        std::mem::take(&mut kept.rooms[which])
    }
    fn room_back(kept: &mut Stages<Self>, which: usize, lent: Self) {
        kept.rooms[which] = lent;
    }
    fn lend_dense(kept: &mut Stages<Self>) -> [Self; 8] {
        std::mem::take(&mut kept.r)
    }
    fn dense_back(kept: &mut Stages<Self>, lent: [Self; 8]) {
        kept.r = lent;
    }

    fn weighted(to: &mut Self, weights: &Weights, k: &[Self; MAX_STAGES], count: usize) {
        sums(weights, k, count, |c, sum| to[c] = sum);
    }
    fn scaled_sums(
        to: &mut Self,
        y0: Option<&Self>,
        (weights, count): (&Weights, usize),
        k: &[Self; MAX_STAGES],
        h: f64,
    ) {
        match y0 {
            Some(y0) => sums(weights, k, count, |c, sum| to[c] = y0[c] + sum * h),
            None => sums(weights, k, count, |c, sum| to[c] = sum * h),
        }
    }
    fn stage<const I: usize>(
        to: &mut Self,
        y0: &Self,
        weights: &Weights,
        k: &[Self; MAX_STAGES],
        h: f64,
    ) {
        sums(weights, k, I - 1, |c, sum| to[c] = y0[c] + sum * h);
        let newest = h * weights[I - 1];
        for (y, &k) in to.iter_mut().zip(&k[I - 1]) {
            *y = add_product(*y, k, newest);
        }
    }
    fn end(
        (y1, rest1): (&mut Self, &mut Self),
        (y0, rest): (&Self, &Self),
        (weights, count): (&Weights, usize),
        k: &[Self; MAX_STAGES],
        h: f64,
    ) {
        sums(weights, k, count, |c, sum| {
            let rise = add_product(rest[c], sum, h);
            y1[c] = y0[c] + rise;
            rest1[c] = rise - (y1[c] - y0[c]);
        });
    }
}

/// The sums over the first `count` stages, each times its weight, given to `put` component by
/// component.
#[inline]
fn sums(
    weights: &Weights,
    k: &[Vec<f64>; MAX_STAGES],
    count: usize,
    mut put: impl FnMut(usize, f64),
) {
    let n = k[0].len();
    let mut first = 0;
    while first < n {
        let length = BLOCK.min(n - first);
        let mut sums = [0.0; BLOCK];
        for (k, &weight) in k.iter().zip(weights).take(count) {
            if weight != 0.0 {
                for (sum, &k) in sums.iter_mut().zip(&k[first..first + length]) {
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
