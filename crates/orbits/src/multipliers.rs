//! Multipliers: eigenvalues of the derivative of the return to the start.

use nalgebra::{DMatrix, DVector, Schur};

/// Singular values below this part of the largest one are 0: the matrix loses a dimension exactly
/// where a segment slides or all states are reset to one.
const RANK: f64 = 1e-14;
/// Rounds of the search for eigenvalues.
const ROUNDS: usize = 10_000;

/// The eigenvalues of a matrix, the largest first, as real and imaginary parts. A trivial
/// eigenvector, of the eigenvalue 1, is divided out. `None` if they cannot be computed.
pub(crate) fn multipliers(
    matrix: &DMatrix<f64>,
    trivial: Option<&DVector<f64>>,
) -> Option<Vec<[f64; 2]>> {
    let own = match trivial {
        Some(direction) if direction.amax() > 0.0 => divided(matrix, direction),
        _ => matrix.clone(),
    };
    let all = own.nrows();
    let mut own = own;
    // Zeros in a chain would be found as small numbers: only what is in the range is kept.
    while own.nrows() > 0 {
        let svd = own.clone().svd(true, false);
        let least = RANK * svd.singular_values.amax();
        let rank = svd.singular_values.iter().filter(|value| **value > least).count();
        if rank == own.nrows() {
            break;
        }
        let range = svd.u?.columns(0, rank).into_owned();
        own = range.transpose() * own * range;
    }
    let mut found = Vec::with_capacity(all);
    if own.nrows() > 0 {
        let schur = Schur::try_new(own, f64::EPSILON, ROUNDS)?;
        found.extend(schur.complex_eigenvalues().iter().map(|it| [it.re, it.im]));
    }
    found.resize(all, [0.0, 0.0]);
    let size = |[re, im]: &[f64; 2]| re.hypot(*im);
    found.sort_by(|one, other| {
        size(other)
            .total_cmp(&size(one))
            .then(other[1].total_cmp(&one[1]))
            .then(other[0].total_cmp(&one[0]))
    });
    Some(found)
}

/// The matrix on the space without a direction that it maps to itself.
fn divided(matrix: &DMatrix<f64>, direction: &DVector<f64>) -> DMatrix<f64> {
    let n = direction.len();
    // The reflection that maps the direction to the first axis.
    let unit = direction.normalize();
    let mut axis = unit.clone();
    axis[0] += if unit[0] < 0.0 { -1.0 } else { 1.0 };
    let axis = axis.normalize();
    let reflection = DMatrix::identity(n, n) - 2.0 * &axis * axis.transpose();
    let turned = &reflection * matrix * &reflection;
    turned.view((1, 1), (n - 1, n - 1)).into_owned()
}
