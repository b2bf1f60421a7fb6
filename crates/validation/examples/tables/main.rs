//! A table of ε_t: its size, its errors and its speed, beside a bilinear table of the same size and
//! the exact engine.
//!
//! Errors are taken at ten million points at random, even in ln κ and ψ, and at a million points
//! beside boundaries, at distances in ψ from 1e-14 to 0.1 of it. The speed of the header for C is
//! measured where there is a compiler `cc`.
//!
//! Run with `cargo run --release -p validation --example tables -- [BOUND [POINTS]]`.

use std::error::Error;
use std::hint::black_box;
use std::path::Path;
use std::process::Command;
use std::time::Instant;
use std::{env, fs};

use fastrand::Rng;
use rayon::prelude::*;
use stickslip::model::{Collision, Contact, Engine};
use stickslip::plane::atlas::{CollisionAtlas, Frame, trace};
use stickslip::plane::progress::SILENT;
use stickslip_practice::tables::{self, RestitutionTable, TableSettings};

mod bilinear;

use bilinear::Bilinear;

/// Points of one batch, each of which has its own random numbers.
const BATCH: usize = 10_000;
/// Points at which times are taken, and how often.
const TIMED: usize = 1_000_000;
const ROUNDS: usize = 5;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = env::args().skip(1);
    let bound = arguments.next().map_or(Ok(1e-8), |text| text.parse())?;
    let points: usize = arguments.next().map_or(Ok(10_000_000), |text| text.parse())?;
    let settings = TableSettings { bound, ..TableSettings::default() };
    let start = Instant::now();
    let table = tables::run(&settings, SILENT)?;
    println!("made and verified in {:.1} s", start.elapsed().as_secs_f64());
    let [slabs, strips] = table.pieces();
    println!("{} bytes, {strips} pieces in {slabs} intervals", table.bytes());
    println!(
        "{} points of its own: {:.2e}",
        table.verification.points, table.verification.largest_error
    );
    let bilinear = Bilinear::of_size(&settings, table.bytes())?;
    println!("bilinear table of {} x {} points", bilinear.sizes[0], bilinear.sizes[1]);

    report("at random", &errors(points, &table, &bilinear, |random| at_random(&settings, random))?);
    let [kappa, psi] = settings.window.sides();
    let frame = Frame::new(kappa, psi, 0.0);
    let atlas = trace(frame, frame.tolerances().usual, SILENT)?;
    report(
        "beside boundaries",
        &errors(points / 10, &table, &bilinear, |random| beside(&atlas, random))?,
    );

    let mut random = Rng::with_seed(11);
    let places: Vec<_> = (0..TIMED).map(|_| at_random(&settings, &mut random)).collect();
    println!("exact engine  {:6.1} ns", best(&places, exact_eps_t));
    println!("bilinear      {:6.1} ns", best(&places, |[kappa, psi]| bilinear.eps_t(kappa, psi)));
    println!("table in Rust {:6.1} ns", best(&places, |[kappa, psi]| table.eps_t(kappa, psi)));
    let near: Vec<_> = (0..TIMED).map(|k| places[k % 100]).collect();
    println!(
        "  the same 100 points {:6.1} ns",
        best(&near, |[kappa, psi]| table.eps_t(kappa, psi))
    );
    in_c(&table, &places)
}

/// A point of the window, even in ln κ and ψ.
fn at_random(settings: &TableSettings, random: &mut Rng) -> [f64; 2] {
    let [kappa, psi] = settings.window.sides();
    let power = random.f64();
    let kappa = (kappa.low * (kappa.high / kappa.low).powf(power)).clamp(kappa.low, kappa.high);
    [kappa, psi.low + (psi.high - psi.low) * random.f64()]
}

/// A point beside a boundary.
fn beside(atlas: &CollisionAtlas, random: &mut Rng) -> [f64; 2] {
    let curves = atlas.regions.curves();
    loop {
        let nodes = &curves[random.usize(..curves.len())].nodes;
        let node = random.usize(1..nodes.len());
        let (low, high) = (nodes[node - 1].point, nodes[node].point);
        let [one, other] = [low, high].map(|point| atlas.plane.parameters(&point));
        let kappa = one[0] + (other[0] - one[0]) * random.f64();
        let Some(psi) = crossing(atlas, [low, high], kappa) else { continue };
        let distance = psi * 10_f64.powf(-1.0 - 13.0 * random.f64());
        let psi = if random.bool() { psi + distance } else { psi - distance };
        let [within, range] = atlas.plane.sheet().sides;
        if (within.low..=within.high).contains(&kappa) && (range.low..=range.high).contains(&psi) {
            return [kappa, psi];
        }
    }
}

