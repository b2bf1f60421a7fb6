//! The event battery: guards whose zeros are known, and what a run finds of them.
//!
//! Most cases run on y' = 1. Both methods integrate this exactly, so that the guard along the run
//! is the planted function of s itself. `cargo test -p stickslip-solver --test solver
//! print_the_table -- --ignored --nocapture` prints the table of `crates/validation/JOURNAL.md`.

mod guards;
mod planted;
mod systems;
mod together;

use planted::{Score, cases, dip, score, triple};
use stickslip_solver::{Dop853, Dopri5};
use systems::{LEVELS, oscillator, relay};

impl Score {
    fn plus(self, other: Self) -> Self {
        Self {
            planted: self.planted + other.planted,
            found: self.found + other.found,
            missed: self.missed + other.missed,
            invented: self.invented + other.invented,
            error: self.error.max(other.error),
        }
    }

    fn print(&self, name: &str, steps: &str) {
        let error =
            if self.found == 0 { String::from("–") } else { format!("{:.0e}", self.error) };
        let Self { planted, found, missed, invented, .. } = self;
        println!("| {name} | {steps} | {planted} | {found} | {missed} | {invented} | {error} |");
    }
}

#[test]
#[ignore = "prints the table of the journal"]
fn print_the_table() {
    println!("| case | step sizes | planted | found | missed | invented | largest error |");
    println!("|---|---|---|---|---|---|---|");
    for case in cases() {
        score(&case).print(&case.name, "1e-3 … 1, adaptive");
    }
    for digits in [5, 7, 9, 11, 13] {
        let case = triple(digits);
        score(&case).print(&case.name, "1e-3 … 1, adaptive");
    }
    for case in together::cases() {
        together::score(&case)
            .print(&format!("two or three guards: {}", case.name), "1e-3 … 1, adaptive");
    }
    for width in [0.3, 0.1, 0.05, 0.03] {
        dip(width, 1.0).print(&format!("dip of half width {width}"), "1");
    }
    for (level, tolerance) in LEVELS {
        let name = format!("integrated sine, 1 − {:.0e} of its height", 1.0 - level);
        let both = oscillator(Dopri5, level, tolerance).plus(oscillator(Dop853, level, tolerance));
        both.print(&name, "adaptive");
    }
    let both = relay(Dopri5, 10_000).plus(relay(Dop853, 10_000));
    both.print("relay with hysteresis, 10 000 switches", "adaptive");
}
