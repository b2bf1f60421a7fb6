//! Linear contacts: the exact engine against the integrator.
//!
//! For each law, contacts are log-uniform in κ from 0.01 to 1000 and ψ from 0.001 to 5. The damping
//! is uniform from 0 to 1.9 or, for every second contact whose normal force does not attract,
//! log-uniform from 0.01 to 20; every second contact has a tangential damping, uniform from 0 to 2.
//! Every contact with other switches is printed, with the least relative change of ψ that makes the
//! integrator's those of the exact engine.
//!
//! Run with `cargo run --release -p validation --example linear_contacts -- [CONTACTS]`, the number
//! for each law; 10 000 without an argument.

use std::error::Error;
use std::hint::black_box;
use std::time::{Duration, Instant};

use rayon::prelude::*;
use stickslip::model::{
    Collider, Collision, Contact, ContactEnd, Damping, HistoryOf, Law, Normal, Tangential, linear,
};

fn main() -> Result<(), Box<dyn Error>> {
    let contacts: u64 = std::env::args().nth(1).map_or(Ok(10_000), |argument| argument.parse())?;
    println!(
        "law: contacts, switches, failed, itineraries differ | |Δε_t| median, largest | \
         |Δt|/t_c largest | ns for each collision: exact, integrator"
    );
    for (number, (name, law)) in laws().into_iter().enumerate() {
        let found: Vec<_> = (0..contacts)
            .into_par_iter()
            .map(|seed| compared(law, number as u64 * 1_000_000_007 + seed))
            .collect();
        report(name, &found, speed(law));
    }
    Ok(())
}

/// All linear laws that differ in effect, and one that differs in what its history is.
fn laws() -> Vec<(&'static str, Law)> {
    let law = Law {
        normal: Normal::Linear,
        damping: Damping::Linear,
        tangential: Tangential::Constant,
        history: HistoryOf::Displacement,
        rescaled: false,
        limit_damping: false,
        end: ContactEnd::Overlap,
        ..Law::PAPER
    };
    let limited = Law { limit_damping: true, ..law };
    vec![
        ("no damping", Law { damping: Damping::None, ..law }),
        ("ends at F = 0", Law { end: ContactEnd::Force, ..law }),
        ("limited, ends at x = 0", limited),
        ("attracting", law),
        ("attracting, force history", Law { history: HistoryOf::Force, ..law }),
    ]
}

/// A random contact.
fn random(law: Law, seed: u64) -> Contact {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut between = |low: f64, high: f64| low * (high / low).powf(random.f64());
    let (kappa, psi, strong) = (between(1e-2, 1e3), between(1e-3, 5.0), between(1e-2, 20.0));
    let damping = match (law.damping, law.end, law.limit_damping) {
        (Damping::None, ..) => 0.0,
        (_, ContactEnd::Force, _) | (.., true) if random.bool() => strong,
        _ => 1.9 * random.f64(),
    };
    let tangential_damping = if random.bool() { 2.0 * random.f64() } else { 0.0 };
    Contact::new(kappa, psi, damping)
        .and_then(|contact| contact.with_law(law, tangential_damping))
        .expect("parameters in range")
}

/// What both engines find of one contact.
struct Found {
    contact: Contact,
    failed: Option<String>,
    itineraries: [String; 2],
    /// The difference of ε_t.
    difference: f64,
    /// The largest difference of the moments of switches, over the contact time.
    moments: f64,
}

