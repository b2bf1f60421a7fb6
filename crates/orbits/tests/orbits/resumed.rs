//! Branches that go on from their ends, and what was written of them.

use stickslip_expression::System;
use stickslip_orbits::{Branch, BranchOptions, Guess, Orbit, Orbits, SpecialKind};

use crate::branches::values;
use crate::impact::{self, Closed};

/// The branch of the oscillator over its amplitude, at the frequency 0.8.
fn impacts(orbits: &Orbits, range: [f64; 2], options: &BranchOptions) -> Branch {
    let closed = Closed { w: 0.8, a: 0.45, ..Closed::EXAMPLE };
    let orbit = impact::near(orbits, &closed, closed.speeds()[0], 1e-4).expect("an orbit");
    orbits.branch(&orbit, 3, range, options).expect("a branch")
}

/// Requires that a branch is the one that is followed at once, with its points in one order.
fn require_whole(branch: &Branch, range: [f64; 2]) {
    assert_eq!((branch.objection.as_deref(), branch.closed, branch.range), (None, false, range));
    let flip = values(branch, SpecialKind::Flip);
    assert!(flip.iter().any(|it| (it - 0.518209866598).abs() < 1e-11), "{flip:?}");
    let graze = values(branch, SpecialKind::Grazing);
    assert!(graze.iter().any(|it| (it - 0.368781778292).abs() < 1e-11), "{graze:?}");
    // A special orbit lies between the points beside it, in the order of the branch.
    let speed = |orbit: &Orbit| orbit.segments[1].end[1];
    for special in &branch.specials {
        let [one, other] = [special.behind - 1, special.behind].map(|k| speed(&branch.points[k]));
        let own = speed(&special.orbit);
        assert!(one.min(other) - 1e-9 <= own && own <= one.max(other) + 1e-9, "{special:?}");
    }
    let speeds: Vec<f64> = branch.points.iter().map(speed).collect();
    assert!(speeds.is_sorted() || speeds.iter().rev().is_sorted(), "{speeds:?}");
}

#[test]
fn a_branch_goes_on_from_both_ends() {
    let (orbits, options) = (impact::orbits(), BranchOptions::default());
    let whole = impacts(&orbits, [0.05, 1.2], &options);
    require_whole(&whole, [0.05, 1.2]);
    let part = impacts(&orbits, [0.42, 0.5], &options);
    assert!(part.specials.is_empty() && part.points.iter().all(Orbit::is_admissible));
    let resumed = orbits.resumed(&part, [0.05, 1.2], &options).expect("a branch");
    require_whole(&resumed, [0.05, 1.2]);
    // What was known stays, and nothing is added where there is nothing more.
    let first =
        resumed.points.iter().position(|it| *it == part.points[0]).expect("its first point");
    assert_eq!(resumed.points[first..first + part.points.len()], part.points);
    assert_eq!(orbits.resumed(&resumed, [0.05, 1.2], &options), Ok(resumed));
}

/// Three points on each side are enough for nothing: the branch goes on where it stopped, through
/// the graze, a few points at a time.
#[test]
fn a_branch_that_had_enough_points_goes_on() {
    let orbits = impact::orbits();
    let few = BranchOptions { most_points: 4, ..BranchOptions::default() };
    let mut branch = impacts(&orbits, [0.05, 1.2], &few);
    assert!(branch.objection.as_ref().is_some_and(|it| it.contains("goes on behind 4 points")));
    let mut rounds = 0;
    while branch.objection.is_some() {
        let before = branch.points.len();
        branch = orbits.resumed(&branch, [0.05, 1.2], &few).expect("a branch");
        assert!(branch.points.len() > before && rounds < 200, "{:?}", branch.objection);
        rounds += 1;
    }
    assert!(rounds > 2, "{rounds}");
    require_whole(&branch, [0.05, 1.2]);
}

/// The orbits of y' = m − … on a circle: (m, y) goes around (0, 1/2), and the branch is closed
/// also where its second half is followed from what was written of its first one.
#[test]
fn a_branch_closes_at_its_other_end() {
    let text = "parameter m = 0, h = 0.5\nstate x = 0, y = 0.9\ny' = 0.16 - m^2 - (y - 0.5)^2\n\
                mode up\n  x' = 1 - x\n  when x > h \"up\" -> down\nmode down\n  x' = -1 - x\n  \
                when x < -h \"down\" -> up\nstart in up\nend = 9";
    let system = System::parse(text).expect("a system");
    let orbits = Orbits::new(&system).expect("orbits");
    let guess = Guess { itinerary: &["up", "down"], ..Guess::default() };
    let orbit = orbits.find(&system.values(), &guess).expect("an orbit");
    let options = BranchOptions::default();
    let whole = orbits.branch(&orbit, 0, [-1.0, 1.0], &options).expect("a branch");
    assert!(whole.closed && whole.objection.is_none(), "{:?}", whole.objection);
    let folds = |branch: &Branch| {
        let mut all = values(branch, SpecialKind::Fold);
        all.sort_by(f64::total_cmp);
        assert!(matches!(all[..], [a, b] if (a + 0.4).abs() < 1e-10 && (b - 0.4).abs() < 1e-10));
    };
    folds(&whole);
    let few = BranchOptions { most_points: 8, ..options };
    let part = orbits.branch(&orbit, 0, [-1.0, 1.0], &few).expect("a branch");
    assert!(!part.closed);
    let resumed = orbits.resumed(&part, [-1.0, 1.0], &options).expect("a branch");
    assert!(resumed.closed && resumed.objection.is_none(), "{:?}", resumed.objection);
    folds(&resumed);
    let said = orbits.resumed(&resumed, [-1.0, 1.0], &options).expect_err("closed").to_string();
    assert!(said.contains("comes back to its start"), "{said}");
}

#[test]
fn what_cannot_go_on_is_refused() {
    let (orbits, options) = (impact::orbits(), BranchOptions::default());
    let branch = impacts(&orbits, [0.4, 0.5], &options);
    let refused = |orbits: &Orbits, branch: &Branch, range: [f64; 2]| {
        orbits.resumed(branch, range, &options).expect_err("refused").to_string()
    };
    let said = refused(&orbits, &branch, [0.45, 0.6]);
    assert!(said.contains("a range that contains that of the branch, 0.4:0.5"), "{said}");
    assert!(refused(&orbits, &branch, [0.3, f64::INFINITY]).contains("LO:HI"));
    assert!(refused(&orbits, &branch, [0.3, f64::NAN]).contains("that of the branch"));
    let empty = Branch { points: Vec::new(), ..branch.clone() };
    assert!(refused(&orbits, &empty, [0.3, 0.6]).contains("at least one orbit"));
    let mut strange = branch.clone();
    strange.points[0].segments.pop();
    assert!(refused(&orbits, &strange, [0.3, 0.6]).contains("segments"));
    let mut strange = branch.clone();
    strange.points[0].segments[0].state[1] += 1e-4;
    assert!(refused(&orbits, &strange, [0.3, 0.6]).contains("from an orbit"));
    // The same rules with another wall.
    let other = impact::TEXT.replace("d = 1", "d = 1.5");
    let other = Orbits::new(&System::parse(&other).expect("a system")).expect("orbits");
    let mut foreign = branch.clone();
    for orbit in &mut foreign.points {
        orbit.parameters[2] = 1.5;
    }
    let said = refused(&other, &foreign, [0.3, 0.6]);
    assert!(said.contains("from an orbit"), "{said}");
}
