//! Windows around the vertices of an atlas, and windows that have one on a corner or on an edge: is
//! the atlas of each complete?
//!
//! The vertices are those in κ 0.05:100, ψ 0.01:3. Around each lie windows of ±5e-7 and ±5e-5.
//! Those with a vertex on a corner, or within an edge, have sides that are log-uniform from 3e-6 to
//! 0.5 in the logarithms, so that they may be very unequal. What is not complete is printed.
//!
//! Run with `cargo run --release -p validation --example windows_at_vertices -- [SEED] [DAMPING]
//! [LAW]`; without damping and with the law of the paper unless these are given.

use std::error::Error;

use stickslip::model::presets;
use stickslip::plane::Range;
use stickslip::plane::atlas::{self, Frame};
use stickslip::plane::progress::SILENT;

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let seed = words.next().map_or(Ok(3), |seed| seed.parse())?;
    let damping = words.next().map_or(Ok(0.0), |damping| damping.parse())?;
    let mut random = fastrand::Rng::with_seed(seed);
    let all = [Range { low: 0.05, high: 100.0 }, Range { low: 0.01, high: 3.0 }];
    let mut frame = Frame::new(all[0], all[1], damping);
    if let Some(law) = words.next() {
        frame.law = presets::find(&law).ok_or(law)?.law;
    }
    let found = traced(frame)?;
    let places = found.regions.vertices().iter();
    let places: Vec<(bool, [f64; 2])> = places
        .map(|vertex| (!vertex.kind.is_on_window(), found.plane.parameters(&vertex.point)))
        .collect();
    let mut tally = Tally::default();
    for (_, place) in &places {
        for width in [5e-7, 5e-5] {
            tally.trace("around", frame, place.map(|at| range(at, [width, width])));
        }
    }
    println!("{}", std::mem::take(&mut tally));
    for (_, place) in places.iter().filter(|(inner, _)| *inner) {
        for [first, second] in [[LOW, LOW], [HIGH, HIGH], [BOTH, LOW], [LOW, BOTH]] {
            let mut side = |at: f64, [below, above]: [f64; 2]| {
                let length = 10.0_f64.powf(-5.5 + 5.2 * random.f64());
                range(at, [below * length, above * length])
            };
            tally.trace("at", frame, [side(place[0], first), side(place[1], second)]);
        }
    }
    println!("{tally}");
    Ok(())
}

/// The parts of a side below and above a vertex.
const LOW: [f64; 2] = [0.0, 1.0];
const HIGH: [f64; 2] = [1.0, 0.0];
const BOTH: [f64; 2] = [1.0, 2.0];

fn range(at: f64, [below, above]: [f64; 2]) -> Range {
    Range { low: at * (1.0 - below), high: at * (1.0 + above) }
}

fn traced(frame: Frame) -> Result<atlas::CollisionAtlas, atlas::AtlasError> {
    atlas::trace(frame, frame.tolerances().usual, SILENT)
}

#[derive(Default)]
struct Tally {
    complete: usize,
    others: usize,
    mismatches: usize,
}

impl Tally {
    fn trace(&mut self, what: &str, frame: Frame, [kappa, psi]: [Range; 2]) {
        let objection = match traced(Frame { kappa, psi, ..frame }) {
            Ok(found) => {
                self.mismatches += found.report.mismatches.len();
                found.objection()
            }
            Err(error) => Some(error.to_string()),
        };
        if let Some(objection) = objection {
            self.others += 1;
            let [kappa, psi] = [kappa, psi].map(|Range { low, high }| format!("{low:?}:{high:?}"));
            println!("{what} a vertex, --kappa {kappa} --psi {psi}: {objection}");
        } else {
            self.complete += 1;
        }
    }
}

impl std::fmt::Display for Tally {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { complete, others, mismatches } = self;
        write!(f, "{complete} complete, {others} not, {mismatches} points wrong")
    }
}
