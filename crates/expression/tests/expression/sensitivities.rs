//! Derivatives of runs against closed forms and differences.

use stickslip_expression::{By, Moving, SensitivityError, System};
use stickslip_solver::{EmbeddedPair, Options, Outcome, RunError};

fn parsed(text: &str) -> System {
    System::parse(text).unwrap_or_else(|error| panic!("{error}"))
}

fn options() -> Options {
    Options::with_tolerance(1e-13)
}

fn found(system: &System, by: &[By], parameters: &[f64], end: Option<f64>) -> Vec<Moving> {
    let found = system.sensitivities(by, parameters, EmbeddedPair::Dop853, end, &options());
    found.expect("derivatives").places
}

/// Times and states of the events and of the end.
fn places(system: &System, parameters: &[f64], starts: &[f64], end: Option<f64>) -> Vec<Vec<f64>> {
    let runnable = system.with(parameters).expect("parameters");
    let end = end.unwrap_or(runnable.end());
    let runnable = runnable.starting(None, None, Some(starts)).expect("a start");
    let run = runnable.record(EmbeddedPair::Dop853, end, &options()).expect("a run");
    let events = run.events.iter().map(|it| (it.s, it.before.clone()));
    let all = events.chain(std::iter::once((run.run.s, run.run.state.clone())));
    all.map(|(s, state)| std::iter::once(s).chain(state).collect()).collect()
}

/// Compares derivatives with differences of sixth order.
fn compare(name: &str, text: &str, by: &[By], end: Option<f64>) {
    let system = parsed(text);
    let parameters = system.values();
    let starts = system.with(&parameters).expect("parameters").start().state.to_vec();
    let exact = found(&system, by, &parameters, end);
    for (k, &by) in by.iter().enumerate() {
        let at = |shift: f64| {
            let (mut parameters, mut starts) = (parameters.clone(), starts.clone());
            match by {
                By::Parameter(place) => {
                    parameters[place] += shift;
                    starts = system.with(&parameters).expect("parameters").start().state.to_vec();
                }
                By::Start(place) => starts[place] += shift,
            }
            places(&system, &parameters, &starts, end)
        };
        let h = 1.5e-3;
        let runs: Vec<_> =
            [-3.0, -2.0, -1.0, 1.0, 2.0, 3.0].into_iter().map(|j| at(j * h)).collect();
        let weights = [-1.0, 9.0, -45.0, 45.0, -9.0, 1.0].map(|weight| weight / (60.0 * h));
        for (place, moving) in exact.iter().enumerate() {
            assert!(runs.iter().all(|run| run.len() >= exact.len()), "{name}: {place}");
            let own: Vec<f64> =
                std::iter::once(moving.s_by[k]).chain(moving.state_by[k].clone()).collect();
            for (i, own) in own.iter().enumerate() {
                let difference: f64 =
                    runs.iter().zip(weights).map(|(run, weight)| run[place][i] * weight).sum();
                let scale = own.abs().max(1.0);
                let off = (own - difference).abs() / scale;
                assert!(off < 1e-9, "{name}, {by:?}, place {place}, {i}: {own} {difference}");
            }
        }
    }
}

#[test]
fn a_ball_has_those_of_its_closed_form() {
    let text = "parameter g = 1, e = 0.6, h = 0.5\nstate x = h, v = 0\nx' = v\nv' = -g\n\
                when x < 0\n  x := 0\n  v := -e*v\nend = 2.7";
    let (system, by) = (parsed(text), [0, 1, 2].map(By::Parameter));
    let places = found(&system, &by, &system.values(), None);
    assert_eq!(places.len(), 3);
    // t₁ = √(2h/g), t₂ = t₁(1 + 2e).
    for (place, factor) in places.iter().zip([1.0, 1.0 + 2.0 * 0.6]) {
        assert!((place.s - factor).abs() < 1e-12);
        let expected = [-0.5 * factor, if factor > 1.0 { 2.0 } else { 0.0 }, factor];
        for (own, expected) in place.s_by.iter().zip(expected) {
            assert!((own - expected).abs() < 1e-11, "{own} {expected}");
        }
        // On the floor, x does not move.
        assert!(place.state_by.iter().all(|by| by[0].abs() < 1e-11));
    }
    // Behind the second bounce, with speed e²√(2gh): x = e²·√(2gh)·τ − gτ²/2.
    let end = &places[2];
    let (tau, e): (f64, f64) = (2.7 - 2.2, 0.6);
    let by_e = 2.0 * e * tau - e * e * 2.0 + tau * 2.0;
    assert!((end.state_by[1][0] - by_e).abs() < 1e-11, "{} {by_e}", end.state_by[1][0]);
    assert!(end.s_by.iter().all(|&by| by == 0.0));
}

