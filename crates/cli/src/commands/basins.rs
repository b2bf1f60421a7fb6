//! `basins`: where runs from a grid of initial values lead.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use stickslip_figure::pictures::map::{self, MapAxis, MapPanel, MapValues};
use stickslip_files::input::range::Size;
use stickslip_files::output::csv::{CsvFile, Rows};
use stickslip_files::output::file::StoredFile;
use stickslip_files::output::picture::PictureFile;
use stickslip_orbits::{Attractor, Basins};

use crate::error::Failure;
use crate::output::console::{counted, deliver, print};
use crate::output::progress::Bar;
use crate::output::text::{self, number};
use crate::shared::files::{picture, plotted, require_different};
use crate::shared::orbit::{StartArguments, StartedSystem, component};
use crate::shared::system::{Axis, axis, time};
use crate::shared::threads::ThreadsArguments;

/// Tell apart where runs of a system of your own lead, over two initial values
#[derive(Debug, clap::Args)]
#[command(long_about = ABOUT, after_long_help = EXAMPLES)]
pub struct BasinsArguments {
    /// Where runs start.
    #[command(flatten)]
    pub from: StartArguments,

    /// The component on the horizontal axis, and its interval
    #[arg(long, value_name = "NAME=LO:HI", value_parser = axis, help_heading = "Basins")]
    pub x: Axis,

    /// The component on the vertical axis, and its interval
    #[arg(long, value_name = "NAME=LO:HI", value_parser = axis, help_heading = "Basins")]
    pub y: Axis,

    /// The number of runs across and up
    #[arg(long, value_name = "NXxNY", default_value = "100x100", help_heading = "Basins")]
    #[arg(value_parser = Size::parse)]
    pub size: Size,

    /// The time in which runs settle
    #[arg(long, value_name = "T", value_parser = time, allow_hyphen_values = true)]
    #[arg(help_heading = "Basins")]
    pub settle: f64,

    /// CSV file with a row for each run: both values, and the number of the attractor
    #[arg(long, value_name = "FILE.csv", help_heading = "Output")]
    pub table: Option<PathBuf>,

    /// Picture of the basins
    #[arg(long, value_name = "FILE.svg|.png|.pdf", help_heading = "Output")]
    #[arg(value_parser = picture())]
    pub plot: Option<PictureFile>,

    /// Threads.
    #[command(flatten)]
    pub threads: ThreadsArguments,
}

/// Computes the basins, writes what is wanted, and prints the attractors.
///
/// # Errors
/// The system cannot be read, options do not fit it, or a file or standard output cannot be
/// written.
pub fn run(arguments: &BasinsArguments) -> Result<(), Failure> {
    let BasinsArguments { from, x, y, size, settle, table, plot, threads } = arguments;
    let (table, plot) = (table.as_deref(), plot.as_ref());
    let outputs = [("--table", table), plotted(plot)];
    require_different(&outputs, &[("the system", Some(&*from.system))])?;
    table.map_or(Ok(()), CsvFile::probe)?;
    plot.map_or(Ok(()), PictureFile::probe)?;
    let pool = threads.pool()?;
    let started = from.read()?;
    let system = started.orbits.system();
    let places = [component(system, "--x", &x.name)?, component(system, "--y", &y.name)?];
    let values = [(x, size.columns), (y, size.rows)].map(|(axis, count)| {
        let (low, high) = (axis.range.low, axis.range.high);
        (0..count).map(|i| low + (high - low) * ((i as f64 + 0.5) / count as f64)).collect()
    });
    let [across, up]: [Vec<f64>; 2] = values;
    let guess = started.guess();
    let bar = Bar::watching(started.orbits.watch());
    let found = pool.install(|| {
        started.orbits.basins(&started.parameters, &guess, places, [&across, &up], *settle)
    });
    drop(bar);
    let found = found.map_err(|error| Failure::Usage(error.to_string()))?;
    let mut stored = Vec::new();
    if let Some(path) = table {
        stored.push(write_table(path, [&x.name, &y.name], &found)?);
    }
    if let Some(plot) = plot {
        let labels = found
            .labels
            .iter()
            .map(|label| label.and_then(|label| i32::try_from(label + 1).ok()).unwrap_or(-1));
        let labels: Vec<i32> = labels.collect();
        let panel = MapPanel {
            heading: "number of the attractor",
            horizontal: MapAxis { name: &x.name, range: (x.range.low, x.range.high) },
            vertical: MapAxis { name: &y.name, range: (y.range.low, y.range.high) },
            columns: size.columns,
            rows: size.rows,
            values: MapValues::Switches(&labels),
            lines: Vec::new(),
            points: Vec::new(),
        };
        let title = format!("{}: basins of {} × {} runs", started.name, size.columns, size.rows);
        stored.push(plot.write(map::draw(&title, &[panel]))?);
    }
    deliver(stored, counted(found.labels.len(), "run", "runs"))?;
    print(|out| attractors(out, &started, &found))
}

