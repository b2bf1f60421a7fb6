//! Random guards whose zeros are known.

use fastrand::Rng;
use stickslip_solver::{Direction, Dop853, Dopri5, Guard, Method, Options};

use super::{Plain, go, places};

/// Checks that a guard of the time along an oscillation has exactly the zeros `expected`.
fn check<M: Method>(
    method: M,
    guard: impl Fn(f64) -> f64,
    expected: &[f64],
    direction: Direction,
    guard_scale: Option<f64>,
    error: f64,
) -> Result<(), String> {
    let system = Plain {
        field: |_s, y: &[f64], f: &mut [f64]| (f[0], f[1]) = (y[1], -y[0]),
        guards: vec![Guard::new(direction)],
        values: |s, _y: &[f64], v: &mut [f64]| v[0] = guard(s),
    }
    .boxed();
    let options = Options { guard_scale, ..Options::default() };
    let mut found = Vec::new();
    let run = go(method, &system, &[0.0, 1.0], 1.0, &options, &mut found);
    let run = run.map_err(|error| error.to_string())?;
    assert!(run.finished().is_ok());
    let found = places(&found);
    let right = found.len() == expected.len()
        && found.iter().zip(expected).all(|((s, _), root)| (s - root).abs() <= error);
    right.then_some(()).ok_or_else(|| format!("{found:?} instead of {expected:?}"))
}

fn all_right(case: impl Fn(&mut Rng) -> Result<(), String>) {
    let mut rng = Rng::with_seed(7);
    let wrong: Vec<String> = (0..150).filter_map(|_| case(&mut rng).err()).collect();
    assert!(wrong.is_empty(), "{} of 150 are wrong: {:#?}", wrong.len(), &wrong[..1]);
}

#[test]
fn steep_guards() {
    for exponent in [4, 5, 6, 7, 8] {
        let k = 10_f64.powi(exponent);
        all_right(|rng| {
            let root = 0.01 + 0.98 * rng.f64();
            let (sign, direction) =
                if rng.bool() { (1.0, Direction::Rising) } else { (-1.0, Direction::Falling) };
            let guard = |s: f64| sign * (k * (s - root)).tanh();
            check(Dop853, guard, &[root], direction, None, 1e-14)?;
            check(Dopri5, guard, &[root], Direction::Either, None, 1e-14)
        });
    }
}

#[test]
fn sines_with_many_roots() {
    all_right(|rng| {
        let omega = 1.0 + 199.0 * rng.f64();
        let phase = 6.0 * rng.f64();
        let zero = |k: i32| (std::f64::consts::PI * f64::from(k) - phase) / omega;
        let expected: Vec<f64> =
            (0..100).map(zero).filter(|root| (0.0..=1.0).contains(root)).collect();
        let near_an_end = |root: &f64| root.min(1.0 - root) < 1e-9;
        if expected.iter().any(near_an_end) {
            return Ok(());
        }
        let guard = |s: f64| (omega * s + phase).sin();
        let scale = Some(1.0 / omega);
        check(Dop853, guard, &expected, Direction::Either, scale, 1e-14)?;
        check(Dopri5, guard, &expected, Direction::Either, scale, 1e-14)
    });
}

#[test]
fn pairs_that_are_nearly_tangent() {
    all_right(|rng| {
        let middle = 0.05 + 0.9 * rng.f64();
        let half = 10_f64.powf(-1.5 - 5.0 * rng.f64());
        let guard = |s: f64| (s - (middle - half)) * (s - (middle + half));
        let expected = [middle - half, middle + half];
        check(Dop853, guard, &expected, Direction::Either, None, 1e-14)?;
        check(Dopri5, guard, &expected, Direction::Either, None, 1e-14)?;
        // And those that just miss.
        let misses = |s: f64| (s - middle) * (s - middle) + half * half;
        check(Dop853, misses, &[], Direction::Either, None, 0.0)?;
        check(Dopri5, misses, &[], Direction::Either, None, 0.0)
    });
}

#[test]
fn short_dips_with_a_scale() {
    all_right(|rng| {
        let middle = 0.1 + 0.8 * rng.f64();
        let half = 10_f64.powf(-1.0 - 3.0 * rng.f64());
        let guard = |s: f64| 1.0 - 2.0 * (-((s - middle) / half).powi(2)).exp();
        let reach = half * 2.0_f64.ln().sqrt();
        let expected = [middle - reach, middle + reach];
        check(Dop853, guard, &expected, Direction::Either, Some(half), 1e-14)?;
        check(Dopri5, guard, &expected, Direction::Either, Some(half), 1e-14)
    });
}
