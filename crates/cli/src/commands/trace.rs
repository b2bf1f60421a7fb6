//! `trace`: an atlas, traced, verified and written.

use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use stickslip_figure::pictures;
use stickslip_files::input::parameter::Parameter;
use stickslip_files::input::recipe::reduced;
use stickslip_files::input::{number, range};
use stickslip_files::output::file::OutputFile;
use stickslip_files::output::json;
use stickslip_files::output::picture::PictureFile;
use stickslip_plane::Range;
use stickslip_plane::atlas::{self, AtlasDocument, CollisionAtlas, Frame, geojson};
use stickslip_plane::gaining;
use stickslip_plane::progress::InParallel;
use stickslip_tracer::{Effort, Surveyor, Watch};

use crate::error::Failure;
use crate::output::console::{counted, deliver};
use crate::shared::collision::{CollisionArguments, ImpactRange, window};
use crate::shared::files::{self, plotted, require_different, write_json};
use crate::shared::law::LawArguments;
use crate::shared::system::{PlaneArguments, SystemPlane};
use crate::shared::threads::ThreadsArguments;

/// Trace every boundary in a window on which the switches change
#[derive(Debug, clap::Args)]
#[command(long_about = ABOUT, after_long_help = EXAMPLES)]
pub struct TraceArguments {
    /// A system of one's own.
    #[command(flatten)]
    pub plane: PlaneArguments,

    /// Interval of the scaled stiffness κ = k_t/(α m β^⅘ g_n^⅖), above 0
    #[arg(long, value_name = "LO:HI", help_heading = "Window", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| range::parse_for(Parameter::Kappa, text), conflicts_with = "system")]
    pub kappa: Option<Range>,

    /// Interval of the reduced impact ratio ψ = (g_t/g_n)·α/μ, above 0
    #[arg(long, value_name = "LO:HI", help_heading = "Window", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| range::parse_for(Parameter::Psi, text), conflicts_with = "system")]
    pub psi: Option<Range>,

    /// Interval of the impact ratio g_t/g_n, instead of --psi; above 0
    #[arg(long, value_name = "LO:HI", help_heading = "Window", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| range::parse_for(Parameter::Ratio, text), conflicts_with = "system")]
    pub ratio: Option<Range>,

    /// The parameters beside κ and ψ.
    #[command(flatten, next_help_heading = "Collisions")]
    pub collisions: CollisionArguments,

    /// The contact law.
    #[command(flatten)]
    pub law: LawArguments,

    /// Accuracy of boundaries in ψ, also between their points; from 1e-11·(1 + HI) to 1e-9·(1 +
    /// HI) with HI of ψ, and less in narrow windows [default: 1e-10·(1 + HI)]. Of a system, above 0
    /// and below a thousandth of the window [default: 1e-9]
    #[arg(long, value_name = "T", help_heading = "Collisions", allow_hyphen_values = true)]
    #[arg(value_parser = number::parse_option)]
    pub tolerance: Option<f64>,

    /// How much is done, as the atlas says too
    #[arg(long, value_name = "EFFORT", help_heading = "Collisions", default_value = "default")]
    #[arg(value_parser = effort())]
    pub effort: Effort,

    /// JSON file for the atlas
    #[arg(long, value_name = "ATLAS.json", help_heading = "Output")]
    pub out: PathBuf,

    /// Picture of the boundaries, with the number of switches in each region
    #[arg(long, value_name = "FILE.svg|.png|.pdf", help_heading = "Output")]
    #[arg(value_parser = files::picture())]
    pub plot: Option<PictureFile>,

    /// GeoJSON file of regions, boundaries and vertices; coordinates are κ and ψ, not degrees
    #[arg(long, value_name = "FILE", help_heading = "Output", conflicts_with = "system")]
    pub geojson: Option<PathBuf>,

    /// JSON file for the lines on which ε_t is 1 or −1, beyond which the law gives back more
    /// tangential energy than it took
    #[arg(long, value_name = "FILE.json", help_heading = "Output", conflicts_with = "system")]
    pub gaining: Option<PathBuf>,

    /// The threads.
    #[command(flatten)]
    pub threads: ThreadsArguments,
}

