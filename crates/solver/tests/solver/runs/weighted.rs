//! Tolerances of components.

use stickslip_solver::{
    Closures, Dop853, EmbeddedPair, HybridSystem, Options, State, Weighted, run, run_backwards,
    run_with,
};

use super::{Wave, at, ball};
use crate::erased;

#[test]
fn equal_tolerances_of_components_change_nothing() {
    let ball = ball();
    let options = Options { rtol: 1e-8, atol: 1e-9, ..Options::default() };
    let weighted = Weighted::new(&ball, [(1e-8, 1e-9); 2]).unwrap();
    for pair in EmbeddedPair::ALL {
        let one = erased::run_with(pair, &ball, at(0.0, [1.0, 0.0]), 3.0, &options, &mut ());
        let other = run_with(pair, &weighted, at(0.0, [1.0, 0.0]), 3.0, &options, &mut ());
        assert_eq!(erased::but_guards(one), erased::but_guards(other));
    }
    const { assert!(<Weighted<Wave, 1> as HybridSystem<1, 1>>::READABLE) };
}

#[test]
fn each_component_has_its_tolerance() {
    // Two oscillators of very different speed, each with its error at the end.
    let field = |_s: f64, y: &State<4>| State::from([y[1], -y[0], 30.0 * y[3], -30.0 * y[2]]);
    let system = Closures::new(field);
    let go = |slow: f64, fast: f64| {
        let tolerances = [(slow, slow), (slow, slow), (fast, fast), (fast, fast)];
        let weighted = Weighted::new(&system, tolerances).unwrap();
        let start = at(0.0, [0.0, 1.0, 0.0, 1.0]);
        let end = run(Dop853, &weighted, start, 3.0, &Options::default(), &mut ()).unwrap();
        let back = run_backwards(Dop853, &weighted, start, -3.0, &Options::default(), &mut ());
        assert_eq!(back.unwrap().statistics, end.statistics);
        let error = |i: usize, speed: f64| (end.state[i] - (3.0 * speed).sin()).abs();
        (error(0, 1.0), error(2, 30.0), end.statistics.accepted)
    };
    let (_, strict, many) = go(1e-11, 1e-11);
    let (slow, loose, few) = go(1e-11, 1e-4);
    assert!(strict < 1e-8 && many > 2 * few, "{strict} {many} {few}");
    assert!(loose > 1e-6 && loose < 0.1 && slow < 1e-9, "{loose} {slow}");
}

#[test]
fn tolerances_of_components_are_checked() {
    let ball = ball();
    let refused = |tolerances| {
        let error = Weighted::new(&ball, tolerances).err()?;
        Some((error.name.into_owned(), error.value))
    };
    let invalid = |name: &str, value: f64| Some((name.to_owned(), value.into()));
    assert_eq!(refused([(1e-6, 1e-6), (1e-15, 1e300)]), None);
    assert_eq!(refused([(1e-6, 1e-6), (0.2, 1.0)]), invalid("rtol of a component", 0.2));
    assert_eq!(refused([(1e-6, 0.0), (0.2, 1.0)]), invalid("atol of a component", 0.0));
    assert!(refused([(f64::NAN, 1.0), (1e-3, 1.0)]).is_some());
    assert!(refused([(1e-3, f64::INFINITY), (1e-3, 1.0)]).is_some());
}

/// An error beyond the range of doubles is compared with the tolerances of the components too.
#[test]
fn a_component_may_have_a_tolerance_that_is_relative_only() {
    // The first component stays near zero, and has an error there.
    let field = |s: f64, y: &State<2>| State::from([1e-20 * (50.0 * s).sin(), -y[1]]);
    let system = Closures::new(field);
    let options = Options { rtol: 0.1, atol: 0.1, ..Options::default() };
    for pair in EmbeddedPair::ALL {
        let tolerances = [(1e-6, f64::MIN_POSITIVE), (1e-12, 1e-12)];
        let weighted = Weighted::new(&system, tolerances).unwrap();
        let end = run_with(pair, &weighted, at(0.0, [0.0, 1.0]), 1.0, &options, &mut ()).unwrap();
        assert!((end.state[1] - (-1.0_f64).exp()).abs() < 1e-11, "{end:?}");
        let exact = 1e-20 * (1.0 - 50.0_f64.cos()) / 50.0;
        assert!((end.state[0] / exact - 1.0).abs() < 1e-4, "{end:?}");
    }
}
