//! Random systems whose events coincide act in the order that exact arithmetic finds.

use crate::instants::Case;

/// Cases in which a run once took another order.
const FOUND: [u64; 72] = [
    3253, 7070, 20636, 21013, 22984, 27499, 29962, 17827, 22504, 23438, 33288, 12805, 12928, 13668,
    14649, 15225, 15888, 17504, 18114, 18271, 19025, 19472, 20684, 21501, 101110, 200908, 5647,
    1010516, 1013290, 1014713, 1015497, 1019137, 1034081, 1040924, 2003684, 2005728, 2006756,
    2007349, 2008407, 2012297, 2016349, 2026736, 2031699, 2037740, 2049232, 2061116, 3017640,
    3029339, 3035418, 3055945, 3066836, 3072227, 3074126, 3084579, 3026467, 6056896, 6177955,
    7041442, 7075322, 7117276, 7143415, 7214320, 7225575, 7252833, 8022158, 8024562, 8036290,
    8047425, 8054794, 8061699, 8052270, 8107198,
];

#[test]
fn everything_that_happens_at_one_instant_acts_in_order() {
    for seed in (0..500).chain(FOUND) {
        let case = Case::new(seed);
        let faults = case.faults();
        assert!(faults.is_empty(), "seed {seed}\n{}\n{faults:#?}", case.describe());
    }
}
