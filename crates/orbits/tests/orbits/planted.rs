//! Special orbits of each kind, planted where a closed form puts them.

use std::f64::consts::PI;

use stickslip_expression::System;
use stickslip_orbits::{Branch, BranchOptions, Guess, Orbit, Orbits, SpecialKind};

/// The branch over the first parameter of a system, from the orbit to which it settles.
fn settled(text: &str, range: [f64; 2]) -> Branch {
    let system = System::parse(text).expect("a system");
    let orbits = Orbits::new(&system).expect("orbits");
    let orbit = orbits.settled(&system.values(), &Guess::default(), 200.0).expect("an orbit");
    assert!(orbit.is_admissible(), "{:?}", orbit.verdict);
    orbits.branch(&orbit, 0, range, &BranchOptions::default()).expect("a branch")
}

/// Requires one special orbit of a kind among those where the verdict changes.
fn require(branch: &Branch, kind: SpecialKind, value: f64) {
    let found: Vec<_> = branch.specials.iter().map(|it| (it.kind, it.value)).collect();
    let own: Vec<_> = found.iter().filter(|it| it.0 == kind).collect();
    assert_eq!(own.len(), 1, "{kind:?}: {found:?}");
    assert!((own[0].1 - value).abs() < 1e-10, "{kind:?} at {value}: {found:?}");
    assert!(!found.iter().any(|it| it.0 == SpecialKind::Boundary), "{found:?}");
    assert_eq!(branch.objection, None);
    // The verdict changes there, and nowhere else.
    let side = |above: bool| {
        let all = branch.points.iter().filter(move |it| (it.parameters[0] > value) == above);
        all.map(Orbit::is_admissible).collect::<Vec<_>>()
    };
    for side in [side(false), side(true)] {
        assert!(!side.is_empty() && side.iter().all(|it| *it == side[0]), "{kind:?}: {side:?}");
    }
    assert_ne!(side(false)[0], side(true)[0]);
}

/// A relay with hysteresis 1/2, whose halves take log 3; `since` is the time since it switched.
fn relay(rules: &str) -> String {
    format!(
        "parameter m = 1.3, h = 0.5\nstate x = 0, since = 0\nsince' = 1\nmode up\n  x' = 1 - x\n  \
         {rules}\nmode down\n  x' = -1 - x\n  when x < -h \"down\" -> up\n    since := 0\n\
         mode low\n  x' = -1 - x\n  when x < -h \"down\" -> up\n    since := 0\n\
         start in up\nend = 9"
    )
}

#[test]
fn a_second_condition_at_an_event() {
    let text = relay(
        "when x > h \"up\" -> down\n    since := 0\n  when since > m \"late\" -> low\n    \
         since := 0",
    );
    require(&settled(&text, [0.8, 1.5]), SpecialKind::CornerCollision, 3.0_f64.ln());
}

#[test]
fn a_choice_at_an_event() {
    let text = relay("when x > h \"up\" if since < m -> down else -> low\n    since := 0");
    require(&settled(&text, [0.8, 1.5]), SpecialKind::Choice, 3.0_f64.ln());
}

#[test]
fn a_segment_without_length() {
    // Between the limits the relay waits for m² − 0.09.
    let text = relay(
        "when x > h \"up\" -> wait\n    since := 0\nmode wait\n  x' = 1 - x\n  when since > m^2 - \
         0.09 \"waits\" -> down",
    );
    require(&settled(&text, [0.1, 1.5]), SpecialKind::VanishingSegment, 0.3);
}

/// x' = cos φ − m sign x crosses zero where sin φ = −πm/2, and slides from cos φ = m on.
#[test]
fn an_event_at_the_edge_of_sliding() {
    let text = "parameter m = 0.3\nstate x = 0.1, phase = 0\nphase' = 1\nwhen phase > pi \
                \"phase\"\n  phase := phase - 2*pi\nmode move\n  sliding on x = 0\n  x' = \
                cos(phase) - m*sign(x)\nend = 9";
    let explicit = "parameter m = 0.3\nstate x = 0.1\nevery 2*pi \"tick\"\nmode move\n  sliding \
                    on x = 0\n  x' = cos(t) - m*sign(x)\nend = 9";
    let edge = 1.0 / 1.0_f64.hypot(PI / 2.0);
    for text in [text, explicit] {
        require(&settled(text, [0.2, 0.6]), SpecialKind::SlidingEdge, edge);
    }
}