fn compared(law: Law, seed: u64) -> Found {
    let contact = random(law, seed);
    let exact = linear::collide(contact);
    let integrated = Collider::default().collide(contact);
    let mut found = Found {
        contact,
        failed: None,
        itineraries: [String::new(), String::new()],
        difference: f64::NAN,
        moments: f64::NAN,
    };
    match (exact, integrated) {
        (Ok(exact), Ok(integrated)) => {
            found.difference = (exact.eps_t() - integrated.eps_t()).abs();
            found.itineraries = [&exact, &integrated].map(Collision::itinerary);
            let moments = exact.switches.iter().zip(&integrated.switches);
            let apart = moments.map(|(one, other)| (one.time - other.time).abs());
            found.moments = apart.fold(0.0, f64::max) / exact.contact_time;
        }
        (Err(error), _) => found.failed = Some(error.to_string()),
        (_, Err(error)) => found.failed = Some(error.to_string()),
    }
    found
}

/// Nanoseconds for each of 1000 collisions by the exact engine and by the integrator, on one
/// thread: the best of several passes.
fn speed(law: Law) -> [f64; 2] {
    const CONTACTS: u64 = 1000;
    let contacts: Vec<_> = (0..CONTACTS).map(|seed| random(law, seed)).collect();
    let mut collision = Collision::before(contacts[0]);
    let mut best = [Duration::MAX; 2];
    for _ in 0..20 {
        let begin = Instant::now();
        for contact in &contacts {
            let _ = black_box(linear::collide_into(*contact, &mut collision));
        }
        let middle = Instant::now();
        for contact in &contacts {
            let _ = black_box(Collider::default().collide_into(*contact, &mut collision));
        }
        best = [best[0].min(middle - begin), best[1].min(middle.elapsed())];
    }
    best.map(|best| best.as_secs_f64() * 1e9 / CONTACTS as f64)
}

fn report(name: &str, found: &[Found], [exact, integrator]: [f64; 2]) {
    let failed = found.iter().filter_map(|found| found.failed.as_ref());
    let differ = |found: &&Found| found.itineraries[0] != found.itineraries[1];
    let mut differences: Vec<_> =
        found.iter().filter(|found| found.failed.is_none()).map(|found| found.difference).collect();
    differences.sort_by(f64::total_cmp);
    let switches: usize = found.iter().map(|found| found.itineraries[0].len().max(1) - 1).sum();
    let same = found.iter().filter(|found| !differ(found) && found.failed.is_none());
    let moments = same.map(|found| found.moments).fold(0.0, f64::max);
    println!(
        "{name}: {}, {switches}, {}, {} | {:.1e}, {:.1e} | {moments:.1e} | {exact:.0}, {integrator:.0}",
        found.len(),
        failed.clone().count(),
        found.iter().filter(differ).count(),
        differences.get(differences.len() / 2).copied().unwrap_or(f64::NAN),
        differences.last().copied().unwrap_or(f64::NAN),
    );
    if let Some(failure) = failed.clone().next() {
        println!("    {failure}");
    }
    for other in found.iter().filter(differ) {
        let [exact, integrated] = &other.itineraries;
        let contact = other.contact;
        println!(
            "    {exact} for {integrated}, |Δε_t| {:.1e}, at κ {:?} ψ {:?} a {:?} b {:?}: {}",
            other.difference,
            contact.kappa(),
            contact.psi(),
            contact.damping(),
            contact.tangential_damping(),
            nearest(&contact, exact)
        );
    }
}

/// How little ψ or κ must change for the integrator to find `expected`.
fn nearest(contact: &Contact, expected: &str) -> String {
    for exponent in (4..=15).rev() {
        let part = 10.0_f64.powi(-exponent);
        for (of_psi, of_kappa) in [(part, 0.0), (-part, 0.0), (0.0, part), (0.0, -part)] {
            let beside = Contact::new(
                contact.kappa() * (1.0 + of_kappa),
                contact.psi() * (1.0 + of_psi),
                contact.damping(),
            )
            .and_then(|beside| beside.with_law(contact.law(), contact.tangential_damping()));
            let found = beside.map(|beside| Collider::default().collide(beside));
            if let Ok(Ok(collision)) = found
                && collision.itinerary() == expected
            {
                return format!("the same within {part:.0e}");
            }
        }
    }
    "not the same nearby".to_owned()
}
