//! Multipliers: eigenvalues of the derivative of the return to the start.

use nalgebra::{Complex, DMatrix, DVector, Schur};

use crate::spaces::range;

/// What is below this part of the largest is 0: the matrix loses a dimension exactly where a
/// segment slides or all states are reset to one.
const RANK: f64 = 1e-14;
/// How far sums of eigenvalues may be off, as a part of the size of the matrix.
const SUM: f64 = 1e-9;
/// Rounds of the search for eigenvalues.
const ROUNDS: usize = 10_000;

/// The eigenvalues of a matrix, the largest first, as real and imaginary parts. A trivial
/// eigenvector, of the eigenvalue 1, is divided out. `None` if they cannot be computed.
pub(crate) fn multipliers(
    matrix: &DMatrix<f64>,
    trivial: Option<&DVector<f64>>,
) -> Option<Vec<[f64; 2]>> {
    let mut own = match trivial {
        Some(direction) if direction.amax() > 0.0 => divided(matrix, direction),
        _ => matrix.clone(),
    };
    let all = own.nrows();
    // Zeros in a chain would be found as small numbers: only what is in the range is kept.
    while own.nrows() > 0 {
        let range = range(&own, RANK);
        if range.ncols() == own.nrows() {
            break;
        }
        own = range.transpose() * own * range;
    }
    let mut found = Vec::with_capacity(all);
    if own.nrows() > 0 {
        let values = Schur::try_new(own.clone(), f64::EPSILON, ROUNDS)?.complex_eigenvalues();
        // What the values and their squares sum up to is known without them.
        let (size, squares) = (own.norm(), (&own * &own).trace());
        let sums = [values.iter().sum(), values.iter().map(|it| it * it).sum::<Complex<f64>>()];
        let near = |sum: Complex<f64>, known: f64, size: f64| (sum - known).norm() <= SUM * size;
        if !(near(sums[0], own.trace(), size) && near(sums[1], squares, size * size)) {
            return None;
        }
        found.extend(values.iter().map(|it| [it.re, it.im]));
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
