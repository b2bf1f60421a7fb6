//! `stack`: atlases over the damping, or over a parameter of a system of one's own, and what
//! changes between them.

use std::error::Error;
use std::path::PathBuf;

use stickslip_figure::pictures;
use stickslip_files::input::parameter::Parameter;
use stickslip_files::input::{number, range};
use stickslip_files::output::file::OutputFile;
use stickslip_files::output::picture::PictureFile;
use stickslip_plane::Range;
use stickslip_plane::atlas::{AtlasError, Frame};
use stickslip_plane::progress::InParallel;
use stickslip_plane::stack::{damped, stack};
use stickslip_tracer::{
    Watch,
    stack::{Stack, StackOptions},
};

use crate::error::Failure;
use crate::output::console::{counted, deliver};
use crate::shared::files::{self, plotted, require_different, write_json};
use crate::shared::system::{PlaneArguments, SystemPlane, place};
use crate::shared::threads::ThreadsArguments;

/// Trace atlases at several dampings, and find where regions are born and die between them
#[derive(Debug, clap::Args)]
#[command(long_about = ABOUT, after_long_help = EXAMPLES)]
pub struct StackArguments {
    /// A system of one's own.
    #[command(flatten)]
    pub plane: PlaneArguments,

    /// The parameter of the system that differs between the atlases, and its values in ascending
    /// order, two or more
    #[arg(long, value_name = "NAME=V,V,…", value_parser = over, requires = "system")]
    #[arg(help_heading = "System of your own")]
    pub over: Option<Over>,

    /// Interval of the scaled stiffness κ = k_t/(α m β^⅘ g_n^⅖), above 0
    #[arg(long, value_name = "LO:HI", help_heading = "Window", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| range::parse_for(Parameter::Kappa, text))]
    #[arg(required_unless_present = "system", conflicts_with = "system")]
    pub kappa: Option<Range>,

    /// Interval of the reduced impact ratio ψ = (g_t/g_n)·α/μ, above 0
    #[arg(long, value_name = "LO:HI", help_heading = "Window", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| range::parse_for(Parameter::Psi, text))]
    #[arg(required_unless_present = "system", conflicts_with = "system")]
    pub psi: Option<Range>,

    /// Scaled dampings a = A β^⅖ g_n^⅕ of the atlases, in ascending order: two above 0 or more, and
    /// 0 before them or not
    #[arg(long, value_name = "A,B,…", help_heading = "Window", allow_hyphen_values = true)]
    #[arg(value_delimiter = ',', default_value = "0,1e-6,0.1,0.2,0.5,1,1.5,2")]
    #[arg(value_parser = |text: &str| Parameter::Damping.parse(text), conflicts_with = "system")]
    pub damping: Vec<f64>,

    /// Accuracy of boundaries in ψ, also between their points; from 1e-11·(1 + HI) to 1e-9·(1 +
    /// HI) with HI of ψ, and less in narrow windows [default: 1e-10·(1 + HI)]. Of a system, above 0
    /// and below a thousandth of the window [default: 1e-9]
    #[arg(long, value_name = "T", help_heading = "Window", allow_hyphen_values = true)]
    #[arg(value_parser = number::parse_option)]
    pub tolerance: Option<f64>,

    /// JSON file for the atlases' regions and the changes between them
    #[arg(long, value_name = "STACK.json", help_heading = "Output")]
    pub out: PathBuf,

    /// Picture of the atlases, and of the births and deaths of regions over the damping
    #[arg(long, value_name = "FILE.svg|.png|.pdf", help_heading = "Output")]
    #[arg(value_parser = files::picture())]
    pub plot: Option<PictureFile>,

    /// The threads.
    #[command(flatten)]
    pub threads: ThreadsArguments,
}

/// A parameter that differs between atlases.
#[derive(Clone, Debug, PartialEq)]
pub struct Over {
    /// Its name.
    pub name: String,
    /// Its values, in ascending order.
    pub values: Vec<f64>,
}

