//! `orbit`: a periodic orbit of a system of one's own.

use std::io::{self, Write};
use std::path::PathBuf;

use stickslip_figure::Svg;
use stickslip_figure::pictures::{self, run::RunPicture};
use stickslip_files::output::file::OutputFile;
use stickslip_files::output::json;
use stickslip_files::output::picture::PictureFile;
use stickslip_orbits::document::{Document, OneOrbit};

use crate::error::Failure;
use crate::output::console::{deliver, print};
use crate::output::text::{self, number};
use crate::shared::Format;
use crate::shared::files::{picture, plotted, require_different, write_json};
use crate::shared::orbit::{FoundOrbit, GuessArguments, failure};

/// Parts of a segment in a picture.
const PARTS: usize = 60;

/// Find a periodic orbit of a system of your own, and whether it is stable
#[derive(Debug, clap::Args)]
#[command(long_about = ABOUT, after_long_help = EXAMPLES)]
pub struct OrbitArguments {
    /// Where the orbit is searched for.
    #[command(flatten)]
    pub guess: GuessArguments,

    /// How the result is printed
    #[arg(long, value_enum, default_value_t = Format::Table, help_heading = "Output")]
    pub format: Format,

    /// JSON file for the orbit
    #[arg(long, value_name = "ORBIT.json", help_heading = "Output")]
    pub out: Option<PathBuf>,

    /// Picture of the state over one period, with modes shaded and events marked
    #[arg(long, value_name = "FILE.svg|.png|.pdf", help_heading = "Output")]
    #[arg(value_parser = picture())]
    pub plot: Option<PictureFile>,
}

/// Finds the orbit, writes what is wanted, and prints it.
pub fn run(arguments: &OrbitArguments) -> Result<(), Failure> {
    let OrbitArguments { guess, format, out, plot } = arguments;
    let (out, plot) = (out.as_deref(), plot.as_ref());
    require_different(&[("--out", out), plotted(plot)], &guess.inputs())?;
    plot.map_or(Ok(()), PictureFile::probe)?;
    let file = out.map(OutputFile::create).transpose()?;
    let found = guess.find()?;
    let document = Document::of_orbit(&found.orbits, &found.name, &found.orbit);
    let mut stored = Vec::new();
    if let Some(file) = file {
        stored.push(write_json(file, &document)?);
    }
    if let Some(plot) = plot {
        stored.push(plot.write(Ok(draw(&found)?))?);
    }
    deliver(stored, "")?;
    print(|out| match format {
        Format::Json => json::lines(out, &document),
        Format::Table => table(out, &found, &document),
    })
}

fn table(out: &mut dyn Write, found: &FoundOrbit, document: &Document<OneOrbit>) -> io::Result<()> {
    let orbit = &document.content.orbit;
    for (parameter, value) in found.orbits.system().parameters.iter().zip(&found.orbit.parameters) {
        writeln!(out, "{} = {value}", parameter.name)?;
    }
    writeln!(out)?;
    let header = ["segment", "mode", "until", "duration"].map(str::to_owned);
    let rows = orbit.segments.iter().enumerate().map(|(place, it)| {
        let leg = &it.leg;
        [place.to_string(), leg.mode.clone(), leg.rule.clone(), number(it.duration)]
    });
    text::aligned(out, &std::iter::once(header).chain(rows).collect::<Vec<_>>())?;
    writeln!(out)?;
    let multipliers = match &orbit.multipliers {
        Some(all) if all.is_empty() => "none but the trivial 1".to_owned(),
        Some(all) => all.iter().map(complex).collect::<Vec<_>>().join(", "),
        None => "infinite, at a graze".to_owned(),
    };
    let mut lines = vec![("period", number(orbit.period)), ("multipliers", multipliers)];
    let yes = |yes: bool| if yes { "yes" } else { "no" }.to_owned();
    lines.push(("stable", yes(orbit.stable)));
    lines.push(("followed by the system", orbit.obstacle.clone().unwrap_or_else(|| yes(true))));
    let start = orbit.segments.first().map_or(&[][..], |it| &it.state);
    let names: Vec<String> =
        document.components.iter().map(|it| format!("{it} at the start")).collect();
    lines.extend(names.iter().map(String::as_str).zip(start.iter().map(|it| number(*it))));
    text::pairs(out, &lines)
}

/// A complex number.
fn complex([re, im]: &[f64; 2]) -> String {
    match im.abs() {
        0.0 => number(*re),
        size => format!("{} {} {}i", number(*re), if *im < 0.0 { "-" } else { "+" }, number(size)),
    }
}

/// The picture of an orbit: its first components, those that only events change last.
fn draw(found: &FoundOrbit) -> Result<Svg, Failure> {
    const MOST_PANELS: usize = 8;
    let (system, orbit) = (found.orbits.system(), &found.orbit);
    let curve = found.orbits.course(orbit, PARTS).map_err(failure)?;
    let mut shown: Vec<usize> = (0..system.components.len()).collect();
    shown.sort_by_key(|&component| system.components[component].discrete);
    shown.truncate(MOST_PANELS);
    let ends = orbit.segments.iter().scan(orbit.start, |s, segment| {
        let from = *s;
        *s += segment.duration;
        Some((segment.leg.mode, from, *s))
    });
    let ends: Vec<_> = ends.collect();
    let pick = |state: &[f64]| shown.iter().map(|&component| state[component]).collect();
    Ok(pictures::run::draw(&RunPicture {
        title: &format!("{}: a periodic orbit", found.name),
        time: "time t",
        names: shown.iter().map(|&component| &*system.components[component].name).collect(),
        curve: curve.iter().map(|(s, state)| (*s, pick(state))).collect(),
        modes: system.modes.iter().map(|mode| &*mode.name).collect(),
        events: ends.iter().map(|(_, _, to)| *to).collect(),
        stays: ends,
    }))
}

/// What `orbit --help` says first.
const ABOUT: &str = "\
Find a periodic orbit of a system of your own: segments from rule to rule that close. From the \
start, the rules of --itinerary act one after another, and the search goes on from there; or a run \
settles.

Multipliers are those of the derivative of the return through all rules. Whether the system follows \
the orbit by itself is decided by bounds along the whole orbit.";

/// What `orbit --help` says last.
const EXAMPLES: &str = "\
Examples:
  stickslip orbit examples/orbits/oscillator.slip --itinerary impact,phase
  stickslip orbit examples/systems/belt.slip --settle 100 --plot orbit.svg
  stickslip orbit examples/systems/relay.slip --itinerary down,up --out orbit.json

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
