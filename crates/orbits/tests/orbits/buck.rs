//! A buck converter against matrix exponentials.

use nalgebra::{Matrix2, Vector2};
use stickslip_expression::System;
use stickslip_orbits::{BranchOptions, Guess, Orbits, SpecialKind};

use crate::branches::values;

const TEXT: &str = include_str!("../../../../examples/orbits/converter.slip");

const T: f64 = 4e-4;

/// The orbit at a voltage, by matrix exponentials: when it switches on, its state at the start of a
/// period, and the derivative of the return.
fn exact(source: f64) -> (f64, Vector2<f64>, Matrix2<f64>) {
    let (r, l, c) = (22.0, 0.02, 4.7e-5);
    let matrix = Matrix2::new(-1.0 / (r * c), 1.0 / c, -1.0 / l, 0.0);
    let input = Vector2::new(0.0, source / l);
    let inverse = matrix.try_inverse().expect("regular");
    let at = |on: f64| {
        let whole = (matrix * T).exp();
        let last = (matrix * (T - on)).exp();
        let pushed = inverse * (last - Matrix2::identity()) * input;
        (Matrix2::identity() - whole).try_inverse().expect("regular") * pushed
    };
    let distance = |on: f64| {
        let state = (matrix * on).exp() * at(on);
        8.4 * (state.x - 11.3) - 3.8 - 4.4 * on / T
    };
    let (mut low, mut high) = (0.0, T);
    assert!(distance(low) > 0.0 && distance(high) < 0.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if distance(middle) > 0.0 { low = middle } else { high = middle }
    }
    let (on, first) = (low, (matrix * low).exp());
    let state = at(on);
    let off = matrix * (first * state);
    let rate = 8.4 * off.x - 4.4 / T;
    let saltation = Matrix2::identity() + input * Vector2::new(8.4, 0.0).transpose() / rate;
    (on, state, (matrix * (T - on)).exp() * saltation * first)
}

#[test]
fn a_buck_converter_flips() {
    let orbits = Orbits::new(&System::parse(TEXT).expect("a system")).expect("orbits");
    let mut parameters = orbits.system().values();
    let (on, state, monodromy) = exact(20.0);
    let start = [state.x * 1.0001, state.y * 0.999, 0.0];
    let guess = Guess { state: Some(&start), itinerary: &["begins", "clock"], ..Guess::default() };
    let orbit = orbits.find(&parameters, &guess).expect("an orbit");
    assert!((orbit.segments[0].duration - on).abs() < 1e-10 * T);
    assert!((orbit.segments[0].state[0] - state.x).abs() < 1e-10);
    let multipliers = orbit.multipliers.clone().expect("no graze");
    let trace: f64 = multipliers.iter().map(|it| it[0]).sum();
    assert_eq!(multipliers.len(), 2);
    assert!((trace - monodromy.trace()).abs() < 1e-9, "{trace} {}", monodromy.trace());
    assert!(orbit.is_admissible());

    let branch = orbits.branch(&orbit, 0, [15.0, 40.0], &BranchOptions::default());
    let branch = branch.expect("a branch");
    // det(M + I) = 0 by matrix exponentials.
    let test = |source: f64| (exact(source).2 + Matrix2::identity()).determinant();
    let (mut low, mut high) = (20.0, 30.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if (test(middle) > 0.0) == (test(low) > 0.0) { low = middle } else { high = middle }
    }
    let flip = values(&branch, SpecialKind::Flip);
    println!("flip at {low}: {flip:?}");
    assert!((flip[0] - low).abs() < 1e-9 && (low - 24.5).abs() < 0.2, "{flip:?} {low}");
    // The orbit to which a run settles is the same.
    parameters[0] = 20.0;
    let settled = orbits.settled(&parameters, &Guess::default(), 0.2).expect("an orbit");
    assert!((settled.period - T).abs() < 1e-14 && settled.segments.len() == 2);
}
