//! Random planted guards of every kind, and how many of them a run finds right: readable systems,
//! black boxes, and black boxes whose guards name their time scale.
//!
//! `cargo run --release -p validation --example planted -- 1000000` prints the table of
//! docs/validation.md. Further arguments: how many wrong cases to describe for each kind, and the
//! number of the only kind to run.

#[allow(dead_code)]
#[path = "../../solver/tests/solver/planted_kinds.rs"]
mod planted_kinds;

use planted_kinds::{Found, Reading, Shape, random_case};

fn main() {
    let mut arguments = std::env::args().skip(1);
    let count = arguments.next().and_then(|count| count.parse().ok()).unwrap_or(1000_u64);
    let shown = arguments.next().and_then(|count| count.parse().ok()).unwrap_or(0_usize);
    let only = arguments.next().and_then(|kind| kind.parse::<usize>().ok());
    println!("{count} cases of each kind: wrong, and refused with an error\n");
    println!("| guard | readable | | black box | | with its scale | |");
    println!("|---|---|---|---|---|---|---|");
    for (kind, name) in Shape::KINDS.into_iter().enumerate() {
        if only.is_some_and(|only| only != kind) {
            continue;
        }
        print!("| {name} |");
        for reading in [Reading::Readable, Reading::BlackBox, Reading::BlackBoxWithScale] {
            let (mut wrong, mut failed) = (0, 0);
            for seed in 0..count {
                let case = random_case(kind, &mut fastrand::Rng::with_seed(seed));
                match case.found(reading) {
                    Found::Right | Found::TooFast => {}
                    Found::Wrong(what) => {
                        wrong += 1;
                        if wrong <= shown {
                            eprintln!("{seed} {reading:?} {what}");
                        }
                    }
                    Found::Failed(error) => {
                        failed += 1;
                        if failed <= shown {
                            eprintln!("{seed} {reading:?} {:?} {error}", case.planted);
                        }
                    }
                }
            }
            print!(" {wrong} | {failed} |");
        }
        println!();
    }
}
