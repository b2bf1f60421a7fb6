//! Random planted guards of every kind, and how many of them a run finds right: readable systems,
//! black boxes, and black boxes whose guards name their time scale.
//!
//! `cargo run --release -p validation --example planted -- 1000000 10000` prints the table of
//! docs/validation.md: a million readable systems and ten thousand black boxes of each kind.
//! Further arguments: how many wrong cases to describe for each kind, the number of the only kind
//! to run, and the number of the first case, so that a long list can be run in parts.

#[allow(dead_code, reason = "the tests of the solver use the rest")]
#[path = "../../solver/tests/solver/planted_kinds.rs"]
mod planted_kinds;

/// What the tests of the solver compile once for all systems is compiled for each one here.
mod erased {
    pub use stickslip::solver::run;
}

use planted_kinds::{Found, Reading, Shape, random_case};
use rayon::prelude::*;

fn main() {
    let numbers: Vec<u64> =
        std::env::args().skip(1).filter_map(|argument| argument.parse().ok()).collect();
    let number = |index: usize| numbers.get(index).copied();
    let count = number(0).unwrap_or(1000);
    let black_boxes = number(1).unwrap_or(count);
    let shown = number(2).unwrap_or(0);
    let first = number(4).unwrap_or(0);
    println!("{count} readable systems and {black_boxes} black boxes of each kind:");
    println!("wrong, and refused with an error\n");
    println!("| guard | readable | | black box | | with its scale | |");
    println!("|---|---|---|---|---|---|---|");
    for (kind, name) in Shape::KINDS.into_iter().enumerate() {
        if number(3).is_some_and(|only| only != kind as u64) {
            continue;
        }
        print!("| {name} |");
        for (reading, count) in [
            (Reading::Readable, count),
            (Reading::BlackBox, black_boxes),
            (Reading::BlackBoxWithScale, black_boxes),
        ] {
            let cases = (first..first + count).into_par_iter();
            let (wrong, refused): (Vec<_>, Vec<_>) = cases
                .flat_map_iter(|seed| not_right(kind, seed, reading))
                .partition(|(is_wrong, _)| *is_wrong);
            print!(" {} | {} |", wrong.len(), refused.len());
            for cases in [wrong, refused] {
                for ((_, what), _) in cases.iter().zip(0..shown) {
                    eprintln!("{reading:?} {what}");
                }
            }
        }
        println!();
    }
}

/// Whether a case is wrong, or else refused, and how. Nothing if it is right.
fn not_right(kind: usize, seed: u64, reading: Reading) -> Option<(bool, String)> {
    let case = random_case(kind, &mut fastrand::Rng::with_seed(seed));
    match case.found(reading) {
        Found::Right | Found::TooFast => None,
        Found::Wrong(what) => Some((true, format!("{seed}: {what}"))),
        Found::Failed(error) => Some((false, format!("{seed}: {:?} {error}", case.planted))),
    }
}