/// ψ at which collisions change their switches at `kappa`, near the chord between two nodes.
fn crossing(
    atlas: &CollisionAtlas,
    ends: [stickslip::tracer::Point; 2],
    kappa: f64,
) -> Option<f64> {
    let [low, high] = ends.map(|point| atlas.plane.parameters(&point)[1]);
    let spread = 0.1 * (high - low).abs() + 1e-9 * low;
    let (mut low, mut high) = (low.min(high) - spread, low.max(high) + spread);
    let itinerary =
        |psi| Some(Engine::Exact.collide(Contact::new(kappa, psi, 0.0).ok()?).ok()?.0.itinerary());
    let (below, above) = (itinerary(low)?, itinerary(high)?);
    if below == above {
        return None;
    }
    while high - low > 4.0 * f64::EPSILON * high {
        let middle = f64::midpoint(low, high);
        if itinerary(middle)? == below { low = middle } else { high = middle }
    }
    Some(low)
}

/// The largest errors of a table, and where; the largest error of a bilinear one; their points.
type Errors = (f64, [f64; 2], f64, usize);

fn errors(
    points: usize,
    table: &RestitutionTable,
    bilinear: &Bilinear,
    place: impl Fn(&mut Rng) -> [f64; 2] + Sync,
) -> Result<Errors, Box<dyn Error>> {
    let batch = |seed: usize| {
        let mut random = Rng::with_seed(seed as u64);
        let mut worst: Errors = (0.0, [0.0; 2], 0.0, BATCH);
        for _ in 0..BATCH {
            let [kappa, psi] = place(&mut random);
            let exact = exact_eps_t([kappa, psi]);
            let error = (table.eps_t(kappa, psi) - exact).abs();
            // What is not a number is worst.
            if worst.0 < error || error.is_nan() {
                (worst.0, worst.1) = (error, [kappa, psi]);
            }
            worst.2 = worst.2.max((bilinear.eps_t(kappa, psi) - exact).abs());
        }
        worst
    };
    let worse = |one: Errors, other: Errors| {
        let (error, at) =
            if one.0 >= other.0 || one.0.is_nan() { (one.0, one.1) } else { (other.0, other.1) };
        (error, at, one.2.max(other.2), one.3 + other.3)
    };
    let batches = (0..points / BATCH).into_par_iter();
    batches.map(batch).reduce_with(worse).ok_or_else(|| "no points".into())
}

fn report(name: &str, (error, [kappa, psi], bilinear, points): &Errors) {
    println!("{points} points {name}: {error:.2e} at {kappa} {psi}; bilinear {bilinear:.2e}");
}

/// ε_t of the exact engine; not a number without a collision.
fn exact_eps_t([kappa, psi]: [f64; 2]) -> f64 {
    let Ok(contact) = Contact::new(kappa, psi, 0.0) else { return f64::NAN };
    let mut collision = Collision::before(contact);
    Engine::Exact.collide_into(contact, &mut collision).map_or(f64::NAN, |_| collision.eps_t())
}

/// The time of a point in ns, the best of some rounds.
fn best(places: &[[f64; 2]], value: impl Fn([f64; 2]) -> f64) -> f64 {
    let round = || {
        let start = Instant::now();
        let sum: f64 = places.iter().map(|place| value(*place)).sum();
        black_box(sum);
        start.elapsed().as_secs_f64() * 1e9 / places.len() as f64
    };
    (0..ROUNDS).map(|_| round()).fold(f64::INFINITY, f64::min)
}

/// The header, compiled and run at the same points.
fn in_c(table: &RestitutionTable, places: &[[f64; 2]]) -> Result<(), Box<dyn Error>> {
    let directory = env::temp_dir().join(format!("stickslip_tables_{}", std::process::id()));
    fs::create_dir_all(&directory)?;
    let header = table.c_header("stickslip")?;
    println!("header for C  {} bytes", header.len());
    fs::write(directory.join("table.h"), header)?;
    fs::write(directory.join("speed.c"), include_str!("speed.c"))?;
    let bytes: Vec<u8> = places.iter().flatten().flat_map(|number| number.to_ne_bytes()).collect();
    fs::write(directory.join("points"), bytes)?;
    let run = |program: &Path, arguments: &[&str]| -> Result<(), Box<dyn Error>> {
        let done = Command::new(program).args(arguments).current_dir(&directory).status()?;
        if done.success() { Ok(()) } else { Err(format!("{} failed", program.display()).into()) }
    };
    run(Path::new("cc"), &["-O2", "-o", "speed", "speed.c", "-lm"])?;
    run(&directory.join("speed"), &[])?;
    fs::remove_dir_all(directory)?;
    Ok(())
}
