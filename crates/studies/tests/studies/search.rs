//! Searches with known answers, and their failures.

use stickslip_model::InvalidValue;
use stickslip_studies::search::{change, highest, maximum, maximum_near, root};

#[derive(Debug, PartialEq)]
enum Failure {
    Search(String),
    Broken,
}

impl From<InvalidValue> for Failure {
    fn from(error: InvalidValue) -> Self {
        Self::Search(error.to_string())
    }
}

#[test]
fn maxima_between_and_at_the_places() {
    let wave = |x: f64| Ok::<_, Failure>((x - 0.3).cos() + 0.1 * x);
    let places: Vec<f64> = (0..20).map(|i| 0.2 * f64::from(i) - 1.0).collect();
    let found = maximum(&places, wave).unwrap();
    assert!((found.at - (0.3 + 0.1_f64.asin())).abs() < 1e-7);
    let end = maximum(&places, Ok::<_, Failure>).unwrap();
    assert_eq!(end.at, places[19]);
    let [single, equal] = [&[2.0][..], &[2.0, 2.0]].map(|places| maximum(places, wave).unwrap());
    assert_eq!([single.at, equal.at], [2.0; 2]);
    let none = maximum(&[], Ok::<_, Failure>).unwrap_err();
    let expected = "a search has no places to start from; expected at least one";
    assert_eq!(none, Failure::Search(expected.to_owned()));
}

#[test]
fn a_maximum_of_two_variables() {
    let hill =
        |[x, y]: [f64; 2]| Ok::<_, Failure>(-(x - 1.0).powi(2) - 3.0 * (y + 0.5).powi(2) - x * y);
    let found = maximum_near([0.0, 0.0], [0.1, 0.1], hill).unwrap();
    // Where 2(x − 1) + y = 0 and 6(y + 1/2) + x = 0.
    assert!((found.at[0] - 15.0 / 11.0).abs() < 1e-6 && (found.at[1] + 8.0 / 11.0).abs() < 1e-6);
}

#[test]
fn maxima_and_zeros_by_brent_s_method() {
    let top = highest((1.0, 3.0), 1e-8, |x| Ok::<_, Failure>(-(x - 1.7).powi(2))).unwrap();
    assert!((top - 1.7).abs() < 1e-7);
    let zero = root((1.0, 3.0), |x| Ok::<_, Failure>(x * x - 2.0)).unwrap();
    assert!((zero - 2.0_f64.sqrt()).abs() < 1e-13);
}

#[test]
fn a_zero_needs_values_of_two_signs() {
    let positive = |x: f64| Ok::<_, Failure>(x * x + 1.0);
    let expected =
        "Brent's method for a zero failed from 1 to 3; expected values of two signs at the ends";
    assert_eq!(root((1.0, 3.0), positive), Err(Failure::Search(expected.to_owned())));
}

#[test]
fn a_change_is_found_to_rounding() {
    let root = change(1.0, 2.0, |x| Ok::<_, Failure>(x * x < 2.0)).unwrap();
    assert!((root - 2.0_f64.sqrt()).abs() <= f64::EPSILON);
}

#[test]
fn failures_come_through() {
    let broken = |_| Err(Failure::Broken);
    assert_eq!(maximum(&[0.0, 1.0], broken).unwrap_err(), Failure::Broken);
    let near = maximum_near([0.0, 0.0], [0.1, 0.1], |_| Err(Failure::Broken));
    assert_eq!(near.unwrap_err(), Failure::Broken);
    assert_eq!(highest((0.0, 1.0), 1e-8, broken), Err(Failure::Broken));
    assert_eq!(root((0.0, 1.0), broken), Err(Failure::Broken));
    assert_eq!(change(0.0, 1.0, |_| Err(Failure::Broken)), Err(Failure::Broken));
}

#[test]
fn a_change_between_any_two_numbers_is_found_or_nan() {
    let below = |x: f64| Ok::<_, Failure>(x < 0.5);
    assert!((change(0.0, 1.0, below).unwrap() - 0.5).abs() < 1e-15);
    assert!((change(-f64::MAX, f64::MAX, below).unwrap() - 0.5).abs() < 1e-15);
    assert_eq!(change(3.0, 3.0, below).unwrap(), 3.0);
    for (from, to) in [(f64::NAN, 1.0), (0.0, f64::NAN), (f64::NEG_INFINITY, f64::INFINITY)] {
        assert!(change(from, to, below).unwrap().is_nan(), "{from} {to}");
    }
}
