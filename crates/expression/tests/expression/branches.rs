//! Equations that branch: their branches are events of which nobody is told.

use stickslip_expression::{Recording, System};
use stickslip_solver::{EmbeddedPair, Options, Outcome};

fn run(text: &str) -> Recording {
    let system = System::parse(text).unwrap_or_else(|error| panic!("{error}"));
    let runnable = system.with(&system.values()).expect("parameters");
    runnable.record(EmbeddedPair::Dop853, runnable.end(), &Options::default()).expect("a run")
}

/// The last state, after a run without events.
fn last(text: &str) -> Vec<f64> {
    let found = run(text);
    assert!(found.events.is_empty() && found.touches.is_empty(), "{text}\n{:?}", found.events);
    assert_eq!(found.run.outcome, Outcome::ReachedEnd);
    found.run.state
}

#[test]
fn a_pulse_is_seen_however_short_it_is() {
    for width in [1e-1, 1e-4, 1e-8, 1e-11] {
        let pulse = format!(
            "state x = 0\nx' = if t > 1.5 and t < {} then {} else 0\nend = 10",
            1.5 + width,
            1.0 / width
        );
        let x = last(&pulse)[0];
        // The times are rounded.
        assert!((x - 1.0).abs() < 1e-13 + 2e-15 / width, "{width}: {x}");
        let state = format!(
            "state x = 0, y = 0\nx' = 1\ny' = if x > 3 and x < {} then {} else 0\nend = 10",
            3.0 + width,
            1.0 / width
        );
        let y = last(&state)[1];
        assert!((y - 1.0).abs() < 1e-12 + 1e-14 / width, "{width}: {y}");
    }
}

#[test]
fn branches_are_as_exact_as_what_is_smooth() {
    // x″ = −x − ½ sign x from (1, 0) keeps its energy.
    let text = "state x = 1, v = 0\nx' = v\nv' = -x - 0.5*sign(x)\nend = 20";
    let energy = |x: f64, v: f64| 0.5 * (v * v + x * x) + 0.5 * x.abs();
    let state = last(text);
    assert!((energy(state[0], state[1]) - 1.0).abs() < 1e-9, "{state:?}");
    // A square wave, and stairs.
    let x = last("state x = 0\nx' = if t % 1 < 0.3 then 1 else -1\nend = 10.1")[0];
    assert!((x - (10.0 * (0.3 - 0.7) + 0.1)).abs() < 1e-13, "{x}");
    let x = last("state x = 0\nx' = floor(t) + floor(-2*t)\nend = 3.25")[0];
    let stairs: f64 = (0..13).map(|k| (f64::from(k) / 4.0).floor() * 0.25).sum();
    let down: f64 = (0..13).map(|k| -0.25 * (f64::from(k / 2) + 1.0)).sum();
    assert!((x - (stairs + down)).abs() < 1e-13, "{x} {}", stairs + down);
}

#[test]
fn branches_begin_where_rules_lead() {
    // A reset carries the state across a condition, and a mode begins on one.
    let x = last("state x = 0, y = 0\nx' = 1\ny' = if x > 5 then 1 else 0\nend = 10")[1];
    assert!((x - 5.0).abs() < 1e-13);
    let found = run(
        "state x = 0, y = 0\nx' = 1\ny' = if x > 5 then 1 else 0\nat 2\n  x := 8\nat 4\n  x := 0\nend = 6",
    );
    assert!((found.run.state[1] - 2.0).abs() < 1e-13, "{:?}", found.run.state);
    assert_eq!(found.events.len(), 2);
    let text = "state v = 1, x = 0\nmode stick\n  v' = 0\n  x' = v\n  at 1 -> slip\nmode slip\n  x' = v\n  \
                v' = -0.5*sign(v - 1) - (v - 1) - 1\nstart in stick\nend = 2";
    // v falls from 1 with −1 − (v − 1) + ½: towards ½, behind v = 1 − ½(1 − e^−τ).
    let found = run(text);
    let right = 1.0 - 0.5 * (1.0 - (-1.0_f64).exp());
    assert!((found.run.state[0] - right).abs() < 1e-9, "{:?} {right}", found.run.state);
}

#[test]
fn where_both_sides_push_back_equations_choose_as_they_are_written() {
    let found = run("state v = 1\nv' = -sign(v)\nend = 1.00001");
    assert!(found.run.state[0].abs() < 1e-9 && found.events.is_empty(), "{:?}", found.run);
}

#[test]
fn events_are_those_of_rules_alone() {
    let text = "state x = 0, v = 1\nx' = v\nv' = if x > 0.5 then -2 else -1\nwhen x < 0 \"floor\"\n  \
                x := 0\n  v := -0.9*v\nend = 10";
    let found = run(text);
    assert!(found.events.iter().all(|event| event.guard == 0 && event.after.len() == 2));
    assert_eq!(found.run.state.len(), 2);
    assert!(found.steps().iter().all(|step| step.coefficients.len() % 2 == 0));
    // It rises up to ½, and the first bounce is as fast as the start.
    let first = &found.events[0];
    assert!((first.s - 2.0).abs() < 1e-8, "{first:?}");
    for (t, x) in [(0.5, 0.375), (1.0, 0.5), (1.5, 0.375)] {
        assert!((found.at(t).expect("within the run")[0] - x).abs() < 1e-8);
    }
    let mut events = Vec::new();
    let system = System::parse(text).expect("a system").with(&[]).expect("parameters");
    let run = system.events(EmbeddedPair::Dop853, 10.0, &Options::default(), &mut events);
    assert_eq!((events, run.expect("a run").state), (found.events, found.run.state));
}

#[test]
fn a_curve_goes_through_events_that_change_nothing() {
    let found = run("state x = 0\nx' = if t < 1 then 1 else -1\nwhen x > 0.4 \"high\"\nend = 2");
    let curve = found.curve(4);
    assert!(curve.windows(2).all(|pair| pair[0].0 <= pair[1].0));
    for (t, x) in &curve {
        assert!((x[0] - (1.0 - (t - 1.0).abs())).abs() < 1e-12, "{t} {x:?}");
    }
    // The corner is a point of it, and so is the event.
    for place in [0.4, 1.0] {
        assert!(curve.iter().any(|(t, _)| (t - place).abs() < 1e-12), "{curve:?}");
    }
}
