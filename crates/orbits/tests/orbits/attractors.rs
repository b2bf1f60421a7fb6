//! Exponents, sections, diagrams and basins against closed forms.

use std::sync::Arc;

use stickslip_expression::System;
use stickslip_orbits::{Attractor, Guess, Orbit, OrbitError, OrbitWatch, Orbits, Section};

use crate::impact;

fn orbits(text: &str) -> Orbits {
    Orbits::new(&System::parse(text).expect("a system")).expect("orbits")
}

/// x goes to m min(x, 1 − x) once in a unit of time: its exponent is log m, chaotic as it is.
const TENT: &str = "parameter m = 1.9\nstate x = 0.3\nx' = 0\nevery 1 from 1 \"folds\"\n  x := \
                    m*min(x, 1 - x)\nend = 9";

#[test]
fn a_tent_map_has_its_exponent() {
    let orbits = orbits(TENT);
    let found = orbits.exponents(&[1.9], &Guess::default(), 10.5, 1000.0).expect("exponents");
    assert!((found.values[0] - 1.9_f64.ln()).abs() < 1e-12 && found.spread < 1e-11, "{found:?}");
    assert_eq!((found.values.len(), found.events), (1, 1000));
    let section = Section { rule: "folds", skip: 0.5, time: 20.0 };
    let points = orbits.section(&[1.9], &Guess::default(), &section).expect("points");
    assert_eq!(points.len(), 20);
    // The clock ticks at the start too.
    let mut x = 1.9 * 0.3_f64;
    for point in points {
        assert!((point.state[0] - x).abs() < 1e-9, "{point:?} {x}");
        x = 1.9 * x.min(1.0 - x);
    }
}

/// Two rules that change nothing vanish together: each has its points, whichever is listed first.
#[test]
fn rules_that_vanish_together_have_their_points() {
    let (turn, top) = ("when v crosses 0 \"turn\"\n", "when v falls through 0 \"top\"\n");
    for rules in [[turn, top], [top, turn]] {
        let text = format!("state x = 0, v = 1\nx' = v\nv' = -x\n{}end = 9", rules.concat());
        for (rule, count) in [("turn", 6), ("top", 3)] {
            let section = Section { rule, skip: 0.0, time: 20.0 };
            let points = orbits(&text).section(&[], &Guess::default(), &section).expect("points");
            assert_eq!(points.len(), count, "{rule} of {rules:?}");
        }
    }
}

/// Along an orbit, exponents are the logarithms of its multipliers over the period.
#[test]
fn exponents_of_an_orbit_are_its_multipliers() {
    let orbits = impact::orbits();
    let values = orbits.system().values();
    let guess = Guess { itinerary: &["impact", "phase"], ..Guess::default() };
    let orbit = orbits.find(&values, &guess).expect("an orbit");
    let found = orbits.exponents(&values, &Guess::default(), 300.0, 3000.0).expect("exponents");
    // Both multipliers have the size √(e² e^(−cT)), and the phase neither grows nor shrinks.
    let size = orbit.largest_multiplier().ln() / orbit.period;
    assert!(found.values[0].abs() < 1e-3, "{found:?}");
    let pair = [found.values[1], found.values[2]];
    assert!((pair[0] + pair[1] - 2.0 * size).abs() < 1e-3, "{found:?} {size}");
    assert!(pair.iter().all(|it| (it - size).abs() < 5e-3), "{found:?} {size}");
    // Where a block sticks, it forgets where it was.
    let text = include_str!("../../../../examples/orbits/sticking.slip");
    let sticking = self::orbits(text);
    let mut values = sticking.system().values();
    values[0] = 0.8;
    let orbit = sticking.settled(&values, &Guess::default(), 400.0).expect("an orbit");
    let found = sticking.exponents(&values, &Guess::default(), 400.0, 2000.0).expect("exponents");
    let [zero, size, lost] = found.values[..] else { panic!("{found:?}") };
    assert!(zero.abs() < 1e-3 && lost == f64::NEG_INFINITY, "{found:?}");
    let exact = orbit.largest_multiplier().ln() / orbit.period;
    assert!((size - exact).abs() < 2e-3 * exact.abs() + 1e-3, "{found:?} {exact}");
}

