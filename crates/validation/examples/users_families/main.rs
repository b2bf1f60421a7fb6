//! The families of the gallery's example, and some that are written less carefully, at other ends
//! of their runs: traced, verified, and compared with runs at random points.
//!
//! `cargo run --release -p validation --example users_families -- [POINTS] [NAME] [SECONDS]`
//!
//! A family that takes longer than so many seconds, 120 if none are given, is cancelled. All
//! regions are in doubt then.

#[path = "../../../../examples/gallery/ball.rs"]
#[expect(dead_code, reason = "the gallery uses more")]
mod ball;
#[path = "../../../../examples/gallery/dry_friction.rs"]
#[expect(dead_code, reason = "the gallery uses more")]
mod dry_friction;
mod duffing;
#[path = "../../../../examples/gallery/impact_oscillator.rs"]
#[expect(dead_code, reason = "the gallery uses more")]
mod impact_oscillator;
mod naive_stick;
#[path = "../../../../examples/gallery/relay.rs"]
#[expect(dead_code, reason = "the gallery uses more")]
mod relay;
#[path = "../../../../examples/gallery/two_masses.rs"]
#[expect(dead_code, reason = "the gallery uses more")]
mod two_masses;

use std::error::Error;
use std::time::Instant;

use stickslip::plane::progress::InParallel;
use stickslip::solver::{Dop853, Options, Start, State};
use stickslip::tracer::{
    AtlasOptions, Family, Point, Surveyor, TraceOptions, Watch, Window,
    hybrid::{HybridFamily, Problem},
    regions::VerifyOptions,
};

use impact_oscillator::Oscillator;

/// A family, the end of its runs, and the greatest number of events of a sequence.
struct Case {
    name: &'static str,
    window: Window,
    end: f64,
    most: usize,
}

/// How a family is tried.
#[derive(Clone, Copy)]
struct Effort {
    /// The number of random points.
    points: usize,
    /// After so many seconds a trace is cancelled.
    patience: u64,
}

/// Traces a family, and prints its row and what speaks against it.
type Trial = (Case, fn(&Case, Effort) -> Result<(), Box<dyn Error>>);

/// No sequence is as long as that.
const ALL: usize = 1000;

/// Frequency and place of the wall.
const GAPS: Window = Window { low: Point::new(2.0, 0.05), high: Point::new(3.5, 0.6) };

fn before_a_gap(point: &Point) -> (Oscillator, Start<(), 2>) {
    let oscillator = Oscillator { frequency: point.x, restitution: 0.7, gap: point.y };
    (oscillator, Start { mode: (), s: 0.0, state: State::zeros() })
}

#[rustfmt::skip]
const TRIALS: [Trial; 11] = [
    (Case { name: "impacts (frequency, restitution)", window: impact_oscillator::WINDOW, end: 20.0, most: 8 },
     |case, effort| show(impact_oscillator::start, case, effort)),
    (Case { name: "impacts (frequency, gap)", window: GAPS, end: 10.0, most: 8 },
     |case, effort| show(before_a_gap, case, effort)),
    (Case { name: "ball on a table", window: ball::WINDOW, end: 7.0, most: 8 },
     |case, effort| show(ball::throw, case, effort)),
    (Case { name: "two masses", window: two_masses::WINDOW, end: 11.0, most: ALL },
     |case, effort| show(two_masses::belt, case, effort)),
    (Case { name: "two masses", window: two_masses::WINDOW, end: 15.0, most: ALL },
     |case, effort| show(two_masses::belt, case, effort)),
    (Case { name: "relay", window: relay::WINDOW, end: 20.0, most: ALL },
     |case, effort| show(relay::start, case, effort)),
    (Case { name: "naive stick", window: dry_friction::WINDOW, end: 12.0, most: ALL },
     |case, effort| show(naive_stick::shake, case, effort)),
    (Case { name: "naive stick", window: dry_friction::WINDOW, end: 20.0, most: ALL },
     |case, effort| show(naive_stick::shake, case, effort)),
    (Case { name: "naive stick, one friction", window: dry_friction::WINDOW, end: 12.0, most: ALL },
     |case, effort| show(naive_stick::shake_with_one_friction, case, effort)),
    (Case { name: "Duffing", window: duffing::WINDOW, end: 11.0, most: ALL },
     |case, effort| show(duffing::shake, case, effort)),
    (Case { name: "Duffing", window: duffing::WINDOW, end: 14.0, most: ALL },
     |case, effort| show(duffing::shake, case, effort)),
];

