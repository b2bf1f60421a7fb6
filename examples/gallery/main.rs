//! A gallery of atlases: piecewise-smooth systems, each with two parameters.
//!
//! Each file beside this one is a family: its equations, its window, and the names of its two
//! parameters; the belt is that of the example `belt_atlas`. Here they are traced and verified, and
//! compared with runs at random points and, where there are any, with closed forms. Sequences are
//! told apart up to the eighth event, because events accumulate in some of the windows.
//!
//! Each family is a text too, in the folder `text`, whose atlas has to have the same regions, and
//! the same curves.
//!
//! Run with `cargo run --release --example gallery -- [POINTS] [NAME] [FOLDER]`. Pictures are
//! written into the folder, if there is one.

mod any;
mod ball;
#[path = "../belt_atlas/belt.rs"]
mod belt;
mod bouncing_ball;
#[path = "../belt_atlas/closed_form.rs"]
#[expect(dead_code, reason = "the other example also compares boundaries")]
mod closed_form;
mod converter;
mod dry_friction;
mod impact_oscillator;
mod relay;
mod two_masses;

use std::error::Error;
use std::fs;
use std::path::Path;
use std::time::Instant;

use stickslip::plane::progress::InParallel;
use stickslip::solver::margin::{Margin, Place};
use stickslip::solver::{Dop853, Options};
use stickslip::tracer::{
    Atlas, AtlasOptions, Family, Point, Surveyor, TraceOptions, Watch, Window,
    hybrid::{FamilyError, HybridFamily, Itinerary, Problem},
    regions::VerifyOptions,
};
use stickslip_expression::{System, SystemFamily};
use stickslip_figure::pictures::family::{Captions, draw};

use any::Any;
use belt::{BELT, Belt, OBSERVED, POSITION};

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
    picture: String,
    text: AsText,
}

/// The atlas of the same family as text.
struct AsText {
    curves: usize,
    regions: usize,
    /// How many nodes of its curves lie beside the family's, and how many there are.
    beside: [usize; 2],
}