/// Traces the boundaries of the window, and writes its atlas.
///
/// # Errors
/// Options contradict each other, a run fails, files cannot be written, or something speaks against
/// the atlas or the lines on which |ε_t| is 1. In the last case the files are complete and say so.
pub fn run(arguments: &TraceArguments) -> Result<(), Failure> {
    match SystemPlane::new(&arguments.plane)? {
        Some(plane) => runs(&plane, arguments),
        None => collisions(arguments),
    }
}

/// Traces the boundaries of collisions.
fn collisions(arguments: &TraceArguments) -> Result<(), Failure> {
    let TraceArguments { out, plot, geojson: map, gaining: lines, effort, .. } = arguments;
    let frame = frame(arguments)?;
    let tolerance = arguments.tolerance.unwrap_or_else(|| frame.tolerances().usual);
    let plot = plot.as_ref();
    let outputs = [
        ("--out", Some(&**out)),
        ("--geojson", map.as_deref()),
        plotted(plot),
        ("--gaining", lines.as_deref()),
    ];
    require_different(&outputs, &[])?;
    plot.map_or(Ok(()), PictureFile::probe)?;
    let file = OutputFile::create(out)?;
    let map = map.as_deref().map(OutputFile::create).transpose()?;
    let gaining_file = lines.as_deref().map(OutputFile::create).transpose()?;

    let (verified, gained) = arguments.threads.with_steps(|report| {
        let verified = atlas::trace_with(frame, tolerance, *effort, report);
        let gained = gaining_file
            .is_some()
            .then(|| gaining::trace_with(frame, tolerance, *effort, report.into()));
        (verified, gained)
    })?;
    let (verified, gained) = (verified?, gained.transpose()?);
    let mut stored = vec![write_json(file, &AtlasDocument::new(&verified))?];
    if let Some(map) = map {
        let line = json::line(&geojson(&verified)).map_err(|error| map.failure(error))?;
        stored.push(map.finish(&line)?);
    }
    if let (Some(file), Some(gained)) = (gaining_file, &gained) {
        stored.push(write_json(file, &gained.document())?);
    }
    if let Some(plot) = plot {
        stored.push(plot.write(Ok(pictures::atlas::draw(&verified)))?);
    }
    deliver(stored, found(&verified))?;
    Failure::if_doubtful(out, "atlas is", verified.objection())?;
    match (lines, gained) {
        (Some(path), Some(gained)) => Failure::if_doubtful(path, "lines are", gained.objection()),
        _ => Ok(()),
    }
}

/// What was found, in a sentence.
fn found(CollisionAtlas { regions, report, .. }: &CollisionAtlas) -> String {
    let all = boundaries_and_regions(regions.curves().len(), regions.regions().len());
    let points = report.tried;
    let verified = if report.agrees { "verified" } else { "not all confirmed" };
    format!("{all}, {verified} at {points} points{}", with(report.effort))
}

/// Another effort than the usual one, in a sentence.
fn with(effort: Effort) -> &'static str {
    match effort {
        Effort::Screen => ", by a first look alone",
        Effort::Default => "",
        Effort::Certain => ", with more effort",
    }
}

/// Reads an effort.
fn effort() -> impl TypedValueParser<Value = Effort> {
    let value = |effort: Effort| {
        let help = match effort {
            Effort::Screen => {
                "A first look: half as fine a grid, a fortieth of the random runs that verify, a \
                 fifth of those beside boundaries, and no second look"
            }
            Effort::Default => "20 000 random collisions, or 10 000 runs of a system",
            Effort::Certain => {
                "Twice as fine a grid, five times as many runs that verify, twice as many rounds"
            }
        };
        PossibleValue::new(effort.name()).help(help)
    };
    let known = |text: String| Effort::ALL.into_iter().find(|effort| effort.name() == text);
    let values = PossibleValuesParser::new(Effort::ALL.map(value));
    values.map(move |text| known(text).unwrap_or_default())
}

/// How many there are.
fn boundaries_and_regions(boundaries: usize, regions: usize) -> String {
    let boundaries = counted(boundaries, "boundary", "boundaries");
    format!("{boundaries}, {}", counted(regions, "region", "regions"))
}

