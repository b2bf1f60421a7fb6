//! Curves of special orbits over two parameters.

use std::f64::consts::{PI, TAU};

use stickslip_expression::System;
use stickslip_orbits::{BranchOptions, Guess, Orbit, Orbits, SpecialCurve, SpecialKind};

use crate::impact::{self, Closed};

/// The curve of a kind of special orbit over (w, second) that begins on the branch over `first`.
fn curve(
    closed: &Closed,
    kind: SpecialKind,
    (parameter, range): (usize, [f64; 2]),
    parameters: [usize; 2],
    window: [[f64; 2]; 2],
) -> SpecialCurve {
    curve_by(closed, kind, (parameter, range), (parameters, window), &BranchOptions::default())
}

/// The same with options.
fn curve_by(
    closed: &Closed,
    kind: SpecialKind,
    (parameter, range): (usize, [f64; 2]),
    (parameters, window): ([usize; 2], [[f64; 2]; 2]),
    options: &BranchOptions,
) -> SpecialCurve {
    let orbits = impact::orbits();
    let v = closed.speeds()[0];
    let orbit = impact::near(&orbits, closed, v, 1e-6).expect("an orbit");
    let branch = orbits.branch(&orbit, parameter, range, options).expect("a branch");
    let special = branch.specials.iter().find(|it| it.kind == kind).expect("a special orbit");
    orbits.curve(special, parameters, window, options).expect("a curve")
}

/// The closed form at the amplitude and the frequency of an orbit.
fn at(closed: &Closed, orbit: &Orbit) -> Closed {
    Closed { a: orbit.parameters[3], w: orbit.parameters[4], ..*closed }
}

#[test]
fn grazes_of_impacts_have_their_closed_form() {
    let closed = Closed { w: 0.8, ..Closed::EXAMPLE };
    let window = [[0.6, 1.4], [0.02, 1.0]];
    let options = BranchOptions { longest_step: 0.02, ..BranchOptions::default() };
    let (over, window) = ((3, [0.05, 1.2]), ([4, 3], window));
    let found = curve_by(&closed, SpecialKind::Grazing, over, window, &options);
    assert!(found.points.len() >= 150 && found.objection.is_none(), "{:?}", found.objection);
    let mut worst = 0.0_f64;
    for orbit in &found.points {
        let own = at(&closed, orbit);
        worst = worst.max((own.a - own.impedance()).abs());
    }
    println!("{} grazes, error {worst:e}", found.points.len());
    assert!(worst < 1e-12, "{worst}");
    // Both ends are at the window, where w is largest and smallest.
    let ends = [&found.points[0], &found.points[found.points.len() - 1]];
    let mut ends = ends.map(|it| it.parameters[4]);
    ends.sort_by(f64::total_cmp);
    assert!((ends[0] - 0.6).abs() < 1e-12 && (ends[1] - 1.4).abs() < 1e-12, "{ends:?}");
    // The fold meets the graze at w = 2nΩ/m.
    let natural = (1.0_f64 - 0.0025).sqrt();
    let meets = found.meetings.iter().filter(|it| it.name == "fold-grazing");
    let meets: Vec<f64> = meets.map(|it| it.orbit.parameters[4]).collect();
    assert!(meets.iter().any(|w| (w - natural).abs() < 1e-6), "{meets:?} {natural}");
}

#[test]
fn folds_and_flips_of_impacts_have_their_closed_form() {
    let closed = Closed { w: 0.8, ..Closed::EXAMPLE };
    let window = [[0.7, 0.9], [0.02, 1.2]];
    let flips = curve(&closed, SpecialKind::Flip, (3, [0.05, 1.2]), [4, 3], window);
    assert!(flips.points.len() > 5, "{:?}", flips.objection);
    for orbit in &flips.points {
        let closed @ Closed { a, w, .. } = at(&closed, orbit);
        let v = orbit.segments.last().expect("segments").end[1];
        let test = 1.0 + closed.trace(v) + closed.determinant();
        assert!(test.abs() < 1e-8, "{a} {w} {v} {test}");
    }
    let closed = Closed { w: 1.3, ..Closed::EXAMPLE };
    let window = [[1.1, 1.6], [0.02, 1.2]];
    let folds = curve(&closed, SpecialKind::Fold, (3, [0.05, 1.2]), [4, 3], window);
    assert!(folds.points.len() > 5, "{:?}", folds.objection);
    for orbit in &folds.points {
        let closed @ Closed { a, w, .. } = at(&closed, orbit);
        // At a fold both speeds are one: their difference is the root of a rounding error.
        let near = Closed { a: a * (1.0 + 1e-9), ..closed }.speeds();
        let far = Closed { a: a * (1.0 - 1e-9), ..closed }.speeds();
        assert!(near.len() == 2 && far.is_empty(), "{a} {w}");
    }
}

