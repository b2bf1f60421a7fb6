//! Input that has no orbit.

use stickslip_expression::System;
use stickslip_orbits::{BranchOptions, Guess, OrbitError, Orbits, RegionOptions};

use crate::impact;

fn message(text: &str, itinerary: &[&str]) -> String {
    let system = System::parse(text).expect("a system");
    let orbits = match Orbits::new(&system) {
        Ok(orbits) => orbits,
        Err(error) => return error.to_string(),
    };
    let guess = Guess { itinerary, ..Guess::default() };
    orbits.find(&system.values(), &guess).expect_err("no orbit").to_string()
}

#[test]
fn errors_say_what_and_where() {
    let decay = "state x = 1\nx' = -x\nwhen x falls through 0.5 \"half\"\nend = 1";
    assert!(
        message(decay, &["haf"])
            .contains("itinerary = \"haf\"; expected a rule of mode main, which has half")
    );
    let never = "state x = 1\nx' = -x\nwhen x > 2 \"high\"\nend = 1";
    let said = message(never, &["high"]);
    assert!(said.contains("segment 0: rule `high` does not act within"), "{said}");
    assert!(message(decay, &[]).contains("the number of segments = 0"));
    let many = vec!["half"; 10_000];
    assert!(message(decay, &many).contains("10000 is out of range; expected 1 to 600"));
    let jumps = "state x = 1, v = 0\nx' = v\nv' = if x > 0 then -1 else 1\nend = 1";
    assert!(message(jumps, &["a"]).contains("equations that jump within a mode"));
    let two = "state x = 1, y = 1\nx' = -sign(x)\ny' = -sign(y)\nsliding on x = 0, y = 0\nend = 1";
    assert!(message(two, &["arrives 1"]).contains("expected modes with one surface at most"));
    let modes = "state x = 0\nmode a\n  x' = 1\n  when x > 1 \"up\" -> b\nmode b\n  x' = -1\n  \
                 when x < 0 \"down\" -> a\nstart in a\nend = 1";
    assert!(message(modes, &["up"]).contains("ends in mode b; expected one that ends in mode a"));
    let time = "state x = 1\nx' = -x + cos(t)\nwhen x < 0.2 \"low\"\n  x := x + 1\nend = 1";
    assert!(message(time, &["low"]).contains("expected a rule `every …`"));
    let other = "state x = 1\nx' = -x + cos(t)\nevery 5 from 0 \"tick\"\nend = 1";
    assert!(
        message(other, &["tick"]).contains("itinerary repeats after 5.0, and equations do not"),
        "{}",
        message(other, &["tick"])
    );
    // The event does not depend on the start.
    let zero = "state x = 0, y = 0\nx' = 0\ny' = 1\nwhen y > 1 \"a\"\n  y := 0\nend = 1";
    assert!(message_of(zero, &["a"]).is_ok_and(|period| (period - 1.0).abs() < 1e-14));
    // A damped spring has no orbit through its zero but the point itself.
    let spring = "state x = 1, v = 0\nx' = v\nv' = -x - 0.2*v\nwhen v falls through 0 \"top\"\n\
                  end = 1";
    assert!(
        message(spring, &["top"]).starts_with("no orbit near the guess"),
        "{}",
        message(spring, &["top"])
    );
}

fn message_of(text: &str, itinerary: &[&str]) -> Result<f64, String> {
    let system = System::parse(text).expect("a system");
    let orbits = Orbits::new(&system).map_err(|error| error.to_string())?;
    let guess = Guess { itinerary, ..Guess::default() };
    let found = orbits.find(&system.values(), &guess).map_err(|error| error.to_string());
    found.map(|orbit| orbit.period)
}

