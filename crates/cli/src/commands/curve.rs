//! `curve`: special orbits over two parameters.

use std::io::{self, Write};
use std::path::PathBuf;

use serde::Deserialize;
use stickslip_figure::pictures::branch::{
    BranchCurve, BranchPoint, BranchStretch, SpecialMark, draw,
};
use stickslip_files::input::source;
use stickslip_files::output::file::OutputFile;
use stickslip_files::output::picture::PictureFile;
use stickslip_orbits::document::{BRANCH, CurveRecord, Document, OrbitRecord, SpecialRecord};
use stickslip_orbits::{BranchOptions, Orbits};

use crate::error::Failure;
use crate::output::console::{counted, deliver, print};
use crate::output::progress::Bar;
use crate::output::text::{self, number};
use crate::shared::files::{picture, plotted, require_different, write_json};
use crate::shared::orbit::{document, failure, special};
use crate::shared::system::{Axis, axis, place, read, title};

/// Follow special orbits of a system of your own over two parameters
#[derive(Debug, clap::Args)]
#[command(long_about = ABOUT, after_long_help = EXAMPLES)]
pub struct CurveArguments {
    /// The system, a text as docs/systems.md describes it; - is standard input
    #[arg(value_name = "SYSTEM.slip")]
    pub system: PathBuf,

    /// A branch of the system that `branch` has written
    #[arg(long, value_name = "BRANCH.json", help_heading = "Curve")]
    pub branch: PathBuf,

    /// The kind of special orbit: the first one of the branch, or the N-th with KIND:N
    #[arg(long, value_name = "KIND[:N]", help_heading = "Curve")]
    pub kind: String,

    /// The parameter on the horizontal axis, and its interval
    #[arg(long, value_name = "NAME=LO:HI", value_parser = axis, help_heading = "Curve")]
    pub x: Axis,

    /// The parameter on the vertical axis, and its interval
    #[arg(long, value_name = "NAME=LO:HI", value_parser = axis, help_heading = "Curve")]
    pub y: Axis,

    /// JSON file for the curve
    #[arg(long, value_name = "CURVE.json", help_heading = "Output")]
    pub out: Option<PathBuf>,

    /// Picture of the curve in its window, with orbits that are special twice
    #[arg(long, value_name = "FILE.svg|.png|.pdf", help_heading = "Output")]
    #[arg(value_parser = picture())]
    pub plot: Option<PictureFile>,
}

/// What is read of a branch.
#[derive(Deserialize)]
struct Written {
    schema: String,
    #[serde(default)]
    specials: Vec<SpecialRecord>,
}

/// Follows the curve, writes what is wanted, and prints its ends and meetings.
///
/// # Errors
/// The system or the branch cannot be read, options do not fit them, there is no curve, a file or
/// standard output cannot be written, or the curve breaks off. In the last case the files are
/// complete and say so.
pub fn run(arguments: &CurveArguments) -> Result<(), Failure> {
    let CurveArguments { x, y, out, plot, .. } = arguments;
    let (out, plot) = (out.as_deref(), plot.as_ref());
    let inputs = [("the system", Some(&*arguments.system)), ("--branch", Some(&*arguments.branch))];
    require_different(&[("--out", out), plotted(plot)], &inputs)?;
    plot.map_or(Ok(()), PictureFile::probe)?;
    let file = out.map(OutputFile::create).transpose()?;
    let (system, _) = read(&arguments.system)?;
    let record = read_special(arguments)?;
    let parameters = [place(&system, "--x", &x.name)?, place(&system, "--y", &y.name)?];
    if parameters[0] == parameters[1] {
        let name = &x.name;
        return Err(Failure::Usage(format!(
            "--x and --y are both {name}; expected two parameters"
        )));
    }
    let orbits = Orbits::new(&system).map_err(|error| Failure::Usage(error.to_string()))?;
    let known = record.special(&orbits);
    let known = known.map_err(|error| Failure::Usage(error.to_string()))?;
    let window = [[x.range.low, x.range.high], [y.range.low, y.range.high]];
    let bar = Bar::watching(orbits.watch());
    let curve = orbits.curve(&known, parameters, window, &BranchOptions::default());
    drop(bar);
    let curve = curve.map_err(failure)?;
    let document = Document::of_curve(&orbits, &title(&arguments.system), &curve);
    let mut stored = Vec::new();
    if let Some(file) = file {
        stored.push(write_json(file, &document)?);
    }
    if let Some(plot) = plot {
        stored.push(plot.write(Ok(picture_of(&document)))?);
    }
    deliver(stored, counted(curve.points.len(), "orbit", "orbits"))?;
    print(|out| table(out, &document.content))?;
    Failure::if_doubtful(out.unwrap_or(&arguments.system), "curve is", curve.objection)
}

/// The special orbit of the branch.
fn read_special(arguments: &CurveArguments) -> Result<SpecialRecord, Failure> {
    let path = &arguments.branch;
    let Written { schema, specials } = document(path)?;
    if schema != BRANCH {
        let reason = format!("schema is {schema:?}; expected {BRANCH:?}");
        return Err(Failure::input(source::shown(path), reason));
    }
    special(&specials, "--kind", &arguments.kind).cloned()
}

/// The parameters of an orbit.
fn at(curve: &CurveRecord, orbit: &OrbitRecord) -> [f64; 2] {
    [0, 1].map(|k| orbit.parameters[&curve.parameters[k]])
}

fn table(out: &mut dyn Write, curve: &CurveRecord) -> io::Result<()> {
    let [x, y] = &curve.parameters;
    let header = [curve.kind.name(), x, y].map(str::to_owned);
    let row = |name: &str, orbit: &OrbitRecord| {
        let [x, y] = at(curve, orbit);
        [name.to_owned(), number(x), number(y)]
    };
    let ends = [curve.points.first(), curve.points.last()];
    let ends = ends.into_iter().flatten().map(|it| row("end", it));
    let meetings = curve.meetings.iter().map(|it| row(&it.name, &it.orbit));
    text::aligned(out, &std::iter::once(header).chain(ends).chain(meetings).collect::<Vec<_>>())
}

fn picture_of(document: &Document<CurveRecord>) -> stickslip_figure::Svg {
    let curve = &document.content;
    let points = curve.points.iter();
    let meetings = curve.meetings.iter().map(|it| SpecialMark {
        name: &it.name,
        at: at(curve, &it.orbit),
        behind: it.behind,
    });
    let kind = curve.kind.name();
    draw(&BranchCurve {
        title: &format!("{}: {kind} of a periodic orbit", document.system),
        axes: [&curve.parameters[0], &curve.parameters[1]],
        points: points
            .map(|it| BranchPoint { at: at(curve, it), stretch: BranchStretch::Special })
            .collect(),
        specials: meetings.collect(),
    })
}

/// What `curve --help` says first.
const ABOUT: &str = "\
Follow the special orbits of one kind over two parameters, from a branch: where an orbit folds, \
flips, grazes or begins to slide. Orbits at which something else changes too are located and named: \
fold-grazing, double-graze, cusp, resonance-1-1, resonance-1-2.

Kinds branch-point, infinite-period and boundary have no curve.";

/// What `curve --help` says last.
const EXAMPLES: &str = "\
Examples:
  stickslip curve examples/orbits/oscillator.slip --branch branch.json --kind grazing \
--x w=0.6:1.4 --y a=0.02:1 --out curve.json --plot curve.svg
  stickslip curve examples/orbits/oscillator.slip --branch branch.json --kind flip \
--x w=0.7:0.9 --y a=0.02:1.2

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