/// x' = m + x − x³ has two attractors for |m| < 2/√27. A diagram keeps the one that it is on.
#[test]
fn a_diagram_keeps_its_attractor() {
    let orbits = orbits(
        "parameter m = 0\nstate x = 0.1\nx' = m + x - x^3\nevery 1 from 0.5 \"looks\"\nend = 9",
    );
    let values: Vec<f64> = (0..41).map(|k| -0.6 + 0.03 * f64::from(k)).collect();
    let section = Section { rule: "looks", skip: 99.0, time: 2.0 };
    let diagram =
        || orbits.diagram(&[0.0], &Guess::default(), (0, &values), &section).expect("a diagram");
    let [up, down] = diagram();
    let edge = 2.0 / 27.0_f64.sqrt();
    for (columns, sign) in [(&up, -1.0), (&down, 1.0)] {
        assert_eq!(columns.len(), 41);
        for column in columns {
            let [one, other] = &column.points[..] else { panic!("{column:?}") };
            let (x, m) = (one.state[0], column.value);
            assert!(column.trouble.is_none() && (x - other.state[0]).abs() < 1e-6, "{column:?}");
            assert!((m + x - x.powi(3)).abs() < 1e-6, "{column:?}");
            // It leaves its side where that ends, and not before.
            let stays = m * sign > -edge;
            assert_eq!(x * sign > 0.0, stays, "{column:?}");
        }
    }
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
    assert_eq!(alone.install(diagram), [up, down]);
}

/// A damped oscillator in two wells, and a rule that ends runs that climb out.
#[test]
fn basins_of_two_wells() {
    let orbits = orbits(
        "parameter c = 0.5\nstate x = 0, v = 0\nx' = v\nv' = x - x^3 - c*v\nwhen x > 3 \"out\" \
         -> end\nend = 9",
    );
    let values: Vec<f64> = (0..9).map(|k| -2.0 + 0.5 * f64::from(k)).collect();
    let speeds = [-0.1, 0.1, 9.0];
    let basins = |c: f64| {
        orbits.basins(&[c], &Guess::default(), [0, 1], [&values, &speeds], 100.0).expect("basins")
    };
    let found = basins(0.5);
    assert_eq!((found.labels.len(), found.attractors.len()), (27, 3));
    let mut wells = Vec::new();
    for attractor in &found.attractors {
        match attractor {
            Attractor::Rest { mode: 0, state } => wells.push(state[0].round()),
            other => assert_eq!(other, &Attractor::End { mode: 0, rule: 0 }),
        }
    }
    wells.sort_by(f64::total_cmp);
    assert_eq!(wells, [-1.0, 1.0]);
    // Near a well and slow, a run stays there; and it cannot climb out without energy.
    for (k, x) in values.iter().enumerate().filter(|(_, x)| (x.abs() - 1.0).abs() < 0.25) {
        for row in 0..2 {
            let label = found.labels[9 * row + k].expect("an attractor");
            let Attractor::Rest { state, .. } = &found.attractors[label] else { panic!("{x}") };
            assert!((state[0] - x.signum()).abs() < 1e-3, "{x} {state:?}");
        }
    }
    // The fast row leaves on the right.
    assert!(
        found.labels[18..].iter().all(|it| {
            it.is_some_and(|it| matches!(found.attractors[it], Attractor::End { .. }))
        })
    );
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
    assert_eq!(alone.install(|| basins(0.5)), found);
    // Without damping nothing settles.
    let none = basins(0.0);
    assert!(none.labels[..18].iter().all(Option::is_none), "{none:?}");
}

/// Where a ball on a table has two orbits, a run belongs to one of them.
#[test]
fn basins_of_a_bouncing_ball_hold_its_orbit() {
    let orbits = orbits(crate::ball::TEXT);
    let heights = [0.0165, 0.02];
    let found = orbits.basins(
        &orbits.system().values(),
        &Guess::default(),
        [0, 1],
        [&heights, &[0.5]],
        300.0,
    );
    let found = found.expect("basins");
    let Attractor::Orbit(orbit) = &found.attractors[0] else { panic!("{found:?}") };
    assert!((orbit.period - 1.0).abs() < 1e-12 && orbit.is_admissible() && orbit.is_stable());
    assert_eq!(found.labels[0], Some(0));
}