#[test]
fn clocks_of_other_periods_are_seen() {
    // The table has the period 1, and the clock another one: the slopes alone do not show it.
    let text = include_str!("../../../../examples/orbits/ball.slip");
    let other = text.replace("every 2*pi/w from pi/w", "every 1.5 from 0.5");
    let system = System::parse(&other).expect("a system");
    let orbits = Orbits::new(&system).expect("orbits");
    let guess = Guess { itinerary: &["period", "bounce"], ..Guess::default() };
    let found = orbits.find(&system.values(), &guess);
    assert!(!found.is_ok_and(|orbit| orbit.is_admissible()));
    // What happens later is not in the orbit.
    let late = text.replace("start at", "at 1000 \"kick\"\n  v := v + 1\nstart at");
    let system = System::parse(&late).expect("a system");
    let orbits = Orbits::new(&system).expect("orbits");
    let orbit = orbits.find(&system.values(), &guess).expect("an orbit");
    let stickslip_orbits::Verdict::Undecided(reason) = &orbit.verdict else {
        panic!("{:?}", orbit.verdict)
    };
    assert!(reason.contains("`kick`"), "{reason}");
}

#[test]
fn what_nothing_reads_need_not_come_back() {
    let neuron = "parameter drive = 1.5, tau = 1\nstate v = 0\ndiscrete spikes = 0\n\
                  v' = (drive - v)/tau\nwhen v > 1 \"spike\"\n  v := 0\n  spikes := spikes + 1\n\
                  end = 100";
    let system = System::parse(neuron).expect("a system");
    let orbits = Orbits::new(&system).expect("orbits");
    let guess = Guess { itinerary: &["spike"], ..Guess::default() };
    let found = orbits.find(&system.values(), &guess).expect("an orbit");
    let settled = orbits.settled(&system.values(), &Guess::default(), 30.0).expect("an orbit");
    for orbit in [found, settled] {
        assert!((orbit.period - 3.0_f64.ln()).abs() < 1e-13, "{orbit:?}");
        assert!(orbit.is_admissible());
        assert_eq!(orbit.multipliers, Some(vec![]));
    }
}

#[test]
fn branches_refuse_what_they_cannot_follow() {
    let orbits = impact::orbits();
    let guess = Guess { itinerary: &["impact", "phase"], ..Guess::default() };
    let values = orbits.system().values();
    let orbit = orbits.find(&values, &guess).expect("an orbit");
    let options = BranchOptions::default();
    let refused = |parameter, range, options: &BranchOptions| {
        orbits.branch(&orbit, parameter, range, options).expect_err("refused").to_string()
    };
    assert!(refused(9, [0.0, 1.0], &options).contains("the parameter = 9"));
    assert!(refused(3, [2.0, 1.0], &options).contains("LO:HI"));
    assert!(refused(3, [2.0, 3.0], &options).contains("a = 1.0 is out of range"));
    assert!(refused(3, [0.0, f64::NAN], &options).contains("LO:HI"));
    let none = BranchOptions { first_step: 0.0, ..options };
    assert!(refused(3, [0.0, 2.0], &none).contains("first_step"));
    // An orbit of another system, or one that was made by hand.
    let mut other = orbit.clone();
    other.segments[0].leg.rule = 7;
    assert!(orbits.branch(&other, 3, [0.0, 2.0], &options).is_err());
    other.segments[0].state.pop();
    assert!(orbits.continued(&other, &values).is_err());
    other.segments.clear();
    assert!(orbits.course(&other, 3).is_err());
    other.parameters.clear();
    assert!(orbits.branch(&other, 3, [0.0, 2.0], &options).is_err());
    let wrong = orbits.find(&values[..3], &guess).expect_err("refused");
    assert!(matches!(wrong, OrbitError::Value(_)));
    let state = [f64::NAN, 0.0, 0.0];
    let nan = Guess { state: Some(&state), ..guess };
    assert!(matches!(orbits.find(&values, &nan), Err(OrbitError::Value(_))));
    let ball = System::parse(
        "state x = 1, v = 0\nx' = v\nv' = -1\nwhen x < 0 \"b\"\n  x := 0\n  v := -0.5*v\nend = 1",
    )
    .expect("it");
    let orbits = Orbits::new(&ball).expect("orbits");
    let found = orbits.find(&[], &Guess { itinerary: &["b"], ..Guess::default() });
    assert!(
        matches!(found, Err(OrbitError::NoLength { .. } | OrbitError::NotFound { .. })),
        "{found:?}"
    );
}

