//! The time of a collision by contact law, over that of a collision with the paper's.
//!
//! For every contact law that has a name, without damping and with it, the same random contacts are
//! integrated with Dormand–Prince 8(5,3) in one thread: log-uniform in κ from 0.05 to 400, ψ from
//! 0.01 to 3 and the damping from 0.01 to 1, with a tangential damping from 0.02 to 2, which
//! the paper's law does not have. The laws take turns, and the least of several times counts.
//!
//! Run with `cargo run --release -p validation --example times_of_laws -- [CONTACTS] [PART]`; with
//! PART only laws whose names contain it.

use std::error::Error;
use std::time::Instant;

use stickslip::model::{Collider, Collision, Contact, Damping, Law, presets};

/// How often each law has its turn.
const TURNS: usize = 7;

/// A law's contacts, and the least time of one of them, in seconds.
struct Row {
    name: &'static str,
    contacts: Vec<Contact>,
    steps: f64,
    time: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let contacts = arguments.next().map_or(Ok(3000), |count| count.parse())?;
    let part = arguments.next().unwrap_or_default();
    for damped in [false, true] {
        let mut seen: Vec<Law> = Vec::new();
        let mut rows = Vec::new();
        for preset in presets::ALL {
            let law = preset.law;
            let listed = law == Law::PAPER || preset.name.contains(&part);
            if !listed || seen.contains(&law) || (damped && law.damping == Damping::None) {
                continue;
            }
            seen.push(law);
            let contacts = random_contacts(law, damped, contacts)?;
            rows.push(Row { name: preset.name, contacts, steps: 0.0, time: f64::INFINITY });
        }
        let collider = Collider::default();
        let mut collision = Collision::before(rows[0].contacts[0]);
        for _ in 0..TURNS {
            for row in &mut rows {
                let (begun, mut steps) = (Instant::now(), 0);
                for contact in &row.contacts {
                    steps += collider.collide_into(*contact, &mut collision)?.accepted;
                }
                let per_contact = |total: f64| total / row.contacts.len() as f64;
                row.time = row.time.min(per_contact(begun.elapsed().as_secs_f64()));
                row.steps = per_contact(steps as f64);
            }
        }
        println!(
            "{} damping: law | µs | times the paper's | steps",
            if damped { "with" } else { "without" }
        );
        for row in &rows {
            let ratio = row.time / rows[0].time;
            println!("{} | {:.1} | {ratio:.2} | {:.1}", row.name, row.time * 1e6, row.steps);
        }
    }
    Ok(())
}

fn random_contacts(law: Law, damped: bool, count: usize) -> Result<Vec<Contact>, Box<dyn Error>> {
    let mut random = fastrand::Rng::with_seed(4);
    let mut between = |least: f64, most: f64| least * (most / least).powf(random.f64());
    (0..count)
        .map(|_| {
            let (kappa, psi, damping) =
                (between(0.05, 400.0), between(0.01, 3.0), between(0.01, 1.0));
            let tangential = if law == Law::PAPER { 0.0 } else { between(0.02, 2.0) };
            Ok(if damped {
                Contact::new(kappa, psi, damping)?.with_law(law, tangential)?
            } else {
                Contact::new(kappa, psi, 0.0)?.with_law(law, 0.0)?
            })
        })
        .collect()
}