/// The window of the options.
fn frame(arguments: &TraceArguments) -> Result<Frame, Failure> {
    let TraceArguments { kappa, psi, ratio, collisions, .. } = *arguments;
    let (kappa, impact) = window(kappa, (psi, ratio), collisions)?;
    let (psi, ratio) = match impact {
        ImpactRange::Psi(psi) => (psi, None),
        ImpactRange::Ratio(ratio) => {
            let psi = |end| reduced(&ratio.reduction, end).map_err(Failure::Usage);
            let Range { low, high } = ratio.range;
            (Range { low: psi(low)?, high: psi(high)? }, Some(ratio))
        }
    };
    let (law, tangential_damping) = arguments.law.chosen()?;
    let damping = collisions.damping(law)?;
    Ok(Frame { kappa, psi, ratio, damping, law, tangential_damping })
}

/// Traces the boundaries of a system of one's own.
fn runs(plane: &SystemPlane, arguments: &TraceArguments) -> Result<(), Failure> {
    let TraceArguments { out, plot, tolerance, threads, effort, .. } = arguments;
    let plot = plot.as_ref();
    let system = ("the system", arguments.plane.system.as_deref());
    require_different(&[("--out", Some(out)), plotted(plot)], &[system])?;
    let options = effort.applied(plane.atlas_options(*tolerance)?);
    plot.map_or(Ok(()), PictureFile::probe)?;
    let file = OutputFile::create(out)?;
    let family = plane.family_of_atlas(arguments.plane.max_events, &[]);
    let atlas = threads.with_steps(|report| {
        let surveyor = Surveyor { options, executor: InParallel, watch: Watch::from(report) };
        surveyor.atlas(&family, &plane.window)
    })?;
    let atlas = atlas.map_err(|error| Failure::Family(error.to_string()))?;
    let document =
        stickslip_tracer::document::FamilyAtlasDocument::of_runs(&atlas, &options, &plane.names);
    let mut stored = vec![write_json(file, &document)?];
    if let Some(plot) = plot {
        stored.push(plot.write(Ok(pictures::family::draw_runs(&atlas, &plane.names)))?);
    }
    let found = boundaries_and_regions(atlas.plane.curves().len(), atlas.plane.regions().len());
    deliver(stored, found + with(*effort))?;
    let objection = atlas.doubts(&plane.names).map(|doubts| doubts.objection());
    Failure::if_doubtful(out, "atlas is", objection)
}

/// What `trace --help` says first.
const ABOUT: &str = "\
Trace every boundary in a window of the (κ, ψ) plane on which the switches of a collision change. \
Find where boundaries meet or turn into others (crossing, degenerate, graze-at-end, \
vanishing-phase), where they are extremal in κ or ψ, and the regions between them.

The regions are verified by integration, so that damping is 0 or 1e-8 to 1e4: collisions at 20 000 random points of the window, and at 40 points beside \
each boundary, must have the switches of their region. If one of them has others, or if a question \
remained open, the atlas is written and says so, and the exit code is 1.

With SYSTEM.slip, the runs of a system of your own over two of its parameters, --x and --y: every \
boundary on which the sequence of its events changes.";

/// What `trace --help` says last.
const EXAMPLES: &str = "\
Examples:
  stickslip trace --kappa 5:100 --psi 0.05:3 --out atlas.json --plot atlas.svg
  stickslip trace --kappa 5:20 --ratio 0.3:3.5 --mu 0.4 --alpha 2/7 --out atlas.json
  stickslip trace --kappa 5:20 --psi 0.2:2.5 --damping 0.05 --out damped.json
  stickslip trace --kappa 5:20 --psi 0.2:2.5 --out atlas.json --geojson atlas.geojson
  stickslip trace --kappa 1.2:1.3 --psi 0.85:1 --law gran/hertz/history --out atlas.json \
    --gaining gaining.json
  stickslip trace examples/systems/ball.slip --x e=0.3:0.7 --y g=5:15 --max-events 6 \
    --out ball.json --plot ball.svg

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