/// Traces a family and compares it with runs at random points. What speaks against the atlas goes
/// to the standard error.
fn show<P, const N: usize, const G: usize>(
    problem: P,
    case: &Case,
    Effort { points, patience }: Effort,
) -> Result<(), Box<dyn Error>>
where
    P: Problem<N, G> + Sync,
{
    let began = Instant::now();
    let Case { name, window, end, most } = case;
    let accurate = Options::with_tolerance(1e-13);
    let options = Options { max_step: 0.3, max_switches: *most, ..accurate };
    let family = HybridFamily { problem, method: Dop853, options, end: *end };
    let verify = VerifyOptions { random_points: points, ..VerifyOptions::default() };
    let trace = TraceOptions { beyond: 1e-3, ..TraceOptions::default() };
    let options = AtlasOptions { trace, verify, ..AtlasOptions::default() };
    let tired = || began.elapsed().as_secs() >= patience;
    let watch = Watch::SILENT.cancelled_by(&tired);
    let surveyor = Surveyor { options, executor: InParallel, watch };
    let atlas = surveyor.atlas(&family, window)?;
    let seconds = began.elapsed().as_secs_f64();
    let mut random = fastrand::Rng::with_seed(2);
    let mut wrong = 0;
    for _ in 0..points {
        let part = Point::new(random.f64(), random.f64());
        let point = window.low + window.extent().component_mul(&part);
        let Some(label) = atlas.label(&point) else { continue };
        if *label != family.label(&point)? {
            wrong += 1;
            eprintln!("  wrong at {point:?}");
        }
    }
    let (curves, regions) = (atlas.plane.curves().len(), atlas.plane.regions().len());
    let (unresolved, findings) = (atlas.unresolved.len(), atlas.plane.findings().len());
    let cancelled = if atlas.is_finished() { "" } else { ", cancelled" };
    println!(
        "| {name} | {end} | {most} | {curves} | {regions} | {unresolved} | {findings} | {:.6} \
         | {wrong} of {points} | {seconds:.1} s{cancelled} |",
        atlas.sure_area(),
    );
    eprintln!("  {} rounds, {:?}", atlas.rounds, atlas.statistics);
    if let Some(objection) = atlas.objection() {
        eprintln!("  {objection}");
    }
    if !atlas.is_finished() {
        let changes =
            changes(&family, [Point::new(window.low.x, window.high.y), window.high], points)?;
        eprintln!("  {changes} changes between {points} runs along the upper edge");
    }
    for what in atlas.unresolved.iter().take(SHOWN) {
        eprintln!("  {what:?}");
    }
    for what in atlas.plane.findings().iter().take(SHOWN) {
        eprintln!("  {what}");
    }
    for what in atlas.verification.mismatches.iter().take(SHOWN) {
        eprintln!("  {what:?}");
    }
    Ok(())
}

/// How often the label changes between so many runs along a segment.
fn changes<F: Family>(family: &F, ends: [Point; 2], runs: usize) -> Result<usize, F::Error> {
    let label = |run: usize| {
        let part = (run as f64 + 0.5) / runs as f64;
        family.label(&ends[0].lerp(&ends[1], part))
    };
    let labels = (0..runs).map(label).collect::<Result<Vec<_>, _>>()?;
    Ok(labels.windows(2).filter(|pair| pair[0] != pair[1]).count())
}

/// The number of doubts of each kind that are shown.
const SHOWN: usize = 5;

/// Prints the table, and what speaks against its rows to the standard error.
///
/// # Errors
/// A family cannot be traced.
fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let points = arguments.next().map_or(Ok(20_000), |points| points.parse())?;
    let name = arguments.next().unwrap_or_default();
    let patience = arguments.next().map_or(Ok(120), |seconds| seconds.parse())?;
    println!(
        "| family | T | events | curves | regions | unresolved | findings | sure area | wrong | time |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for (case, trial) in &TRIALS {
        if format!("{} {} {}", case.name, case.end, case.most).contains(&name) {
            trial(case, Effort { points, patience })?;
        }
    }
    Ok(())
}
