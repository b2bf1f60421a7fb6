//! Dormand–Prince 5(4) with its dense output of degree 4.
//!
//! The coefficients are from Dormand and Prince, *J. Comput. Appl. Math.* 6 (1980) 19, table 2. The
//! dense output is Shampine's, as in Hairer, Nørsett and Wanner, *Solving Ordinary Differential
//! Equations I*, 2nd ed., section II.6 (code DOPRI5).

use crate::method::tableau::{MAX_STAGES, Method, Tableau};

/// Dormand–Prince 5(4): order 5, six stages and the derivative at the end, and dense output of
/// degree 4.
///
/// ```
/// use stickslip_solver::{Dopri5, Method};
///
/// assert_eq!((Dopri5::ORDER, Dopri5::STAGES, Dopri5::DENSE_DEGREE), (5, 6, 4));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dopri5;

impl Method for Dopri5 {
    const NAME: &'static str = "dopri5";
    const ORDER: usize = 5;
    const CONTROL_ORDER: usize = 5;
    const STAGES: usize = 6;
    const DENSE_STAGES: usize = 7;
    const DENSE_DEGREE: usize = 4;
    const ERROR_USES_END: bool = true;
    const INTERIOR_STAGES: Option<[usize; 4]> = None;
    const QUICK_ERROR: f64 = 1.0;
    const CONTROL_BETA: f64 = 0.04;
    const STEP_FACTORS: (f64, f64) = (0.2, 10.0);
    const TABLEAU: Tableau = Tableau {
        c: row(&[0.0, 1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0, 1.0]),
        a: stage_weights(),
        b: row(B),
        error: row(&[
            71.0 / 57600.0,
            0.0,
            -71.0 / 16695.0,
            71.0 / 1920.0,
            -17253.0 / 339200.0,
            22.0 / 525.0,
            -1.0 / 40.0,
        ]),
        coarse_error: [0.0; MAX_STAGES],
        dense: [
            row(&[
                -12715105075.0 / 11282082432.0,
                0.0,
                87487479700.0 / 32700410799.0,
                -10690763975.0 / 1880347072.0,
                701980252875.0 / 199316789632.0,
                -1453857185.0 / 822651844.0,
                69997945.0 / 29380423.0,
            ]),
            [0.0; MAX_STAGES],
            [0.0; MAX_STAGES],
            [0.0; MAX_STAGES],
        ],
    };
}

const B: &[f64] =
    &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0];

const A: [&[f64]; 7] = [
    &[],
    &[1.0 / 5.0],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
    &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
    B,
];

const fn row(weights: &[f64]) -> [f64; MAX_STAGES] {
    let mut full = [0.0; MAX_STAGES];
    let mut i = 0;
    while i < weights.len() {
        full[i] = weights[i];
        i += 1;
    }
    full
}

const fn stage_weights() -> [[f64; MAX_STAGES]; MAX_STAGES] {
    let mut full = [[0.0; MAX_STAGES]; MAX_STAGES];
    let mut i = 0;
    while i < A.len() {
        full[i] = row(A[i]);
        i += 1;
    }
    full
}