/// Two equal relays that know nothing of each other: a difference of their phases stays, so that
/// their orbit is not stable, though no multiplier is outside the unit circle.
#[test]
fn a_neutral_orbit_is_not_stable() {
    let text = "state x = 0, y = 0, u = 1, w = 1\nx' = u - x\ny' = w - y\nu' = 0\nw' = 0\n\
                when x*u > 0.5 \"x\"\n  u := -u\nwhen y*w > 0.5 \"y\"\n  w := -w\nend = 9";
    let system = System::parse(text).expect("a system");
    let orbits = Orbits::new(&system).expect("orbits");
    let state = [0.0, 0.3, 1.0, 1.0];
    let itinerary = ["y", "x", "y", "x"];
    let guess = Guess { itinerary: &itinerary, state: Some(&state), ..Guess::default() };
    let orbit = orbits.find(&[], &guess);
    let settled = orbits.settled(&[], &Guess::default(), 100.0).expect("an orbit");
    // Orbits with any difference are not isolated; with none, both switch at once.
    for orbit in orbit.into_iter().chain([settled]) {
        assert!((orbit.period - 2.0 * 3.0_f64.ln()).abs() < 1e-11, "{orbit:?}");
        let multipliers = orbit.multipliers.clone().expect("no graze");
        assert!((multipliers[0][0] - 1.0).abs() < 1e-12 && !orbit.is_stable(), "{multipliers:?}");
    }
}

/// From a start in the middle, the second round is the orbit: its first one begins elsewhere.
#[test]
fn a_second_round_is_near_enough() {
    let text =
        "parameter m = 1\nstate x = 0\nx' = m + x^2\nwhen x > 5 \"spike\"\n  x := -5\nend = 9";
    let system = System::parse(text).expect("a system");
    let orbits = Orbits::new(&system).expect("orbits");
    let guess = Guess { itinerary: &["spike"], ..Guess::default() };
    let orbit = orbits.find(&[1.0], &guess).expect("an orbit");
    assert!((orbit.period - 2.0 * 5.0_f64.atan()).abs() < 1e-12, "{orbit:?}");
    // As m falls to 0, the period grows as π/√m.
    let branch = orbits.branch(&orbit, 0, [0.1, 4.0], &BranchOptions::default()).expect("it");
    assert_eq!((branch.objection.as_deref(), branch.specials.len()), (None, 0));
    for orbit in &branch.points {
        let root = orbit.parameters[0].sqrt();
        let exact = 2.0 / root * (5.0 / root).atan();
        assert!((orbit.period - exact).abs() < 1e-9 * exact, "{orbit:?}");
    }
}

/// A block sticks while a force m + 0.1 cos φ + 0.5 cos 2φ is less than 1. Its second maximum, at
/// φ = π, is m + 0.4; the phase may start anew before it while the block sticks.
#[test]
fn sliding_that_ends_for_an_instant() {
    for turn in ["1.5", "0.8"] {
        let text = format!(
            "parameter m = 0.55\nstate v = 0, phase = 0\nphase' = 1\nwhen phase > {turn}*pi \
             \"phase\"\n  phase := phase - 2*pi\nmode move\n  sliding on v = 0\n  v' = m + \
             0.1*cos(phase) + 0.5*cos(2*phase) - sign(v)\nend = 9"
        );
        require(&settled(&text, [0.5, 0.7]), SpecialKind::AddingSliding, 0.6);
    }
}

/// Beside the relay, y' = m y − y³ gives up its symmetry at m = 0, or with −y² in place of −y³
/// changes places with another orbit there.
#[test]
fn branches_that_meet() {
    for (power, exact) in [(3, f64::sqrt as fn(f64) -> f64), (2, |m| m)] {
        let text = relay("when x > h \"up\" -> down\n    since := 0")
            .replace("since = 0\n", &format!("since = 0, y = 0\ny' = m*y - y^{power}\n"))
            .replace("m = 1.3", "m = -0.4");
        let system = System::parse(&text).expect("a system");
        let orbits = Orbits::new(&system).expect("orbits");
        let guess = Guess { itinerary: &["up", "down"], ..Guess::default() };
        let orbit = orbits.find(&system.values(), &guess).expect("an orbit");
        let options = BranchOptions::default();
        let branch = orbits.branch(&orbit, 0, [-0.5, 0.5], &options).expect("a branch");
        let found: Vec<_> = branch.specials.iter().map(|it| (it.kind, it.value)).collect();
        assert!(matches!(found[..], [(SpecialKind::BranchPoint, _)]), "{found:?}");
        assert!(found[0].1.abs() < 1e-10, "{found:?}");
        let special = &branch.specials[0];
        let said = orbits.curve(special, [0, 1], [[-0.5, 0.5], [0.1, 0.9]], &options);
        let said = said.expect_err("no curve").to_string();
        assert!(said.contains("branch-point") && said.contains("not `branch-point`"), "{said}");
        let beside = &branch.points[special.behind - 1];
        let other = orbits.switched(special, beside, 0, 0.05).expect("another branch");
        let [m, y] = [other.parameters[0], other.segments[0].state[2]];
        assert!(y.abs() > 0.01 && (y.abs() - exact(m).abs()).abs() < 1e-10, "{m} {y}");
        let all = orbits.branch(&other, 0, [-0.5, 0.5], &options).expect("a branch");
        let far = all.points.iter().any(|it| it.segments[0].state[2].abs() > 0.45);
        assert!(far && all.objection.is_none(), "{:?}", all.objection);
    }
}