/// Traces the atlases, isolates the changes between them, and writes both.
///
/// # Errors
/// Options contradict each other, a run fails, files cannot be written, or something speaks against
/// the stack. In the last case the stack is complete and says so.
pub fn run(arguments: &StackArguments) -> Result<(), Failure> {
    match SystemPlane::new(&arguments.plane)? {
        Some(plane) => runs(&plane, arguments),
        None => collisions(arguments),
    }
}

/// Atlases of collisions over the damping.
fn collisions(arguments: &StackArguments) -> Result<(), Failure> {
    let StackArguments { kappa, psi, damping, tolerance, out, plot, .. } = arguments;
    let (Some(kappa), Some(psi)) = (kappa, psi) else {
        return Err(Failure::Usage("--kappa and --psi are missing".to_owned()));
    };
    let refused = |error| Failure::Usage(format!("--damping: {error}"));
    damped(damping).map_err(refused)?;
    let plot = plot.as_ref();
    require_different(&[("--out", Some(&**out)), plotted(plot)], &[])?;
    let frame = Frame::new(*kappa, *psi, 0.0);
    let tolerance = tolerance.unwrap_or_else(|| frame.tolerances().usual);
    plot.map_or(Ok(()), PictureFile::probe)?;
    let file = OutputFile::create(out)?;
    let made = arguments.threads.with_steps(|report| stack(frame, damping, tolerance, report))?;
    let made = made.map_err(|error| match error {
        AtlasError::Dampings { .. } => refused(error),
        AtlasError::Layer { source, .. } => (*source).into(),
        error => error.into(),
    })?;
    let mut stored = vec![write_json(file, &made.document())?];
    if let Some(plot) = plot {
        stored.push(plot.write(Ok(pictures::stack::draw(&made)))?);
    }
    deliver(stored, found("damping", "dampings", made.layers.len(), made.changes.len()))?;
    let doubtful = made.changes.iter().find(|change| change.doubtful);
    let doubtful = doubtful.map(|change| change.between);
    let objection = made.objection().map(|why| advised(why, "--damping ", damping, doubtful));
    Failure::if_doubtful(out, "stack is", objection)
}

/// Atlases of a system of one's own over a third parameter.
fn runs(plane: &SystemPlane, arguments: &StackArguments) -> Result<(), Failure> {
    let StackArguments { tolerance, out, plot, threads, .. } = arguments;
    let (third, Over { name, values }) = over_third(plane, arguments)?;
    let plot = plot.as_ref();
    let system = ("the system", arguments.plane.system.as_deref());
    require_different(&[("--out", Some(out)), plotted(plot)], &[system])?;
    let atlas = plane.atlas_options(*tolerance)?;
    let options = StackOptions { atlas, ..StackOptions::default() };
    plot.map_or(Ok(()), PictureFile::probe)?;
    let file = OutputFile::create(out)?;
    let over: Vec<(usize, f64)> = values.iter().map(|&value| (third, value)).collect();
    let family = plane.family_of_atlas(arguments.plane.max_events, &over);
    let family = |value| family.with(third, value);
    let made = threads.with_steps(|report| {
        Stack::watched(family, &plane.window, values, &options, InParallel, Watch::from(report))
    })?;
    let made = made.map_err(|error| {
        let at = error.source().map_or_else(String::new, |source| format!(": {source}"));
        Failure::Family(format!("{error}{at}"))
    })?;
    let document =
        stickslip_tracer::stack::StackDocument::of_runs(&made, &options, &plane.names, name);
    let mut stored = vec![write_json(file, &document)?];
    if let Some(plot) = plot {
        let picture = pictures::stack::draw_runs(&made, &plane.names, name);
        stored.push(plot.write(Ok(picture))?);
    }
    deliver(stored, found("value", "values", made.layers.len(), made.changes.len()))?;
    let doubtful = made.changes.iter().find(|change| change.is_doubtful());
    let doubtful = doubtful.map(|change| change.between);
    let option = format!("--over {name}=");
    let objection = document.objection.map(|why| advised(why, &option, values, doubtful));
    Failure::if_doubtful(out, "stack is", objection)
}

