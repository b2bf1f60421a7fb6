//! Inverses of small matrices, compiled with this crate.
//!
//! The inverse of nalgebra has code for every size. Called from generic code, all of it would be
//! compiled again in each program that defines a family.

use nalgebra::{Matrix2, Matrix3};

/// The inverse of a matrix, if there is one.
#[inline(never)]
pub(crate) fn of_two(matrix: &Matrix2<f64>) -> Option<Matrix2<f64>> {
    matrix.try_inverse()
}

/// The inverse of a matrix, if there is one.
#[inline(never)]
pub(crate) fn of_three(matrix: &Matrix3<f64>) -> Option<Matrix3<f64>> {
    matrix.try_inverse()
}