#[test]
fn a_relay_has_those_of_its_closed_form() {
    let system = parsed(include_str!("../../../../examples/systems/relay.slip"));
    let places = found(&system, &[By::Parameter(0)], &[0.5], Some(6.0));
    let width = 0.5_f64;
    for (k, place) in places[..places.len() - 1].iter().enumerate() {
        // −log(1 − w), and then log((1 + w)/(1 − w)) for each half period.
        let rate = 1.0 / (1.0 - width) + k as f64 * (1.0 / (1.0 + width) + 1.0 / (1.0 - width));
        assert!((place.s_by[0] - rate).abs() < 1e-10 * rate, "{k}: {} {rate}", place.s_by[0]);
    }
}

#[test]
fn others_have_those_of_differences() {
    let example = |name: &str| {
        let path = format!("{}/../../examples/systems/{name}.slip", env!("CARGO_MANIFEST_DIR"));
        std::fs::read_to_string(path).expect("an example")
    };
    let parameters = |count: usize| (0..count).map(By::Parameter).collect::<Vec<_>>();
    compare("belt", &example("belt"), &parameters(3), Some(12.3));
    compare("impact", &example("impact"), &[0, 1].map(By::Parameter), Some(5.2));
    compare("rocking", &example("rocking"), &parameters(1), None);
    let starts = [By::Start(0), By::Start(1)];
    compare("impact from elsewhere", &example("impact"), &starts, Some(5.2));
    // Times of rules and the end that move.
    let clocks = "parameter period = 0.7, phase = 0.2, dose = 0.4, late = 1.3\n\
                  state x = 1\ndiscrete count = 0\nx' = -x*x\n\
                  every period phase phase\n  x := x + dose*x\n  count := count + 1\n\
                  at late, 2*late\n  x := x + sin(t)\nend = 3.1 + 0.1*dose";
    compare("clocks", &clocks.replace("phase phase", "from phase"), &parameters(4), None);
    // A branch, an event that changes nothing, and a rule that ends the run.
    let branch = "parameter push = 0.3, level = 0.2\nstate x = 1, v = 0\nx' = v\n\
                  mode free\n  v' = -x\n  when x crosses 0.5 \"seen\"\n  \
                  when x < level if v < -0.5 -> fast else -> slow\n    v := v - push*x\n\
                  mode fast\n  v' = -x - 0.3*v\n  when x < -0.4 -> end\n\
                  mode slow\n  v' = -2*x\n  when x < -0.4 -> end\nstart in free\nend = 20";
    compare("branch", branch, &[By::Parameter(0), By::Parameter(1), By::Start(1)], None);
    // A guard that depends on time, and a kink of the field.
    let steep = "parameter w = 3, a = 0.4\nstate x = 0, v = 0.3\nx' = v\nv' = -x - abs(x)*a\n\
                 when x > a*sin(w*t) + 0.5\n  v := -0.9*v + a*w*cos(w*t)\nend = 6";
    compare("steep", steep, &[By::Parameter(0), By::Parameter(1)], None);
    // A start that moves, in a mode that parameters choose.
    for late in ["0.4", "0.7"] {
        let start = "parameter p = LATE, q = 1.5\nstate x = q*p, v = 0.3\nx' = v + t*x\n\
                     mode up\n  v' = -q*x + t\n  when x > 2 -> down\n\
                     mode down\n  v' = -2*x*p - 3*t\n  when x < 0.5 -> up\n\
                     start if p < 0.5 in up else down at p + q*p*p\nend = 4";
        let start = start.replace("LATE", late);
        compare("start", &start, &[By::Parameter(0), By::Parameter(1), By::Start(0)], None);
    }
}

#[test]
fn what_has_no_derivatives_is_refused() {
    let system = parsed("parameter p = 1\nstate x = p\nx' = -x\nend = 1");
    let run = |by: &[By]| {
        system.sensitivities(by, &[1.0], EmbeddedPair::Dopri5, None, &Options::default())
    };
    for by in [By::Parameter(1), By::Start(7)] {
        let error = run(&[by]).expect_err("no such place");
        assert!(error.to_string().contains("one of those that the system has"), "{error}");
    }
    assert_eq!(run(&[]).expect("a run").places.len(), 1);
    let error = system.sensitivities(&[], &[1.0], EmbeddedPair::Dop853, Some(-1.0), &options());
    assert!(matches!(error, Err(SensitivityError::Run(RunError::Span { .. }))), "{error:?}");
}

/// The derivatives of the last component at the end.
fn last(text: &str, by: &[By]) -> Result<Vec<f64>, SensitivityError> {
    let system = parsed(text);
    let values = system.values();
    let made = system.sensitivities(by, &values, EmbeddedPair::Dop853, None, &options())?;
    let end = made.places.last().expect("an end");
    Ok(end.state_by.iter().map(|by| *by.last().expect("a component")).collect())
}

