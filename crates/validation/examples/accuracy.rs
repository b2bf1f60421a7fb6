//! Random contacts over the whole range, κ from 1e-6 to 1e6, ψ from 1e-10 to 10 and damping up to
//! 1e4, by every method at its default tolerances: failures, itineraries that differ, errors, and
//! whether the estimates of the errors cover them.
//!
//! The exact solution is the reference of the integrators, and double-double numbers are that of
//! the exact solution. The last rows are those of the contacts with 25 digits in tests/data.
//!
//! `cargo run --release -p validation --example accuracy -- 1000000` prints the figures of
//! docs/validation.md. Four further arguments: the number of the first contact, so that a long list
//! can be run in parts, how many contacts to describe of those that differ and of those with the
//! largest errors, the only row of the table that is wanted, counted from 0, or 99 for all of them,
//! and the tolerance of both pairs.

use std::collections::BTreeMap;

use rayon::prelude::*;
use stickslip_model::{Collider, Collision, Contact, Engine, Estimate, Tolerances};

/// What is compared: an engine, with or without damping, and its reference.
#[derive(Clone, Copy)]
struct Task {
    damped: bool,
    engine: Engine,
    reference: Reference,
}

#[derive(Clone, Copy)]
enum Reference {
    Engine(Engine),
    DoubleDouble,
}

/// What an engine and its reference made of a contact.
struct Compared {
    contact: Contact,
    same_itinerary: bool,
    /// The errors of ε_t, of the contact time relative to itself, and of ε_n relative to itself.
    errors: [f64; 3],
    estimate: Estimate,
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |index: usize, usual| {
        arguments.get(index).and_then(|number| number.parse().ok()).unwrap_or(usual)
    };
    let (count, first, shown, row) = (number(0, 1000), number(1, 0), number(2, 3), number(3, 99));
    let tolerance = arguments.get(4).and_then(|number| number.parse().ok());
    let tolerances = |usual| tolerance.map_or(usual, |rtol| Tolerances { rtol, atol: rtol });
    let dop853 = Engine::Dop853(tolerances(Tolerances::DOP853));
    let dopri5 = Engine::Dopri5(tolerances(Tolerances::DOPRI5));
    let task = |damped, engine, reference| Task { damped, engine, reference };
    println!(
        "| damping | method | contacts | failed | other itineraries, certain | ε_t | time | ε_n | not covered | estimate/error, median |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    let tasks = [
        task(false, Engine::Exact, Reference::DoubleDouble),
        task(false, dop853, Reference::Engine(Engine::Exact)),
        task(false, dopri5, Reference::Engine(Engine::Exact)),
        task(true, Engine::Exact, Reference::DoubleDouble),
        task(true, dop853, Reference::Engine(Engine::Exact)),
        task(true, dopri5, Reference::Engine(Engine::Exact)),
    ];
    let wanted = |index: &u64| row == 99 || row == *index;
    for (_, task) in (0..).zip(&tasks).filter(|(index, _)| wanted(index)) {
        let cases = (first..first + count).into_par_iter();
        let compared: Vec<_> = cases.map(|seed| task.compare(random(task.damped, seed))).collect();
        report(task.damped, &task.engine, &compared, shown);
    }
    let engines = [Engine::Exact, dop853, dopri5];
    let with_series = [false, true].into_iter().flat_map(|damped| engines.map(|one| (damped, one)));
    for (_, (damped, engine)) in (6..).zip(with_series).filter(|(index, _)| wanted(index)) {
        report(damped, &engine, &series(damped, engine), shown);
    }
}

