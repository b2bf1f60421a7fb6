//! Every contact law on random contacts: the integrator at two tolerances, the other pair, and a
//! second opinion in plain time.
//!
//! For each law, contacts are log-uniform in κ from 0.05 to 400, ψ from 0.01 to 3 and the damping
//! from 0.01 to 2 (or to 0.95 of that with which contacts never end); every second has a tangential
//! damping from 0 to 5. Where plain time has other switches, the least relative change of κ, ψ or a
//! damping is searched for with which the integrator has them too: the distance from the boundary.
//! Contacts farther from it than 1e-6 are printed.
//!
//! Run with `cargo run --release -p validation --example contact_laws -- [CONTACTS]`, the number
//! for each law and both opinions; 1000 without an argument.

use std::error::Error;

use rayon::prelude::*;
use stickslip::model::{
    self, Contact, ContactEnd, CoulombTest, Damping, Engine, HistoryOf, Law, Normal, Tangential,
    Tolerances,
};

#[path = "../../../../tests/common/plain.rs"]
mod plain;

use plain::{lasting, longer};

fn main() -> Result<(), Box<dyn Error>> {
    let contacts: u64 = std::env::args().nth(1).map_or(Ok(1000), |argument| argument.parse())?;
    let only = std::env::args().nth(2).map(|argument| argument.parse::<usize>()).transpose()?;
    println!(
        "law: failed | counts differ, largest |Δε_t| with 1e-10 | with dopri5 at 1e-10 | in plain time"
    );
    let mut total = Tally::default();
    for (number, law) in laws().into_iter().enumerate() {
        if only.is_some_and(|only| only != number) {
            continue;
        }
        let tally = (0..contacts)
            .into_par_iter()
            .map(|seed| compared(law, number as u64 * 1_000_000_007 + seed))
            .reduce(Tally::default, Tally::with);
        println!("{number:3} {}: {tally}", name(law));
        total = total.with(tally);
    }
    println!("all: {total}");
    Ok(())
}

/// All laws that differ in effect.
fn laws() -> Vec<Law> {
    let mut laws = Vec::new();
    for normal in [Normal::Linear, Normal::Hertz] {
        for (damping, limit_damping, end) in [
            (Damping::None, false, ContactEnd::Force),
            (Damping::Linear, false, ContactEnd::Force),
            (Damping::Linear, true, ContactEnd::Overlap),
            (Damping::Linear, false, ContactEnd::Overlap),
            (Damping::Viscoelastic, false, ContactEnd::Force),
            (Damping::Viscoelastic, true, ContactEnd::Overlap),
            (Damping::Viscoelastic, false, ContactEnd::Overlap),
            (Damping::Tsuji, false, ContactEnd::Force),
            (Damping::Tsuji, true, ContactEnd::Overlap),
            (Damping::Tsuji, false, ContactEnd::Overlap),
        ] {
            for (tangential, history) in [
                (Tangential::Constant, HistoryOf::Displacement),
                (Tangential::Mindlin, HistoryOf::Displacement),
                (Tangential::Mindlin, HistoryOf::Force),
            ] {
                for rescaled in [false, true] {
                    for coulomb_test in [CoulombTest::Total, CoulombTest::Spring] {
                        laws.push(Law {
                            normal,
                            damping,
                            tangential,
                            history,
                            rescaled,
                            limit_damping,
                            end,
                            coulomb_test,
                            ..Law::PAPER
                        });
                    }
                }
            }
            laws.push(Law {
                normal,
                damping,
                tangential: Tangential::Constant,
                history: HistoryOf::None,
                rescaled: false,
                limit_damping,
                end,
                ..Law::PAPER
            });
        }
    }
    laws
}

fn name(law: Law) -> String {
    let Law {
        normal,
        damping,
        tangential,
        history,
        rescaled,
        limit_damping,
        end,
        coulomb_test,
        ..
    } = law;
    let rescaled = if rescaled { " rescaled" } else { "" };
    let limit = if limit_damping { " limited" } else { "" };
    let test = if coulomb_test == CoulombTest::Spring { " spring tested" } else { "" };
    format!("{normal:?} {damping:?} {tangential:?} {history:?}{rescaled} {end:?}{limit}{test}")
}

/// What the opinions on some contacts differ in.
#[derive(Clone, Debug)]
struct Tally {
    contacts: usize,
    failed: usize,
    counts: [usize; 3],
    largest: [f64; 3],
    worst: [Option<Contact>; 3],
    /// How many contacts with other switches in plain time are up to each of [`DISTANCES`] from
    /// them.
    near: [usize; DISTANCES.len()],
    failure: Option<String>,
}

impl Default for Tally {
    fn default() -> Self {
        Self {
            contacts: 0,
            failed: 0,
            counts: [0; 3],
            largest: [0.0; 3],
            worst: [None; 3],
            near: [0; DISTANCES.len()],
            failure: None,
        }
    }
}

impl Tally {
    fn with(mut self, other: Self) -> Self {
        self.contacts += other.contacts;
        self.failed += other.failed;
        self.failure = self.failure.or(other.failure);
        for (own, other) in self.near.iter_mut().zip(other.near) {
            *own += other;
        }
        for i in 0..3 {
            self.counts[i] += other.counts[i];
            if other.largest[i] > self.largest[i] {
                self.largest[i] = other.largest[i];
                self.worst[i] = other.worst[i];
            }
        }
        self
    }
}

