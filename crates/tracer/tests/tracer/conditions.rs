//! Points solved by conditions: how exact they are, and what a search says where there is none.

use std::convert::Infallible;

use nalgebra::{DMatrix, DVector, Matrix2, U1, Vector1, Vector2};
use stickslip_tracer::conditions::{Limits, Unsolved, Zero, solve};

/// The zero of a function of one unknown with this slope.
fn zero(
    value: impl Fn(f64) -> Option<f64>,
    slope: impl Fn(f64) -> f64,
    start: f64,
    limits: &Limits,
) -> Result<Zero<U1>, Unsolved<U1>> {
    let Ok(found) = solve(&Vector1::new(start), limits, |at, _| {
        let values = value(at.x).map(Vector1::new);
        Ok::<_, Infallible>(values.map(|values| (values, Some(Vector1::new(slope(at.x))))))
    });
    found
}

fn wide() -> Limits {
    Limits::new(10.0, 1e-12)
}

#[test]
fn a_simple_zero_is_exact() {
    let found = zero(|x| Some(x * x - 2.0), |x| 2.0 * x, 1.0, &wide()).expect("a zero");
    assert!((found.at.x - 2.0_f64.sqrt()).abs() < 1e-15);
    assert_eq!(found.error, 1e-11);
}

/// Updates for a double zero halve: forty of them are not enough from a distance of 1e3, and they
/// are not taken for those of a simple zero.
#[test]
fn a_double_zero_is_slow() {
    let limits = Limits { square: 1e-3, ..Limits::new(1e4, 1e-12) };
    let found = zero(|x| Some(x * x), |x| 2.0 * x, 1e3, &limits);
    let Err(Unsolved::Slow { at, update }) = found else { panic!("{found:?}") };
    assert!(at.x > 0.0 && at.x < 1e-8 && update < 1e-8);
}

/// Noise keeps updates at 1e-9. They end the search if the noise is known.
#[test]
fn noise_ends_a_search() {
    let noisy = |x: f64| Some(x + 1e-9 * (1e12 * x).cos().signum());
    let found = zero(noisy, |_| 1.0, 0.5, &Limits { noise: 1e-9, ..wide() }).expect("a zero");
    assert!(found.at.x.abs() <= found.error && found.error == 1e-8);
}

#[test]
fn what_has_no_zero_says_why() {
    let line = zero(|x| Some(x - 20.0), |_| 1.0, 0.0, &wide());
    assert_eq!(line, Err(Unsolved::Leaves));
    let flat = zero(|_| Some(1.0), |_| 0.0, 0.0, &wide());
    assert_eq!(flat, Err(Unsolved::Dependent));
    let nowhere = zero(|_| None, |_| 1.0, 3.0, &wide());
    let update = f64::INFINITY;
    assert_eq!(nowhere, Err(Unsolved::Ceases { at: Vector1::new(3.0), update }));
}

/// Newton's method on √x − 1 leads from 9 to −3, where the root does not exist, and half of the way
/// back to 3.
#[test]
fn half_an_update_leads_back() {
    let root = |x: f64| (x >= 0.0).then(|| x.sqrt() - 1.0);
    let slope = |x: f64| 0.5 / x.sqrt();
    let back = Limits { retreat: 1e-6, ..Limits::new(20.0, 1e-12) };
    assert!((zero(root, slope, 9.0, &back).expect("a zero").at.x - 1.0).abs() < 1e-15);
    let found = zero(root, slope, 9.0, &Limits::new(20.0, 1e-12));
    assert_eq!(found, Err(Unsolved::Ceases { at: Vector1::new(-3.0), update: 12.0 }));
}

/// Places beyond a bound are moved to it. A search that is led beyond it twice leaves.
#[test]
fn a_bound_holds_a_search() {
    let held = |bound: f64| {
        let Ok(found) = solve(&Vector1::new(1.0), &wide(), |at, _| {
            at.x = at.x.min(bound);
            let local = (Vector1::new(at.x * at.x - 4.0), Some(Vector1::new(2.0 * at.x)));
            Ok::<_, Infallible>(Some(local))
        });
        found
    };
    assert!((held(2.25).expect("a zero").at.x - 2.0).abs() < 1e-15);
    assert_eq!(held(1.75), Err(Unsolved::Leaves));
}

/// The roots of 1, 2, 3 … together.
#[test]
fn the_number_of_unknowns_may_be_known_at_run_time() {
    for number in [1, 2, 3, 7] {
        let squares = DVector::from_fn(number, |row, _| (row + 1) as f64);
        let start = DVector::repeat(number, 1.5);
        let Ok(found) = solve(&start, &wide(), |at: &mut DVector<f64>, _| {
            let slopes = DMatrix::from_diagonal(&(2.0 * &*at));
            Ok::<_, Infallible>(Some((at.component_mul(at) - &squares, Some(slopes))))
        });
        let at = found.expect("a zero").at;
        assert!((at.component_mul(&at) - squares).amax() < 1e-14);
    }
}

#[test]
fn derivatives_are_used_again_while_updates_shrink_fast() {
    let found = |reuse: f64| {
        let mut asked = 0;
        let limits = Limits { reuse, ..wide() };
        let Ok(found) = solve(&Vector2::new(0.9, 0.9), &limits, |at, steep| {
            let values = *at + 1e-3 * Vector2::new(at.y * at.y, at.x * at.x) - Vector2::repeat(1.0);
            asked += usize::from(steep);
            let slopes = steep.then(|| Matrix2::new(1.0, 2e-3 * at.y, 2e-3 * at.x, 1.0));
            Ok::<_, Infallible>(Some((values, slopes)))
        });
        (found.expect("a zero").at, asked)
    };
    let [(first, often), (second, rarely)] = [0.0, 0.01].map(found);
    assert!((first - second).norm() < 1e-14);
    assert!(often > 2 && rarely == 1, "{often} and {rarely}");
}
