//! Random windows of the (κ, ψ) plane: is the atlas of each complete, and are all points right?
//!
//! Windows are log-uniform in κ from 1e-4 to 1e5, in ψ from 1e-6 to 1e3, in their width and height
//! from 1e-6 to 10 in the logarithms, and in the damping from 1e-6 to 10; every fourth is undamped.
//! Points are uniform in the window, half of them in its logarithms; each is located and compared
//! with its collision; one whose region is not known counts as wrong. Fails if a point is wrong or
//! anything speaks against an atlas.
//!
//! Run with `cargo run --release -p validation --example random_windows -- [WINDOWS] [POINTS]
//! [FIRST] [LEAST] [laws]`; 200 windows with 20 000 points each without arguments. LEAST is the
//! least length instead of 1e-6. With `laws` every window has another contact law, in κ from 0.05
//! to 400, ψ from 0.01 to 3, damping from 0.01 to 0.9 and tangential damping from 0.02 to 4 or 0.

use std::error::Error;
use std::io::Write;
use std::time::Instant;

use rayon::prelude::*;
use stickslip::model::{ContactEnd, Damping, Engine, HistoryOf, Law, Normal, Tangential};
use stickslip::plane::Range;
use stickslip::plane::atlas::{self, Frame};
use stickslip::plane::progress::SILENT;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let mut count = |usual: u64| arguments.next().map_or(Ok(usual), |argument| argument.parse());
    let (windows, points, first) = (count(200)?, count(20_000)?, count(0)?);
    let least = arguments.next().map_or(Ok(1e-6), |argument| argument.parse())?;
    let laws = arguments.next().is_some_and(|argument| argument == "laws");
    let mut outcomes = [0; 3];
    for number in first..first + windows {
        let mut random = fastrand::Rng::with_seed(number);
        let frame = frame(&mut random, least, number.is_multiple_of(4), laws);
        let Frame { kappa, psi, damping, law, tangential_damping, .. } = frame;
        if laws {
            println!("{law:?}, b {tangential_damping:?}");
        }
        print!(
            "{number:4} κ {:?}:{:?} ψ {:?}:{:?} a {damping:?}: ",
            kappa.low, kappa.high, psi.low, psi.high
        );
        std::io::stdout().flush()?;
        let start = Instant::now();
        let tolerance = frame.tolerances().usual;
        let outcome = match atlas::trace(frame, tolerance, SILENT) {
            Ok(found) => {
                let seconds = start.elapsed().as_secs_f64();
                let wrong = wrong(&found, &mut random, points);
                let regions = &found.regions;
                let objection = found.objection();
                println!(
                    "{} curves, {} regions, {seconds:.2} s, {} wrong {}",
                    regions.curves().len(),
                    regions.regions().len(),
                    wrong.len(),
                    objection.as_deref().unwrap_or("ok")
                );
                for [kappa, psi] in wrong.iter().take(3) {
                    println!("       wrong: --kappa {kappa:?} --psi {psi:?}");
                }
                usize::from(!wrong.is_empty() || objection.is_some())
            }
            Err(error) => {
                println!("{error}");
                2
            }
        };
        outcomes[outcome] += 1;
    }
    let [complete, doubtful, refused] = outcomes;
    println!("{complete} complete, {doubtful} wrong or doubtful, {refused} refused");
    if doubtful + refused == 0 { Ok(()) } else { Err("an atlas is not complete".into()) }
}

fn frame(random: &mut fastrand::Rng, least: f64, undamped: bool, laws: bool) -> Frame {
    let mut log = |low: f64, high: f64| low * (high / low).powf(random.f64());
    let mut side = |low: f64, high: f64| {
        let (start, length) = (log(low, high), log(least, 10.0));
        // The window lies around its place, and inside the range.
        let reach = (0.5 * length).exp();
        Range { low: (start / reach).max(low), high: (start * reach).min(high) }
    };
    if !laws {
        let (kappa, psi) = (side(1e-4, 1e5), side(1e-6, 1e3));
        let damping = if undamped { 0.0 } else { log(1e-6, 10.0) };
        return Frame::new(kappa, psi, damping);
    }
    let (kappa, psi) = (side(0.05, 400.0), side(0.01, 3.0));
    let damping = if undamped { 0.0 } else { log(0.01, 0.9) };
    let tangential_damping = log(0.02, 4.0);
    let law = law(random);
    let tangential_damping = if random.bool() { tangential_damping } else { 0.0 };
    Frame { law, tangential_damping, ..Frame::new(kappa, psi, damping) }
}

fn law(random: &mut fastrand::Rng) -> Law {
    let [linear, constant, displacement, rescaled, limited] = [(); 5].map(|()| random.bool());
    let end = if random.bool() { ContactEnd::Force } else { ContactEnd::Overlap };
    Law {
        normal: if linear { Normal::Linear } else { Normal::Hertz },
        damping: [Damping::Linear, Damping::Viscoelastic, Damping::Tsuji][random.usize(..3)],
        tangential: if constant { Tangential::Constant } else { Tangential::Mindlin },
        history: if displacement { HistoryOf::Displacement } else { HistoryOf::Force },
        rescaled,
        limit_damping: limited && end == ContactEnd::Overlap,
        end,
        ..Law::PAPER
    }
}

/// The points whose region has other switches than their collisions.
fn wrong(atlas: &atlas::CollisionAtlas, random: &mut fastrand::Rng, count: u64) -> Vec<[f64; 2]> {
    let [kappa, psi] = atlas.plane.sheet().sides;
    let plane = atlas.plane;
    let even = |Range { low, high }: Range, part: f64| low + part * (high - low);
    let log = |Range { low, high }: Range, part: f64| low * (high / low).powf(part);
    let points: Vec<[f64; 2]> = (0..count)
        .map(|index| {
            let parts = [random.f64(), random.f64()];
            let place = if index.is_multiple_of(2) { even } else { log };
            let [x, y] = [place(kappa, parts[0]), place(psi, parts[1])];
            [x.clamp(kappa.low, kappa.high), y.clamp(psi.low, psi.high)]
        })
        .collect();
    let is_wrong = |&[kappa, psi]: &[f64; 2]| {
        let Ok(contact) = plane.contact_at([kappa, psi]) else { return true };
        let Ok(region) = atlas.locate([kappa, psi]).region else { return true };
        let found = Engine::Auto.collide(contact);
        found.map_or(true, |(found, _)| found.itinerary() != atlas.itinerary(region))
    };
    points.into_par_iter().filter(is_wrong).collect()
}
