//! Orders of convergence, fitted to errors that are known.

use stickslip_solver::method::fit_order;

/// Steps that fall from 1 by factors of 2^{1/4}, with their errors, which scatter by 1 %.
fn errors(count: u32, error: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    let scatter = |i: u32| 1.0 + 0.01 * f64::from(7 * i % 5) - 0.02;
    let step = |i: u32| 0.5_f64.powf(f64::from(i) / 4.0);
    (0..count).map(|i| (step(i), scatter(i) * error(step(i)))).collect()
}

#[test]
fn a_pure_power_is_fitted_over_its_whole_range() {
    let fit = fit_order(&errors(21, |h| 3.0 * h.powf(2.5)), 4.0).unwrap();
    assert!((fit.order - 2.5).abs() < 0.003 && fit.standard_error < 0.004, "{fit:?}");
    assert!(fit.drift.abs() < 0.02, "{fit:?}");
    assert!((fit.coarsest / fit.finest - 32.0).abs() < 1e-9 && fit.points == 21);
}

#[test]
fn the_standard_error_agrees_with_the_textbook_formula() {
    // y = (0, 1, 3, 4, 5) at x = 0 … 4: the slope is 1.3, the residuals are 0.0, −0.3, 0.4,
    // 0.1 and −0.2, s² = 0.3/3, and Σ(x − x̄)² = 10.
    let points: Vec<(f64, f64)> = (0_u8..).map(f64::from).zip([0.0, 1.0, 3.0, 4.0, 5.0]).collect();
    let powers: Vec<_> = points.iter().rev().map(|p| (p.0.exp(), p.1.exp())).collect();
    let fit = fit_order(&powers, 2.0).unwrap();
    assert!((fit.order - 1.3).abs() < 1e-14 && (fit.standard_error - 0.1).abs() < 1e-14);
    // The finer half 0, 1, 3 has slope 1.5, the coarser half 3, 4, 5 has slope 1.
    assert!((fit.drift - 0.5).abs() < 1e-14 && fit.points == 5);
}

#[test]
fn of_two_regimes_the_finer_one_is_fitted() {
    let fit = fit_order(&errors(41, |h| h.powi(5) + 1e-3 * h * h), 4.0).unwrap();
    assert!((fit.order - 2.0).abs() < 0.01, "{fit:?}");
    assert!(fit.coarsest < 0.05, "{fit:?}");
}

#[test]
fn rounding_and_errors_that_cannot_be_compared_are_left_out() {
    let floor = |h: f64| (h.powi(8)).hypot(2e-16);
    let fit = fit_order(&errors(60, floor), 4.0).unwrap();
    assert!((fit.order - 8.0).abs() < 0.01 && fit.finest > 0.012, "{fit:?}");
    let mut others = errors(40, |h| h);
    others[20].1 = f64::NAN;
    others[3].1 = f64::INFINITY;
    let fit = fit_order(&others, 4.0).unwrap();
    assert_eq!(fit.points, 19);
    // A level of 1e-10 does not count as rounding.
    let stuck = fit_order(&errors(60, |h| h.powi(8).hypot(1e-10)), 4.0).unwrap();
    assert!(stuck.order.abs() < 0.1, "{stuck:?}");
}

#[test]
fn too_few_errors_give_no_order() {
    assert_eq!(fit_order(&[], 4.0), None);
    assert_eq!(fit_order(&errors(8, |h| h), 4.0), None);
    assert!(fit_order(&errors(9, |h| h), 4.0).is_some());
    assert_eq!(fit_order(&errors(40, |_| f64::NAN), 4.0), None);
    assert_eq!(fit_order(&errors(40, |_| 0.0), 4.0), None);
    assert_eq!(fit_order(&errors(40, |_| f64::INFINITY), 4.0), None);
    assert_eq!(fit_order(&[(0.5, 0.1); 9], 1.0), None);
}