/// Files of somebody who did not design this: each is an orbit, or an error that says where.
#[test]
fn strange_guesses_are_answered() {
    let relay = "state x = 0\nmode up\n  x' = 1 - x\n  when x > 0.5 \"up\" -> down\nmode down\n  x' \
                 = -1 - x\n  when x < -0.5 \"down\" -> up\nstart in up\nend = 9";
    let system = System::parse(relay).expect("a system");
    let orbits = Orbits::new(&system).expect("orbits");
    let (itinerary, far) = (["up", "down"], [1e300]);
    let guess = Guess { itinerary: &itinerary, ..Guess::default() };
    // Durations that lead nowhere, and a state from which the search has far to go.
    let answered = |guess: &Guess<'_>| match orbits.find(&[], guess) {
        Ok(orbit) => assert!((orbit.period - 2.0 * 3.0_f64.ln()).abs() < 1e-11, "{orbit:?}"),
        Err(error) => assert!(!error.to_string().is_empty()),
    };
    for durations in [[f64::NAN, 1.0], [0.0, 0.0], [1.0, f64::INFINITY], [-1.0, 1.0], [1e300, 1.0]]
    {
        answered(&Guess { durations: Some(&durations), ..guess });
    }
    answered(&Guess { state: Some(&far), ..guess });
    // Three rounds are an orbit of three times the period; half a round is none.
    let rounds = ["up", "down"].repeat(3);
    let found = orbits.find(&[], &Guess { itinerary: &rounds, ..guess }).expect("an orbit");
    assert!((found.period - 6.0 * 3.0_f64.ln()).abs() < 1e-11 && found.is_admissible());
    let wrong = orbits.find(&[], &Guess { itinerary: &["down", "up"], ..guess });
    assert!(wrong.is_err_and(|it| it.to_string().contains("mode up, which has up")));
    for time in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let said = orbits.settled(&[], &Guess::default(), time).expect_err("refused");
        assert!(said.to_string().contains("the time to settle"), "{said}");
    }
    // A condition that is zero throughout, one that ends runs, and a rule at given times.
    let both = "state x = 0, y = 0\nx' = 1\ny' = 1\nwhen x > y \"never\"\n  x := 0\n  y := 0\n\
                when x > 2 \"out\" -> end\nat 1 \"once\"\n  x := 0\nend = 9";
    for (rule, expected) in [
        ("never", "segment 0"),
        ("out", "a rule that never ends a run"),
        ("once", "a rule that acts again and again"),
    ] {
        let said = message(both, &[rule]);
        assert!(said.contains(expected), "{rule}: {said}");
    }
    // A run that a rule ends, or that does nothing at all.
    let ends = System::parse("state x = 0\nx' = 1\nwhen x > 2 \"out\" -> end").expect("a system");
    let orbits = Orbits::new(&ends).expect("orbits");
    let said = orbits.settled(&[], &Guess::default(), 9.0).expect_err("no orbit").to_string();
    assert!(said.contains("a rule ends it"), "{said}");
    let still = System::parse("state x = 1\nx' = 0*x\nend = 9").expect("a system");
    let orbits = Orbits::new(&still).expect("orbits");
    let said = orbits.settled(&[], &Guess::default(), 9.0).expect_err("no orbit").to_string();
    assert!(said.contains("its last 0 events do not repeat"), "{said}");
}