/// How many atlases there are, and how many changes between them.
fn found(one: &str, more: &str, layers: usize, changes: usize) -> String {
    let changes = counted(changes, "change", "changes");
    format!("atlases at {}, {changes} between them", counted(layers, one, more))
}

/// What speaks against a stack, and what to do if it is a change between two values: search again
/// between atlases that are closer to it, of which other values are tried.
fn advised(objection: String, option: &str, values: &[f64], change: Option<[f64; 2]>) -> String {
    let Some([low, high]) = change else { return objection };
    let below = values.iter().rev().find(|value| **value < low);
    let above = values.iter().find(|value| **value > high);
    let (Some(below), Some(above)) = (below, above) else { return objection };
    let (below, above) = (low - 0.3 * (low - below), high + 0.3 * (above - high));
    format!("{objection}; a search in {option}{below:.4},{above:.4} may resolve it")
}

/// The place of the third parameter, and its values.
fn over_third<'a>(
    plane: &SystemPlane,
    arguments: &'a StackArguments,
) -> Result<(usize, &'a Over), Failure> {
    let Some(over) = &arguments.over else {
        let message = "--over is missing; expected NAME=V,V,… for a third parameter";
        return Err(Failure::Usage(message.to_owned()));
    };
    let third = place(&plane.system, "--over", &over.name)?;
    if plane.names.axes.contains(&over.name) {
        let name = &over.name;
        let message = format!("--over {name}: expected another parameter than --x and --y");
        return Err(Failure::Usage(message));
    }
    let one = plane.system.require_one_first_mode(third);
    one.map_err(|error| Failure::Usage(format!("--over: {error}")))?;
    Ok((third, over))
}

/// Reads `name=value,value,…`.
fn over(text: &str) -> Result<Over, String> {
    const EXPECTED: &str =
        "expected NAME=V,V,… with two values or more in ascending order, such as mu=0.1,0.3,0.5";
    let (name, values) = text.split_once('=').ok_or(EXPECTED)?;
    let value = |text| number::parse(text).map_err(|problem| format!("{problem}; {EXPECTED}"));
    let values = values.split(',').map(value).collect::<Result<Vec<f64>, _>>()?;
    let ascend = values.windows(2).all(|pair| pair[0] < pair[1]);
    if values.len() < 2 || !ascend || !values.iter().all(|value| value.is_finite()) {
        return Err(format!("{values:?}; {EXPECTED}"));
    }
    Ok(Over { name: name.trim().to_owned(), values })
}

/// What `stack --help` says first.
const ABOUT: &str = "\
Trace the atlases of a window at several dampings, and find the dampings between them at which \
regions are born, split, merge and die.

Where a special point meets another one or the edge of the window, or where a boundary touches \
another one or the edge, or shrinks to a point, the damping is solved for. A change for which \
nothing can be solved is enclosed between two dampings. Without damping all regions are others, so \
that an atlas at 0 stands beside the others. If something speaks against an atlas, or if changes \
are in doubt, the result is written and says so, and the exit code is 1.

With SYSTEM.slip, the runs of a system of your own over two of its parameters, --x and --y, at \
several values of a third one, --over.";

/// What `stack --help` says last.
const EXAMPLES: &str = "\
Examples:
  stickslip stack --kappa 0.5:30 --psi 0.05:2 --out stack.json --plot stack.svg
  stickslip stack --kappa 5:8 --psi 0.5:1.2 --damping 0.05,0.2,0.4 --out stack.json
  stickslip stack examples/systems/ball.slip --x e=0.3:0.7 --y g=5:15 --over height=0.5,1,2 \
    --max-events 6 --end 2 --out stack.json --plot stack.svg

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
