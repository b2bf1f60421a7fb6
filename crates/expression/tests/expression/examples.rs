//! The systems in `examples/systems` against closed forms.

use std::f64::consts::PI;
use std::path::PathBuf;

use stickslip_expression::{Recording, System};
use stickslip_solver::{EmbeddedPair, Options};

/// A run of an example, whose text must be in the usual form.
fn recorded(name: &str) -> (System, Recording) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../examples/systems").join(name);
    let text = std::fs::read_to_string(path).expect("an example");
    assert_eq!(stickslip_expression::format(&text).expect("a system"), text);
    let system = System::parse(&text).unwrap_or_else(|error| panic!("{error}"));
    let runnable = system.with(&system.values()).expect("parameters");
    let found = runnable.record(EmbeddedPair::Dop853, runnable.end(), &Options::default());
    let found = found.expect("a run");
    assert!(found.run.decided);
    (system, found)
}

/// Times of events.
fn times(name: &str) -> Vec<f64> {
    recorded(name).1.events.iter().map(|event| event.s).collect()
}

#[track_caller]
fn near(found: f64, expected: f64, error: f64) {
    assert!((found - expected).abs() < error, "{found} instead of {expected}");
}

#[test]
fn all_examples_are_tested() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../examples/systems");
    let here = include_str!("examples.rs");
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let name = entry.expect("an entry").file_name().into_string().expect("a name");
        assert!(here.contains(&format!("(\"{name}\")")), "{name}");
    }
}

#[test]
fn ball() {
    let times = times("ball.slip");
    assert_eq!(times.len(), 5);
    for (found, expected) in times.into_iter().zip([1.0, 2.0, 2.5, 2.75, 2.875]) {
        near(found, expected, 1e-13);
    }
}

#[test]
fn bangbang() {
    let (_, found) = recorded("bangbang.slip");
    near(found.events[0].s, 1.0, 1e-12);
    near(found.run.s, 2.0, 1e-12);
    near(found.run.state[0], 0.0, 1e-12);
}

#[test]
fn belt() {
    let times = times("belt.slip");
    near(times[0], 2.0, 1e-12);
    near(times[1] - times[0], 2.0 * (PI - 0.8_f64.atan()), 1e-9);
    // It begins to stick at x = 0.2.
    near(times[2] - times[1], 0.8 / 0.5, 1e-9);
}

/// Between events, the converter is a damped circuit; at an event, the voltage is on the ramp.
#[test]
fn buck() {
    let (system, found) = recorded("buck.slip");
    let [source, r, l, c, low, high, period, gain, reference] = system.values()[..] else {
        panic!("nine parameters")
    };
    let (decay, frequency) = (0.5 / (r * c), (1.0 / (l * c) - 0.25 / (r * c).powi(2)).sqrt());
    assert!(found.events.len() > 40);
    for pair in found.events.windows(2) {
        let (from, to) = (&pair[0], &pair[1]);
        let conducts = system.modes[from.to].name == "conducting";
        let rest = if conducts { source } else { 0.0 };
        let (v, slope) = (from.after[0] - rest, (from.after[1] - from.after[0] / r) / c);
        let t = to.s - from.s;
        let (sine, cosine) = (frequency * t).sin_cos();
        let swing = v * cosine + (slope + decay * v) / frequency * sine;
        near(to.before[0], rest + (-decay * t).exp() * swing, 1e-8);
        // The ramp jumps with the clock, and a rule may act there at once.
        if to.from != to.to && t > 0.0 {
            let ramp = low + (high - low) * (to.s - to.before[2]) / period;
            near(gain * (to.before[0] - reference), ramp, 1e-8);
        }
    }
}

/// The model's own coefficients of restitution.
#[test]
fn collision() {
    let (_, found) = recorded("collision.slip");
    let [_, v, time, _, w] = found.run.state[..] else { panic!("five components") };
    near(-v, 0.8928588754972, 1e-11);
    near(w, 0.0913013288485, 1e-11);
    near(time, 3.157255655813, 1e-11);
}