/// A family with the ends of its runs, in words.
struct Room {
    name: &'static str,
    text: &'static str,
    axes: [&'static str; 2],
    window: Window,
    end: f64,
}

/// Traces a family and compares it with runs at so many random points.
type Exhibit = (Room, fn(&Room, usize) -> Result<Row, Box<dyn Error>>);

/// The greatest number of events of a sequence.
const MOST: usize = 8;

const BELT_AXES: [&str; 2] =
    ["frequency Ω in units of √(k/m)", "amplitude f in units of the friction"];

/// The settings of runs.
fn runs() -> Options {
    Options { max_step: 0.3, max_switches: MOST, ..Options::with_tolerance(1e-13) }
}

/// The part of the window over which margins are differenced.
const STEP: f64 = 1e-6;

/// There is no closed form.
fn unknown(_: &Point, _: &Itinerary) -> bool {
    true
}

/// Whether a sequence has so many events, up to those that are told apart.
fn has(label: &Itinerary, events: usize) -> bool {
    label.fired().map(<[usize]>::len) == Some(events.min(MOST))
}

#[rustfmt::skip]
const GALLERY: [Exhibit; 8] = [
    (Room { name: "bouncing ball", text: include_str!("text/bouncing_ball.slip"), axes: bouncing_ball::AXES, window: bouncing_ball::WINDOW, end: 5.0 },
     |room, points| show(bouncing_ball::drop, room, |at, label| has(label, bouncing_ball::bounces(at)), points)),
    (Room { name: "ball on a table", text: include_str!("text/ball_on_a_table.slip"), axes: ball::AXES, window: ball::WINDOW, end: 8.0 },
     |room, points| show(ball::throw, room, unknown, points)),
    (Room { name: "impact oscillator", text: include_str!("text/impact_oscillator.slip"), axes: impact_oscillator::AXES, window: impact_oscillator::WINDOW, end: 10.0 },
     |room, points| show(impact_oscillator::start, room, unknown, points)),
    (Room { name: "relay", text: include_str!("text/relay.slip"), axes: relay::AXES, window: relay::WINDOW, end: 20.0 },
     |room, points| show(relay::start, room, |at, label| !relay::is_still(at) || has(label, 0), points)),
    (Room { name: "dry friction", text: include_str!("text/dry_friction.slip"), axes: dry_friction::AXES, window: dry_friction::WINDOW, end: 20.0 },
     |room, points| show(dry_friction::shake, room, unknown, points)),
    (Room { name: "two masses", text: include_str!("text/two_masses.slip"), axes: two_masses::AXES, window: two_masses::WINDOW, end: 11.0 },
     |room, points| show(two_masses::belt, room, unknown, points)),
    (Room { name: "boost converter", text: include_str!("text/boost_converter.slip"), axes: converter::AXES, window: converter::WINDOW, end: 12.0 },
     |room, points| show(converter::boost, room, converter::fits, points)),
    (Room { name: "shaken belt", text: include_str!("text/shaken_belt.slip"), axes: BELT_AXES, window: belt::WINDOW, end: f64::INFINITY },
     |room, points| {
         let switches = |at: &Point| Belt { frequency: at.x, amplitude: at.y }.switches();
         let fits = |at: &Point, label: &Itinerary| has(label, switches(at));
         show(belt::Belts, room, fits, points)
     }),
];

/// Traces the family of a problem.
fn show<P, const N: usize, const G: usize>(
    problem: P,
    room: &Room,
    fits: impl Fn(&Point, &Itinerary) -> bool,
    points: usize,
) -> Result<Row, Box<dyn Error>>
where
    P: Problem<N, G> + Sync,
{
    let family = HybridFamily { problem, method: Dop853, options: runs(), end: room.end };
    compare(&Any(&family), room, &fits, points)
}

/// Traces a family and compares it with runs at twice so many random points: the tracer looks again
/// where the first half disagrees. `fits` compares a label with the closed form.
fn compare(
    family: &Any<'_>,
    Room { name, text, axes, window, .. }: &Room,
    fits: &dyn Fn(&Point, &Itinerary) -> bool,
    points: usize,
) -> Result<Row, Box<dyn Error>> {
    let verify = VerifyOptions { random_points: points, ..VerifyOptions::default() };
    let trace = TraceOptions { beyond: 1e-3, ..TraceOptions::default() };
    let options = AtlasOptions { trace, verify, ..AtlasOptions::default() };
    let surveyor = Surveyor { options, executor: InParallel, watch: Watch::SILENT };
    let atlas = surveyor.atlas(family, window)?;
    let system = System::parse(text)?;
    let own = SystemFamily::new(&system, [0, 1], &system.values(), None, runs())?;
    let again = surveyor.atlas(&Any(&own), window)?;
    let text = AsText {
        curves: again.plane.curves().len(),
        regions: again.plane.regions().len(),
        beside: beside(&again, family, window)?,
    };
    let mut random = fastrand::Rng::with_seed(2);
    let mut wrong = 0;
    for _ in 0..points {
        let part = Point::new(random.f64(), random.f64());
        let point = window.low + window.extent().component_mul(&part);
        let Some(label) = atlas.label(&point) else { continue };
        wrong += usize::from(*label != family.label(&point)? || !fits(&point, label));
    }
    let (curves, regions) = (atlas.plane.curves().len(), atlas.plane.regions().len());
    let title =
        format!("{name}: {curves} boundaries, {regions} regions with their number of events");
    let captions = Captions {
        title: &title,
        axes: *axes,
        kinds: &KINDS,
        kind: &kind,
        text: &number,
        hint: &number,
    };
    Ok(Row {
        curves,
        regions,
        unresolved: atlas.unresolved.len(),
        findings: atlas.plane.findings().len(),
        sure: atlas.sure_area(),
        wrong,
        picture: draw(&atlas, &captions).document(),
        text,
    })
}

/// How many nodes of an atlas lie beside the curves of a family, and how many there are: where the
/// family's margin over its slope is more than a millionth of the window.
fn beside(
    atlas: &Atlas<Itinerary, Margin>,
    family: &Any<'_>,
    window: &Window,
) -> Result<[usize; 2], FamilyError> {
    let mut counts = [0; 2];
    for curve in atlas.plane.curves() {
        for node in &curve.nodes {
            let margin = |part: Point| {
                let point = node.point + window.extent().component_mul(&part);
                Ok::<_, FamilyError>(family.margin(&point, &curve.margin)?.unwrap_or(f64::NAN))
            };
            let here = margin(Point::zeros())?;
            // Margins end where an event before them grazes, so that a step may lead beyond.
            let slope = |axis: Point| {
                let [ahead, behind] = [STEP, -STEP].map(|step| margin(axis * step));
                let [ahead, behind] = [(ahead? - here) / STEP, (here - behind?) / STEP];
                Ok::<_, FamilyError>(if ahead.is_nan() { behind } else { ahead })
            };
            let slope = slope(Point::new(1.0, 0.0))?.hypot(slope(Point::new(0.0, 1.0))?);
            let distance = here.abs() / if slope.is_nan() { 1.0 } else { slope };
            // Where it ends at the node itself, it is known beside it. One that the family does not
            // have is far away.
            let is_near = || {
                let places = [(STEP, 0.0), (-STEP, 0.0), (0.0, STEP), (0.0, -STEP)];
                let mut near = places.map(|(x, y)| margin(Point::new(x, y))).into_iter();
                near.any(|value| value.is_ok_and(|value| value.abs() < 1e-2))
            };
            let distance = match distance {
                it if it.is_nan() && is_near() => STEP,
                it if it.is_nan() => 1.0,
                it => it,
            };
            counts[0] += usize::from(distance > STEP);
            counts[1] += 1;
        }
    }
    Ok(counts)
}

/// The kinds of boundaries in the pictures.
const KINDS: [&str; 4] = ["event at the end", "graze", "order of events", "start or branch"];

fn kind(margin: &Margin) -> usize {
    match margin.place {
        Place::End => 0,
        Place::Minimum { .. } | Place::Maximum { .. } => 1,
        Place::Exit(_) => 2,
        Place::Start { .. } | Place::Branch(_) | Place::Condition => 3,
    }
}

/// The number of events in the pictures.
fn number(label: &Itinerary) -> String {
    match label {
        Itinerary::Fires(guards) => guards.len().to_string(),
        Itinerary::Begins(guards) => format!("{}+", guards.len()),
        Itinerary::Accumulates => "∞".to_owned(),
        Itinerary::Unfinished | Itinerary::Fails | Itinerary::NoStart(_) => "–".to_owned(),
    }
}

/// Prints the table, and writes the pictures.
///
/// # Errors
/// A family cannot be traced, or a picture not be written.
fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let points = arguments.next().map_or(Ok(10_000), |points| points.parse())?;
    let name = arguments.next().unwrap_or_default();
    let folder = arguments.next();
    println!(
        "| family | curves | regions | unresolved | findings | sure area | wrong | as text | time |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for (room, family) in GALLERY.iter().filter(|(room, _)| room.name.contains(&name)) {
        let began = Instant::now();
        let Row { curves, regions, unresolved, findings, sure, wrong, picture, text } =
            family(room, points)?;
        let seconds = began.elapsed().as_secs_f64();
        println!(
            "| {} | {curves} | {regions} | {unresolved} | {findings} | {sure:.6} \
             | {wrong} of {points} | {} and {}, {} of {} | {seconds:.1} s |",
            room.name, text.curves, text.regions, text.beside[0], text.beside[1]
        );
        if let Some(folder) = &folder {
            let file = format!("{}.svg", room.name.replace(' ', "_"));
            fs::write(Path::new(folder).join(file), picture)?;
        }
    }
    Ok(())
}

/// The families that take a second or less in a debug build.
#[test]
fn small_families_hold() {
    for name in ["bouncing ball", "relay", "boost converter"] {
        let (room, family) = GALLERY.iter().find(|(room, _)| room.name == name).expect("a name");
        let row = family(room, 200).expect("an atlas");
        assert_eq!((row.unresolved, row.findings, row.wrong), (0, 0, 0), "{name}");
        assert_eq!(row.text.regions, row.regions, "{name}");
        assert_eq!(row.text.beside[0], 0, "{name}");
        assert!(row.picture.contains(room.axes[0]) && row.picture.contains(room.axes[1]));
    }
}