/// A relay whose upper limit is m, and m + 0.1 in every other round: `n` is 0 and 1 in turns, and
/// any n would come back after two rounds.
#[test]
fn a_discrete_state_keeps_its_values() {
    let text = "parameter m = 0.5\nstate x = 0, n = 0\nn' = 0\nmode up\n  x' = 1 - x\n  when x > m \
                + 0.1*n \"up\" -> down\n    n := 1 - n\nmode down\n  x' = -1 - x\n  when x < -0.5 \
                \"down\" -> up\nstart in up\nend = 9";
    let system = System::parse(text).expect("a system");
    let orbits = Orbits::new(&system).expect("orbits");
    let guess = Guess { itinerary: &["up", "down", "up", "down"], ..Guess::default() };
    let found = orbits.find(&[0.5], &guess).expect("an orbit");
    let settled = orbits.settled(&[0.5], &Guess::default(), 200.0).expect("an orbit");
    let round = |m: f64| (1.5 / (1.0 - m)).ln() + ((1.0 + m) / 0.5).ln();
    for orbit in [found, settled] {
        let error = orbit.period - round(0.5) - round(0.6);
        assert!(error.abs() < 1e-11 && orbit.is_admissible() && orbit.is_stable(), "{orbit:?}");
        let mut n = [&orbit.segments[0], &orbit.segments[2]].map(|it| it.state[1]);
        n.sort_by(f64::total_cmp);
        assert_eq!(n, [0.0, 1.0]);
        let branch = orbits.branch(&orbit, 0, [0.1, 0.8], &BranchOptions::default());
        let branch = branch.expect("a branch");
        assert_eq!((branch.specials.len(), branch.objection.as_deref()), (0, None));
        for orbit in &branch.points {
            let m = orbit.parameters[0];
            assert!((orbit.period - round(m) - round(m + 0.1)).abs() < 1e-11, "{m}");
        }
    }
    // In one round n has to be 1/2, and a value that is held from the state is no discrete one.
    let one = Guess { itinerary: &["up", "down"], ..Guess::default() };
    let orbit = orbits.find(&[0.5], &one).expect("an orbit");
    assert!((orbit.segments[0].state[1] - 0.5).abs() < 1e-12 && !orbit.is_stable());
    let sampled = System::parse(&text.replace("n := 1 - n", "n := x - 0.5")).expect("a system");
    let orbits = Orbits::new(&sampled).expect("orbits");
    let orbit = orbits.find(&[0.5], &guess).expect("an orbit");
    // n = x − 1/2 at x = 1/2 + n/10 is 0.
    assert!(orbit.segments.iter().all(|it| it.state[1].abs() < 1e-11), "{orbit:?}");
    assert!((orbit.period - 2.0 * round(0.5)).abs() < 1e-10);
}

/// A run settles late, and its orbit is the one of the first period: a branch over the period of a
/// clock would have to move its start far.
#[test]
fn an_orbit_of_a_clock_begins_early() {
    let text = "parameter w = 2\nstate x = 0, v = 0\nx' = v\nv' = -x - 0.3*v + 0.5*cos(w*t)\n\
                every 2*pi/w \"tick\"\nend = 9";
    let system = System::parse(text).expect("a system");
    let orbits = Orbits::new(&system).expect("orbits");
    let orbit = orbits.settled(&[2.0], &Guess::default(), 400.0).expect("an orbit");
    assert!((0.0..2.0 * PI).contains(&orbit.start) && orbit.is_admissible(), "{orbit:?}");
    let branch = orbits.branch(&orbit, 0, [0.3, 3.0], &BranchOptions::default()).expect("it");
    let count = branch.points.len();
    assert!(count < 1000 && branch.objection.is_none(), "{count}: {:?}", branch.objection);
    for orbit in &branch.points {
        let w = orbit.parameters[0];
        let x = 0.5 * (1.0 - w * w) / ((1.0 - w * w).powi(2) + 0.09 * w * w);
        assert!((orbit.segments[0].state[0] - x).abs() < 1e-10, "{w}");
    }
}

#[test]
fn a_run_that_comes_to_rest_has_no_orbit() {
    let ball = "state x = 1, v = 0\nx' = v\nv' = -1\nwhen x < 0 \"bounce\"\n  x := 0\n  \
                v := -0.5*v\nend = 9";
    let system = System::parse(ball).expect("a system");
    let orbits = Orbits::new(&system).expect("orbits");
    let said = orbits.settled(&[], &Guess::default(), 9.0).expect_err("no orbit").to_string();
    // √2 (1 + 2 (1/2 + 1/4 + …)).
    assert!(said.contains("its events accumulate at t = 4.2426406"), "{said}");
}

