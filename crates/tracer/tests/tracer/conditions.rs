//! Points solved by conditions: what a search says where there is none, and how exact it is.

use std::convert::Infallible;

use nalgebra::{DMatrix, DVector, Dyn, Matrix2, U1, U2, Vector1, Vector2};
use stickslip_tracer::conditions::{Conditions, Limits, Unsolved, Zero, solve};

/// A function of one unknown, with its slope.
struct Function<V, S>(V, S);

impl<V: Fn(f64) -> Option<f64>, S: Fn(f64) -> f64> Conditions<U1> for Function<V, S> {
    type Error = Infallible;

    fn values(&mut self, at: &Vector1<f64>) -> Result<Option<Vector1<f64>>, Infallible> {
        Ok(self.0(at.x).map(Vector1::new))
    }

    fn slopes(
        &mut self,
        at: &Vector1<f64>,
        _: &Vector1<f64>,
    ) -> Result<Option<Vector1<f64>>, Infallible> {
        Ok(Some(Vector1::new(self.1(at.x))))
    }
}

fn zero(
    value: impl Fn(f64) -> Option<f64>,
    slope: impl Fn(f64) -> f64,
    start: f64,
    limits: &Limits,
) -> Result<Zero<U1>, Unsolved<U1>> {
    let Ok(found) = solve(&mut Function(value, slope), Vector1::new(start), limits);
    found
}

const WIDE: Limits = Limits::new(10.0, 1e-12);

#[test]
fn a_simple_zero_is_exact() {
    let found = zero(|x| Some(x * x - 2.0), |x| 2.0 * x, 1.0, &WIDE).expect("a zero");
    assert!((found.at.x - 2.0_f64.sqrt()).abs() < 1e-15);
    assert_eq!(found.error, 1e-11);
}

/// Updates for a double zero halve: forty of them are not enough from a distance of 1e3, and the
/// square rule must not take them for those of a simple zero.
#[test]
fn a_double_zero_is_slow() {
    let square = Limits { square: 1e-3, ..Limits::new(1e4, 1e-12) };
    let found = zero(|x| Some(x * x), |x| 2.0 * x, 1e3, &square);
    let Err(Unsolved::Slow { at, update }) = found else { panic!("{found:?}") };
    assert!(at.x > 0.0 && at.x < 1e-8 && update < 1e-8);
}

/// Noise keeps updates at 1e-9. They end the search if the noise is known.
#[test]
fn noise_ends_a_search() {
    let noisy = |x: f64| Some(x + 1e-9 * (1e12 * x).cos().signum());
    let limits = Limits { noise: 1e-9, ..WIDE };
    let found = zero(noisy, |_| 1.0, 0.5, &limits).expect("a zero");
    assert!(found.at.x.abs() <= found.error && found.error == 1e-8);
}

#[test]
fn what_has_no_zero_says_why() {
    let line = zero(|x| Some(x - 20.0), |_| 1.0, 0.0, &WIDE);
    assert_eq!(line, Err(Unsolved::Leaves));
    let flat = zero(|_| Some(1.0), |_| 0.0, 0.0, &WIDE);
    assert_eq!(flat, Err(Unsolved::Dependent));
    let nowhere = zero(|_| None, |_| 1.0, 3.0, &WIDE);
    let update = f64::INFINITY;
    assert_eq!(nowhere, Err(Unsolved::Ceases { at: Vector1::new(3.0), update }));
}

/// Newton's method on 1 − √x leads from 9 to −3, where the root does not exist, and back to 3.
#[test]
fn half_an_update_leads_back() {
    let root = |x: f64| (x >= 0.0).then(|| x.sqrt() - 1.0);
    let slope = |x: f64| 0.5 / x.sqrt();
    let back = Limits { retreat: 1e-6, ..WIDE };
    assert!((zero(root, slope, 9.0, &back).expect("a zero").at.x - 1.0).abs() < 1e-15);
    let found = zero(root, slope, 9.0, &WIDE);
    assert_eq!(found, Err(Unsolved::Ceases { at: Vector1::new(-3.0), update: 12.0 }));
}

/// The roots of 1, 2, 3 … together, as many as are wanted at run time.
struct AnyNumber;

impl Conditions<Dyn> for AnyNumber {
    type Error = Infallible;

    fn values(&mut self, at: &DVector<f64>) -> Result<Option<DVector<f64>>, Infallible> {
        let target = DVector::from_fn(at.len(), |row, _| (row + 1) as f64);
        Ok(Some(at.component_mul(at) - target))
    }

    fn slopes(
        &mut self,
        at: &DVector<f64>,
        _: &DVector<f64>,
    ) -> Result<Option<DMatrix<f64>>, Infallible> {
        Ok(Some(DMatrix::from_diagonal(&(2.0 * at))))
    }
}

#[test]
fn the_number_of_unknowns_may_be_known_at_run_time() {
    for number in [1, 2, 3, 7] {
        let start = DVector::repeat(number, 1.5);
        let Ok(found) = solve(&mut AnyNumber, start, &WIDE);
        let at = found.expect("a zero").at;
        assert!(at.iter().enumerate().all(|(row, x)| (x * x - (row + 1) as f64).abs() < 1e-14));
    }
}

/// A condition counts its derivatives.
struct Counted(usize);

impl Conditions<U2> for Counted {
    type Error = Infallible;

    fn values(&mut self, at: &Vector2<f64>) -> Result<Option<Vector2<f64>>, Infallible> {
        Ok(Some(Vector2::new(at.x + 1e-3 * at.y * at.y - 1.0, at.y + 1e-3 * at.x * at.x - 1.0)))
    }

    fn slopes(
        &mut self,
        at: &Vector2<f64>,
        _: &Vector2<f64>,
    ) -> Result<Option<Matrix2<f64>>, Infallible> {
        self.0 += 1;
        Ok(Some(Matrix2::new(1.0, 2e-3 * at.y, 2e-3 * at.x, 1.0)))
    }
}

#[test]
fn derivatives_are_used_again_while_updates_shrink_fast() {
    let (mut often, mut rarely) = (Counted(0), Counted(0));
    let start = Vector2::new(0.9, 0.9);
    let Ok(first) = solve(&mut often, start, &WIDE);
    let Ok(second) = solve(&mut rarely, start, &Limits { reuse: 0.01, ..WIDE });
    assert!((first.expect("a zero").at - second.expect("a zero").at).norm() < 1e-14);
    assert!(often.0 > 2 && rarely.0 == 1, "{} and {}", often.0, rarely.0);
}
