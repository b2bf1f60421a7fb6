//! Margins of prescribed runs vanish on the switch boundaries, whose places are known to twenty
//! digits.

use stickslip_model::regularized::{Phase, Regularized};
use stickslip_model::{Contact, exact};
use stickslip_solver::margin::{Margin, Margins, Place, margin, margins};
use stickslip_solver::{Dop853, Options, Start};

use crate::common::{file, number};

fn options() -> Options {
    Options { rtol: 1e-14, atol: 1e-14, first_step: Some(0.1), max_step: 0.1, ..Options::default() }
}

fn start(contact: Contact) -> (Regularized, Start<Phase, 8>) {
    let system = Regularized::new(contact);
    (system, Start { mode: Phase::first(&contact), s: 0.0, state: system.start() })
}

fn free(kappa: f64, psi: f64) -> Margins {
    let (system, start) = start(Contact::new(kappa, psi, 0.0).unwrap());
    margins(Dop853, &system, start, f64::INFINITY, &options()).unwrap()
}

fn value(kappa: f64, psi: f64, which: &Margin) -> f64 {
    let (system, start) = start(Contact::new(kappa, psi, 0.0).unwrap());
    let miss = margin(Dop853, &system, start, f64::INFINITY, &options(), which).unwrap();
    miss.expect("the margin exists near the boundary").value
}

/// Checks that the least margin on the side of fewer switches vanishes within `accuracy` of each
/// reference boundary.
fn assert_zeros_at_boundaries(
    accuracy: f64,
    free: impl Fn(f64, f64) -> (usize, Vec<(Margin, f64)>),
    value: impl Fn(f64, f64, &Margin) -> f64,
) {
    let data = file("boundaries");
    let mut largest = 0.0_f64;
    for boundary in data["boundaries"].as_array().unwrap() {
        let (kappa, psi) = (number(&boundary["kappa"]), number(&boundary["psi"]));
        let (below, above) = (boundary["below"].as_u64(), boundary["above"].as_u64());
        // A place near the boundary, on the side of fewer switches.
        let side = if below < above { -1.0 } else { 1.0 };
        let near = psi * (1.0 + side * 1e-5);
        let (count, margins) = free(kappa, near);
        assert_eq!(Some(count as u64), if side < 0.0 { below } else { above });
        // Other margins tell where a phase starts or ends, and none of them vanishes here.
        let tells = |place| matches!(place, Place::End | Place::Minimum { .. });
        let positive = margins.iter().filter(|(which, value)| *value > 0.0 && tells(which.place));
        let (which, nearest) =
            positive.min_by(|(_, a), (_, b)| a.total_cmp(b)).expect("a near miss");
        let kind = match which.place {
            Place::End => "end-of-contact",
            Place::Minimum { .. } if which.exits.len().is_multiple_of(2) => "slip-graze",
            Place::Minimum { .. } => "stick-graze",
            place => panic!("{place:?}"),
        };
        assert_eq!(boundary["kind"], kind, "κ = {kappa}, ψ = {psi}");
        // The secant method: the margin exists on both sides of its zero.
        let (mut last, mut at) = (near, psi * (1.0 - side * 1e-6));
        let (mut last_value, mut at_value) = (*nearest, value(kappa, at, which));
        assert!(at_value < 0.0, "beyond the boundary the margin is negative");
        for _ in 0..6 {
            if at_value == last_value {
                break;
            }
            let next = at - at_value * (at - last) / (at_value - last_value);
            (last, last_value) = (at, at_value);
            (at, at_value) = (next, value(kappa, next, which));
            if (at - last).abs() < 1e-14 {
                break;
            }
        }
        if (at - psi).abs() > 0.1 * accuracy {
            println!("{kind} κ = {kappa}, ψ = {psi}: off by {:.1e}, {which:?}", at - psi);
        }
        largest = largest.max((at - psi).abs());
    }
    println!("largest error in ψ {largest:.1e}");
    assert!(largest < accuracy);
}

#[test]
fn boundaries_are_the_zeros_of_margins() {
    let pairs = |kappa, psi| {
        let run = free(kappa, psi);
        let margins = run.near_misses.into_iter().map(|miss| (miss.margin, miss.value));
        (run.fired.len(), margins.collect())
    };
    assert_zeros_at_boundaries(1e-11, pairs, value);
}

fn undamped(kappa: f64, psi: f64) -> Contact {
    Contact::new(kappa, psi, 0.0).unwrap()
}

#[test]
fn boundaries_are_the_zeros_of_exact_margins() {
    let pairs = |kappa, psi| {
        let found = exact::margins(&undamped(kappa, psi)).unwrap();
        (found.fired.len(), found.near_misses)
    };
    let value = |kappa, psi, which: &Margin| {
        let value = exact::margin(&undamped(kappa, psi), which).unwrap();
        value.expect("the margin exists near the boundary")
    };
    assert_zeros_at_boundaries(1e-13, pairs, value);
}