/// The period of the clock changes along this branch. It folds at ω² = π(1 − r)/((1 + r)A).
#[test]
fn a_fold_over_the_period_of_a_clock() {
    let system = System::parse(crate::ball::TEXT).expect("a system");
    let orbits = Orbits::new(&system).expect("orbits");
    let guess = Guess { itinerary: &["period", "bounce"], ..Guess::default() };
    let orbit = orbits.find(&system.values(), &guess).expect("an orbit");
    let branch = orbits.branch(&orbit, 1, [4.0, 7.0], &BranchOptions::default()).expect("it");
    let folds = branch.specials.iter().filter(|it| it.kind == SpecialKind::Fold);
    let folds: Vec<f64> = folds.map(|it| it.value).collect();
    let exact = (PI * 0.3 / (1.7 * 0.02)).sqrt();
    assert!(folds.len() == 1 && (folds[0] - exact).abs() < 1e-10, "{folds:?} {exact}");
    assert!(
        branch.points.iter().all(|it| { (it.period - 2.0 * PI / it.parameters[1]).abs() < 1e-12 })
    );
}

/// A rimless wheel rolls down a slope. Where it is too slow to pass above a spoke, its step takes
/// for ever.
#[test]
fn a_period_grows_without_bound() {
    let wheel = "parameter s = 0.08, a = 0.3\nstate q = s - a, w = 0.45\nq' = w\nw' = sin(q)\n\
                 when q > s + a \"step\"\n  q := s - a\n  w := cos(2*a)*w\nend = 100";
    let system = System::parse(wheel).expect("a system");
    let orbits = Orbits::new(&system).expect("orbits");
    let guess = Guess { itinerary: &["step"], ..Guess::default() };
    let orbit = orbits.find(&system.values(), &guess).expect("an orbit");
    let options = BranchOptions::default();
    let branch = orbits.branch(&orbit, 0, [0.0, 0.3], &options).expect("a branch");
    // The energy behind a step, less what it takes to stand above the spoke.
    let left = |s: f64| {
        let (gain, kept) = (4.0 * s.sin() * 0.3_f64.sin(), 0.6_f64.cos().powi(2));
        kept * gain / (1.0 - kept) - 2.0 * (1.0 - (s - 0.3).cos())
    };
    let (mut low, mut high) = (0.01, 0.08);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if left(middle) < 0.0 { &mut low } else { &mut high }) = middle;
    }
    let [end] = &branch.specials[..] else {
        panic!("{:?} {:?}", branch.specials, branch.objection)
    };
    assert_eq!((end.kind, end.segment, end.behind), (SpecialKind::InfinitePeriod, Some(0), 0));
    assert!((end.value - low).abs() < 1e-10, "{} {low}", end.value);
    assert_eq!(branch.objection, None);
    assert!(branch.points.iter().all(Orbit::is_admissible));
    let resumed = orbits.resumed(&branch, [0.0, 0.3], &options).expect("a branch");
    assert_eq!(resumed, branch);
}

/// An oscillator sticks to a belt until that is too fast. The return is singular where the arrival
/// grazes, and no multiplier is -1.
#[test]
fn a_graze_is_no_flip() {
    let belt = "parameter belt = 3\nstate x = 0.3, v = belt\nx' = v\nmode move\n  sliding on v = \
                belt\n  v' = -x - 0.05*v - sign(v - belt)*(1 + 0.6*exp(-3*abs(v - belt)))\nend = 9";
    let branch = settled(belt, [2.9, 3.1]);
    let found: Vec<_> = branch.specials.iter().map(|it| it.kind).collect();
    assert_eq!(found, [SpecialKind::Fold, SpecialKind::GrazingSliding]);
}

/// Two clocks tick at once in every second period: the time between is 0, all along the branch.
#[test]
fn clocks_that_tick_at_once() {
    let text = "parameter k = 0.5\nstate x = 1\nx' = -k*x\nevery 1 \"one\"\n  x := x + 1\n\
                every 2 \"two\"\n  x := x - 0.3\nend = 9";
    let branch = settled(text, [0.1, 2.0]);
    assert!(branch.specials.is_empty(), "{:?}", branch.specials);
    for orbit in &branch.points {
        assert!(orbit.is_admissible() && orbit.is_stable(), "{orbit:?}");
        let multiplier = (-2.0 * orbit.parameters[0]).exp();
        let own = orbit.multipliers.as_ref().expect("one")[0][0];
        assert!((own - multiplier).abs() < 1e-12, "{own} {multiplier}");
    }
}
