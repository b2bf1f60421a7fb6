//! Inverses of small matrices, compiled with this crate.
//!
//! The inverse of nalgebra has code for every size. Called from generic code, all of it would be
//! compiled again in each program that defines a family.

use nalgebra::allocator::Allocator;
use nalgebra::{DMatrix, DefaultAllocator, Dim, Matrix2, OMatrix, SMatrix};

/// The inverse of a matrix, if there is one.
#[inline(never)]
pub(crate) fn of_two(matrix: &Matrix2<f64>) -> Option<Matrix2<f64>> {
    matrix.try_inverse()
}

/// The inverse of a square matrix, if there is one.
pub(crate) fn of<D: Dim>(matrix: &OMatrix<f64, D, D>) -> Option<OMatrix<f64, D, D>>
where
    DefaultAllocator: Allocator<D, D>,
{
    let mut inverse = matrix.clone();
    invert(matrix.nrows(), inverse.as_mut_slice()).then_some(inverse)
}

/// Inverts a matrix of some size, column by column; returns whether there is an inverse.
#[inline(never)]
fn invert(size: usize, entries: &mut [f64]) -> bool {
    fn fixed<const N: usize>(entries: &mut [f64]) -> bool {
        let inverse = SMatrix::<f64, N, N>::from_column_slice(entries).try_inverse();
        inverse.is_some_and(|inverse| {
            entries.copy_from_slice(inverse.as_slice());
            true
        })
    }
    match size {
        1 => fixed::<1>(entries),
        2 => fixed::<2>(entries),
        3 => fixed::<3>(entries),
        _ => {
            let inverse = DMatrix::from_column_slice(size, size, entries).try_inverse();
            inverse.is_some_and(|inverse| {
                entries.copy_from_slice(inverse.as_slice());
                true
            })
        }
    }
}