/// Every kind of input that has no orbit, and what is said of it.
#[test]
fn what_cannot_be_an_orbit_is_named() {
    let said = |text: &str, itinerary: &[&str], durations: Option<&[f64]>| {
        let system = System::parse(text).expect("a system");
        let orbits = Orbits::new(&system).expect("orbits");
        let guess = Guess { itinerary, durations, ..Guess::default() };
        orbits.find(&system.values(), &guess).expect_err("no orbit")
    };
    // A condition that is zero throughout, by its formula or along the solution.
    let zero = "parameter k = 0\nstate x = 0, y = 0\nx' = 1\ny' = 1\nwhen k*x > 0 \"still\"\n  \
                x := 0\nwhen x > y \"same\"\n  x := 0\n  y := 0\nend = 9";
    let still = said(zero, &["still"], Some(&[1.0]));
    assert!(matches!(still, OrbitError::StillGuard { segment: 0, .. }), "{still}");
    assert!(still.to_string().contains("rule `still` is zero or constant throughout"), "{still}");
    let same = said(zero, &["same"], Some(&[1.0])).to_string();
    assert!(same.starts_with("no orbit near the guess") && same.contains("segment 0"), "{same}");
    // The rule acts at once, and the orbit is a point.
    let point = "state x = 1\nx' = -1\nwhen x < 0 \"floor\"\n  x := 0\nend = 9";
    let length = said(point, &["floor"], None);
    assert!(matches!(length, OrbitError::NoLength { .. }), "{length}");
    assert!(length.to_string().contains("which is a point"), "{length}");
    // The flow of a guess grows beyond all numbers before its rule acts.
    let far = "state x = 1\nx' = x^2\nwhen x < 0 \"below\"\n  x := 1\nend = 9";
    let run = said(far, &["below"], None).to_string();
    assert!(run.contains("segment 0"), "{run}");
    let long = vec!["floor"; 10_000];
    assert!(said(point, &long, None).to_string().contains("10000 is out of range"));
}

/// At a graze a multiplier is infinite: there are none, and the orbit is not stable.
#[test]
fn a_multiplier_at_infinity_is_none() {
    let orbits = impact::orbits();
    let closed = impact::Closed { w: 0.8, ..impact::Closed::EXAMPLE };
    let closed = impact::Closed { a: closed.impedance(), ..closed };
    let orbit = impact::near(&orbits, &closed, 0.0, 0.0).expect("an orbit");
    assert!(orbit.segments.last().expect("segments").end[1].abs() < 1e-10);
    assert_eq!(orbit.multipliers, None);
    assert!(orbit.largest_multiplier() == f64::INFINITY && !orbit.is_stable());
    assert!(matches!(orbit.verdict, stickslip_orbits::Verdict::Undecided(_)));
}

#[test]
fn regions_refuse_what_they_cannot_follow() {
    let orbits = impact::orbits();
    let guess = Guess { itinerary: &["impact", "phase"], ..Guess::default() };
    let orbit = orbits.find(&orbits.system().values(), &guess).expect("an orbit");
    let refused = |parameters, window, options: &RegionOptions| {
        orbits.regions(&orbit, parameters, window, options).expect_err("refused").to_string()
    };
    let (usual, window) = (RegionOptions::default(), [[0.5, 1.5], [0.5, 1.5]]);
    assert!(refused([3, 3], window, &usual).contains("the places of two parameters"));
    assert!(refused([3, 9], window, &usual).contains("the parameter = 9"));
    assert!(refused([3, 4], [[2.0, 3.0], [0.5, 1.5]], &usual).contains("a = 1.0 is out of range"));
    assert!(refused([3, 4], [[1.5, 0.5], [0.5, 1.5]], &usual).contains("LO:HI"));
    let none = RegionOptions { cells: 0, ..usual };
    assert!(refused([3, 4], window, &none).contains("cells = 0"));
    let exact = RegionOptions { tolerance: 0.0, ..usual };
    assert!(refused([3, 4], window, &exact).contains("tolerance"));
}
