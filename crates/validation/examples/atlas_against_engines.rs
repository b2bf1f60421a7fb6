//! Random points of the (κ, ψ) plane against its atlas: does any collision have other switches than
//! its region?
//!
//! Half of the points are uniform in κ, half uniform in ln κ; as many again lie at distances 1e-8 …
//! 1e-3 from the boundaries, on both sides. Collisions are integrated, and computed by the exact
//! solution too. Points within 1e-9 of a boundary are undecided. Fails if a point is wrong or
//! anything speaks against an atlas.
//!
//! Run with `cargo run --release -p validation --example atlas_against_engines -- [COUNT] [NEAR]`;
//! a million and a hundred thousand without arguments.

use std::error::Error;
use std::time::Instant;

use rayon::prelude::*;
use stickslip::model::{Collider, exact};
use stickslip::plane::{CollisionEvent, CollisionLabel, CollisionPlane};
use stickslip::solver::margin::Margin;
use stickslip::tracer::{
    Point, TraceOptions,
    regions::{Location, Subdivision, VerifyOptions, verify_with},
    tracing::Tracer,
};

type Interval = (f64, f64);

/// κ, ψ and damping.
const WINDOWS: [(Interval, Interval, f64); 7] = [
    ((0.05, 100.0), (0.01, 3.0), 0.0),
    ((0.05, 1000.0), (0.01, 3.0), 0.0),
    ((0.001, 0.1), (0.01, 1100.0), 0.0),
    ((0.05, 100.0), (0.01, 3.0), 0.01),
    ((0.05, 100.0), (0.01, 3.0), 0.1),
    ((0.05, 100.0), (0.01, 3.0), 0.3),
    ((0.05, 100.0), (0.01, 3.0), 1.0),
];

/// How often a verification may send the tracer back.
const ROUNDS: u64 = 8;

type Atlas = Subdivision<CollisionLabel, Margin>;

fn main() -> Result<(), Box<dyn Error>> {
    let counts: Vec<usize> =
        std::env::args().skip(1).map(|a| a.parse()).collect::<Result<_, _>>()?;
    let count = counts.first().copied().unwrap_or(1_000_000);
    let near = counts.get(1).copied().unwrap_or(100_000);
    let mut sound = true;
    for (kappa, psi, damping) in WINDOWS {
        println!("κ {kappa:?}, ψ {psi:?}, damping {damping}");
        let plane = CollisionPlane::new(kappa, psi, damping)?;
        let (atlas, agrees) = atlas(&plane)?;
        let random = random_points(&plane, kappa, psi, count);
        let start = Instant::now();
        let located: Vec<Location> = random.iter().map(|point| atlas.locate(point)).collect();
        let locating = start.elapsed().as_secs_f64() / count as f64;
        let wrong: Vec<&Point> = random
            .par_iter()
            .zip(&located)
            .filter(|(point, location)| match **location {
                Location::Region(region) => {
                    atlas.regions()[region].label.as_ref() != label(&plane, point).as_ref().ok()
                }
                _ => false,
            })
            .map(|(point, _)| point)
            .collect();
        let regions = located.iter().filter(|l| matches!(l, Location::Region(_))).count();
        println!(
            "  {count} random points: {} wrong, {} undecided; {:.2} µs to locate one",
            wrong.len(),
            count - regions,
            1e6 * locating
        );
        for point in wrong.iter().take(5) {
            println!("    wrong: {:?}", plane.parameters(point));
        }
        let near_points = near.div_ceil(2 * atlas.curves().len());
        let options =
            VerifyOptions { random_points: 0, near_points, seed: 99, ..Default::default() };
        let verification = verify_with(&atlas, &options, |points| labels(&plane, points))?;
        println!(
            "  {} points near boundaries: {} wrong",
            verification.tried.iter().sum::<usize>() - atlas.regions().len(),
            verification.mismatches.len()
        );
        sound &= agrees && wrong.is_empty() && verification.mismatches.is_empty();
    }
    if sound { Ok(()) } else { Err("an atlas is not right".into()) }
}

/// Traces until nothing speaks against the atlas any more; whether that came about.
fn atlas(plane: &CollisionPlane) -> Result<(Atlas, bool), Box<dyn Error>> {
    let family = plane.family();
    let mut tracer = Tracer::new(&family, &plane.window(), &TraceOptions::default())?;
    let start = Instant::now();
    tracer.explore()?;
    for round in 1.. {
        let network = tracer.network();
        let open = network.unresolved.len();
        let (curves, vertices) = (network.curves, network.vertices);
        let atlas = Subdivision::new(plane.window(), curves, vertices, 1e-9)?;
        if round == 1 {
            println!(
                "  traced in {:.2} s: {} curves, {} vertices, {} regions, {} free and {} prescribed runs",
                start.elapsed().as_secs_f64(),
                atlas.curves().len(),
                atlas.vertices().len(),
                atlas.regions().len(),
                network.statistics.free_runs,
                network.statistics.prescribed_runs
            );
        }
        let options = VerifyOptions { seed: round, ..VerifyOptions::default() };
        let verification = verify_with(&atlas, &options, |points| labels(plane, points))?;
        println!(
            "  round {round}: {} regions, {open} unresolved, {} findings, {} mismatches",
            atlas.regions().len(),
            verification.findings,
            verification.mismatches.len()
        );
        let agrees = verification.agrees() && open == 0;
        if round == ROUNDS || !tracer.look_between(&verification.brackets())? {
            return Ok((atlas, agrees));
        }
    }
    Err("no round is the last one".into())
}

fn random_points(
    plane: &CollisionPlane,
    kappa: Interval,
    psi: Interval,
    count: usize,
) -> Vec<Point> {
    let mut random = fastrand::Rng::with_seed(7);
    let point = |index: usize| {
        let part = random.f64();
        let kappa = if index.is_multiple_of(2) {
            kappa.0 + part * (kappa.1 - kappa.0)
        } else {
            kappa.0 * (kappa.1 / kappa.0).powf(part)
        };
        plane.point(kappa, psi.0 + random.f64() * (psi.1 - psi.0))
    };
    (0..count).map(point).collect()
}

fn labels(plane: &CollisionPlane, points: &[Point]) -> Vec<Result<CollisionLabel, String>> {
    points.par_iter().map(|point| label(plane, point)).collect()
}

/// The switches of a collision, by integration and by the exact solution.
fn label(plane: &CollisionPlane, point: &Point) -> Result<CollisionLabel, String> {
    let contact = plane.contact(point).map_err(|error| error.to_string())?;
    let integrated = Collider::default().collide(contact).map_err(|error| error.to_string())?;
    let exact = exact::collide(contact).map_err(|error| error.to_string())?;
    if exact.itinerary() != integrated.itinerary() {
        return Err(format!("{} and {}", exact.itinerary(), integrated.itinerary()));
    }
    Ok(CollisionEvent::label(&integrated))
}
