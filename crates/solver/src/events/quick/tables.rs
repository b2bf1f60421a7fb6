//! Weights for the first look at a guard, computed when the crate is compiled.

use crate::method::INTERIOR_NODES;

/// The number of values of a guard that a step provides without further work.
pub(super) const COUNT: usize = 6;

/// The step fractions of the six values.
pub(crate) const NODES: [f64; COUNT] =
    [0.0, INTERIOR_NODES[0], INTERIOR_NODES[1], INTERIOR_NODES[2], INTERIOR_NODES[3], 1.0];

/// The matrix, by columns, from values at the six nodes to Bernstein coefficients of degree 5.
pub(super) const QUINTIC: [[f64; 6]; 6] = to_bernstein(&NODES);
/// The matrix, by columns, from values at the five nodes after the start to Bernstein coefficients
/// of degree 4.
pub(super) const QUARTIC: [[f64; 5]; 5] = to_bernstein(&LATE_NODES);
const LATE_NODES: [f64; 5] = [NODES[1], NODES[2], NODES[3], NODES[4], NODES[5]];

/// Weights that give the size of the last term of the quintic on the step.
pub(super) const QUINTIC_TERM: [f64; 6] = last_term_weights(&NODES, None, 2);
/// Weights that give the size of the next-to-last term of the quintic.
pub(super) const QUARTIC_TERM: [f64; 6] = last_term_weights(&NODES, Some(2), 3);
/// Weights that give the size of the last term of the quartic on the step.
pub(super) const LATE_QUARTIC_TERM: [f64; 5] = last_term_weights(&LATE_NODES, None, 1);
/// Weights that give the size of the next-to-last term of the quartic.
pub(super) const LATE_CUBIC_TERM: [f64; 5] = last_term_weights(&LATE_NODES, Some(1), 2);

/// The largest change of the quintic and its error, anywhere on the step, if the value at a node
/// moves by one unit away from the chord through the ends.
pub(super) const BEND: [f64; 6] = {
    let mut bend = [0.0; 6];
    let mut i = 0;
    while i < 6 {
        bend[i] = greatest_lagrange(&NODES, i) + QUINTIC_TERM[i].abs() + QUARTIC_TERM[i].abs();
        i += 1;
    }
    bend
};

/// The largest absolute value on [0, 1] of the polynomial that is 1 at node `i` and 0 at the other
/// nodes, rounded up.
const fn greatest_lagrange<const K: usize>(nodes: &[f64; K], i: usize) -> f64 {
    let mut greatest = 0.0;
    let mut sample = 0;
    while sample <= 1000 {
        let theta = sample as f64 / 1000.0;
        let mut product = 1.0;
        let mut j = 0;
        while j < K {
            if j != i {
                product *= (theta - nodes[j]) / (nodes[i] - nodes[j]);
            }
            j += 1;
        }
        if product.abs() > greatest {
            greatest = product.abs();
        }
        sample += 1;
    }
    1.01 * greatest
}

/// Weights that give the size of the last term of Newton's form on [0, 1].
///
/// Newton's form goes through all nodes but `skip`, and node `last` is added last. Its last term is
/// the highest coefficient, times a polynomial. The result is the weights of this coefficient,
/// times the largest absolute value of the polynomial on [0, 1].
const fn last_term_weights<const K: usize>(
    nodes: &[f64; K],
    skip: Option<usize>,
    last: usize,
) -> [f64; K] {
    let skip = match skip {
        Some(i) => i,
        None => K,
    };
    let mut greatest = 0.0;
    let mut sample = 0;
    while sample <= 1000 {
        let mut product = 1.0;
        let mut i = 0;
        while i < K {
            if i != skip && i != last {
                product *= sample as f64 / 1000.0 - nodes[i];
            }
            i += 1;
        }
        if product.abs() > greatest {
            greatest = product.abs();
        }
        sample += 1;
    }
    let mut weights = [0.0; K];
    let mut i = 0;
    while i < K {
        if i != skip {
            let mut product = 1.0;
            let mut j = 0;
            while j < K {
                if j != skip && j != i {
                    product *= nodes[i] - nodes[j];
                }
                j += 1;
            }
            weights[i] = greatest / product;
        }
        i += 1;
    }
    weights
}

/// The inverse of the Bernstein collocation matrix at `nodes`, by columns.
const fn to_bernstein<const K: usize>(nodes: &[f64; K]) -> [[f64; K]; K] {
    let mut matrix = [[0.0; K]; K];
    let mut inverse = [[0.0; K]; K];
    let mut row = 0;
    while row < K {
        let mut column = 0;
        while column < K {
            matrix[row][column] = bernstein(K - 1, column, nodes[row]);
            column += 1;
        }
        inverse[row][row] = 1.0;
        row += 1;
    }
    // Gauss–Jordan elimination. The matrix is totally positive, so no pivoting is needed.
    let mut pivot = 0;
    while pivot < K {
        let scale = 1.0 / matrix[pivot][pivot];
        let mut column = 0;
        while column < K {
            matrix[pivot][column] *= scale;
            inverse[pivot][column] *= scale;
            column += 1;
        }
        let mut row = 0;
        while row < K {
            if row != pivot {
                let factor = matrix[row][pivot];
                let mut column = 0;
                while column < K {
                    matrix[row][column] -= factor * matrix[pivot][column];
                    inverse[row][column] -= factor * inverse[pivot][column];
                    column += 1;
                }
            }
            row += 1;
        }
        pivot += 1;
    }
    let mut columns = [[0.0; K]; K];
    let mut row = 0;
    while row < K {
        let mut column = 0;
        while column < K {
            columns[column][row] = inverse[row][column];
            column += 1;
        }
        row += 1;
    }
    columns
}

/// The Bernstein polynomial of this degree and index at `theta`.
const fn bernstein(degree: usize, index: usize, theta: f64) -> f64 {
    let mut product = 1.0;
    let mut i = 0;
    while i < degree {
        product *=
            if i < index { theta * (degree - i) as f64 / (index - i) as f64 } else { 1.0 - theta };
        i += 1;
    }
    product
}
