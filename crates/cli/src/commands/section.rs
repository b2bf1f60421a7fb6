//! `section`: where a run meets a rule, its Lyapunov exponents, and diagrams over a parameter.

use std::path::{Path, PathBuf};

use rayon::prelude::*;
use stickslip_figure::Svg;
use stickslip_figure::canvas::panel::Scale;
use stickslip_figure::canvas::shape::Stroke;
use stickslip_figure::canvas::style::{BLUE, GREEN, INK, PURPLE, VERMILION};
use stickslip_figure::pictures::chart::{self, ChartAxis, LineChart, Mark, Series, Shape};
use stickslip_files::output::csv::{CsvFile, Rows};
use stickslip_files::output::file::StoredFile;
use stickslip_files::output::picture::PictureFile;
use stickslip_orbits::{Column, Exponents, OrbitError, Section, SectionPoint};

use crate::error::Failure;
use crate::output::console::{counted, deliver, print};
use crate::output::progress::Bar;
use crate::output::text::{self, number};
use crate::shared::files::{picture, plotted, require_different};
use crate::shared::orbit::{StartArguments, StartedSystem, component, failure};
use crate::shared::system::{Axis, axis, place, time};
use crate::shared::threads::ThreadsArguments;

/// Find where a run of a system of your own meets a rule, and its Lyapunov exponents
#[derive(Debug, clap::Args)]
#[command(long_about = ABOUT, after_long_help = EXAMPLES)]
pub struct SectionArguments {
    /// Where the run starts.
    #[command(flatten)]
    pub from: StartArguments,

    /// The rule that is met, in any mode
    #[arg(long, value_name = "RULE", help_heading = "Section")]
    pub rule: String,

    /// The time before anything is looked at
    #[arg(long, value_name = "T", value_parser = time, allow_hyphen_values = true)]
    #[arg(default_value_t = 0.0, help_heading = "Section")]
    pub skip: f64,

    /// The time in which the run is looked at
    #[arg(long = "for", value_name = "T", value_parser = time, allow_hyphen_values = true)]
    #[arg(help_heading = "Section")]
    pub length: f64,

    /// A diagram over a parameter: upwards and downwards, each run goes on where the last one ended
    #[arg(long, value_name = "NAME=LO:HI", value_parser = axis, help_heading = "Section")]
    pub over: Option<Axis>,

    /// The number of values of the parameter; 2 to 100000
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=100_000))]
    #[arg(default_value_t = 200, allow_hyphen_values = true, help_heading = "Section")]
    pub values: u32,

    /// CSV file with a row for each point: its time and the state before the rule acts
    #[arg(long, value_name = "FILE.csv", help_heading = "Output")]
    pub table: Option<PathBuf>,

    /// Picture of the points
    #[arg(long, value_name = "FILE.svg|.png|.pdf", help_heading = "Output")]
    #[arg(value_parser = picture())]
    pub plot: Option<PictureFile>,

    /// Picture of the Lyapunov exponents over the parameter of --over, each run from the start
    #[arg(long, value_name = "FILE.svg|.png|.pdf", help_heading = "Output", requires = "over")]
    #[arg(value_parser = picture())]
    pub exponents: Option<PictureFile>,

    /// The components in the picture: two, or one over the parameter [default: the first ones]
    #[arg(long, value_name = "NAME,NAME", value_delimiter = ',', help_heading = "Output")]
    #[arg(requires = "plot")]
    pub show: Vec<String>,

    /// Threads.
    #[command(flatten)]
    pub threads: ThreadsArguments,
}

