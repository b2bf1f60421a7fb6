//! Random contacts over the whole range, κ from 1e-6 to 1e6, ψ from 1e-10 to 10 and damping up to
//! 1e4, by both pairs at their default tolerances: failures, itineraries that differ, and errors.
//!
//! Without damping the exact solution is the reference. With damping the pairs are compared with
//! each other, which share the coordinates of the law but neither steps nor tolerances.
//!
//! `cargo run --release -p validation --example accuracy -- 1000000` prints the figures of
//! docs/validation.md. Two further arguments: the number of the first contact, so that a long list
//! can be run in parts, and how many contacts to describe of those that differ.

use rayon::prelude::*;
use stickslip_model::{Collision, Contact, Engine, Tolerances};

/// The contacts of one kind.
#[derive(Clone, Copy)]
enum Kind {
    Undamped,
    Damped,
}

/// What two engines made of a contact.
struct Compared {
    contact: Contact,
    /// Why it failed, if it did.
    failure: Option<String>,
    same_itinerary: bool,
    /// The errors of ε_t, of the contact time relative to itself, and of ε_n relative to itself.
    errors: [f64; 3],
}

fn main() {
    let arguments = std::env::args().skip(1);
    let numbers: Vec<u64> = arguments.filter_map(|argument| argument.parse().ok()).collect();
    let number = |index: usize, usual| numbers.get(index).copied().unwrap_or(usual);
    let (count, first, shown) = (number(0, 10_000), number(1, 0), number(2, 3));
    println!("{count} contacts of each kind:\n");
    println!("| kind | engines | failed | other itineraries | ε_t | contact time | ε_n |");
    println!("|---|---|---|---|---|---|---|");
    let dop853 = Engine::Dop853(Tolerances::DOP853);
    let dopri5 = Engine::Dopri5(Tolerances::DOPRI5);
    for (kind, name, engine, reference) in [
        (Kind::Undamped, "undamped", dop853, Engine::Exact),
        (Kind::Undamped, "undamped", dopri5, Engine::Exact),
        (Kind::Damped, "damped", dopri5, dop853),
    ] {
        let cases = (first..first + count).into_par_iter();
        let compared: Vec<_> =
            cases.map(|seed| compare(random(kind, seed), engine, reference)).collect();
        let engines = format!("{}, {}", engine.name(), reference.name());
        report(name, &engines, &compared, shown);
    }
}

fn random(kind: Kind, seed: u64) -> Contact {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut power = |low: f64, high: f64| 10_f64.powf(low + (high - low) * random.f64());
    let (kappa, psi) = (power(-6.0, 6.0), power(-10.0, 1.0));
    let damping = match kind {
        Kind::Undamped => 0.0,
        Kind::Damped => power(-6.0, 4.0),
    };
    Contact::new(kappa, psi, damping).expect("positive numbers")
}

fn compare(contact: Contact, engine: Engine, reference: Engine) -> Compared {
    let [found, expected] = [engine, reference].map(|engine| engine.collide(contact));
    match (found, expected) {
        (Ok((found, _)), Ok((expected, _))) => Compared {
            contact,
            failure: None,
            same_itinerary: found.itinerary() == expected.itinerary(),
            errors: errors(&found, &expected),
        },
        (Err(error), _) | (_, Err(error)) => {
            let failure = Some(error.to_string());
            Compared { contact, failure, same_itinerary: true, errors: [0.0; 3] }
        }
    }
}

fn errors(found: &Collision, expected: &Collision) -> [f64; 3] {
    [
        (found.eps_t() - expected.eps_t()).abs(),
        (found.contact_time / expected.contact_time - 1.0).abs(),
        (found.eps_n / expected.eps_n - 1.0).abs(),
    ]
}

/// Prints a row of the table, and describes some contacts that failed or differ.
fn report(name: &str, engines: &str, compared: &[Compared], shown: u64) {
    let failed: Vec<_> = compared.iter().filter(|one| one.failure.is_some()).collect();
    let differ: Vec<_> = compared.iter().filter(|one| !one.same_itinerary).collect();
    let agree = || compared.iter().filter(|one| one.failure.is_none() && one.same_itinerary);
    let largest = |index: usize| agree().map(|one| one.errors[index]).fold(0.0, f64::max);
    let [eps_t, time, eps_n] = [0, 1, 2].map(largest);
    println!(
        "| {name} | {engines} | {} | {} | {eps_t:.1e} | {time:.1e} | {eps_n:.1e} |",
        failed.len(),
        differ.len()
    );
    for one in [failed, differ].iter().flat_map(|all| all.iter().zip(0..shown)).map(|(one, _)| one)
    {
        let what = one.failure.as_deref().unwrap_or("other itinerary");
        eprintln!("{engines}: {:?}: {what}", one.contact);
    }
}