#[test]
fn equations_that_jump_have_derivatives() {
    let (p, x, y) = (By::Parameter(0), By::Start(0), By::Start(1));
    for (text, by, right) in [
        // A pulse, also one that no step would see.
        (
            "parameter p = 1\nstate x = 0\nx' = if t < p then 1 else 0\nend = 2",
            &[p, x][..],
            &[1.0, 1.0][..],
        ),
        (
            "parameter p = 1e-7\nstate x = 0\nx' = if t > 1 and t < 1 + p then 1 else 0\nend = 2",
            &[p],
            &[1.0],
        ),
        // A condition on the state, whose rate differs on both sides or not.
        (
            "parameter p = 0.5\nstate x = 0, y = 0\nx' = 1\ny' = if x < p then 3 else 1\nend = 2",
            &[p, x, y],
            &[2.0, -2.0, 1.0],
        ),
        (
            "parameter p = 0.5\nstate x = 0\nx' = if x < p then 1 else 2\nend = 2",
            &[p, x],
            &[-1.0, 2.0],
        ),
        // Friction that changes its sign: v = −½(T − v₀/1.5).
        ("parameter m = 1\nstate v = 1\nv' = -m - 0.5*sign(v)\nend = 2", &[x], &[1.0 / 3.0]),
        // The integral of ⌊pt⌋ is that of jumps at k/p.
        ("parameter p = 1\nstate x = 0\nx' = floor(p*t)\nend = 2.5", &[p], &[3.0]),
        ("parameter p = -1\nstate x = 0\nx' = floor(p*t)\nend = 2.5", &[p], &[3.0]),
        // A square wave, by its duty and by its period.
        (
            "parameter p = 0.3\nstate x = 0\nx' = if t % 1 < p then 1 else 0\nend = 2.5",
            &[p],
            &[3.0],
        ),
        (
            "parameter p = 1\nstate x = 0\nx' = if t % p < 0.3 then 1 else 0\nend = 2.1",
            &[p],
            &[-2.0],
        ),
        // Corners that do not jump, and numbers that do not move.
        ("parameter p = 0.5\nstate x = 0, y = 0\nx' = 1\ny' = abs(x - p)\nend = 2", &[p], &[-1.0]),
        (
            "parameter p = 2\nstate x = 0\nx' = polygon(t, 0: 0, 1: p, 3: p, 4: 0)\nend = 4",
            &[p],
            &[3.0],
        ),
        ("parameter p = 2\nstate x = 0\nx' = if p > 1 then p else 0\nend = 4", &[p], &[4.0]),
        // An event behind the jump, whose state does not move.
        (
            "parameter p = 1\nstate x = 0\nx' = if t < p then 2 else 1\nwhen x > 3 -> end\nend = 9",
            &[p],
            &[0.0],
        ),
    ] {
        let found = last(text, by).unwrap_or_else(|error| panic!("{text}\n{error}"));
        let off = found.iter().zip(right).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(found.len() == right.len() && off < 1e-9, "{text}\n{found:?} {right:?}");
    }
}

#[test]
fn jumps_without_derivatives_are_refused() {
    for (text, reason) in [
        // The condition itself jumps.
        (
            "parameter p = 1\nstate x = 0\nx' = 1\nwhen (if t < p then 1 else -1) falls through 0\nend = 2",
            "jumps over its limit",
        ),
        // The jump comes with an event.
        (
            "parameter p = 1\nstate x = 0\nx' = if t < p then 1 else 0\nat 1\n  x := x + 1\nend = 2",
            "something else",
        ),
    ] {
        let error = last(text, &[By::Parameter(0)]).expect_err(text);
        assert!(error.to_string().contains(reason), "{text}\n{error}");
    }
}

#[test]
fn derivatives_end_where_they_are_stopped() {
    let system = parsed("parameter k = 2\nstate x = 1\nx' = -k*x\nend = 1000");
    let by = [By::Parameter(0)];
    let stops = |s| s > 0.5;
    let pair = EmbeddedPair::Dop853;
    let made = system.sensitivities_unless(&stops, &by, &[2.0], pair, None, &options());
    let found = made.expect("derivatives up to there");
    assert_eq!(found.recording.run.outcome, Outcome::Stopped);
    let end = found.places.last().expect("an end");
    assert!(0.5 < end.s && end.s < 10.0, "{end:?}");
    assert_eq!(end.s_by, [0.0]);
    let exact = -end.s * (-2.0 * end.s).exp();
    assert!((end.state_by[0][0] - exact).abs() < 1e-12, "{end:?}");
}
