//! Families traced by their margins alone, beside the usual way: regions, what contradicts them,
//! random points in regions with other labels than their runs, runs, and time.
//!
//! `cargo run --release -p validation --example margins_first -- [POINTS] [NAME] [WAY] [LIMIT]`;
//! 5000 points, all families, both ways (`usual`, `margins`) and no limit without arguments. The
//! usual way is cancelled after so many seconds, and its row has what was found so far. What speaks
//! against a row is written to the standard error. The last three families are written as by
//! somebody who does not know the tracer.

#[path = "../../../../examples/gallery/any.rs"]
mod any;
#[path = "../../../../examples/gallery/ball.rs"]
#[expect(dead_code, reason = "the gallery uses more")]
mod ball;
mod block;
#[path = "../../../../examples/gallery/converter.rs"]
#[expect(dead_code, reason = "the gallery uses more")]
mod converter;
mod dead_time;
#[path = "../../../../examples/gallery/dry_friction.rs"]
#[expect(dead_code, reason = "the gallery uses more")]
mod dry_friction;
#[path = "../users_families/duffing.rs"]
mod duffing;
#[path = "../../../../examples/gallery/impact_oscillator.rs"]
#[expect(dead_code, reason = "the gallery uses more")]
mod impact_oscillator;
#[path = "../users_families/naive_stick.rs"]
mod naive_stick;
mod pendulum;
#[path = "../../../../examples/gallery/relay.rs"]
#[expect(dead_code, reason = "the gallery uses more")]
mod relay;
#[path = "../../../../examples/gallery/two_masses.rs"]
#[expect(dead_code, reason = "the gallery uses more")]
mod two_masses;

use std::error::Error;
use std::time::Instant;

use stickslip::solver::{Dop853, Options};
use stickslip::tracer::{
    AtlasOptions, Family, Point, RunNames, Surveyor, TraceOptions, Watch, Window,
    hybrid::{HybridFamily, Problem},
    regions::{Location, Subdivision},
    tracing::{Network, trace_by_margins},
};

use any::Any;

/// The window of a family, the end of its runs, and the greatest number of events of a sequence.
struct Case {
    name: &'static str,
    window: Window,
    end: f64,
    most: usize,
}

/// Traces a family in both ways, and prints two rows.
type Trial = (Case, fn(&Case, &Wanted) -> Result<(), Box<dyn Error>>);

/// The random points, the way, and the seconds after which the usual way is cancelled.
struct Wanted {
    points: usize,
    way: Option<String>,
    limit: f64,
}

impl Wanted {
    fn wants(&self, way: &str) -> bool {
        self.way.as_ref().is_none_or(|wanted| wanted == way)
    }
}

/// No sequence is as long as that.
const ALL: usize = 1000;

#[rustfmt::skip]
const TRIALS: [Trial; 12] = [
    (Case { name: "impact oscillator", window: impact_oscillator::WINDOW, end: 10.0, most: 8 },
     |case, wanted| show(impact_oscillator::start, case, wanted)),
    (Case { name: "ball on a table", window: ball::WINDOW, end: 7.0, most: 8 },
     |case, wanted| show(ball::throw, case, wanted)),
    (Case { name: "two masses", window: two_masses::WINDOW, end: 11.0, most: 8 },
     |case, wanted| show(two_masses::belt, case, wanted)),
    (Case { name: "relay", window: relay::WINDOW, end: 20.0, most: 8 },
     |case, wanted| show(relay::start, case, wanted)),
    (Case { name: "dry friction", window: dry_friction::WINDOW, end: 20.0, most: 8 },
     |case, wanted| show(dry_friction::shake, case, wanted)),
    (Case { name: "boost converter", window: converter::WINDOW, end: 12.0, most: 8 },
     |case, wanted| show(converter::boost, case, wanted)),
    (Case { name: "naive stick", window: dry_friction::WINDOW, end: 12.0, most: ALL },
     |case, wanted| show(naive_stick::shake, case, wanted)),
    (Case { name: "naive stick, one friction", window: dry_friction::WINDOW, end: 4.0, most: 4 },
     |case, wanted| show(naive_stick::shake_with_one_friction, case, wanted)),
    (Case { name: "Duffing", window: duffing::WINDOW, end: 11.0, most: ALL },
     |case, wanted| show(duffing::shake, case, wanted)),
    (Case { name: "pendulum between stops", window: pendulum::WINDOW, end: 12.0, most: 8 },
     |case, wanted| show(pendulum::push, case, wanted)),
    (Case { name: "relay with dead time", window: dead_time::WINDOW, end: 12.0, most: ALL },
     |case, wanted| show(dead_time::switch_on, case, wanted)),
    (Case { name: "rocking block", window: block::WINDOW, end: 10.0, most: 8 },
     |case, wanted| show(block::shake, case, wanted)),
];

