//! Systems with which other programs are shown, and what is published of them.

use stickslip_expression::System;
use stickslip_orbits::{Branch, BranchOptions, Guess, Orbit, Orbits, SpecialKind};

use crate::branches::values;

/// Dankowicz and Schilder, *Recipes for Continuation* (SIAM, 2013), example 17.3 and figures 17.4
/// and 17.5; the demo `bangbang` of COCO's toolbox `hspo`: a Duffing oscillator with λ = 0.2,
/// α = ε = 1 and a force of ±26, over ω from 0.8 to 1.5.
const BANG_BANG: &str = include_str!("../../../../examples/orbits/bangbang.slip");

/// The same oscillator, in which the mirror image of each half period is taken.
const BANG_BANG_HALF: &str = "parameter a = 26, w = 1.2\nstate x = 0, v = 0, phase = 0\nx' = v\n\
    v' = a - 0.2*v - x - x^3\nphase' = w\nwhen phase > pi \"half\"\n  x := -x\n  v := -v\n  \
    phase := phase - pi\nend = 9";

/// How far an orbit is from its mirror image half a period later.
fn asymmetry(orbit: &Orbit) -> f64 {
    let [one, other] = [0, 1].map(|k| &orbit.segments[k].state);
    one.iter().zip(other).take(2).map(|(x, y)| (x + y).abs()).fold(0.0, f64::max)
}

#[test]
fn a_bang_bang_duffing_oscillator() {
    let system = System::parse(BANG_BANG).expect("a system");
    let orbits = Orbits::new(&system).expect("orbits");
    let orbit = orbits.settled(&system.values(), &Guess::default(), 400.0).expect("an orbit");
    assert!(asymmetry(&orbit) < 1e-9 && orbit.is_stable(), "{orbit:?}");
    // "A primary branch of two-segment periodic orbits", with saddle-nodes and branch points.
    let options = BranchOptions::default();
    let primary = orbits.branch(&orbit, 4, [0.8, 1.5], &options).expect("a branch");
    let kinds =
        |branch: &Branch| branch.specials.iter().map(|it| (it.kind, it.value)).collect::<Vec<_>>();
    println!("primary {:?} {:?}", kinds(&primary), primary.objection);
    assert_eq!(primary.objection, None);
    assert!(primary.points.iter().all(|it| asymmetry(it) < 1e-7));
    let meets = primary.specials.iter().filter(|it| it.kind == SpecialKind::BranchPoint);
    let meets: Vec<_> = meets.collect();
    assert!(!meets.is_empty() && !values(&primary, SpecialKind::Fold).is_empty());
    // The mirror image as the last rule: half of the orbit, whose branch points are flips.
    let half = System::parse(BANG_BANG_HALF).expect("a system");
    let halves = Orbits::new(&half).expect("orbits");
    let own = halves.settled(&half.values(), &Guess::default(), 400.0).expect("an orbit");
    let mirrored = halves.branch(&own, 1, [0.8, 1.5], &options).expect("a branch");
    for (kind, other) in
        [(SpecialKind::Fold, SpecialKind::Fold), (SpecialKind::Flip, SpecialKind::BranchPoint)]
    {
        let [one, other] = [values(&mirrored, kind), values(&primary, other)].map(|mut all| {
            all.sort_by(f64::total_cmp);
            all
        });
        let errors = one.iter().zip(&other).map(|(x, y)| (x - y).abs());
        println!("{kind:?} {one:?} {other:?}");
        assert!(one.len() == other.len() && errors.fold(0.0, f64::max) < 1e-9);
    }
    // "Several secondary branches emanating from branch points", with period doublings. They
    // consist of pairs of mirror images, so that the parameter turns at the branch point.
    let beside = &primary.points[meets[0].behind - 1];
    let other = orbits.switched(meets[0], beside, 4, 0.02).expect("the other branch");
    assert!(asymmetry(&other) > 1e-3, "{other:?}");
    let secondary = orbits.branch(&other, 4, [0.5, 1.5], &options).expect("a branch");
    println!("secondary {:?} {:?}", kinds(&secondary), secondary.objection);
    let again = values(&secondary, SpecialKind::BranchPoint);
    let apart = again.iter().map(|it| (it - meets[0].value).abs()).fold(1.0, f64::min);
    assert!(apart < 1e-8, "{again:?} {}", meets[0].value);
    let flip = secondary.specials.iter().find(|it| it.kind == SpecialKind::Flip);
    let flip = flip.expect("a period doubling");
    let doubled = orbits.switched(flip, &secondary.points[flip.behind - 1], 4, 0.02);
    assert_eq!(doubled.expect("an orbit").segments.len(), 4);
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

/// The van der Pol oscillator with μ = 1 has no events. A rule that changes nothing says where its
/// orbit starts. Its period is known to many digits (Andersen and Geer, *SIAM J. Appl. Math.* 42,
/// 678, 1982: 6.6632868593…).
#[test]
fn an_oscillator_without_events() {
    let text = "parameter mu = 1\nstate x = 2, v = 0\nx' = v\nv' = mu*(1 - x^2)*v - x\nwhen v \
                falls through 0 \"top\"\nend = 9";
    let system = System::parse(text).expect("a system");
    let orbits = Orbits::new(&system).expect("orbits");
    let orbit = orbits.settled(&[1.0], &Guess::default(), 100.0).expect("an orbit");
    assert!((orbit.period - 6.663286859323).abs() < 1e-11, "{orbit:?}");
    assert!(orbit.is_admissible() && orbit.is_stable() && orbit.segments.len() == 1);
    let found = orbits.exponents(&[1.0], &Guess::default(), 100.0, 1000.0).expect("exponents");
    let exact = orbit.largest_multiplier().ln() / orbit.period;
    let errors = [found.values[0], found.values[1] - exact];
    assert!(errors.iter().all(|error| error.abs() < 2e-3), "{found:?} {exact}");
}