/// Each exact margin has the same value after the free run and after the prescribed one, and its
/// hints fit the collision to which they belong.
#[test]
fn exact_margins_are_those_of_the_free_run() {
    let mut random = fastrand::Rng::with_seed(1);
    let (mut count, mut largest) = (0, [0.0_f64; 2]);
    for index in 0..20_000 {
        let mut power = |low: f64, ratio: f64| low * ratio.powf(random.f64());
        let damping = if index % 2 == 0 { 0.0 } else { power(1e-6, 1e8) };
        let contact = Contact::new(power(1e-3, 1e7), power(3e-3, 1e3), damping).unwrap();
        let found = exact::margins(&contact).unwrap();
        let collision = exact::collide(contact).unwrap();
        assert_eq!(found.fired, collision.fired(), "{contact:?}");
        for (which, value) in &found.near_misses {
            assert!(*value >= 0.0, "{contact:?}: {which:?} is {value}");
            let again = exact::margin(&contact, which).unwrap().expect("it exists here");
            let difference = (again - value).abs() / value.max(1.0);
            let largest = &mut largest[usize::from(damping > 0.0)];
            *largest = largest.max(difference);
            let moved = exact::moved(&contact, which).unwrap();
            // Hints compare as equal whatever their numbers are; their text does not.
            assert_eq!(format!("{:?}", moved.exits), format!("{:?}", which.exits), "{contact:?}");
            count += 1;
        }
    }
    println!("{count} margins, largest relative differences {largest:?}");
    assert!(count > 100_000 && largest[0] < 1e-15 && largest[1] < 1e-14);
}

/// Margins of both engines have the same sign on both sides of a boundary and away from it.
#[test]
fn both_engines_have_margins_of_one_sign() {
    let mut random = fastrand::Rng::with_seed(2);
    let mut counts = [0; 2];
    for _ in 0..3000 {
        let (kappa, psi) = (0.05 * 2e3_f64.powf(random.f64()), 0.01 + 2.5 * random.f64());
        let integrated = free(kappa, psi);
        let exact = exact::margins(&undamped(kappa, psi)).unwrap();
        assert_eq!(integrated.fired, exact.fired, "κ = {kappa}, ψ = {psi}");
        let (kappa, psi) = (kappa * (0.8 + 0.4 * random.f64()), psi * (0.8 + 0.4 * random.f64()));
        let tells = |place| matches!(place, Place::End | Place::Minimum { .. });
        for miss in integrated.near_misses.iter().filter(|miss| tells(miss.margin.place)) {
            // Minima of the gap and tops of the ratio have different numbers. If there is one of
            // each in a phase and guard, they belong together.
            let alike = |other: &Margin| {
                let Margin { exits, guard, place } = &miss.margin;
                let end = (*place == Place::End) == (other.place == Place::End);
                other.exits == *exits && other.guard == *guard && end
            };
            let mut others = exact.near_misses.iter().filter(|(other, _)| alike(other));
            let (Some((other, _)), None) = (others.next(), others.next()) else { continue };
            if integrated.near_misses.iter().filter(|miss| alike(&miss.margin)).count() != 1 {
                continue;
            }
            let (system, start) = start(undamped(kappa, psi));
            let end = f64::INFINITY;
            let one = margin(Dop853, &system, start, end, &options(), &miss.margin).unwrap();
            let two = exact::margin(&undamped(kappa, psi), other).unwrap();
            if let (Some(one), Some(two)) = (one, two)
                && one.value.abs() > 1e-11
            {
                let same = (one.value > 0.0) == (two > 0.0);
                assert!(same, "κ = {kappa}, ψ = {psi}: {} and {two}, {other:?}", one.value);
                counts[usize::from(two < 0.0)] += 1;
            }
        }
    }
    println!("{counts:?} margins above and below 0");
    assert!(counts[0] > 2000 && counts[1] > 100, "{counts:?}");
}

/// Phases that are followed by another one have no margin at the end of the run.
#[test]
fn only_the_last_phase_leaves_a_margin_at_the_end() {
    let run = free(63.0, 0.5);
    let at_end = run.near_misses.iter().filter(|miss| miss.margin.place == Place::End);
    let phases: Vec<usize> = at_end.map(|miss| miss.margin.exits.len()).collect();
    assert_eq!((run.fired.len(), &phases[..]), (6, &[6][..]));
}

/// With little damping the limit falls faster than the spring over many half swings before the end
/// of contact. The graze at the end belongs to the last of them alone, and its margin is smooth on
/// both sides of the boundary, and where the least gap leaves through the end of contact.
#[test]
fn a_late_graze_has_one_margin() {
    let contact = |kappa: f64, psi: f64| Contact::new(kappa, psi, 5.4e-5).unwrap();
    // All is stick from the start, and at κ = 77.1977 the spring swings through nine half swings.
    let near = exact::margins(&contact(77.2054, 1.1e-4)).unwrap().near_misses;
    let grazes: Vec<_> = near
        .iter()
        .filter(|(which, value)| {
            which.exits.is_empty() && matches!(which.place, Place::Minimum { .. }) && *value < 1.0
        })
        .collect();
    let [(graze, _)] = grazes[..] else { panic!("{grazes:?}") };
    let value = |kappa, psi| exact::margin(&contact(kappa, psi), graze).unwrap().unwrap();
    let across: Vec<f64> =
        (-4..=4).map(|i| value(77.197_696 * (1.0 + 1e-4 * f64::from(i)), 1.1e-4)).collect();
    assert!(across[0] < 0.0 && across[8] > 0.0, "{across:?}");
    for pair in across.windows(2) {
        assert!((2.8e-3..2.9e-3).contains(&(pair[1] - pair[0])), "{across:?}");
    }
    // The least gap is at the end of contact for κψ = √a, which is ψ = 9.52e-5.
    let along: Vec<f64> = (0..=40).map(|i| value(77.25, 8.5e-5 + 5e-7 * f64::from(i))).collect();
    for triple in along.windows(3) {
        let bend = triple[2] - 2.0 * triple[1] + triple[0];
        assert!((-4e-8..-1.5e-8).contains(&bend), "{bend:e} {along:?}");
    }
}
