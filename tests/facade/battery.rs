//! Every event of the battery is found, and no other.

use stickslip::solver::{Dop853, EmbeddedPair};

use crate::cases::{Reading, cases, run_case, text};

/// Cases that take the 5(4) pair more steps than a run may have by default.
const TOO_LONG_FOR_DOPRI5: [&str; 1] = ["long-run-1e5"];

/// Checks all cases, as texts, but those that are `left_out`.
fn check(pair: EmbeddedPair, left_out: &[&str]) {
    let mut wrong = Vec::new();
    for case in cases() {
        if left_out.contains(&case.name.as_str()) {
            continue;
        }
        let report = text::run(pair, &case);
        if !report.is_right() {
            wrong.push(format!("{}: {report}", case.name));
        }
    }
    assert!(wrong.is_empty(), "{} cases are wrong:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn the_battery_is_right_with_dop853() {
    check(EmbeddedPair::Dop853, &[]);
}

#[test]
fn the_battery_is_right_with_dopri5() {
    check(EmbeddedPair::Dopri5, &TOO_LONG_FOR_DOPRI5);
}

#[test]
fn a_black_box_has_no_event_too_many() {
    for case in cases() {
        for reading in [Reading::BlackBox, Reading::ScaledBlackBox] {
            let report = run_case(Dop853, &case, reading);
            let verdict = &report.verdict;
            let name = &case.name;
            assert!(verdict.invented + verdict.misplaced == 0, "{name}, {reading:?}: {report}");
        }
    }
}

/// Where the black box of fixed dimension is right, that of any dimension is.
#[test]
fn a_dynamic_system_is_right_where_a_black_box_is() {
    let mut right = 0;
    for case in cases().into_iter().step_by(2) {
        for (fixed, free) in [
            (Reading::BlackBox, Reading::Dynamic),
            (Reading::ScaledBlackBox, Reading::ScaledDynamic),
        ] {
            let (fixed, report) = (run_case(Dop853, &case, fixed), run_case(Dop853, &case, free));
            assert!(report.is_right() || !fixed.is_right(), "{}, {free:?}: {report}", case.name);
            let verdict = &report.verdict;
            assert_eq!(
                verdict.invented + verdict.misplaced,
                0,
                "{}, {free:?}: {report}",
                case.name
            );
            right += usize::from(report.is_right());
        }
    }
    assert!(right > 45, "{right}");
}
