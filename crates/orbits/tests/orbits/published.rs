//! Systems with which other programs are shown, and what is published of them.

use stickslip_expression::System;
use stickslip_orbits::{BranchOptions, Guess, Orbit, Orbits, SpecialKind};

use crate::branches::values;

/// Dankowicz and Schilder, *Recipes for Continuation* (SIAM, 2013), example 17.3 and figures 17.4
/// and 17.5; the demo `bangbang` of COCO's toolbox `hspo`: a Duffing oscillator with λ = 0.2,
/// α = ε = 1 and a force of ±26, over ω from 0.8 to 1.5.
const BANG_BANG: &str = include_str!("../../../../examples/orbits/bangbang.slip");

/// How far an orbit is from its mirror image half a period later.
fn asymmetry(orbit: &Orbit) -> f64 {
    let [one, other] = [0, 1].map(|k| &orbit.segments[k].state);
    one.iter().zip(other).take(2).map(|(x, y)| (x + y).abs()).fold(0.0, f64::max)
}

#[test]
fn a_bang_bang_duffing_oscillator() {
    let system = System::parse(BANG_BANG).expect("a system");
    let orbits = Orbits::new(&system).expect("orbits");
    // Ten periods from rest lead near an orbit that is not symmetric, as published.
    let orbit = orbits.settled(&system.values(), &Guess::default(), 400.0).expect("an orbit");
    assert!(asymmetry(&orbit) > 0.1 && orbit.segments.len() == 2, "{orbit:?}");
    let options = BranchOptions::default();
    let branch = orbits.branch(&orbit, 4, [0.8, 1.5], &options).expect("a branch");
    assert_eq!(branch.objection, None);
    println!("{:?}", branch.specials.iter().map(|it| (it.kind, it.value)).collect::<Vec<_>>());
    // Along the branch the symmetry is gained at a branch point, behind which the mirror images
    // follow: at its orbit, the state turns its sign in half a period.
    let meets = branch.specials.iter().filter(|it| it.kind == SpecialKind::BranchPoint);
    let meets: Vec<_> = meets.collect();
    let symmetric = meets.iter().find(|it| asymmetry(&it.orbit) < 1e-8).expect("a branch point");
    // The other branch there is symmetric throughout.
    let beside = &branch.points[symmetric.behind - 1];
    assert!(asymmetry(beside) > 1e-6);
    let other = orbits.switched(symmetric, beside, 4, 0.02).expect("the other branch");
    assert!(asymmetry(&other) < 1e-9, "{other:?}");
    let primary = orbits.branch(&other, 4, [0.8, 1.5], &options).expect("a branch");
    assert!(primary.points.iter().all(|it| asymmetry(it) < 1e-8));
    let again = values(&primary, SpecialKind::BranchPoint);
    let apart = again.iter().map(|it| (it - symmetric.value).abs()).fold(1.0, f64::min);
    assert!(apart < 1e-8, "{again:?} {}", symmetric.value);
}

/// The test `IF_squarespike_model.py` of PyDSTool (Clewley): v' = (I − g(v − v₀))/C up to −65, a
/// spike that lasts 1.5 and ends at −97. Its fourth spike is at 54.009, up to 1 in 1000.
#[test]
fn an_integrate_and_fire_neuron() {
    let text = "parameter i = 1.3, g = 0.1, rest = -67, threshold = -65, c = 1\n\
                state v = -80, since = 0\nmode leak\n  v' = (i - g*(v - rest))/c\n  since' = 0\n  \
                when v > threshold \"fires\" -> spike\n    v := 48\nmode spike\n  v' = 0\n  \
                since' = 1\n  when since > 1.5 \"ends\" -> leak\n    v := -97\n    since := 0\n\
                start in leak\nend = 60";
    let system = System::parse(text).expect("a system");
    let orbits = Orbits::new(&system).expect("orbits");
    let orbit = orbits.settled(&system.values(), &Guess::default(), 200.0).expect("an orbit");
    let period = 1.5 + 10.0 * (43.0_f64 / 11.0).ln();
    assert!((orbit.period - period).abs() < 1e-11 && orbit.is_admissible());
    assert_eq!(orbit.multipliers, Some(vec![[0.0, 0.0]]));
    let fourth = 10.0 * (26.0_f64 / 11.0).ln() + 3.0 * orbit.period;
    assert!((fourth - 54.009).abs() < 0.001 * 54.009, "{fourth}");
    // The rate of firing ceases where the rest potential reaches the threshold, i = 0.2.
    let branch = orbits.branch(&orbit, 0, [0.25, 3.0], &BranchOptions::default()).expect("it");
    for orbit in &branch.points {
        let rest = -67.0 + 10.0 * orbit.parameters[0];
        let exact = 1.5 + 10.0 * ((rest + 97.0) / (rest + 65.0)).ln();
        assert!((orbit.period - exact).abs() < 1e-10 * exact, "{orbit:?}");
    }
}
