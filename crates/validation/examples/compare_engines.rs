//! Random collisions by both engines: do they ever disagree on a switch?
//!
//! κ is log-uniform in [0.02, 400], ψ uniform in [0.002, 2.3]. With `damped`, κ is log-uniform in
//! [0.01, 1000], ψ in [0.001, 5] and the damping in [1e-6, 1e4]. The program prints the largest
//! difference of the final velocity and every collision whose itineraries differ, with its margin:
//! the least relative change of ψ that changes the itinerary of the exact engine. It fails if a
//! collision with a margin of 1e-12 or more differs.
//!
//! Run with `cargo run --release -p validation --example compare_engines -- [COUNT] [SEED]
//! [damped]`; one million without arguments.

use std::process::ExitCode;

use rayon::prelude::*;
use stickslip::model::{Collider, Collision, Contact, exact};

/// Margin from which on both engines must find the same itinerary.
const DECISIVE: f64 = 1e-12;
const CHUNK: u64 = 10_000;

/// The result of a chunk of collisions.
#[derive(Default)]
struct Comparison {
    switches: usize,
    velocity: f64,
    at: Option<Contact>,
    time: f64,
    different: Vec<Contact>,
    failed: Vec<String>,
}

impl Comparison {
    fn merge(mut self, other: Self) -> Self {
        self.switches += other.switches;
        if other.velocity > self.velocity {
            (self.velocity, self.at) = (other.velocity, other.at);
        }
        self.time = self.time.max(other.time);
        self.different.extend(other.different);
        self.failed.extend(other.failed);
        self
    }
}

fn main() -> Result<ExitCode, Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let count: u64 = arguments.next().map_or(Ok(1_000_000), |text| text.parse())?;
    let seed: u64 = arguments.next().map_or(Ok(1), |text| text.parse())?;
    let damped = arguments.next().is_some_and(|text| text == "damped");
    let chunks: Vec<u64> = (0..count).step_by(usize::try_from(CHUNK)?).collect();
    let result = chunks
        .into_par_iter()
        .map(|first| compare(seed, damped, first..count.min(first + CHUNK)))
        .collect::<Vec<_>>()
        .into_iter()
        .fold(Comparison::default(), Comparison::merge);

    println!("{count} collisions, {} switches, seed {seed}", result.switches);
    println!("largest difference of w: {:e}, at {:?}", result.velocity, result.at);
    println!("largest difference of a switch time: {:e}", result.time);
    let mut wrong = result.failed.len();
    for failure in &result.failed {
        println!("failed: {failure}");
    }
    for contact in &result.different {
        let margin = margin(*contact);
        wrong += usize::from(margin >= DECISIVE);
        println!("itineraries differ at {contact:?}, margin {margin:e}");
    }
    println!("{} itineraries differ, {wrong} of them wrong", result.different.len());
    Ok(if wrong == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn compare(seed: u64, damped: bool, cases: std::ops::Range<u64>) -> Comparison {
    let collider = Collider::default();
    let mut comparison = Comparison::default();
    for case in cases {
        let parameters = parameters(seed, damped, case);
        match collide(&collider, parameters) {
            Ok((integrated, closed)) => {
                let contact = closed.contact;
                comparison.switches += closed.switches.len();
                if integrated.itinerary() != closed.itinerary() {
                    comparison.different.push(contact);
                    continue;
                }
                if integrated.reversals != closed.reversals {
                    let reversals = (integrated.reversals, closed.reversals);
                    comparison.failed.push(format!("{contact:?}: reversals {reversals:?}"));
                }
                let velocity = (integrated.final_velocity - closed.final_velocity).abs();
                if velocity > comparison.velocity {
                    (comparison.velocity, comparison.at) = (velocity, Some(contact));
                }
                for (a, b) in integrated.switches.iter().zip(&closed.switches) {
                    let difference = (a.time - b.time).abs();
                    comparison.time = comparison.time.max(difference);
                }
            }
            Err(error) => comparison.failed.push(format!("{parameters:?}: {error}")),
        }
    }
    comparison
}

fn collide(
    collider: &Collider,
    [kappa, psi, damping]: [f64; 3],
) -> Result<(Collision, Collision), Box<dyn std::error::Error>> {
    let contact = Contact::new(kappa, psi, damping)?;
    Ok((collider.collide(contact)?, exact::collide(contact)?))
}

/// The least relative change of ψ, up to a factor of 2, that changes the itinerary of the exact
/// engine.
fn margin(contact: Contact) -> f64 {
    let itinerary = |factor: f64| {
        let moved =
            Contact::new(contact.kappa(), contact.psi() * factor, contact.damping()).ok()?;
        exact::collide(moved).ok().map(|collision| collision.itinerary())
    };
    let here = itinerary(1.0);
    let mut change = f64::EPSILON;
    while change < 0.1 && itinerary(1.0 + change) == here && itinerary(1.0 - change) == here {
        change *= 2.0;
    }
    change
}

/// Random κ, ψ and damping.
fn parameters(seed: u64, damped: bool, case: u64) -> [f64; 3] {
    let (first, second) = uniform_pair(seed, case);
    if !damped {
        return [0.02 * (400.0_f64 / 0.02).powf(first), 0.002 + (2.3 - 0.002) * second, 0.0];
    }
    let (third, _) = uniform_pair(seed ^ 0x5eed, case);
    [0.01 * 1e5_f64.powf(first), 0.001 * 5e3_f64.powf(second), 1e-6 * 1e10_f64.powf(third)]
}

/// Two random numbers in [0, 1) that depend on seed and case alone (splitmix64), not on threads.
fn uniform_pair(seed: u64, case: u64) -> (f64, f64) {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(case << 1);
    let mut next = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        let mantissa = (z >> 11) as f64;
        mantissa / (1_u64 << 53) as f64
    };
    (next(), next())
}
