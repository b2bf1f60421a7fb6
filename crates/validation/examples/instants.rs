//! Random hybrid systems whose events coincide exactly or nearly, against exact arithmetic.
//!
//! `cargo run --release -p validation --example instants -- 100000 0` runs the systems of the seeds
//! 0 to 99 999, each in four forms and by two methods, and prints how many runs are wrong. A third
//! argument says how many wrong runs to describe; with a count of 1, the system itself is printed.

#[allow(dead_code, reason = "the tests of the solver use the rest")]
#[path = "../../solver/tests/solver/instants.rs"]
mod instants;

use instants::oracle::Counts;
use instants::{Case, FORMS, Fault};
use rayon::prelude::*;

fn main() {
    let numbers: Vec<u64> =
        std::env::args().skip(1).filter_map(|argument| argument.parse().ok()).collect();
    let number = |index: usize, otherwise| numbers.get(index).copied().unwrap_or(otherwise);
    let (count, first, shown) = (number(0, 1000), number(1, 0), number(2, 3));
    if count == 1 {
        println!("{}", Case::new(first).describe());
    }
    let cases = (first..first + count).into_par_iter();
    let results: Vec<_> = cases
        .map(|seed| {
            let case = Case::new(seed);
            (seed, case.plan.counts, case.faults())
        })
        .collect();
    let mut sum = Counts::default();
    for (_, counts, _) in &results {
        sum.instants += counts.instants;
        sum.shared += counts.shared;
        sum.most = sum.most.max(counts.most);
        sum.preempted += counts.preempted;
        sum.dismissed += counts.dismissed;
        sum.violated += counts.violated;
        sum.jumps += counts.jumps;
        sum.at_start += counts.at_start;
        sum.at_end += counts.at_end;
        sum.close += counts.close;
        sum.closest += counts.closest;
    }
    println!("{count} systems: {sum:?}\n");
    println!(
        "| form | method | errors | other outcomes | wrong orders | wrong values | undecided | seeds |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for form in FORMS {
        for method in ["dop853", "dopri5"] {
            let mut kinds = [0; 5];
            let mut seeds = Vec::new();
            for (seed, _, faults) in &results {
                for (_, _, fault) in faults.iter().filter(|one| (one.0, one.1) == (form, method)) {
                    seeds.push(seed);
                    kinds[match fault {
                        Fault::Error(_) => 0,
                        Fault::Outcome(_) => 1,
                        Fault::Order(_) => 2,
                        Fault::Value(_) => 3,
                        Fault::Undecided => 4,
                    }] += 1;
                }
            }
            let [errors, outcomes, orders, values, undecided] = kinds;
            seeds.truncate(8);
            println!(
                "| {form:?} | {method} | {errors} | {outcomes} | {orders} | {values} | {undecided} \
                 | {seeds:?} |"
            );
        }
    }
    let faults = results.iter().flat_map(|(seed, _, faults)| faults.iter().map(move |f| (seed, f)));
    for (seed, (form, method, fault)) in faults.take(usize::try_from(shown).unwrap_or(usize::MAX)) {
        println!("\nseed {seed}, {form:?}, {method}: {fault:?}");
    }
}