/// Traces a family in both ways.
fn show<P, const N: usize, const G: usize>(
    problem: P,
    case: &Case,
    wanted: &Wanted,
) -> Result<(), Box<dyn Error>>
where
    P: Problem<N, G> + Sync,
{
    let runs = Options { max_step: 0.3, max_switches: case.most, ..Options::with_tolerance(1e-13) };
    let family = HybridFamily { problem, method: Dop853, options: runs, end: case.end };
    compare(&Any(&family), case, wanted)
}

fn compare(family: &Any<'_>, case: &Case, wanted: &Wanted) -> Result<(), Box<dyn Error>> {
    if wanted.wants("usual") {
        usual(family, case, wanted)?;
    }
    if wanted.wants("margins") {
        by_margins(family, case, wanted.points)?;
    }
    Ok(())
}

fn usual(family: &Any<'_>, case: &Case, wanted: &Wanted) -> Result<(), Box<dyn Error>> {
    let Case { name, window, .. } = case;
    let begun = Instant::now();
    let tired = || begun.elapsed().as_secs_f64() > wanted.limit;
    let usual = AtlasOptions::default();
    let trace = TraceOptions { beyond: 1e-3, ..usual.trace };
    let watch = Watch::SILENT.cancelled_by(&tired);
    let surveyor =
        Surveyor { options: AtlasOptions { trace, ..usual }, watch, ..Surveyor::default() };
    let atlas = surveyor.atlas(family, window)?;
    let seconds = begun.elapsed().as_secs_f64();
    let wrong = wrong(family, window, wanted.points, |point| atlas.label(point).cloned())?;
    let doubts = [atlas.unresolved.len(), atlas.plane.findings().len()];
    let (work, regions) = (atlas.statistics, atlas.plane.regions().len());
    row([name, "usual"], regions, doubts, wrong, [work.free_runs, work.prescribed_runs], seconds);
    if let Some(doubts) = atlas.doubts(&RunNames::default()) {
        eprintln!("  sure: {:.6}", atlas.sure_area());
        doubts.sentences().iter().take(8).for_each(|what| eprintln!("  {what}"));
    }
    Ok(())
}

fn by_margins(family: &Any<'_>, case: &Case, points: usize) -> Result<(), Box<dyn Error>> {
    let Case { name, window, .. } = case;
    let options = AtlasOptions::default();
    let began = Instant::now();
    let Network { curves, vertices, statistics: work, unresolved, .. } =
        trace_by_margins(family, window, &options.trace)?;
    let (plane, left_out) =
        Subdivision::leaving_out(*window, &curves, &vertices, options.tolerance)?;
    let unresolved = unresolved.len() + left_out.len();
    let seconds = began.elapsed().as_secs_f64();
    let label = |point: &Point| match plane.locate(point) {
        Location::Region(region) => plane.regions()[region].label.clone(),
        _ => None,
    };
    let wrong = wrong(family, window, points, label)?;
    let doubts = [unresolved, plane.findings().len()];
    let regions = plane.regions().len();
    row([name, "margins"], regions, doubts, wrong, [work.free_runs, work.prescribed_runs], seconds);
    for what in plane.findings().iter().take(5) {
        eprintln!("  {what}");
    }
    Ok(())
}

/// How many random points have a known label that is not the one of their run.
fn wrong<F: Family>(
    family: &F,
    window: &Window,
    points: usize,
    known: impl Fn(&Point) -> Option<F::Label>,
) -> Result<usize, F::Error> {
    let mut random = fastrand::Rng::with_seed(2);
    let mut wrong = 0;
    for _ in 0..points {
        let part = Point::new(random.f64(), random.f64());
        let point = window.low + window.extent().component_mul(&part);
        if let Some(label) = known(&point)
            && label != family.label(&point)?
        {
            wrong += 1;
        }
    }
    Ok(wrong)
}

fn row(
    [name, way]: [&str; 2],
    regions: usize,
    [unresolved, findings]: [usize; 2],
    wrong: usize,
    [free, prescribed]: [usize; 2],
    seconds: f64,
) {
    println!(
        "| {name} | {way} | {regions} | {unresolved} | {findings} | {wrong} | {free} \
         | {prescribed} | {seconds:.1} s |"
    );
}

/// Prints the table.
///
/// # Errors
/// A family cannot be traced.
fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let points = arguments.next().map_or(Ok(5000), |points| points.parse())?;
    let name = arguments.next().unwrap_or_default();
    let way = arguments.next().filter(|way| !way.is_empty());
    let limit = arguments.next().map_or(Ok(f64::INFINITY), |limit| limit.parse())?;
    let wanted = Wanted { points, way, limit };
    println!(
        "| family | way | regions | unresolved | findings | wrong | free runs | prescribed | time |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for (case, trial) in &TRIALS {
        if name.is_empty() || case.name == name {
            trial(case, &wanted)?;
        }
    }
    Ok(())
}