/// Before the first impact: x = A cos t + C cos 2t with C = 1/(1 − 4).
#[test]
fn impact() {
    let (_, found) = recorded("impact.slip");
    let x = |t: f64| (0.5 + 1.0 / 3.0) * t.cos() - (2.0 * t).cos() / 3.0;
    let first = found.events[0].s;
    near(x(first), 0.0, 1e-10);
    assert!((0..1000).all(|k| x(first * f64::from(k) / 1000.0) > 0.0));
    near(found.at(1.0).expect("within the run")[0], x(1.0), 1e-9);
}

#[test]
fn neuron() {
    let times = times("neuron.slip");
    assert_eq!(times.len(), 9);
    for (index, found) in times.into_iter().enumerate() {
        near(found, (index as f64 + 1.0) * 3.0_f64.ln(), 1e-9);
    }
}

#[test]
fn relay() {
    let times = times("relay.slip");
    near(times[0], 2.0_f64.ln(), 1e-10);
    assert!(times.windows(2).all(|pair| (pair[1] - pair[0] - 3.0_f64.ln()).abs() < 1e-9));
}

/// Each half swing starts with the part e of the velocity.
#[test]
fn rocking() {
    let times = times("rocking.slip");
    near(times[0], 2.0_f64.acosh() / 2.0, 1e-10);
    // φ = −α + α cosh pt − (e v/p) sinh pt returns after (2/p) artanh(e v/(α p)).
    let mut v = 0.2 * 2.0 * 0.5 * 3.0_f64.sqrt();
    for pair in times.windows(2) {
        v *= 0.9;
        near(pair[1] - pair[0], (v / 0.4).atanh(), 1e-9);
    }
}

#[test]
fn table() {
    let (_, found) = recorded("table.slip");
    let [a, w, e, g] = [0.01, 60.0, 0.5, 9.81];
    let first = &found.events[0];
    near(0.3 - 0.5 * g * first.s.powi(2), a * (w * first.s).sin(), 1e-12);
    let table = a * w * (w * first.s).cos();
    near(first.after[1], (1.0 + e) * table + e * g * first.s, 1e-10);
}

#[test]
fn tank() {
    let times = times("tank.slip");
    let (q, c) = (0.1, 0.5);
    // With the root u of the level, dt = 2u du/(q − c u).
    let u = |level: f64| level.sqrt() + q / c * (q - c * level.sqrt()).abs().ln();
    let drains = 2.0 / c * (u(2.0) - u(1.0));
    near(times[0], 5.0, 1e-11);
    near(times[1] - times[0], drains, 1e-9);
    near(times[2] - times[1], 10.0, 1e-9);
}

#[test]
fn thermostat() {
    let (_, found) = recorded("thermostat.slip");
    let times: Vec<f64> = found.events.iter().map(|event| event.s).collect();
    let (first, cools, heats) =
        ((15.0_f64 / 9.0).ln(), (16.0_f64 / 14.0).ln(), (11.0_f64 / 9.0).ln());
    near(times[0], first, 1e-10);
    near(times[1] - times[0], cools, 1e-10);
    near(times[2] - times[1], heats, 1e-10);
    let last = found.events.len() / 2;
    near(found.run.state[1], 1.0 + last as f64, 1e-15);
    near(found.run.state[2], first + (last as f64 - 1.0) * heats, 1e-8);
}

/// What a recording knows between events and on both sides of them.
#[test]
fn recordings() {
    let (_, found) = recorded("ball.slip");
    for t in [0.0, 0.3, 0.999, 1.5, 2.9] {
        let into = if t < 1.0 { t } else { t - 1.0 };
        let free = if t < 1.0 { 4.905 - 4.905 * into * into } else { 4.905 * into * (1.0 - into) };
        if t < 2.0 {
            near(found.at(t).expect("within the run")[0], free, 1e-11);
        }
    }
    assert_eq!(found.at(found.events[1].s), Some(found.events[1].after.clone()));
    assert!(found.at(-0.1).is_none() && found.at(2.91).is_none() && found.at(f64::NAN).is_none());
    let curve = found.curve(4);
    assert!(curve.windows(2).all(|pair| pair[0].0 <= pair[1].0));
    let (_, thermostat) = recorded("thermostat.slip");
    let stays = thermostat.stays();
    assert_eq!(stays.len(), thermostat.events.len() + 1);
    assert!(stays.windows(2).all(|pair| pair[0].to == pair[1].from));
    assert_eq!(thermostat.mode_at(0.6), 1);
}
