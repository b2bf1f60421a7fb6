//! Random systems whose events coincide act in the order that exact arithmetic finds.

use crate::instants::{Case, Form};

/// Cases in which a run once took another order.
const FOUND: [u64; 64] = [
    3253, 7070, 20636, 21013, 22984, 27499, 29962, 17827, 22504, 23438, 33288, 12805, 12928, 13668,
    14649, 15225, 15888, 17504, 18114, 18271, 19025, 19472, 20684, 21501, 101110, 200908, 5647,
    1010516, 1013290, 1014713, 1015497, 1019137, 1034081, 1040924, 2003684, 2005728, 2006756,
    2007349, 2008407, 2012297, 2016349, 2026736, 2031699, 2037740, 2049232, 2061116, 3017640,
    3029339, 3035418, 3055945, 3066836, 3072227, 3074126, 3084579, 3026467, 6056896, 6177955,
    7041442, 7075322, 7117276, 7143415, 7214320, 7225575, 7252833,
];

/// Cases in which noise is a large part of all that a guard does. Bounds tell it; samples do not.
const NOISY: [u64; 3] = [3203416, 7239225, 7266137];

#[test]
fn everything_that_happens_at_one_instant_acts_in_order() {
    for seed in (0..500).chain(FOUND) {
        let case = Case::new(seed);
        let faults = case.faults();
        assert!(faults.is_empty(), "seed {seed}\n{}\n{faults:#?}", case.describe());
    }
}

#[test]
fn readable_guards_know_their_own_rounding() {
    for seed in NOISY {
        let case = Case::new(seed);
        let mut faults = case.faults();
        faults.retain(|(form, ..)| matches!(form, Form::Fixed | Form::Any));
        assert!(faults.is_empty(), "seed {seed}\n{}\n{faults:#?}", case.describe());
    }
}
