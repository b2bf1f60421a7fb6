//! `locate`: points, looked up in an atlas.

use std::path::{Path, PathBuf};

use stickslip_files::input::atlas::{self, AnyAtlas, NamedAtlas};
use stickslip_files::input::parameter::Parameter;
use stickslip_files::input::recipe::Given;
use stickslip_files::input::rows::{ByteRecord, Columns, Input, Reading, TwoColumns};
use stickslip_files::output::csv::{CsvFile, Rows};
use stickslip_files::output::file::STANDARD_OUTPUT;
use stickslip_files::output::rows::{LOCATED, LOCATED_ORBITS, LOCATED_RUNS};
use stickslip_model::Contact;
use stickslip_plane::atlas::switch_count;
use stickslip_tracer::{Atlas, Names, Point, hybrid::Itinerary, regions::Location};

use crate::error::Failure;
use crate::output::console::{counted, deliver, print};
use crate::output::text::{explained, number, pairs};
use crate::shared::collision::contact;
use crate::shared::files::{require_different, require_one_standard_input};
use crate::shared::threads;

/// Look up the switches of collisions in an atlas
#[derive(Debug, clap::Args)]
#[command(long_about = ABOUT, after_long_help = EXAMPLES)]
pub struct LocateArguments {
    /// Atlas that the command trace or regions has written; - is standard input
    #[arg(value_name = "ATLAS.json", required_unless_present = "atlas", help_heading = "Input")]
    pub file: Option<PathBuf>,

    /// The same atlas, as an option
    #[arg(long, value_name = "ATLAS.json", help_heading = "Input", conflicts_with = "file")]
    pub atlas: Option<PathBuf>,

    /// CSV file with a header row that names kappa and psi, or the parameters of a system, and one
    /// point per row; - is standard input
    #[arg(long, value_name = "POINTS.csv", help_heading = "Input")]
    #[arg(required_unless_present = "kappa", conflicts_with = "kappa")]
    pub batch: Option<PathBuf>,

    /// κ of one point, whose place is printed, with --psi; above 0
    #[arg(long, value_name = "K", help_heading = "Input", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Kappa.parse(text), requires = "psi")]
    pub kappa: Option<f64>,

    /// ψ of the point; above 0
    #[arg(long, value_name = "P", help_heading = "Input", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Psi.parse(text), requires = "kappa")]
    pub psi: Option<f64>,

    /// CSV file for the results, one row per point in the order of the input [default: standard
    /// output]
    #[arg(long, value_name = "OUT.csv", help_heading = "Output", conflicts_with = "kappa")]
    pub out: Option<PathBuf>,
}

/// The files of the points and of the results.
#[derive(Clone, Copy)]
struct PointFiles<'a> {
    input: &'a Path,
    out: &'a Path,
}

/// Locates every point of the input, or one.
///
/// # Errors
/// The atlas or the input cannot be used, the output cannot be written, or some points cannot be
/// located. In the last case the output is complete.
pub fn run(arguments: &LocateArguments) -> Result<(), Failure> {
    let LocateArguments { kappa, psi, out, .. } = arguments;
    let path = arguments.file.as_deref().or(arguments.atlas.as_deref());
    let Some(path) = path else {
        return Err(Failure::Usage("no atlas is given; expected ATLAS.json".to_owned()));
    };
    let name = if arguments.atlas.is_some() { "--atlas" } else { "ATLAS.json" };
    let (named, batch) = ((name, Some(path)), ("--batch", arguments.batch.as_deref()));
    require_one_standard_input(named, batch)?;
    require_different(&[("--out", out.as_deref())], &[batch, named])?;
    let out = out.as_deref().unwrap_or(Path::new(STANDARD_OUTPUT));
    let files = batch.1.map(|input| PointFiles { input, out });
    let atlas = match (atlas::read(path)?, files) {
        (AnyAtlas::Collisions(atlas), _) => atlas,
        (AnyAtlas::Runs(found), Some(files)) => {
            let count = |label: &Itinerary| label.fired().map(<[_]>::len);
            return points(files, &found, &LOCATED_RUNS, count);
        }
        (AnyAtlas::Orbits(found), Some(files)) => {
            return points(files, &found, &LOCATED_ORBITS, |label| Some(label.0.len()));
        }
        (AnyAtlas::Runs(found), None) => return Err(needs_points(found.names.axes())),
        (AnyAtlas::Orbits(found), None) => return Err(needs_points(found.names.axes())),
    };
    let located = |contact: &Contact| {
        let located = atlas.locate([contact.kappa(), contact.psi()]);
        let region = located.region.map_err(|why| why.to_string()).map(|region| {
            let itinerary = atlas.itinerary(region);
            [switch_count(itinerary).to_string(), itinerary.to_owned(), region.to_string()]
        });
        (region, located.distance)
    };
    if let Some(files) = files {
        let points = |header: &_| Columns::POINTS.recipe(header, &Given::default());
        return write(files, points, &LOCATED, located);
    }
    let (region, distance) =
        located(&contact(&Given { kappa: *kappa, psi: *psi, ..Given::default() })?);
    let [switches, itinerary, region] = region.map_err(Failure::NotLocated)?;
    let distance = distance.map_or_else(|| "no boundary at this κ".to_owned(), number);
    print(|out| {
        pairs(
            out,
            &[
                ("switches", switches),
                ("itinerary", explained(&itinerary)),
                ("region", region),
                ("distance to a boundary in ψ", distance),
            ],
        )
    })
}

