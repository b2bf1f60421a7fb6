//! `branch`: a periodic orbit followed over a parameter.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use stickslip_figure::Svg;
use stickslip_figure::pictures::branch::{
    BranchCurve, BranchPoint, BranchStretch, SpecialMark, draw,
};
use stickslip_files::output::csv::{CsvFile, Rows};
use stickslip_files::output::file::{OutputFile, StoredFile};
use stickslip_files::output::picture::PictureFile;
use stickslip_orbits::document::{BranchRecord, Document, OrbitRecord};
use stickslip_orbits::{Branch, BranchOptions, Orbit};

use crate::error::Failure;
use crate::output::console::{counted, deliver, print};
use crate::output::progress::Bar;
use crate::output::text::{self, number};
use crate::shared::files::{picture, plotted, require_different, write_json};
use crate::shared::orbit::{FoundOrbit, GuessArguments, component, failure};
use crate::shared::system::{Axis, axis, place};

/// Follow a periodic orbit of a system of your own over a parameter
#[derive(Debug, clap::Args)]
#[command(long_about = ABOUT, after_long_help = EXAMPLES)]
pub struct BranchArguments {
    /// Where the first orbit is searched for.
    #[command(flatten)]
    pub guess: GuessArguments,

    /// The parameter, and its interval, in which its present value lies
    #[arg(long, value_name = "NAME=LO:HI", value_parser = axis, help_heading = "Branch")]
    pub over: Axis,

    /// Go on from both ends of the branch in the file of --near, over an interval that contains its
    /// own, or from where it broke off; what it has stays
    #[arg(long, help_heading = "Branch", requires = "near")]
    #[arg(conflicts_with_all = ["itinerary", "settle", "set", "switch"])]
    pub resume: bool,

    /// The longest step along the branch, of the size of what changes; 1e-7 to 1
    #[arg(long, value_name = "H", help_heading = "Branch", default_value_t = 0.05)]
    #[arg(allow_hyphen_values = true, value_parser = stickslip_files::input::number::parse_option)]
    pub longest_step: f64,

    /// The greatest number of orbits in either direction; 2 to 1000000
    #[arg(long, value_name = "N", help_heading = "Branch", default_value_t = 2000)]
    #[arg(allow_hyphen_values = true)]
    pub most_points: usize,

    /// JSON file for the branch
    #[arg(long, value_name = "BRANCH.json", help_heading = "Output")]
    pub out: Option<PathBuf>,

    /// CSV file with a row for each orbit and each special orbit, in order
    #[arg(long, value_name = "FILE.csv", help_heading = "Output")]
    pub table: Option<PathBuf>,

    /// Picture of a component over the parameter, with special orbits
    #[arg(long, value_name = "FILE.svg|.png|.pdf", help_heading = "Output")]
    #[arg(value_parser = picture())]
    pub plot: Option<PictureFile>,

    /// The component in the picture, at the end of the first segment [default: the first one]
    #[arg(long, value_name = "NAME", help_heading = "Output", requires = "plot")]
    pub show: Option<String>,
}

/// Follows the branch, writes what is wanted, and prints its special orbits.
///
/// # Errors
/// The system cannot be read, options do not fit it, there is no orbit, a file or standard output
/// cannot be written, or the branch breaks off. In the last case the files are complete and say so.
pub fn run(arguments: &BranchArguments) -> Result<(), Failure> {
    let BranchArguments { guess, over, out, table, plot, .. } = arguments;
    let (out, table, plot) = (out.as_deref(), table.as_deref(), plot.as_ref());
    let outputs = [("--out", out), ("--table", table), plotted(plot)];
    require_different(&outputs, &guess.inputs())?;
    table.map_or(Ok(()), CsvFile::probe)?;
    plot.map_or(Ok(()), PictureFile::probe)?;
    let file = out.map(OutputFile::create).transpose()?;
    let options = BranchOptions {
        longest_step: arguments.longest_step,
        first_step: arguments.longest_step.min(BranchOptions::default().first_step),
        most_points: arguments.most_points,
        ..BranchOptions::default()
    };
    options.validate().map_err(|error| Failure::Usage(error.to_string()))?;
    let (found, known) = match &guess.near {
        Some(path) if arguments.resume => {
            guess.branch(path).map(|(found, known)| (found, Some(known)))?
        }
        _ => (guess.find()?, None),
    };
    let system = found.orbits.system();
    let parameter = place(system, "--over", &over.name)?;
    let shown = shown(arguments, &found)?;
    let range = [over.range.low, over.range.high];
    let bar = Bar::watching(found.orbits.watch());
    let branch = match known {
        None => found.orbits.branch(&found.orbit, parameter, range, &options),
        Some(known) if known.parameter == parameter => {
            found.orbits.resumed(&known, range, &options)
        }
        Some(known) => {
            let (name, own) = (&over.name, &system.parameters[known.parameter].name);
            let message = format!("--over {name}: expected {own}, over which the branch goes");
            return Err(Failure::Usage(message));
        }
    };
    drop(bar);
    let branch = branch.map_err(failure)?;
    let document = Document::of_branch(&found.orbits, &found.name, &branch);
    let mut stored = Vec::new();
    if let Some(file) = file {
        stored.push(write_json(file, &document)?);
    }
    if let Some(path) = table {
        stored.push(write_table(path, &document)?);
    }
    if let Some(plot) = plot {
        stored.push(plot.write(Ok(curve(&found, &branch, shown)))?);
    }
    deliver(stored, counted(branch.points.len(), "orbit", "orbits"))?;
    print(|out| specials(out, &document.content))?;
    let path = out.unwrap_or(&guess.from.system);
    Failure::if_doubtful(path, "branch is", branch.objection)
}