#[test]
fn tori_of_impacts_begin_where_the_product_of_multipliers_is_one() {
    // c = 2 ln e/T: the damping is negative, and two complex multipliers have the size 1.
    let closed = Closed { c: -0.05, a: 0.8, ..Closed::EXAMPLE };
    let window = [[0.9, 1.1], [-0.2, 0.0]];
    let found = curve(&closed, SpecialKind::NeimarkSacker, (1, [-0.2, 0.0]), [4, 1], window);
    assert!(found.points.len() > 3, "{:?}", found.objection);
    for orbit in &found.points {
        let [c, w] = [orbit.parameters[1], orbit.parameters[4]];
        assert!((c - 2.0 * 0.8_f64.ln() * w / TAU).abs() < 1e-10, "{c} {w} {PI}");
    }
}

/// Where the multipliers of a torus are both 1 or both −1, its curve ends.
#[test]
fn curves_of_tori_end_at_resonances() {
    let closed = Closed { c: -0.05, a: 0.8, ..Closed::EXAMPLE };
    let window = [[0.4, 1.9], [-0.3, 0.0]];
    let found = curve(&closed, SpecialKind::NeimarkSacker, (1, [-0.2, 0.0]), [4, 1], window);
    let ends: Vec<&str> = found.meetings.iter().map(|it| &*it.name).collect();
    println!("{ends:?} {:?}", found.objection);
    assert!(found.objection.is_none(), "{:?}", found.objection);
    let resonances = found.meetings.iter().filter(|it| it.name.starts_with("resonance"));
    let mut count = 0;
    for meeting in resonances {
        let [c, w] = [1, 4].map(|k| meeting.orbit.parameters[k]);
        let v = meeting.orbit.segments.last().expect("segments").end[1];
        let trace = Closed { c, w, ..closed }.trace(v);
        let exact = if meeting.name == "resonance-1-1" { 2.0 } else { -2.0 };
        println!("{} {c} {w} {trace}", meeting.name);
        assert!((trace - exact).abs() < 1e-6, "{} {trace}", meeting.name);
        count += 1;
    }
    assert!(count > 0, "{ends:?}");
}

/// The frequency where the closed form folds at an amplitude while the product of the multipliers
/// is 1, between two others.
fn fold_of_torus(closed: &Closed, [mut low, mut high]: [f64; 2]) -> f64 {
    let at = |w: f64| Closed { w, c: 2.0 * closed.e.ln() * w / TAU, ..*closed };
    let above = |w: f64| at(w).fold() > closed.a;
    assert_ne!(above(low), above(high));
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if above(middle) == above(low) { low = middle } else { high = middle }
    }
    low
}

/// Both multipliers are 1 where the curve of tori meets that of folds. By the closed form that is
/// at one frequency; the curve begins at another one.
#[test]
fn a_curve_of_tori_ends_at_a_fold() {
    let closed = Closed { c: -0.045, a: 0.5, w: 0.56, ..Closed::EXAMPLE };
    let exact = fold_of_torus(&closed, [0.51, 0.56]);
    let window = [[0.5, 0.62], [-0.1, 0.0]];
    let found = curve(&closed, SpecialKind::NeimarkSacker, (1, [-0.1, 0.0]), [4, 1], window);
    assert!(found.objection.is_none(), "{:?}", found.objection);
    let ends = found.meetings.iter().filter(|it| it.name == "resonance-1-1");
    let [end] = ends.collect::<Vec<_>>()[..] else { panic!("{:?}", found.meetings) };
    let [c, w] = [1, 4].map(|k| end.orbit.parameters[k]);
    println!("resonance-1-1 at w = {w}, by the closed form {exact}");
    assert!((w - exact).abs() < 1e-9, "{w} {exact}");
    assert!((c - 2.0 * 0.8_f64.ln() * w / TAU).abs() < 1e-10, "{c} {w}");
    // It is the end of the curve.
    let last = [&found.points[0], &found.points[found.points.len() - 1]];
    assert!(last.iter().any(|it| **it == end.orbit), "{end:?}");
}

