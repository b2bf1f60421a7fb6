//! Orbits of systems that nobody here had in mind.

use stickslip_expression::System;
use stickslip_orbits::{Branch, BranchOptions, Guess, Obstacle, Orbits, SpecialKind, Verdict};

use crate::branches::values;

fn orbits(text: &str) -> Orbits {
    Orbits::new(&System::parse(text).expect("a system")).expect("orbits")
}

/// The branch over the parameter `over`, the others of which have these values.
fn along(
    orbits: &Orbits,
    (values, over): (&[f64], usize),
    itinerary: &[&str],
    range: [f64; 2],
) -> Branch {
    let guess = Guess { itinerary, ..Guess::default() };
    let orbit = orbits.find(values, &guess).expect("an orbit");
    orbits.branch(&orbit, over, range, &BranchOptions::default()).expect("a branch")
}

/// Clocks of 2 and 3: the orbit takes 6, and one in which each ticks once does not come back.
#[test]
fn all_clocks_tick_again() {
    let text = "parameter b = 3\nstate x = 0.1\nx' = -x\nevery 2 \"one\"\n  x := x + 1\n\
                every b from 0.5 \"two\"\n  x := 0.5*x\nend = 20";
    let both = orbits(text);
    let guess = Guess { itinerary: &["one", "two"], ..Guess::default() };
    let refused = both.find(&[3.0], &guess).expect_err("no orbit").to_string();
    assert!(refused.contains("repeats after 2.0, and equations do not"), "{refused}");
    assert!((both.find(&[2.0], &guess).expect("an orbit").period - 2.0).abs() < 1e-12);
    let settled = both.settled(&[3.0], &Guess::default(), 50.0).expect("an orbit");
    assert!((settled.period - 6.0).abs() < 1e-12);
    // Clocks of one period, one later than the other.
    let same = orbits(&text.replace("every b", "every 2"));
    let orbit = same.find(&[3.0], &guess).expect("an orbit");
    assert!((orbit.period - 2.0).abs() < 1e-12 && orbit.is_admissible(), "{:?}", orbit.verdict);
}

/// A reset to a line: one multiplier is 0, the other one is e⁻¹ times the trace of the reset.
#[test]
fn a_return_that_loses_a_dimension() {
    let text = "state x = 1.01, y = 1.01, p = 0\nx' = -x\ny' = -y\np' = 1\nwhen p > 1 \"tick\"\n  \
                p := 0\n  x := 3.97421*((-1.27)*(0.66*x + 0.26*y)) + 2.708236031814374\n  \
                y := 3.97421*(0.58*(0.66*x + 0.26*y)) + 0.2198607098800497\nend = 10";
    let guess = Guess { itinerary: &["tick"], ..Guess::default() };
    let orbit = orbits(text).find(&[], &guess).expect("an orbit");
    let multipliers = orbit.multipliers.clone().expect("no graze");
    let value = (-1.0_f64).exp() * 3.97421 * (-1.27 * 0.66 + 0.58 * 0.26);
    assert!((multipliers[0][0] - value).abs() < 1e-11 && !orbit.is_stable(), "{multipliers:?}");
    assert_eq!(multipliers[1], [0.0, 0.0]);
}

/// What acts in the first half of a segment belongs to that segment.
#[test]
fn a_rule_acts_behind_the_last_event() {
    let text = "parameter q = 0.01\nstate x = 0.5\nmode up\n  x' = 1\n  when x > 1 \"up\" -> down\n\
                mode down\n  x' = -1\n  when x < 0 \"down\" -> up\n  when x > 5 \"far\" -> end\n  \
                when (x - 0.8)^2 < q \"mid\" -> end\nstart in up\nend = 10";
    let own = orbits(text);
    let orbit = own.find(&[0.01], &Guess { itinerary: &["up", "down"], ..Guess::default() });
    let verdict = orbit.expect("an orbit").verdict;
    let acts =
        |it: &Verdict| matches!(it, Verdict::Virtual(Obstacle::Acts { segment: 1, rule: 2, .. }));
    assert!(acts(&verdict), "{verdict:?}");
    let branch = along(&own, (&[-0.01], 0), &["up", "down"], [-0.1, 0.03]);
    assert!(values(&branch, SpecialKind::Grazing)[0].abs() < 1e-10, "{:?}", branch.specials);
    let oscillator = orbits(include_str!("../../../../examples/orbits/oscillator.slip"));
    // In the order of the file: k, c, d, a, w, e.
    let values_of = [1.1, 0.28, 1.0, 1.1, 0.55, 0.26];
    let branch = along(&oscillator, (&values_of, 3), &["impact", "phase"], [0.9, 1.3]);
    let found = values(&branch, SpecialKind::Grazing);
    assert!((found[0] - 1.184904297523).abs() < 1e-10, "{:?}", branch.specials);
}

/// Where two branches meet on the edge of sliding, and the rate of the rule is zero.
#[test]
fn a_branch_point_at_the_edge_of_sliding() {
    let text = include_str!("../../../../examples/orbits/sticking.slip");
    let own = orbits(text);
    let values_of = [1.92, 2.05, 0.25, 0.5, 1.0];
    let orbit = own.settled(&values_of, &Guess::default(), 200.0).expect("an orbit");
    let branch = own.branch(&orbit, 0, [1.43, 3.0], &BranchOptions::default()).expect("it");
    for kind in [SpecialKind::BranchPoint, SpecialKind::GrazingSliding] {
        let found = values(&branch, kind);
        let near = found.iter().any(|it| (it - 1.6905190859870).abs() < 1e-10);
        assert!(near, "{kind:?} {found:?}");
    }
}

/// Multipliers −1 − p and −1 − 2(p − g), each with a flip of its own.
#[test]
fn two_flips_in_one_step() {
    let text = "parameter p = -0.4, g = 0.001\nstate x = 0.2, y = 0.2, s = 0\nx' = 0\ny' = 0\n\
                s' = 1\nwhen s > 1 \"tick\"\n  s := 0\n  x := (-1 - p)*x + 1\n  y := (-1 - \
                2*(p - g))*y + x\nend = 20";
    let own = orbits(text);
    for g in [0.1, 0.001] {
        let branch = along(&own, (&[-0.4, g], 0), &["tick"], [-0.7, 0.7]);
        let mut found = values(&branch, SpecialKind::Flip);
        found.sort_by(f64::total_cmp);
        assert_eq!((found.len(), &branch.objection), (2, &None), "{g}: {found:?}");
        assert!(found[0].abs() < 1e-10 && (found[1] - g).abs() < 1e-10, "{found:?}");
    }
    // At once they are not told apart, and the branch says so.
    let branch = along(&own, (&[-0.4, 0.0], 0), &["tick"], [-0.7, 0.7]);
    let objection = branch.objection.expect("an objection");
    assert!(objection.contains("several multipliers pass the unit circle"), "{objection}");
}
