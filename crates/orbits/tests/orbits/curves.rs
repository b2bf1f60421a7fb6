//! Curves of special orbits over two parameters.

use std::f64::consts::{PI, TAU};

use stickslip_orbits::{BranchOptions, Orbit, SpecialCurve, SpecialKind};

use crate::impact::{self, Closed};

/// The curve of a kind of special orbit over (w, second) that begins on the branch over `first`.
fn curve(
    closed: &Closed,
    kind: SpecialKind,
    (parameter, range): (usize, [f64; 2]),
    parameters: [usize; 2],
    window: [[f64; 2]; 2],
) -> SpecialCurve {
    let orbits = impact::orbits();
    let v = closed.speeds()[0];
    let orbit = impact::near(&orbits, closed, v, 1e-6).expect("an orbit");
    let options = BranchOptions::default();
    let branch = orbits.branch(&orbit, parameter, range, &options).expect("a branch");
    let special = branch.specials.iter().find(|it| it.kind == kind).expect("a special orbit");
    orbits.curve(special, parameters, window, &options).expect("a curve")
}

/// The closed form at the amplitude and the frequency of an orbit.
fn at(closed: &Closed, orbit: &Orbit) -> Closed {
    Closed { a: orbit.parameters[3], w: orbit.parameters[4], ..*closed }
}

#[test]
fn grazes_of_impacts_have_their_closed_form() {
    let closed = Closed { w: 0.8, ..Closed::EXAMPLE };
    let window = [[0.6, 1.4], [0.02, 1.0]];
    let found = curve(&closed, SpecialKind::Grazing, (3, [0.05, 1.2]), [4, 3], window);
    assert!(found.points.len() > 20 && found.objection.is_none(), "{:?}", found.objection);
    let mut worst = 0.0_f64;
    for orbit in &found.points {
        let own = at(&closed, orbit);
        worst = worst.max((own.a - own.impedance()).abs());
    }
    println!("{} grazes, error {worst:e}", found.points.len());
    assert!(worst < 1e-11, "{worst}");
    // Both ends are at the window, where w is largest and smallest.
    let ends = [&found.points[0], &found.points[found.points.len() - 1]];
    let mut ends = ends.map(|it| it.parameters[4]);
    ends.sort_by(f64::total_cmp);
    assert!((ends[0] - 0.6).abs() < 1e-12 && (ends[1] - 1.4).abs() < 1e-12, "{ends:?}");
    // The fold meets the graze at w = 2nΩ/m.
    let natural = (1.0_f64 - 0.0025).sqrt();
    let meets = found.meetings.iter().filter(|it| it.kind == SpecialKind::Fold);
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
