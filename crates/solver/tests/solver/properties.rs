//! What must hold of every run, for a bounded number of random systems. The fuzz targets in `fuzz/`
//! check the same for as long as they run.

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::{RngAlgorithm, TestError, TestRng, TestRunner};
use stickslip_solver::StepSize;

use crate::checks;

/// Checks `cases` values, which are the same every time.
fn hold<S: Strategy>(cases: u32, strategy: &S, check: impl Fn(S::Value) -> Result<(), String>) {
    let config = ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() };
    let rng = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let ran = TestRunner::new_with_rng(config, rng)
        .run(strategy, |value| check(value).map_err(TestCaseError::fail));
    if let Err(TestError::Fail(reason, value)) = ran {
        panic!("{reason}\nminimal: {value:?}");
    }
}

#[test]
fn polynomials_as_guards() {
    hold(20_000, &vec(any::<u8>(), 0..16), |bytes| checks::polynomials(&bytes));
}

/// The coefficients of the polynomial with these roots, which are given in 64ths.
fn with_roots(roots: &[u8], factor: f64) -> [f64; checks::COEFFICIENTS] {
    let mut coefficients = [0.0; checks::COEFFICIENTS];
    coefficients[0] = factor;
    for &root in roots {
        let root = f64::from(root) / 64.0;
        for i in (0..checks::COEFFICIENTS).rev() {
            let before = if i == 0 { 0.0 } else { coefficients[i - 1] };
            coefficients[i] = before - root * coefficients[i];
        }
    }
    coefficients
}

#[test]
fn polynomials_with_common_roots() {
    let others = || vec(1..64_u8, 0..4);
    let factors = prop::sample::select(vec![1.0, -1.0, 0.25, -3.0]);
    let step = prop_oneof![
        Just(StepSize::Adaptive),
        // Many of these steps end on a root.
        (1..128_u8).prop_map(|part| StepSize::Fixed(f64::from(part) / 128.0)),
    ];
    hold(5000, &(1..64_u8, others(), others(), factors, step), |case| {
        let (common, one, other, factor, step) = case;
        // The roots are simple, because rounding near a double root may show a wrong sign.
        let [one, other] = [one, other].map(|mut roots| {
            roots.push(common);
            roots.sort_unstable();
            roots.dedup();
            roots
        });
        checks::signs([with_roots(&one, factor), with_roots(&other, 1.0)], step)
    });
}

/// Guards that vanish together, and once fired by turns without end.
#[test]
fn common_roots_found_before() {
    let cases = [
        (vec![16_u8, 32], vec![16, 32, 48], StepSize::Fixed(0.25)),
        (vec![32], vec![32], StepSize::Adaptive),
        (vec![36, 37], vec![20, 36, 37], StepSize::Fixed(1.0 / 128.0)),
        (vec![36, 37], vec![20, 36, 37], StepSize::Fixed(7.0 / 64.0)),
    ];
    for (one, other, step) in cases {
        checks::signs([with_roots(&one, 1.0), with_roots(&other, -2.0)], step).unwrap();
    }
}

#[test]
fn short_expressions_as_systems() {
    hold(750, &vec(any::<u8>(), 0..100), |bytes| checks::expressions(&bytes));
}

#[test]
fn long_expressions_as_systems() {
    hold(750, &vec(any::<u8>(), 100..200), |bytes| checks::expressions(&bytes));
}

/// Faults that fuzzing found.
#[test]
fn faults_found_before() {
    // A guard with a double root at the end of the span. It fires between two steps that are too
    // short to show the scatter of its values.
    checks::polynomials(&[0x82, 0x02, 0x80, 0x00, 0x00, 0x00, 0xfd, 0x01, 0xff, 0xff, 0x01])
        .unwrap();
    // A guard that is not a number at its own minimum, and a guard that fires where the right-hand
    // side is infinite.
    checks::expressions(&[
        0x1b, 0xe9, 0xe9, 0xe9, 0xe9, 0xe9, 0xe9, 0xe9, 0xe9, 0xe9, 0xe9, 0xe9, 0xe9, 0xe9, 0xe9,
        0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x31, 0x3d, 0x01, 0x03, 0xb1, 0xb0, 0xb0, 0xb0,
        0xb0, 0xb0, 0xb0, 0xb0, 0xb0, 0xb0, 0xb0, 0xff, 0x31, 0x3d, 0x01, 0x03, 0xb1, 0xb1, 0x27,
        0x27, 0x27, 0xff, 0x01, 0xae, 0xce, 0xc5, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff,
        0xff, 0xff, 0xff, 0xff, 0xbf, 0x59, 0x2c,
    ])
    .unwrap();
    checks::expressions(&[
        0x80, 0x7e, 0x80, 0x03, 0x01, 0x80, 0x43, 0x00, 0x03, 0xf7, 0xf7, 0xf7, 0x03, 0x01, 0x77,
        0xce, 0x01, 0x1a, 0x01, 0xff, 0x01, 0xf7, 0xf7, 0xf7, 0xf7, 0xf7, 0xf7, 0x01, 0xf7, 0xf7,
        0x53, 0x53, 0x53, 0x53, 0x53, 0x53, 0xf7, 0x53, 0x53, 0x53, 0x53, 0x53, 0xf7, 0xf7, 0xf5,
        0xf7, 0xf7, 0xf7, 0xf7, 0xf7, 0xf7, 0x01, 0xf7, 0xf7, 0xff, 0x09, 0xbe, 0xbe, 0xbc, 0x10,
        0xb8, 0xb8, 0xbe, 0x03, 0x57, 0x57, 0x57,
    ])
    .unwrap();
}