/// Beside a clock, y'' = m + y² + (n + y) y' has the equilibrium y = −√−m, whose eigenvalues are
/// imaginary at n = √−m and both 0 at the origin (Bogdanov and Takens).
#[test]
fn tori_and_folds_meet_at_the_origin() {
    let text = "parameter m = -0.04, n = 0.3\nstate phase = 0.5, y = -0.2, z = 0\nphase' = 1\n\
                y' = z\nz' = m + y^2 + (n + y)*z\nwhen phase > 1 \"phase\"\n  phase := phase - 1\n\
                end = 9";
    let system = System::parse(text).expect("a system");
    let orbits = Orbits::new(&system).expect("orbits");
    let guess = Guess { itinerary: &["phase"], ..Guess::default() };
    let orbit = orbits.find(&system.values(), &guess).expect("an orbit");
    let options = BranchOptions::default();
    let branch = orbits.branch(&orbit, 1, [0.1, 0.4], &options).expect("a branch");
    let [ref torus] = branch.specials[..] else { panic!("{:?}", branch.specials) };
    assert!((torus.value - 0.2).abs() < 1e-10, "{}", torus.value);
    let window = [[-0.09, 0.05], [-0.2, 0.4]];
    let tori = orbits.curve(torus, [0, 1], window, &options).expect("a curve");
    assert!(tori.points.len() > 5 && tori.objection.is_none(), "{:?}", tori.objection);
    for orbit in &tori.points {
        let [m, n] = [orbit.parameters[0], orbit.parameters[1]];
        assert!((m + n * n).abs() < 1e-9 && n > -1e-5, "{m} {n}");
    }
    let ends = |curve: &SpecialCurve| {
        let [ref meeting] = curve.meetings[..] else { panic!("{:?}", curve.meetings) };
        let [m, n] = [meeting.orbit.parameters[0], meeting.orbit.parameters[1]];
        println!("{} at {m:e} {n:e}", meeting.name);
        assert!(meeting.name == "resonance-1-1" && m.abs() < 1e-8 && n.abs() < 1e-5, "{meeting:?}");
    };
    ends(&tori);
    // The curve of folds goes through the same orbit.
    let branch = orbits.branch(&orbit, 0, [-0.09, 0.05], &options).expect("a branch");
    let fold = branch.specials.iter().find(|it| it.kind == SpecialKind::Fold).expect("a fold");
    let folds = orbits.curve(fold, [0, 1], window, &options).expect("a curve");
    assert!(folds.points.iter().all(|it| it.parameters[0].abs() < 1e-10));
    ends(&folds);
}

/// A phase between two conditions, which touch zero at m = 1 and at n = 1.
pub const TWO_TOUCHES: &str = "parameter m = 0.7, n = 0.8\nstate phase = 1, x = 0\nmode turn\n  \
    phase' = 1\n  x' = -x\n  when phase > 2*pi \"phase\"\n    phase := phase - 2*pi\n  when \
    m*cos(phase - 3) > 1 \"one\" -> out\n  when n*cos(phase - 5) > 1 \"two\" -> out\nmode out\n  \
    phase' = 1\n  x' = 1\nstart in turn\nend = 9";

/// The orbits of a text with an itinerary, and the curve of the first special orbit of a kind.
fn planted(
    text: &str,
    itinerary: &[&str],
    (kind, range): (SpecialKind, [f64; 2]),
    window: [[f64; 2]; 2],
) -> SpecialCurve {
    let system = System::parse(text).expect("a system");
    let orbits = Orbits::new(&system).expect("orbits");
    let guess = Guess { itinerary, ..Guess::default() };
    let orbit = orbits.find(&system.values(), &guess).expect("an orbit");
    let options = BranchOptions::default();
    let branch = orbits.branch(&orbit, 0, range, &options).expect("a branch");
    let special = branch.specials.iter().find(|it| it.kind == kind);
    let special = special.unwrap_or_else(|| panic!("{kind:?}: {:?}", branch.specials));
    orbits.curve(special, [0, 1], window, &options).expect("a curve")
}