/// Compares an engine with the contacts whose results have 25 digits.
fn series(damped: bool, engine: Engine) -> Vec<Result<Compared, String>> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/contacts_series.json");
    let text = std::fs::read_to_string(path).expect("the repository has this file");
    let file: serde_json::Value = serde_json::from_str(&text).expect("it is JSON");
    let cases = file["cases"].as_array().expect("it has contacts").par_iter();
    let compared = cases.map(|case| {
        let [kappa, psi, damping] =
            [0, 1, 2].map(|column| case[column].as_f64().expect("a number"));
        let [eps_t, eps_n, time] = [4, 5, 6].map(|column| {
            let text = case[column].as_str().expect("digits");
            text.parse::<f64>().expect("a number")
        });
        let contact = Contact::new(kappa, psi, damping).expect("positive numbers");
        (damped == (damping > 0.0)).then(|| {
            let (found, _) = engine.collide(contact).map_err(|error| error.to_string())?;
            let estimate = engine.estimate(&found).map_err(|error| error.to_string())?;
            let errors = [
                (found.eps_t() - eps_t).abs(),
                (found.contact_time / time - 1.0).abs(),
                (found.eps_n / eps_n - 1.0).abs(),
            ];
            let same_itinerary = case[3] == found.itinerary();
            Ok(Compared { contact, same_itinerary, errors, estimate })
        })
    });
    compared.flatten_iter().collect()
}

fn random(damped: bool, seed: u64) -> Contact {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut power = |low: f64, high: f64| 10_f64.powf(low + (high - low) * random.f64());
    let (kappa, psi) = (power(-6.0, 6.0), power(-10.0, 1.0));
    let damping = if damped { power(-6.0, 4.0) } else { 0.0 };
    Contact::new(kappa, psi, damping).expect("positive numbers")
}

impl Task {
    fn compare(&self, contact: Contact) -> Result<Compared, String> {
        let by = |engine: Engine| engine.collide(contact).map_err(|error| error.to_string());
        let (found, _) = by(self.engine)?;
        let expected = match self.reference {
            Reference::Engine(engine) => by(engine)?.0,
            Reference::DoubleDouble => {
                let finest = Collider::default().collide_finely(contact);
                let finest = finest.map_err(|error| error.to_string())?;
                finest.ok_or("no double-double reference")?
            }
        };
        let estimate = self.engine.estimate(&found).map_err(|error| error.to_string())?;
        let same_itinerary = found.itinerary() == expected.itinerary();
        Ok(Compared { contact, same_itinerary, errors: errors(&found, &expected), estimate })
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
fn report(damped: bool, engine: &Engine, compared: &[Result<Compared, String>], shown: u64) {
    let good: Vec<_> = compared.iter().flatten().collect();
    let mut failures = BTreeMap::<&str, usize>::new();
    for reason in compared.iter().filter_map(|one| one.as_ref().err()) {
        // The numbers of a message differ, its end does not.
        *failures.entry(reason.rsplit(": ").next().unwrap_or(reason)).or_default() += 1;
    }
    let differ: Vec<_> = good.iter().filter(|one| !one.same_itinerary).collect();
    let certain = differ.iter().filter(|one| one.estimate.certain);
    let largest = |index: usize| {
        let agree = good.iter().filter(|one| one.same_itinerary);
        agree.map(|one| one.errors[index]).fold(0.0, f64::max)
    };
    let uncovered: Vec<_> =
        good.iter().filter(|one| one.errors[0] > one.estimate.eps_t_error).collect();
    let with_error = good.iter().filter(|one| one.errors[0] > 0.0);
    let mut ratios: Vec<f64> =
        with_error.map(|one| one.estimate.eps_t_error / one.errors[0]).collect();
    ratios.sort_by(f64::total_cmp);
    println!(
        "| {} | {} | {} | {} {failures:?} | {}, {} | {:.1e} | {:.1e} | {:.1e} | {} | {:.1} |",
        if damped { "1e-6 … 1e4" } else { "0" },
        engine.name(),
        compared.len(),
        compared.len() - good.len(),
        differ.len(),
        certain.count(),
        largest(0),
        largest(1),
        largest(2),
        uncovered.len(),
        ratios.get(ratios.len() / 2).unwrap_or(&f64::NAN),
    );
    let described = |what: &str, some: &[&&Compared]| {
        for one in some.iter().zip(0..shown).map(|(one, _)| one) {
            let name = engine.name();
            eprintln!("{name}: {:?}: {what}: {:?}, {:?}", one.contact, one.errors, one.estimate);
        }
    };
    described("other itinerary", &differ);
    described("not covered", &uncovered);
    let mut worst: Vec<_> = good.iter().filter(|one| one.same_itinerary).collect();
    worst.sort_by(|a, b| b.errors[0].total_cmp(&a.errors[0]));
    described("large error", &worst);
}
