//! Every event of the battery is found, and no other.

use stickslip::solver::{Dop853, Dopri5, Method};

use crate::cases::{Reading, cases, run_case};

/// Cases that are still wrong when the solver reads them, with the method.
const KNOWN_WRONG: [(&str, &str); 0] = [];

fn check<M: Method>(method: M, name: &str) {
    let mut wrong = Vec::new();
    for case in cases() {
        let report = run_case(method, &case, Reading::Readable);
        let known = KNOWN_WRONG.contains(&(case.name.as_str(), name));
        if report.is_right() == known {
            wrong.push(format!("{}: {report:?}", case.name));
        }
    }
    assert!(wrong.is_empty(), "{} cases differ with {name}:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn the_battery_is_right_with_dop853() {
    check(Dop853, "dop853");
}

#[test]
fn the_battery_is_right_with_dopri5() {
    check(Dopri5, "dopri5");
}