#[test]
fn two_grazes_at_once() {
    let special = (SpecialKind::Grazing, [0.5, 1.5]);
    let found = planted(TWO_TOUCHES, &["phase"], special, [[0.5, 1.5], [0.5, 1.5]]);
    assert!(found.points.iter().all(|it| (it.parameters[0] - 1.0).abs() < 1e-11));
    let [meeting] = &found.meetings[..] else { panic!("{:?}", found.meetings) };
    assert_eq!((&*meeting.name, meeting.segment), ("double-graze", Some(0)));
    assert!((meeting.orbit.parameters[1] - 1.0).abs() < 1e-10, "{:?}", meeting.orbit.parameters);
    assert_eq!(found.objection, None);
}

/// A text, a kind that its branch has over a range, a range of the second parameter, and the first
/// parameter over it.
type Planted<'a> = (String, SpecialKind, [f64; 2], [f64; 2], &'a dyn Fn(f64) -> f64);

/// The kinds of special orbits that only some systems have, each with the closed form of its curve
/// over a second parameter.
#[test]
fn every_kind_has_its_curve() {
    let relay = |rules: &str| {
        format!(
            "parameter m = 1.3, h = 0.5\nstate x = 0, since = 0\nsince' = 1\nmode up\n  \
             x' = 1 - x\n  {rules}\nmode down\n  x' = -1 - x\n  when x < -h \"down\" -> up\n    since := 0\n\
             mode low\n  x' = -1 - x\n  when x < -h \"down\" -> up\n    since := 0\nstart in up"
        )
    };
    let corner = relay(
        "when x > h \"up\" -> down\n    since := 0\n  when since > m \"late\" -> low\n    \
         since := 0",
    );
    let choice = relay("when x > h \"up\" if since < m -> down else -> low\n    since := 0");
    let waits = relay(
        "when x > h \"up\" -> wait\n    since := 0\nmode wait\n  x' = 1 - x\n  when since > m^2 - \
         0.09*h \"waits\" -> down",
    );
    let sliding = |start: &str, turn: &str, law: &str| {
        format!(
            "parameter {start}\nstate v = 0.1, phase = 0\nphase' = 1\nwhen phase > {turn}*pi \
             \"phase\"\n  phase := phase - 2*pi\nmode move\n  sliding on v = 0\n  v' = {law}"
        )
    };
    let edge = sliding("m = 0.3, h = 1", "1", "h*cos(phase) - m*sign(v)");
    let law = "m + h*cos(phase) + 0.5*cos(2*phase) - sign(v)";
    let leaves = sliding("m = 0.55, h = 0.1", "1.5", law);
    let half = |h: f64| ((1.0 + h) / (1.0 - h)).ln();
    let at_edge = |h: f64| h / 1.0_f64.hypot(PI / 2.0);
    let cases: [Planted<'_>; 5] = [
        (corner, SpecialKind::CornerCollision, [0.8, 1.5], [0.3, 0.7], &half),
        (choice, SpecialKind::Choice, [0.8, 1.5], [0.3, 0.7], &half),
        (waits, SpecialKind::VanishingSegment, [0.1, 1.5], [0.3, 0.7], &|h| 0.3 * h.sqrt()),
        (edge, SpecialKind::SlidingEdge, [0.2, 0.6], [0.7, 1.3], &at_edge),
        (leaves, SpecialKind::AddingSliding, [0.5, 0.7], [0.05, 0.2], &|h| 0.5 + h),
    ];
    for (text, kind, range, across, exact) in cases {
        let system = System::parse(&text).expect("a system");
        let orbits = Orbits::new(&system).expect("orbits");
        let orbit = orbits.settled(&system.values(), &Guess::default(), 200.0).expect("an orbit");
        let options = BranchOptions::default();
        let branch = orbits.branch(&orbit, 0, range, &options).expect("a branch");
        let special = branch.specials.iter().find(|it| it.kind == kind).expect("a special orbit");
        let found = orbits.curve(special, [1, 0], [across, [0.05, 2.0]], &options);
        let found = found.expect("a curve");
        assert!(found.points.len() > 20 && found.objection.is_none(), "{:?}", found.objection);
        // Nothing else changes on the way.
        assert!(found.meetings.is_empty(), "{kind:?}: {:?}", found.meetings);
        let mut ends = Vec::new();
        for orbit in &found.points {
            let [m, h] = [orbit.parameters[0], orbit.parameters[1]];
            assert!((m - exact(h)).abs() < 1e-12, "{kind:?}: {m} at {h}");
            ends.push(h);
        }
        ends.sort_by(f64::total_cmp);
        let away = [ends[0] - across[0], ends[ends.len() - 1] - across[1]];
        assert!(away.iter().all(|it| it.abs() < 1e-12), "{kind:?}: {away:?}");
    }
}