#[test]
fn what_has_no_section_is_refused() {
    let orbits = orbits(TENT);
    let guess = Guess::default();
    let section = Section { rule: "falls", skip: 0.0, time: 1.0 };
    let said = orbits.section(&[1.9], &guess, &section).expect_err("refused").to_string();
    assert!(
        said.contains("the section = \"falls\"; expected a rule of the system, which has folds"),
        "{said}"
    );
    let none = Section { rule: "folds", time: 0.0, ..section };
    assert!(orbits.section(&[1.9], &guess, &none).is_err());
    assert!(orbits.exponents(&[1.9], &guess, 1.0, f64::NAN).is_err());
    let none = orbits.basins(&[1.9], &guess, [0, 0], [&[1.0], &[1.0]], 1.0);
    assert!(none.is_err());
    // A component that only itself reads has to come back all the same.
    let decay = "state x = 1\nx' = -x\nevery 1 from 1 \"adds\"\n  x := x + 1\nend = 9";
    let orbits = self::orbits(decay);
    let guess = Guess { itinerary: &["adds"], ..Guess::default() };
    let orbit = orbits.find(&[], &guess).expect("an orbit");
    let exact = 1.0 / (1.0 - (-1.0_f64).exp());
    assert!((orbit.segments[0].state[0] - exact).abs() < 1e-11, "{orbit:?}");
    let [[size, _]] = orbit.multipliers.as_deref().expect("no graze") else { panic!("one") };
    assert!((size - (-1.0_f64).exp()).abs() < 1e-11);
}

/// A run that comes to an orbit from both sides in turn repeats after two rounds before it does
/// after one. The orbit goes around once.
#[test]
fn an_orbit_goes_around_once() {
    let text = "state x = 1.02\nx' = -0.01*(x - 1)\nevery 1 \"tick\"\n  x := 1 - 0.98*(x - 1)";
    let orbits = orbits(text);
    let multiplier = -0.98 * (-0.01_f64).exp();
    let is_once = |orbit: &Orbit| {
        let once = (orbit.period - 1.0).abs() < 1e-12 && orbit.segments.len() == 1;
        once && (orbit.multipliers.as_ref().expect("some")[0][0] - multiplier).abs() < 1e-12
    };
    // The distance is 1.0e-3 then, and falls by 0.06 of it in two rounds.
    let orbit = orbits.settled(&[], &Guess::default(), 100.5).expect("an orbit");
    assert!(is_once(&orbit), "{orbit:?}");
    // A phase begins anew at 0, but for rounding.
    let text = text.replace("state x = 1.02", "state x = 1.02, y = 0, phase = 0");
    let text = format!("{text}\n  phase := phase - 1\ny' = -y\nphase' = 1");
    let orbits = self::orbits(&text);
    let starts = [1.0, 1.02];
    let found = orbits.basins(&[], &Guess::default(), [0, 1], [&starts, &[0.0]], 120.5);
    let found = found.expect("basins");
    let [Attractor::Orbit(orbit)] = &found.attractors[..] else { panic!("{found:?}") };
    assert_eq!((orbit.segments.len(), &found.labels[..]), (1, &[Some(0), Some(0)][..]));
}

/// An infection dies out under pulses of vaccination: runs come to the orbit without it.
#[test]
fn what_dies_out_is_no_other_attractor() {
    let orbits = orbits(
        "state S = 0.6, I = 0.01\nS' = 0.02*(1 - S) - 1.8*S*I\nI' = 1.8*S*I - 0.92*I\n\
         every 2 \"pulse\"\n  S := 0.7*S",
    );
    let found = orbits.basins(&[], &Guess::default(), [0, 1], [&[0.3, 0.9], &[0.01, 0.2]], 600.0);
    let found = found.expect("basins");
    let [Attractor::Orbit(orbit)] = &found.attractors[..] else { panic!("{found:?}") };
    assert!(orbit.segments[0].state[1].abs() < 1e-12 && orbit.is_stable(), "{orbit:?}");
    assert_eq!(found.labels, [Some(0); 4]);
}

#[test]
fn a_watch_knows_the_steps_and_stops_them() {
    let section = Section { rule: "folds", skip: 0.5, time: 20.0 };
    let (orbits, guess, values) = (orbits(TENT), Guess::default(), [1.8, 1.85, 1.9]);
    let watched = |work: &dyn Fn(&Orbits)| {
        let watch = Arc::new(OrbitWatch::default());
        work(&orbits.watched(Arc::clone(&watch)));
        watch.progress()
    };
    let diagram = |own: &Orbits| own.diagram(&[1.9], &guess, (0, &values), &section).map(drop);
    assert_eq!(watched(&|own| diagram(own).expect("a diagram")), (6, 6));
    let run = |own: &Orbits| own.section(&[1.9], &guess, &section).map(drop);
    assert_eq!(watched(&|own| run(own).expect("points")), (1000, 1000));
    let exponents = |own: &Orbits| own.exponents(&[1.9], &guess, 0.5, 20.0).map(drop);
    assert_eq!(watched(&|own| exponents(own).expect("exponents")), (2000, 2000));
    let stopped = orbits.watched(Arc::default());
    stopped.watch().stop();
    assert_eq!(diagram(&stopped), Err(OrbitError::Stopped));
    assert!(run(&stopped).is_err() && exponents(&stopped).is_err());
}