impl std::fmt::Display for Tally {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} of {}", self.failed, self.contacts)?;
        for (count, largest) in self.counts.iter().zip(self.largest) {
            write!(f, " | {count}, {largest:.1e}")?;
        }
        if self.counts[2] > 0 {
            write!(f, "\n      in plain time, with the same switches within")?;
            for (distance, near) in DISTANCES.iter().zip(self.near) {
                write!(f, " {distance:e}: {near}")?;
            }
        }
        if let Some(failure) = &self.failure {
            write!(f, "\n      {failure}")?;
        }
        for worst in self.worst.iter().zip(self.largest).filter(|(_, largest)| *largest > 1e-4) {
            if let (Some(contact), _) = worst {
                write!(
                    f,
                    "\n      κ {:?} ψ {:?} a {:?} b {:?}",
                    contact.kappa(),
                    contact.psi(),
                    contact.damping(),
                    contact.tangential_damping()
                )?;
            }
        }
        Ok(())
    }
}

/// A random contact.
fn random(law: Law, seed: u64) -> Contact {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut between = |low: f64, high: f64| low * (high / low).powf(random.f64());
    let (kappa, psi) = (between(0.05, 400.0), between(0.01, 3.0));
    let damping = between(0.01, (0.95 * law.endless_from()).min(2.0));
    let damping = if law.damping == Damping::None { 0.0 } else { damping };
    let tangential = if random.bool() { 5.0 * random.f64() } else { 0.0 };
    Contact::new(kappa, psi, damping)
        .and_then(|contact| contact.with_law(law, tangential))
        .expect("parameters in range")
}

/// Relative changes of a parameter by which a contact may have other switches.
const DISTANCES: [f64; 5] = [1e-10, 1e-8, 1e-6, 1e-4, 1e-2];

/// The least relative change of κ, ψ or a damping with which the integrator finds these phases up
/// to `end`; up to a factor of √10, and at most the last of [`DISTANCES`].
fn distance(contact: &Contact, phases: &str, end: f64) -> Option<f64> {
    let changes = (0..=16).map(|half| 1e-10 * 10.0_f64.powf(0.5 * f64::from(half)));
    changes.into_iter().find(|change| {
        (0..8).any(|which| {
            let part = |parameter: usize| {
                let sign = if which % 2 == 0 { 1.0 } else { -1.0 };
                if which / 2 == parameter { 1.0 + sign * change } else { 1.0 }
            };
            let beside = Contact::new(
                contact.kappa() * part(0),
                contact.psi() * part(1),
                contact.damping() * part(2),
            )
            .and_then(|beside| {
                beside.with_law(contact.law(), contact.tangential_damping() * part(3))
            });
            beside.is_ok_and(|beside| {
                let found = Engine::Dop853(Tolerances::DOP853).collide(beside);
                found.is_ok_and(|(collision, _)| lasting(&collision, end) == phases)
            })
        })
    })
}

/// The opinions on one contact.
fn compared(law: Law, seed: u64) -> Tally {
    let contact = random(law, seed);
    let mut tally = Tally { contacts: 1, ..Tally::default() };
    let collision = match Engine::Dop853(Tolerances::DOP853).collide(contact) {
        Ok((collision, _)) => collision,
        Err(error) => {
            tally.failed = 1;
            tally.failure = Some(format!("{error} at {contact:?}"));
            return tally;
        }
    };
    let coarse = Tolerances { rtol: 1e-10, atol: 1e-10 };
    let of = |engine: Engine| {
        let (collision, _) = engine.collide(contact).ok()?;
        Some((collision.eps_t(), lasting(&collision, f64::INFINITY), f64::INFINITY))
    };
    let opinions = [
        of(Engine::Dop853(coarse)),
        of(Engine::Dopri5(coarse)),
        // A free flight is counted with the last slip, and plain time has none.
        plain::collide(contact)
            .map(|found| (found.eps_t, longer(found.phases.into_iter(), found.end), found.end)),
    ];
    for (i, opinion) in opinions.into_iter().enumerate() {
        let Some((eps_t, itinerary, end)) = opinion else {
            tally.failed += 1;
            tally.failure = Some(format!("opinion {i} has no result at {contact:?}"));
            continue;
        };
        let difference = (eps_t - collision.eps_t()).abs();
        let own = lasting(&collision, end);
        if itinerary != own {
            tally.counts[i] += 1;
            let distance = distance(&contact, &itinerary, end);
            if i == 2 {
                let reached = |limit: f64| distance.is_some_and(|it| it <= limit * 1.1);
                tally.near = DISTANCES.map(|limit| usize::from(reached(limit)));
            }
            if distance.is_none_or(|distance| distance > 1.1e-6) {
                println!(
                    "{i} {itinerary} for {own} at {distance:?}, start {:?} Δ {difference:.1e} κ {:?} ψ {:?} a {:?} b {:?}",
                    contact.start_margin(),
                    contact.kappa(),
                    contact.psi(),
                    contact.damping(),
                    contact.tangential_damping()
                );
            }
        }
        if difference > tally.largest[i] {
            (tally.largest[i], tally.worst[i]) = (difference, Some(contact));
        }
    }
    tally
}
