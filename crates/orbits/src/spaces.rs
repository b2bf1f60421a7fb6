//! What a matrix maps to about zero, and what it maps to.
//!
//! Both come from QR decompositions with pivoting. The singular value decomposition of nalgebra
//! 0.35 is wrong for some matrices, above all for those that lose a dimension (its issue 1172).

use nalgebra::DMatrix;

/// Orthonormal columns that a matrix maps to about zero: those that it makes smallest.
pub(crate) fn kernel(matrix: &DMatrix<f64>, count: usize) -> DMatrix<f64> {
    let columns = matrix.nrows().max(matrix.ncols());
    let q = matrix.transpose().resize_horizontally(columns, 0.0).col_piv_qr().q();
    q.columns(q.ncols() - count, count).into_owned()
}

/// Orthonormal columns that span what a square matrix maps to, without what is below `least` as a
/// part of the largest.
pub(crate) fn range(matrix: &DMatrix<f64>, least: f64) -> DMatrix<f64> {
    let factors = matrix.clone().col_piv_qr();
    let sizes = factors.r().diagonal();
    let rank = sizes.iter().filter(|size| **size > least * sizes.amax()).count();
    factors.q().columns(0, rank).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Matrices that nalgebra's own decomposition gets wrong, with others of one column fewer.
    #[test]
    fn a_matrix_that_loses_a_dimension_has_its_spaces() {
        let wrong = [0.32106209430308413, 0.20275689722971993, -0.8664845485503817];
        let wrong =
            DMatrix::from_column_slice(2, 2, &[&wrong[..], &[-0.5472016836584961]].concat());
        let own = range(&wrong, 1e-14);
        assert_eq!(own.ncols(), 1);
        let value = (own.transpose() * &wrong * &own)[0];
        assert!((value - wrong.trace()).abs() < 1e-15, "{value}");
        let mut random = fastrand::Rng::with_seed(3);
        for n in 2..12 {
            for rank in 1..n {
                let [one, other] =
                    [(); 2].map(|()| DMatrix::from_fn(n, rank, |_, _| random.f64() - 0.5));
                for matrix in [&one * other.transpose(), DMatrix::from_element(n, n, 1.0)] {
                    let lost = n - range(&matrix, 1e-13).ncols();
                    let null = kernel(&matrix, lost);
                    assert!((&matrix * &null).amax() < 1e-14 * n as f64, "{matrix}");
                    assert!(
                        (null.transpose() * &null - DMatrix::identity(lost, lost)).amax() < 1e-14
                    );
                    let image = range(&matrix, 1e-13);
                    assert!((&image * (image.transpose() * &matrix) - &matrix).amax() < 1e-13);
                }
            }
            let wide = DMatrix::from_fn(n, n + 1, |_, _| random.f64() - 0.5);
            assert!((&wide * kernel(&wide, 1)).amax() < 1e-14 * n as f64);
        }
    }
}
