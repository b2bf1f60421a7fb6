//! Whether a matrix is singular, as a smooth number.

use nalgebra::{DMatrix, DVector};

use crate::spaces::kernel;

/// What borders a matrix, so that a number is zero exactly where it is singular (Govaerts,
/// *Numerical Methods for Bifurcations of Dynamical Equilibria*, 2000, chapter 3).
#[derive(Clone)]
pub(super) struct Borders {
    column: DVector<f64>,
    row: DVector<f64>,
}

impl Borders {
    pub fn of(matrix: &DMatrix<f64>) -> Self {
        Self { column: null_vector(&matrix.transpose()), row: null_vector(matrix) }
    }

    pub fn value(&self, matrix: &DMatrix<f64>) -> Option<f64> {
        let count = matrix.nrows();
        let mut all = matrix.clone().insert_row(count, 0.0).insert_column(count, 0.0);
        all.view_mut((0, count), (count, 1)).copy_from(&self.column);
        all.view_mut((count, 0), (1, count)).copy_from(&self.row.transpose());
        let mut right = DVector::zeros(count + 1);
        right[count] = 1.0;
        all.lu().solve(&right).map(|solved| solved[count])
    }
}

/// The plane that the derivatives of a branch map to about zero: both branches that meet at a point
/// lie in it.
pub(super) fn plane(slopes: &DMatrix<f64>) -> [DVector<f64>; 2] {
    let both = kernel(slopes, 2);
    [0, 1].map(|own| both.column(own).into_owned())
}

/// A vector that a matrix maps to about zero.
pub(super) fn null_vector(matrix: &DMatrix<f64>) -> DVector<f64> {
    kernel(matrix, 1).column(0).into_owned()
}