/// Prints a row for each attractor.
fn attractors(out: &mut dyn Write, started: &StartedSystem, found: &Basins) -> io::Result<()> {
    let system = started.orbits.system();
    let mut rows = vec![["attractor", "runs", "what it is", "where"].map(str::to_owned)];
    let runs =
        |label: Option<usize>| found.labels.iter().filter(|it| **it == label).count().to_string();
    let at = |mode: usize, state: &[f64]| {
        let parts = system.components.iter().zip(state);
        let parts = parts.map(|(it, value)| format!("{} = {}", it.name, number(*value)));
        format!("{}: {}", system.modes[mode].name, parts.collect::<Vec<_>>().join(", "))
    };
    for (place, attractor) in found.attractors.iter().enumerate() {
        let (what, place_of) = match attractor {
            Attractor::Orbit(orbit) => {
                let first = &orbit.segments[0];
                let what = format!("orbit of period {}", number(orbit.period));
                (what, at(first.leg.mode, &first.state))
            }
            Attractor::Rest { mode, state } => ("rest".to_owned(), at(*mode, state)),
            Attractor::End { mode, rule } => {
                let name = system.modes[*mode].rules[*rule].name(*rule);
                (format!("end at rule {name}"), system.modes[*mode].name.clone())
            }
        };
        rows.push([(place + 1).to_string(), runs(Some(place)), what, place_of]);
    }
    rows.push(["-".to_owned(), runs(None), "does not settle".to_owned(), String::new()]);
    text::aligned(out, &rows)
}

/// Writes a row for each run, all but the name of the file.
fn write_table(path: &Path, names: [&str; 2], found: &Basins) -> Result<StoredFile, Failure> {
    let mut file = CsvFile::create(path)?;
    let mut rows = Rows::default();
    rows.fields(names);
    rows.field("attractor");
    rows.end();
    let [xs, ys] = &found.values;
    for (y, labels) in ys.iter().zip(found.labels.chunks(xs.len())) {
        for (x, label) in xs.iter().zip(labels) {
            rows.number(*x);
            rows.number(*y);
            rows.field(label.map_or_else(String::new, |label| (label + 1).to_string()));
            rows.end();
        }
        file.write(&rows)?;
        rows.clear();
    }
    Ok(file.store()?)
}

/// What `basins --help` says first.
const ABOUT: &str = "\
Run a system of your own from a grid of values of two components, and tell apart what the runs lead \
to: periodic orbits, states that do not change, rules that end runs. A run that does not settle, as \
on a chaotic attractor, has none.

Two attractors that differ by less than 1e-3 of their size are one.";

/// What `basins --help` says last.
const EXAMPLES: &str = "\
Examples:
  stickslip basins examples/orbits/oscillator.slip --x x=-2:1 --y v=-2:2 --settle 400 \
--size 60x60 --plot basins.svg

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