/// Runs the system, writes what is wanted, and prints how it moves.
///
/// # Errors
/// The system cannot be read, options do not fit it, a run does not come to its end, or a file or
/// standard output cannot be written.
pub fn run(arguments: &SectionArguments) -> Result<(), Failure> {
    let SectionArguments { from, table, plot, exponents, .. } = arguments;
    let (table, plot, exponents) = (table.as_deref(), plot.as_ref(), exponents.as_ref());
    let shown = ("--exponents", plotted(exponents).1);
    let outputs = [("--table", table), plotted(plot), shown];
    require_different(&outputs, &[("the system", Some(&*from.system))])?;
    table.map_or(Ok(()), CsvFile::probe)?;
    for file in [plot, exponents].into_iter().flatten() {
        file.probe()?;
    }
    let pool = arguments.threads.pool()?;
    let started = from.read()?;
    let system = started.orbits.system();
    let show = arguments.show.iter().map(|name| component(system, "--show", name));
    let show = show.collect::<Result<Vec<_>, _>>()?;
    let section = Section { rule: &arguments.rule, skip: arguments.skip, time: arguments.length };
    let (orbits, guess) = (&started.orbits, started.guess());
    let bar = Bar::watching(orbits.watch());
    let (mut lines, mut troubled) = (Vec::new(), Vec::new());
    let mut stored = Vec::new();
    let (found, axis) = if let Some(over) = &arguments.over {
        let parameter = place(system, "--over", &over.name)?;
        let values = (0..arguments.values).map(|k| {
            let part = f64::from(k) / f64::from(arguments.values - 1);
            over.range.low * (1.0 - part) + over.range.high * part
        });
        let values: Vec<f64> = values.collect();
        let diagram =
            || orbits.diagram(&started.parameters, &guess, (parameter, &values), &section);
        let found = pool.install(diagram).map_err(failure)?;
        lines.push(("values", values.len().to_string()));
        if let Some(file) = exponents {
            let each = || {
                values.par_iter().map(|value| {
                    let mut own = started.parameters.clone();
                    own[parameter] = *value;
                    (*value, orbits.exponents(&own, &guess, section.skip, section.time))
                })
            };
            let all: Vec<_> = pool.install(|| each().collect());
            stored.push(file.write(Ok(draw_exponents(&started.name, over, &all)))?);
            let without = all.iter().filter_map(|(value, own)| Some((*value, own.as_ref().err()?)));
            troubled.extend(without.map(|(value, error)| format!("at {value:?}: {error}")));
        }
        (found, Some(&*over.name))
    } else {
        let points = orbits.section(&started.parameters, &guess, &section).map_err(failure)?;
        let (skip, length) = (arguments.skip, arguments.length);
        let own = orbits.exponents(&started.parameters, &guess, skip, length);
        let own = own.map_err(failure)?;
        let all: Vec<String> = own.values.iter().map(|it| number(*it)).collect();
        lines.push(("Lyapunov exponents", all.join(", ")));
        lines.push(("differ between halves by", number(own.spread)));
        let column = Column { value: f64::NAN, points, trouble: None };
        ([vec![column], Vec::new()], None)
    };
    drop(bar);
    if let Some(path) = table {
        stored.push(write_table(path, &started, axis, &found)?);
    }
    if let Some(plot) = plot {
        stored.push(plot.write(Ok(draw(&started, &arguments.rule, axis, &show, &found)))?);
    }
    let points: usize = found.iter().flatten().map(|column| column.points.len()).sum();
    deliver(stored, counted(points, "point", "points"))?;
    lines.insert(0, ("points", points.to_string()));
    print(|out| text::pairs(out, &lines))?;
    troubled.extend(found.iter().flatten().filter_map(|column| {
        column.trouble.as_ref().map(|reason| format!("at {:?}: {reason}", column.value))
    }));
    let count = counted(troubled.len(), "run has no result", "runs have no result");
    let first = troubled.first().map(|it| format!("{count}, {it}"));
    Failure::if_doubtful(table.unwrap_or(&from.system), "diagram is", first)
}

/// Writes a row for each point, all but the name of the file.
fn write_table(
    path: &Path,
    started: &StartedSystem,
    axis: Option<&str>,
    found: &[Vec<Column>; 2],
) -> Result<StoredFile, Failure> {
    let mut file = CsvFile::create(path)?;
    let mut rows = Rows::default();
    if let Some(axis) = axis {
        rows.fields([axis, "direction"]);
    }
    rows.field("t");
    rows.fields(started.orbits.system().components.iter().map(|it| it.name.as_str()));
    rows.end();
    for (direction, columns) in ["up", "down"].into_iter().zip(found) {
        for Column { value, points, .. } in columns {
            for SectionPoint { s, state } in points {
                if axis.is_some() {
                    rows.number(*value);
                    rows.field(direction);
                }
                rows.number(*s);
                for value in state {
                    rows.number(*value);
                }
                rows.end();
            }
            file.write(&rows)?;
            rows.clear();
        }
    }
    Ok(file.store()?)
}

/// The picture of the points: two components, or one of them over the parameter or over the one
/// before it.
fn draw(
    started: &StartedSystem,
    rule: &str,
    axis: Option<&str>,
    show: &[usize],
    found: &[Vec<Column>; 2],
) -> Svg {
    let components = &started.orbits.system().components;
    let first = show.first().copied().unwrap_or(0);
    let second = show.get(1).copied().or((show.is_empty() && components.len() > 1).then_some(1));
    let name = |component: usize| format!("{} before {rule}", components[component].name);
    let (x, y) = match (axis, second) {
        (Some(axis), _) => (axis.to_owned(), name(first)),
        (None, Some(second)) => (name(first), name(second)),
        (None, None) => (format!("{}, once before", name(first)), name(first)),
    };
    let series = if axis.is_some() {
        over(found, first)
    } else {
        let points = found.iter().flatten().flat_map(|Column { points, .. }| {
            let before = std::iter::once(None).chain(points.iter().map(Some));
            points.iter().zip(before).filter_map(move |(point, before)| match second {
                Some(second) => Some((point.state[first], point.state[second])),
                None => Some((before?.state[first], point.state[first])),
            })
        });
        vec![dots("", points.collect(), BLUE)]
    };
    chart_of(&format!("{}: where a run meets {rule}", started.name), [&x, &y], series)
}

