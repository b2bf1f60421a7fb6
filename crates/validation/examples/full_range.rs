//! Random collisions over the whole range of κ, ψ and damping: is every result right, and how long
//! does the slowest take?
//!
//! κ is log-uniform in [1e-12, 1e5], ψ in [1e-12, 1e12]. Half of the collisions have no damping; in
//! the others it is log-uniform in [1e-12, 1e3]. `tests/checks/collision.rs` checks each collision
//! of each engine. The program prints the number of results for each part of the range, and fails
//! if a check fails.
//!
//! Run with `cargo run --release -p validation --example full_range -- [COUNT] [SEED]`; 100 000
//! without arguments.

use std::collections::BTreeMap;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use stickslip::model::{Collider, Collision, Contact};
use stickslip::solver::{Dop853, Dopri5};

#[path = "../../../tests/checks/collision.rs"]
#[allow(dead_code, reason = "the fuzz targets and tests use the rest")]
mod checks;

/// The results in a part of the range.
#[derive(Default)]
struct Part {
    ok: u64,
    refused: u64,
    wrong: u64,
    switches: usize,
    longest: Duration,
}

fn main() -> Result<ExitCode, Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let count: u64 = arguments.next().map_or(Ok(100_000), |text| text.parse())?;
    let seed: u64 = arguments.next().map_or(Ok(1), |text| text.parse())?;
    let mut random = fastrand::Rng::with_seed(seed);
    let mut logarithmic = |low: f64, high: f64| 10_f64.powf(low + (high - low) * random.f64());
    let (accurate, other) = (Collider::new(Dop853), Collider::new(Dopri5));
    let mut parts: BTreeMap<(&str, bool, i64), Part> = BTreeMap::new();
    let mut differ = 0;
    for index in 0..count {
        let damping = if index % 2 == 0 { 0.0 } else { logarithmic(-12.0, 3.0) };
        let contact = Contact::new(logarithmic(-12.0, 5.0), logarithmic(-12.0, 12.0), damping)?;
        #[expect(clippy::cast_possible_truncation, reason = "it lies between −24 and 17")]
        let pull = 8 * ((contact.kappa() * contact.psi()).log10() / 8.0).floor() as i64;
        let mut note = |engine, began: Instant, outcome: Result<Option<usize>, &str>| {
            let part = parts.entry((engine, damping > 0.0, pull)).or_default();
            part.longest = part.longest.max(began.elapsed());
            match outcome {
                Ok(Some(switches)) => {
                    part.ok += 1;
                    part.switches = part.switches.max(switches);
                }
                Ok(None) => part.refused += 1,
                Err(reason) => {
                    println!("{engine}: {reason}");
                    part.wrong += 1;
                }
            }
        };
        let began = Instant::now();
        let integrated = checks::integrated(&accurate, contact);
        note("dop853", began, outcome(&integrated));
        let began = Instant::now();
        note("dopri5", began, outcome(&checks::integrated(&other, contact)));
        if damping > 0.0 {
            continue;
        }
        let began = Instant::now();
        let closed = checks::exact(contact);
        note("exact", began, outcome(&closed));
        if let (Ok(Ok(integrated)), Ok(Ok(closed))) = (&integrated, &closed)
            && let Err(reason) = checks::agree(integrated, closed)
        {
            println!("{contact:?}: {reason}");
            differ += 1;
        }
    }
    println!("engine   damped        κψ       ok  refused  wrong  most switches   longest");
    for ((engine, damped, pull), part) in &parts {
        let Part { ok, refused, wrong, switches, longest } = part;
        let from = format!("1e{pull}");
        println!(
            "{engine:<8} {damped:<6} {from:>9} {ok:>8} {refused:>8} {wrong:>6} {switches:>14} {longest:>9.1?}"
        );
    }
    let wrong: u64 = parts.values().map(|part| part.wrong).sum();
    println!("{count} contacts: {wrong} results are wrong, {differ} differ between the engines");
    Ok(if wrong + differ == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// The number of switches, `None` if the engine refuses the contact, or what is wrong.
fn outcome<E>(held: &Result<Result<Collision, E>, String>) -> Result<Option<usize>, &str> {
    match held {
        Ok(Ok(collision)) => Ok(Some(collision.switches.len())),
        Ok(Err(_)) => Ok(None),
        Err(reason) => Err(reason),
    }
}