/// The component of the picture.
fn shown(arguments: &BranchArguments, found: &FoundOrbit) -> Result<usize, Failure> {
    let Some(name) = &arguments.show else { return Ok(0) };
    component(found.orbits.system(), "--show", name)
}

fn specials(out: &mut dyn Write, branch: &BranchRecord) -> io::Result<()> {
    let admissible = branch.points.iter().filter(|it| it.admissible).count();
    let stable = branch.points.iter().filter(|it| it.admissible && it.stable).count();
    if branch.specials.is_empty() {
        writeln!(out, "No special orbit.")?;
    } else {
        let header = ["special orbit", &branch.parameter, "rule", "period"].map(str::to_owned);
        let rows = branch.specials.iter().map(|it| {
            let rule = it.rule.rule.clone().unwrap_or_default();
            [it.kind.name().to_owned(), number(it.value), rule, number(it.orbit.period)]
        });
        text::aligned(out, &std::iter::once(header).chain(rows).collect::<Vec<_>>())?;
    }
    writeln!(out)?;
    text::pairs(
        out,
        &[
            ("orbits", branch.points.len().to_string()),
            ("followed by the system", admissible.to_string()),
            ("of these, stable", stable.to_string()),
        ],
    )
}

/// Writes a row for each orbit, all but the name of the file.
fn write_table(path: &Path, document: &Document<BranchRecord>) -> Result<StoredFile, Failure> {
    let branch = &document.content;
    let mut file = CsvFile::create(path)?;
    let mut rows = Rows::default();
    let parameter = &branch.parameter;
    rows.fields([parameter.as_str(), "special", "period", "stable", "followed", "multiplier"]);
    let Some(first) = branch.points.first() else { return Ok(file.store()?) };
    for segment in 0..first.segments.len() {
        rows.field(format!("duration_{segment}"));
        rows.fields(document.components.iter().map(|it| format!("{it}_{segment}")));
    }
    rows.end();
    let mut row = |orbit: &OrbitRecord, special: &str| {
        rows.number(orbit.parameters[parameter]);
        rows.field(special);
        rows.number(orbit.period);
        rows.field(orbit.stable.to_string());
        rows.field(orbit.admissible.to_string());
        let largest = orbit
            .multipliers
            .as_ref()
            .map(|all| all.iter().map(|[re, im]| re.hypot(*im)).fold(0.0, f64::max));
        match largest {
            Some(size) => rows.number(size),
            None => rows.field("inf"),
        }
        for segment in &orbit.segments {
            rows.number(segment.duration);
            segment.end.iter().for_each(|value| rows.number(*value));
        }
        rows.end();
    };
    let mut specials = branch.specials.iter().peekable();
    for (place, orbit) in branch.points.iter().enumerate() {
        while let Some(special) = specials.next_if(|it| it.behind <= place) {
            row(&special.orbit, special.kind.name());
        }
        row(orbit, "");
    }
    specials.for_each(|special| row(&special.orbit, special.kind.name()));
    file.write(&rows)?;
    Ok(file.store()?)
}

/// The picture of a branch.
fn curve(found: &FoundOrbit, branch: &Branch, shown: usize) -> Svg {
    let system = found.orbits.system();
    let parameter = &system.parameters[branch.parameter].name;
    let at = |orbit: &Orbit| [orbit.parameters[branch.parameter], orbit.segments[0].end[shown]];
    let rule = branch.points[0].segments[0].leg.name(system);
    let component = format!("{} before {rule}", system.components[shown].name);
    let stretch = |orbit: &Orbit| match (orbit.is_admissible(), orbit.is_stable()) {
        (false, _) => BranchStretch::Virtual,
        (true, true) => BranchStretch::Stable,
        (true, false) => BranchStretch::Unstable,
    };
    let points = branch.points.iter();
    let specials = branch.specials.iter().map(|it| SpecialMark {
        name: it.kind.name(),
        at: at(&it.orbit),
        behind: it.behind,
    });
    draw(&BranchCurve {
        title: &format!("{}: a branch of periodic orbits", found.name),
        axes: [parameter, &component],
        points: points.map(|it| BranchPoint { at: at(it), stretch: stretch(it) }).collect(),
        specials: specials.collect(),
    })
}

/// What `branch --help` says first.
const ABOUT: &str = "\
Follow a periodic orbit of a system of your own over a parameter, through folds and grazes. \
Orbits that the system does not follow are kept and marked. Special orbits are located and named: \
fold, flip, neimark-sacker, branch-point, grazing, grazing-sliding, adding-sliding, sliding-edge, \
corner-collision, choice, vanishing-segment, infinite-period, boundary.

If the branch breaks off within the interval, it is written and says why, and the exit code is 1.";

/// What `branch --help` says last.
const EXAMPLES: &str = "\
Examples:
  stickslip branch examples/orbits/oscillator.slip --itinerary impact,phase --set w=0.8 \
--over a=0.05:1.2 --out branch.json --plot branch.svg --show v
  stickslip branch examples/orbits/oscillator.slip --near branch.json --resume --over a=0.05:2
  stickslip branch examples/systems/relay.slip --itinerary down,up --over width=0.1:0.9

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
