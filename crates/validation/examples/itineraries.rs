//! The switches of random contacts of every law, by both pairs: how many are right?
//!
//! `tests/checks/itinerary.rs` says which contacts, and how they are judged. For each law and pair
//! the program prints how many itineraries are right, how many are those of a contact so near that
//! tolerances do not tell the two apart, how many contacts the pair refuses, and how many are
//! wrong. Wrong ones are printed, and it fails if there is one.
//!
//! Run with `cargo run --release -p validation --example itineraries -- [CONTACTS] [SEED] [LAW]`,
//! the number of contacts for each law, ten times as many with the paper's; 100 000 without an
//! argument. Runs with different seeds are parts of one battery.

use std::collections::BTreeMap;
use std::error::Error;
use std::process::ExitCode;

use rayon::prelude::*;
use stickslip_model::{Contact, Law};

#[path = "../../../tests/checks/itinerary.rs"]
mod itinerary;
use itinerary::{ENGINES, Verdict, judged, laws, random};

/// The contacts that share a boundary.
const GROUP: usize = 16;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let contacts: usize = arguments.next().map_or(Ok(100_000), |text| text.parse())?;
    let seed: u64 = arguments.next().map_or(Ok(1), |text| text.parse())?;
    let only = arguments.next();
    let mut total = 0;
    println!("law, pair: right, near, refused, wrong");
    for (number, (name, law)) in laws().into_iter().enumerate() {
        if only.as_ref().is_some_and(|only| *only != name) {
            continue;
        }
        let contacts = if law == Law::PAPER { 10 * contacts } else { contacts };
        let found: Vec<_> = (0..contacts.div_ceil(GROUP))
            .into_par_iter()
            .flat_map_iter(|index| {
                let seed = (seed << 40) + ((number as u64) << 32) + index as u64;
                let contacts = random(law, 1e6, GROUP, &mut fastrand::Rng::with_seed(seed));
                contacts.into_iter().map(|contact| (contact, judged(contact)))
            })
            .collect();
        for (which, engine) in ENGINES.into_iter().enumerate() {
            let found: Vec<_> = found.iter().map(|(of, found)| (*of, &found[which])).collect();
            total += report(&format!("{name}, {}", engine.name()), &found);
        }
    }
    Ok(if total == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Prints what was found of one law and pair, and returns how many itineraries are wrong.
fn report(title: &str, found: &[(Contact, &Verdict)]) -> usize {
    let mut counts = [0; 4];
    for (_, verdict) in found {
        counts[match verdict {
            Verdict::Right => 0,
            Verdict::Near => 1,
            Verdict::Refused(_) => 2,
            Verdict::Wrong(_) => 3,
        }] += 1;
    }
    let [right, near, refused, wrong] = counts;
    println!("{title}: {right}, {near}, {refused}, {wrong}");
    let mut reasons = BTreeMap::<String, usize>::new();
    for (_, verdict) in found {
        if let Verdict::Refused(reason) = verdict {
            let words = reason.split_whitespace().filter(|it| !it.contains(char::is_numeric));
            *reasons.entry(words.collect::<Vec<_>>().join(" ")).or_default() += 1;
        }
    }
    for (reason, times) in reasons {
        println!("    {times} refused: {reason}");
    }
    for (contact, verdict) in found {
        if let Verdict::Wrong(reason) = verdict {
            println!(
                "    {reason}: κ {:?} ψ {:?} a {:?} b {:?}",
                contact.kappa(),
                contact.psi(),
                contact.damping(),
                contact.tangential_damping()
            );
        }
    }
    wrong
}