/// Beside a relay, y' = m + n y − y³ folds where 27 m² = 4 n³.
pub const CUSP: &str = "parameter m = 0.1, n = 1\nstate x = 0, y = 1\ny' = m + n*y - y^3\nmode up\n  \
    x' = 1 - x\n  when x > 0.5 \"up\" -> down\nmode down\n  x' = -1 - x\n  when x < -0.5 \"down\" \
    -> up\nstart in up\nend = 9";

#[test]
fn folds_meet_at_a_cusp() {
    let special = (SpecialKind::Fold, [-0.9, 0.9]);
    let found = planted(CUSP, &["up", "down"], special, [[-0.9, 0.9], [-0.6, 1.4]]);
    assert!(found.points.len() > 10 && found.objection.is_none(), "{:?}", found.objection);
    for orbit in &found.points {
        let [m, n] = [orbit.parameters[0], orbit.parameters[1]];
        assert!((27.0 * m * m - 4.0 * n * n * n).abs() < 1e-9, "{m} {n}");
    }
    let cusps: Vec<_> = found.meetings.iter().filter(|it| it.name == "cusp").collect();
    assert_eq!(cusps.len(), 1, "{:?}", found.meetings);
    let at = &cusps[0].orbit.parameters;
    assert!(at[0].abs() < 1e-9 && at[1].abs() < 1e-6, "{at:?}");
    // Both branches of the cusp leave the window.
    let ends = [&found.points[0], &found.points[found.points.len() - 1]];
    assert!(ends.iter().all(|it| it.parameters[1] > 1.39 || it.parameters[0].abs() > 0.89));
}

/// A driven mass between two walls: its symmetric orbits graze both at once, all along the curve.
#[test]
fn two_walls_are_grazed_together() {
    let walls = "parameter a = 0.6, w = 1.3\nstate x = 0, v = 1, ph = 0\nx' = v\n\
                 v' = -0.5*x - 0.05*v + a*cos(ph)\nph' = w\n\
                 when x > 1 \"right\"\n  x := 1\n  v := -0.7*v\n\
                 when x < -1 \"left\"\n  x := -1\n  v := -0.7*v\n\
                 when ph > 2*pi \"phase\"\n  ph := ph - 2*pi\nend = 9";
    let system = System::parse(walls).expect("a system");
    let orbits = Orbits::new(&system).expect("orbits");
    let orbit = orbits.settled(&system.values(), &Guess::default(), 400.0).expect("an orbit");
    let options = BranchOptions::default();
    let branch = orbits.branch(&orbit, 0, [0.1, 2.0], &options).expect("a branch");
    let graze = branch.specials.iter().find(|it| it.kind == SpecialKind::Grazing).expect("one");
    let window = [[1.0, 1.4], [0.05, 1.5]];
    let curve = orbits.curve(graze, [1, 0], window, &options).expect("a curve");
    // Without impacts |k − w² + icw| is the amplitude of the force at which that of x is 1.
    let (w, a) = (curve.points[3].parameters[1], curve.points[3].parameters[0]);
    assert!((a - (0.5 - w * w).hypot(0.05 * w)).abs() < 1e-9, "{a} {w}");
    assert!(curve.meetings.is_empty(), "{:?}", curve.meetings);
}