fn needs_points([x, y]: [&str; 2]) -> Failure {
    let expected = format!("expected --batch, a file with the columns {x} and {y}");
    let message = format!("--kappa is not in the atlas of a system of your own; {expected}");
    Failure::Usage(message)
}

/// Locates every point of the input in an atlas of a system of one's own. `count` is what the first
/// of the columns `results` has for a label.
fn points<Label: Clone + Ord, Margin: Clone, N: Names<Label, Margin>>(
    files: PointFiles<'_>,
    NamedAtlas { atlas, names }: &NamedAtlas<Label, Margin, N>,
    results: &[&str; 4],
    count: impl Fn(&Label) -> Option<usize>,
) -> Result<(), Failure> {
    let axes = names.axes();
    let points = |header: &_| TwoColumns::named(header, &axes, results);
    write(files, points, results, |&(x, y)| {
        let point = names.point([x, y]);
        let region = region_of(atlas, &point).map(|(region, label)| {
            let count = count(label).map_or_else(String::new, |count| count.to_string());
            [count, names.text(label), region.to_string()]
        });
        let named = |why| format!("{} = {x}, {} = {y} {why}", axes[0], axes[1]);
        (region.map_err(named), atlas.plane.vertical_distance(&point))
    })
}

/// The first columns of a point, or the reason why it is not located, and its distance.
type Located = (Result<[String; 3], String>, Option<f64>);

/// Writes a row with the columns `names` for every point of the input.
fn write<R: Reading>(
    PointFiles { input, out }: PointFiles<'_>,
    points: impl FnOnce(&ByteRecord) -> Result<R, String>,
    names: &[&str; 4],
    locate: impl Fn(&R::Case) -> Located,
) -> Result<(), Failure> {
    let mut input = Input::open(input, points)?;
    let pool = threads::pool(Some(1))?;
    let mut table = CsvFile::create(out)?;
    let mut text = Rows::default();
    text.fields(input.header().iter().chain(names.iter().map(|name| name.as_bytes())));
    text.end();
    let (mut rows, mut failed, mut first) = (0, 0, None);
    let mut portion = Vec::new();
    loop {
        table.write(&std::mem::take(&mut text))?;
        pool.install(|| input.read_portion(&mut portion))?;
        if portion.is_empty() {
            break;
        }
        for row in &portion {
            rows += 1;
            let (region, distance) = match &row.case {
                Ok(point) => {
                    let (region, distance) = locate(point);
                    (region.map_err(|why| format!("row {rows}: {why}")), distance)
                }
                Err(reason) => (Err(reason.clone()), None),
            };
            text.fields(&row.fields);
            match region {
                Ok(columns) => text.fields(columns),
                Err(reason) => {
                    text.fields([""; 3]);
                    failed += 1;
                    first.get_or_insert(reason);
                }
            }
            match distance {
                Some(distance) => text.number(distance),
                None => text.field(""),
            }
            text.end();
        }
    }
    let found = counted(usize::try_from(rows - failed).unwrap_or(usize::MAX), "point", "points");
    deliver([table.store()?], format_args!("{found} located"))?;
    match first {
        Some(first) => Err(Failure::Unlocated { failed, rows, path: out.to_owned(), first }),
        None => Ok(()),
    }
}

/// The region of a point, and its label, or why that is not known.
fn region_of<'a, Label: Clone + Ord, Margin: Clone>(
    atlas: &'a Atlas<Label, Margin>,
    point: &Point,
) -> Result<(usize, &'a Label), &'static str> {
    match atlas.plane.locate(point) {
        Location::Outside => Err("lies outside the window"),
        Location::OnBoundary { .. } => Err("lies on a boundary within its error"),
        Location::Region(region) if atlas.is_doubtful(region) => Err("lies in a region in doubt"),
        Location::Region(region) => {
            let label = atlas.plane.regions()[region].label.as_ref();
            label.map(|label| (region, label)).ok_or("lies in a region that is not known")
        }
    }
}

/// What `locate --help` says first.
const ABOUT: &str = "\
Look up the switches of collisions in an atlas.

POINTS.csv has the columns kappa and psi; other columns pass through. OUT.csv has the columns of the \
input followed by switch_count, itinerary, region and distance. The distance, in ψ, is that to the \
nearest boundary of the atlas at the same κ. Within the error of a boundary, the collision itself is \
computed, and decides. A point has no count, itinerary and region if it lies outside the window, or \
if its collision has the switches of no region there. The first such point is named on standard \
error, and the exit code is 1.

In an atlas of a system of your own, the columns are the parameters on its axes, and event_count takes \
the place of switch_count; in the regions of a periodic orbit, orbit_count and orbits are what the \
system follows there. Nothing is run: within the error of a boundary and in regions in doubt, a point \
is not located.";

/// What `locate --help` says last.
const EXAMPLES: &str = "\
Examples:
  stickslip locate atlas.json --kappa 18 --psi 0.5
  stickslip locate atlas.json --batch POINTS.csv --out OUT.csv

Exit codes: 0 done, 1 a point cannot be located, 2 bad usage or bad input.";
