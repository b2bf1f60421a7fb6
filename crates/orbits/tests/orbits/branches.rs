//! Branches, and the special orbits on them.

use stickslip_orbits::{Branch, BranchOptions, Guess, Orbits, SpecialKind};

use crate::impact::{self, Closed};

/// The values of the special orbits of a kind.
pub fn values(branch: &Branch, kind: SpecialKind) -> Vec<f64> {
    branch.specials.iter().filter(|it| it.kind == kind).map(|it| it.value).collect()
}

fn impacts(w: f64) -> Branch {
    let orbits = impact::orbits();
    let closed = Closed { w, ..Closed::EXAMPLE };
    let v = closed.speeds()[0];
    let orbit = impact::near(&orbits, &closed, v, 1e-4).expect("an orbit");
    orbits.branch(&orbit, 3, [0.05, 1.2], &BranchOptions::default()).expect("a branch")
}

#[test]
fn an_impact_oscillator_flips_and_grazes() {
    let branch = impacts(0.8);
    let flip = values(&branch, SpecialKind::Flip);
    assert!(flip.iter().any(|it| (it - 0.518209866598).abs() < 1e-11), "{flip:?}");
    let graze = values(&branch, SpecialKind::Grazing);
    assert!((graze[0] - 0.368781778292).abs() < 1e-11, "{graze:?}");
    let flipped = branch.specials.iter().find(|it| it.kind == SpecialKind::Flip).expect("a flip");
    assert!((flipped.orbit.segments[1].end[1] - 0.458378634989).abs() < 1e-9);
    // Before the graze the system follows the orbit, and behind it does not.
    for orbit in &branch.points {
        let real = orbit.parameters[3] > graze[0] && orbit.segments[1].end[1] > 0.0;
        assert_eq!(orbit.is_admissible(), real, "{orbit:?}");
    }
    assert!(branch.points.iter().any(|it| !it.is_admissible()));
    assert_eq!(branch.objection, None);
}

#[test]
fn an_impact_oscillator_grazes_and_folds() {
    for (w, graze, fold) in [(1.3, 0.702139587262, 0.205318870798), (1.0, 0.1, 0.099970753628)] {
        let branch = impacts(w);
        let found = values(&branch, SpecialKind::Grazing);
        assert!(found.iter().any(|it| (it - graze).abs() < 1e-11), "{w}: {found:?}");
        let found = values(&branch, SpecialKind::Fold);
        assert!(found.iter().any(|it| (it - fold).abs() < 1e-11), "{w}: {found:?}");
        assert_eq!(branch.objection, None);
    }
}

#[test]
fn the_grazing_curve_of_impacts() {
    let orbits = impact::orbits();
    let mut worst = 0.0_f64;
    for k in 0..10 {
        let w = 0.35 + 0.15 * f64::from(k);
        let closed = Closed { w, a: 0.0, ..Closed::EXAMPLE };
        let graze = closed.d * closed.impedance();
        let closed = Closed { a: 1.02 * graze, ..closed };
        let speeds = closed.speeds();
        // Where the branch folds first, the orbit is beside the graze on its virtual side.
        let v = speeds.into_iter().min_by(|one, other| one.abs().total_cmp(&other.abs()));
        let v = v.expect("beyond the graze");
        let Ok(orbit) = impact::near(&orbits, &closed, v, 1e-6) else { panic!("{w}") };
        let range = [0.9 * graze, 1.1 * graze];
        let branch = orbits.branch(&orbit, 3, range, &BranchOptions::default()).expect("a branch");
        let found = values(&branch, SpecialKind::Grazing);
        let error = found.iter().map(|it| (it - graze).abs() / graze).fold(f64::INFINITY, f64::min);
        assert!(error < 1e-11, "{w}: {found:?}, {graze}, {:?}", branch.objection);
        worst = worst.max(error);
    }
    println!("10 grazes, error {worst:e}");
}

#[test]
fn a_bouncing_ball_folds_and_flips_and_doubles() {
    let system = stickslip_expression::System::parse(crate::ball::TEXT).expect("a system");
    let orbits = Orbits::new(&system).expect("orbits");
    let (a, w, r) = (0.02, std::f64::consts::TAU, 0.7);
    let cos: f64 = 0.014043083214 / a;
    let sine = (1.0 - cos * cos).sqrt();
    let guess = Guess {
        time: Some(cos.acos() / w),
        state: Some(&[a * sine, 0.5]),
        itinerary: &["period", "bounce"],
        ..Guess::default()
    };
    let orbit = orbits.find(&[a, w, r], &guess).expect("an orbit");
    assert!(orbit.is_admissible() && orbit.is_stable());
    let branch = orbits.branch(&orbit, 0, [0.005, 0.05], &BranchOptions::default()).expect("it");
    let fold = values(&branch, SpecialKind::Fold);
    assert!((fold[0] - 0.014043083214).abs() < 1e-11, "{fold:?}");
    let flip = values(&branch, SpecialKind::Flip);
    assert!((flip[0] - 0.029654967002).abs() < 1e-11, "{flip:?}");
    // The system follows the orbits behind the fold too.
    let behind = branch.points.iter().filter(|it| it.start < 0.0);
    assert!(behind.clone().count() > 4 && behind.take(4).all(|it| !it.is_stable()));
    let flip = branch.specials.iter().find(|it| it.kind == SpecialKind::Flip).expect("a flip");
    let multipliers = flip.orbit.multipliers.as_ref().expect("no graze");
    assert!((multipliers[0][0] + 1.0).abs() < 1e-9 && (multipliers[1][0] + 0.49).abs() < 1e-9);
    let doubled = orbits.switched(flip, &orbit, 0, 0.05).expect("the doubled orbit");
    assert!((doubled.period - 2.0).abs() < 1e-12);
    let [one, other] = [1, 3].map(|i| doubled.segments[i].end[1]);
    assert!((one - other).abs() > 1e-3, "{one} {other}");
    assert!(doubled.parameters[0] > flip.value && doubled.is_admissible() && doubled.is_stable());
}
