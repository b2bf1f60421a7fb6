//! Whether a matrix is singular, as a smooth number.

use nalgebra::{DMatrix, DVector};

/// What borders a matrix, so that a number is zero exactly where it is singular (Govaerts,
/// *Numerical Methods for Bifurcations of Dynamical Equilibria*, 2000, chapter 3).
#[derive(Clone)]
pub(super) struct Borders {
    column: DVector<f64>,
    row: DVector<f64>,
}

impl Borders {
    pub fn of(matrix: &DMatrix<f64>) -> Self {
        let (column, row) = null_vectors(matrix);
        Self { column, row }
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
pub(super) fn plane(slopes: &DMatrix<f64>) -> Option<[DVector<f64>; 2]> {
    let svd = slopes.clone().insert_row(slopes.nrows(), 0.0).svd(false, true);
    let mut order: Vec<usize> = (0..svd.singular_values.len()).collect();
    order.sort_by(|one, other| svd.singular_values[*one].total_cmp(&svd.singular_values[*other]));
    let (rows, [one, other]) = (svd.v_t?, [*order.first()?, *order.get(1)?]);
    Some([one, other].map(|row| rows.row(row).transpose()))
}

/// The left and the right singular vector of the least singular value.
pub(super) fn null_vectors(matrix: &DMatrix<f64>) -> (DVector<f64>, DVector<f64>) {
    let svd = matrix.clone().svd(true, true);
    let least = svd.singular_values.imin();
    match (svd.u, svd.v_t) {
        (Some(left), Some(right)) => {
            (left.column(least).into_owned(), right.row(least).transpose())
        }
        // Both were asked for.
        _ => (DVector::zeros(matrix.nrows()), DVector::zeros(matrix.ncols())),
    }
}
