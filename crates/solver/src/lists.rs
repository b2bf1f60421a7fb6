//! Lists whose length is known when they are compiled or not.

use std::fmt::Debug;
use std::ops::{Index, IndexMut};

use smallvec::SmallVec;

/// A list: an array, or a buffer, which are lent as [`Store`]s are.
pub(crate) trait List<T>:
    Clone + Debug + Index<usize, Output = T> + IndexMut<usize>
{
    /// `n` equal values.
    fn of(n: usize, value: T) -> Self;
    /// `n` values by their places.
    fn made(n: usize, value: impl FnMut(usize) -> T) -> Self;
    fn parts(&self) -> &[T];
    fn parts_mut(&mut self) -> &mut [T];
    /// Makes this the same list.
    fn set(&mut self, other: &Self);
    /// Makes room for `n` values.
    fn fit(&mut self, n: usize, value: T);
    /// Lends the list, whose values are lost.
    fn lend(&mut self, value: T) -> Self;
    /// Gives it back.
    fn back(&mut self, lent: Self);
}

impl<T: Copy + Debug, const N: usize> List<T> for [T; N] {
    #[inline(always)]
    fn of(_: usize, value: T) -> Self {
        [value; N]
    }
    #[inline(always)]
    fn made(_: usize, mut value: impl FnMut(usize) -> T) -> Self {
        if N == 0 {
            return std::array::from_fn(value);
        }
        // `from_fn` is not always compiled into its caller.
        let mut all = [value(0); N];
        for (i, entry) in all.iter_mut().enumerate().skip(1) {
            *entry = value(i);
        }
        all
    }
    #[inline(always)]
    fn parts(&self) -> &[T] {
        self
    }
    #[inline(always)]
    fn parts_mut(&mut self) -> &mut [T] {
        self
    }
    #[inline(always)]
    fn set(&mut self, other: &Self) {
        *self = *other;
    }
    #[inline(always)]
    fn fit(&mut self, _: usize, _: T) {}
    #[inline(always)]
    fn lend(&mut self, value: T) -> Self {
        [value; N]
    }
    #[inline(always)]
    fn back(&mut self, _: Self) {}
}

/// Makes a type that grows a list, which is lent by moving it.
macro_rules! growing_list {
    ($list:ty) => {
        impl<T: Copy + Debug> List<T> for $list {
            fn of(n: usize, value: T) -> Self {
                std::iter::repeat_n(value, n).collect()
            }
            fn made(n: usize, value: impl FnMut(usize) -> T) -> Self {
                (0..n).map(value).collect()
            }
            fn parts(&self) -> &[T] {
                self
            }
            fn parts_mut(&mut self) -> &mut [T] {
                self
            }
            fn set(&mut self, other: &Self) {
                self.clone_from(other);
            }
            fn fit(&mut self, n: usize, value: T) {
                self.resize(n, value);
            }
            fn lend(&mut self, _: T) -> Self {
                std::mem::take(self)
            }
            fn back(&mut self, lent: Self) {
                *self = lent;
            }
        }
    };
}

growing_list!(Vec<T>);
growing_list!(SmallVec<[T; 8]>);

/// The length of lists, known when they are compiled or not.
pub(crate) trait Shape: Copy + Debug {
    /// A list of this length.
    type Of<T: Copy + Debug>: List<T>;
    /// Which components are bounded: all, or those that guards read.
    type Read: Clone;
    /// How many of `n` components are bounded.
    fn count(read: &Self::Read, n: usize) -> usize;
    /// The place of the one that is bounded as number `i`.
    fn place(read: &Self::Read, i: usize) -> usize;
}

/// A length that is known when it is compiled.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FixedShape<const N: usize>;
/// Any length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AnyShape;

impl<const N: usize> Shape for FixedShape<N> {
    type Of<T: Copy + Debug> = [T; N];
    type Read = ();
    #[inline(always)]
    fn count((): &(), _: usize) -> usize {
        N
    }
    #[inline(always)]
    fn place((): &(), i: usize) -> usize {
        i
    }
}
impl Shape for AnyShape {
    type Of<T: Copy + Debug> = Vec<T>;
    type Read = ();
    fn count((): &(), n: usize) -> usize {
        n
    }
    fn place((): &(), i: usize) -> usize {
        i
    }
}
/// The number of components that guards read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ReadShape;
impl Shape for ReadShape {
    type Of<T: Copy + Debug> = SmallVec<[T; 8]>;
    type Read = SmallVec<[usize; 8]>;
    fn count(read: &Self::Read, _: usize) -> usize {
        read.len()
    }
    fn place(read: &Self::Read, i: usize) -> usize {
        read[i]
    }
}
