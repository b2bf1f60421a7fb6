//! A gallery of atlases: piecewise-smooth systems, each with two parameters.
//!
//! Each file beside this one is a family: its equations, its window, and the time at which its runs
//! end. Here they are traced and verified, and compared with runs at random points and, where there
//! are any, with closed forms. Sequences are told apart up to the eighth switch, because switches
//! accumulate in some of the windows.
//!
//! Run with `cargo run --release --example gallery -- [POINTS] [NAME]`.

mod ball;
mod bouncing_ball;
mod converter;
mod dry_friction;
mod impact_oscillator;
mod relay;
mod two_masses;

use std::error::Error;
use std::time::Instant;

use stickslip::solver::{Dop853, Options};
use stickslip::tracer::{
    Atlas, AtlasOptions, Family, HybridFamily, Point, Problem, VerifyOptions, Window,
};

/// What a family shows.
struct Row {
    curves: usize,
    regions: usize,
    unresolved: usize,
    findings: usize,
    /// The part of the window's area in regions that are not in doubt.
    sure: f64,
    /// Points at which a region that is not in doubt has another label than the run, or than the
    /// closed form.
    wrong: usize,
}

/// A name, and what the family shows at so many random points.
type Exhibit = (&'static str, fn(usize) -> Result<Row, Box<dyn Error>>);

const GALLERY: [Exhibit; 7] = [
    ("bouncing ball", |points| {
        let known = |point: &Point| Some(bouncing_ball::bounces(point));
        show(bouncing_ball::drop, &bouncing_ball::WINDOW, 5.0, known, points)
    }),
    ("ball on a table", |points| show(ball::throw, &ball::WINDOW, 8.0, |_| None, points)),
    ("impact oscillator", |points| {
        show(impact_oscillator::start, &impact_oscillator::WINDOW, 10.0, |_| None, points)
    }),
    ("relay", |points| show(relay::start, &relay::WINDOW, 20.0, |_| None, points)),
    ("dry friction", |points| {
        show(dry_friction::shake, &dry_friction::WINDOW, 20.0, |_| None, points)
    }),
    ("two masses", |points| show(two_masses::belt, &two_masses::WINDOW, 11.0, |_| None, points)),
    ("boost converter", |points| {
        show(converter::boost, &converter::WINDOW, 12.0, |_| None, points)
    }),
];

/// Traces a family whose runs end at `end`, and compares it with runs at twice so many random
/// points: the tracer looks again where the first half disagrees. `known` is the number of switches in closed form.
fn show<P, const N: usize, const G: usize>(
    problem: P,
    window: &Window,
    end: f64,
    known: impl Fn(&Point) -> Option<usize>,
    points: usize,
) -> Result<Row, Box<dyn Error>>
where
    P: Problem<N, G>,
{
    let accurate = Options::with_tolerance(1e-13);
    let options = Options { max_step: 0.3, max_switches: 8, ..accurate };
    let family = HybridFamily { problem, method: Dop853, options, end };
    let verify = VerifyOptions { random_points: points, ..VerifyOptions::default() };
    let atlas = Atlas::of(&family, window, &AtlasOptions { verify, ..AtlasOptions::default() })?;
    let mut random = fastrand::Rng::with_seed(2);
    let mut wrong = 0;
    for _ in 0..points {
        let part = Point::new(random.f64(), random.f64());
        let point = window.low + window.extent().component_mul(&part);
        let Some(label) = atlas.label(&point) else { continue };
        let count = label.fired().map(<[usize]>::len);
        let is_known = known(&point).is_none_or(|known| count == Some(known.min(8)));
        wrong += usize::from(*label != family.label(&point)? || !is_known);
    }
    Ok(Row {
        curves: atlas.plane.curves().len(),
        regions: atlas.plane.regions().len(),
        unresolved: atlas.unresolved.len(),
        findings: atlas.plane.findings().len(),
        sure: atlas.sure_area(),
        wrong,
    })
}

/// Prints the table.
///
/// # Errors
/// A family cannot be traced.
fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let points = arguments.next().map_or(Ok(10_000), |points| points.parse())?;
    let name = arguments.next().unwrap_or_default();
    println!("| family | curves | regions | unresolved | findings | sure area | wrong | time |");
    println!("|---|---|---|---|---|---|---|---|");
    for (own, family) in GALLERY.iter().filter(|(own, _)| own.contains(&name)) {
        let began = Instant::now();
        let Row { curves, regions, unresolved, findings, sure, wrong } = family(points)?;
        let seconds = began.elapsed().as_secs_f64();
        println!(
            "| {own} | {curves} | {regions} | {unresolved} | {findings} | {sure:.6} \
             | {wrong} of {points} | {seconds:.1} s |"
        );
    }
    Ok(())
}

/// The families that take a second or less in a debug build.
#[test]
fn small_families_hold() {
    for name in ["bouncing ball", "relay", "boost converter"] {
        let (_, family) = GALLERY.iter().find(|(own, _)| *own == name).expect("a name");
        let row = family(200).expect("an atlas");
        assert_eq!((row.unresolved, row.findings, row.wrong), (0, 0, 0), "{name}");
    }
}