/// A picture with room around its points.
fn chart_of(title: &str, [x, y]: [&str; 2], series: Vec<Series>) -> Svg {
    let range = |of: fn(&(f64, f64)) -> f64| {
        let values = series.iter().flat_map(|it| &it.points).map(of);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        let room = if low < high { 0.03 * (high - low) } else { 1.0_f64.max(low.abs()) * 1e-3 };
        if low.is_finite() { (low - room, high + room) } else { (0.0, 1.0) }
    };
    let (across, up) = (range(|it| it.0), range(|it| it.1));
    let x = ChartAxis { name: x, range: across, scale: Scale::Linear };
    let y = ChartAxis { name: y, range: up, scale: Scale::Linear };
    chart::draw(&LineChart { title, x, y, series })
}

/// The picture of exponents over a parameter, and of zero. Those that are −∞ are not drawn.
fn draw_exponents(name: &str, over: &Axis, all: &[(f64, Result<Exponents, OrbitError>)]) -> Svg {
    const COLOURS: [&str; 4] = [BLUE, VERMILION, GREEN, PURPLE];
    let own = all.iter().filter_map(|(value, found)| Some((*value, &found.as_ref().ok()?.values)));
    let most = own.clone().map(|(_, values)| values.len()).max().unwrap_or(0);
    let line = |points: Vec<(f64, f64)>, line: Stroke| Series {
        name: String::new(),
        points,
        line: Some(line),
        mark: None,
    };
    let (low, high) = (over.range.low, over.range.high);
    let mut series = vec![line(vec![(low, 0.0), (high, 0.0)], Stroke::full(INK, 0.6))];
    for place in 0..most {
        let points = own.clone().filter_map(|(value, values)| Some((value, *values.get(place)?)));
        let points = points.filter(|(_, exponent)| exponent.is_finite());
        series.push(line(points.collect(), Stroke::full(COLOURS[place % COLOURS.len()], 1.4)));
    }
    let title = format!("{name}: Lyapunov exponents");
    chart_of(&title, [&over.name, "exponents, the largest first"], series)
}

fn dots(name: &str, points: Vec<(f64, f64)>, colour: &'static str) -> Series {
    let mark = Some(Mark { shape: Shape::Dot, colour });
    Series { name: name.to_owned(), points, line: None, mark }
}

/// The points of a diagram: those upwards, those downwards, and those of both, each place once.
fn over([up, down]: &[Vec<Column>; 2], component: usize) -> Vec<Series> {
    let all = || up.iter().chain(down).flat_map(|it| &it.points).map(|it| it.state[component]);
    let (low, high) =
        (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
    let near = (high - low) / PLACES;
    let mut found: [Vec<(f64, f64)>; 3] = Default::default();
    for (one, other) in up.iter().zip(down.iter().rev()) {
        let of = |column: &Column, direction: usize| {
            let values = column.points.iter().map(move |it| (it.state[component], direction));
            values.collect::<Vec<_>>()
        };
        let mut values = [of(one, 0), of(other, 1)].concat();
        values.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        let mut rest = &values[..];
        while let Some(&(first, _)) = rest.first() {
            let (place, others) =
                rest.split_at(rest.partition_point(|(it, _)| *it <= first + near));
            rest = others;
            let directions = [0, 1].map(|own| place.iter().any(|(_, it)| *it == own));
            let series = if directions == [true, true] { 2 } else { usize::from(directions[1]) };
            found[series].push((one.value, first));
        }
    }
    let [up, down, both] = found;
    vec![
        dots("upwards", up, BLUE),
        dots("downwards", down, VERMILION),
        dots("both ways", both, INK),
    ]
}

/// So many places of a diagram are told apart along its axis.
const PLACES: f64 = 2000.0;

/// What `section --help` says first.
const ABOUT: &str = "\
Run a system of your own past a rule, and show the states in which they meet: a Poincaré map as \
points. The Lyapunov exponents of the run are printed, through every event; of a system without \
explicit time one is 0, and one is -inf for each direction that events forget.

With --over, the points are those at many values of a parameter, upwards and downwards: a \
bifurcation diagram by brute force.";

/// What `section --help` says last.
const EXAMPLES: &str = "\
Examples:
  stickslip section examples/orbits/oscillator.slip --rule impact --set w=0.8 --skip 400 --for 2000 \
--plot section.svg
  stickslip section examples/orbits/oscillator.slip --rule phase --set w=0.8 --skip 400 --for 63 \
--over a=0.3:1.5 --values 120 --plot diagram.svg --show v

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
