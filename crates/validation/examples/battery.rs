//! The battery of event-location cases: how many events this solver, SciPy and heyoka find.
//!
//! Each cell has the numbers of events that are right, missed, invented and misplaced, then the
//! largest error of a place that is right, evaluations of the right-hand side and the time. The
//! solver runs each case three times: it reads the formulas; it only evaluates them (a black box);
//! and as a black box that is told the scale of its guards, where the case has one. The results of
//! SciPy and heyoka are those that `tests/battery/peers.py` wrote.
//!
//! Run with `cargo run --release -p validation --example battery`, or with `-- dopri5` for the
//! other method.

#[path = "../../../tests/battery/cases.rs"]
#[allow(dead_code, reason = "the tests of the facade use the rest")]
mod cases;

use std::error::Error;

use serde_json::Value;
use stickslip::solver::{Dop853, Dopri5};

use cases::{Case, Reading, cases, run_case};

const READINGS: [Reading; 3] = [Reading::Readable, Reading::BlackBox, Reading::ScaledBlackBox];

/// The cell of a peer.
fn peer(result: &Value) -> String {
    let text = result["error_text"].as_str();
    if result["right"].is_null() {
        return text.unwrap_or("not run").to_owned();
    }
    let [right, missed, invented, misplaced] =
        ["right", "missed", "invented", "misplaced"].map(|key| result[key].as_u64().unwrap_or(0));
    let error = result["error"].as_f64().unwrap_or(f64::NAN);
    let mut cell = format!("{right}/{missed}/{invented}/{misplaced}, {error:.0e}");
    if let Some(seconds) = result["seconds"].as_f64() {
        cell = format!("{cell}, {:.2} ms", 1e3 * seconds);
    }
    if let Some(text) = text {
        cell = format!("{cell} ({text})");
    }
    let wrong = missed + invented + misplaced > 0 || text.is_some();
    if wrong { format!("**{cell}**") } else { cell }
}

/// The cells of a case in each reading that it has, and whether each is right.
fn own(case: &Case, dopri5: bool) -> [Option<(String, bool)>; 3] {
    READINGS.map(|reading| {
        let has = reading != Reading::ScaledBlackBox || case.guard_scale.is_some();
        has.then(|| {
            let report = if dopri5 {
                run_case(Dopri5, case, reading)
            } else {
                run_case(Dop853, case, reading)
            };
            let right = report.is_right();
            (if right { report.to_string() } else { format!("**{report}**") }, right)
        })
    })
}

fn main() -> Result<(), Box<dyn Error>> {
    let dopri5 = match std::env::args().nth(1).as_deref() {
        None | Some("dop853") => false,
        Some("dopri5") => true,
        Some(other) => return Err(format!("the method is dop853 or dopri5, not {other}").into()),
    };
    let peers: Value = serde_json::from_str(include_str!("../../../tests/battery/peers.json"))?;
    println!("| case | readable | black box | black box with scale | SciPy | heyoka |");
    println!("|---|---|---|---|---|---|");
    let mut right = [0; 3];
    let mut total = 0;
    for case in cases() {
        let runs = own(&case, dopri5);
        for (count, run) in right.iter_mut().zip(&runs) {
            // Without a scale of its own, a case counts as in the plain black box.
            *count += usize::from(run.as_ref().or(runs[1].as_ref()).is_some_and(|run| run.1));
        }
        let cells = runs.map(|run| run.map_or("–".to_owned(), |run| run.0));
        total += 1;
        let others = ["scipy", "heyoka"].map(|name| peer(&peers[&case.name][name]));
        println!("| {} | {} | {} |", case.name, cells.join(" | "), others.join(" | "));
    }
    println!(
        "\nAll right in {} of {total} cases if read, {} as black boxes, {} with a scale.",
        right[0], right[1], right[2]
    );
    Ok(())
}
