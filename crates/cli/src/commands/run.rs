//! `run`: a system of one's own, integrated through every event.

mod files;

use std::io::{self, Write};
use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use serde_json::{Map, Value, json};
use stickslip_expression::{Recording, System, outcome_name};
use stickslip_files::output::csv::CsvFile;
use stickslip_files::output::json;
use stickslip_files::output::picture::PictureFile;
use stickslip_solver::dynamic::DynamicSwitch;
use stickslip_solver::{EmbeddedPair, Options, Outcome, Rest};

use crate::error::Failure;
use crate::output::console::{deliver, print};
use crate::output::text::{self, number};
use crate::schema;
use crate::shared::Format;
use crate::shared::course::points;
use crate::shared::files::{picture, plotted, require_different};
use crate::shared::method::{atol, rtol};
use crate::shared::system::{SystemRun, setting, time};

/// So many events are printed.
const MOST_LINES: usize = 200;

/// Integrate a system of your own through every event
#[derive(Debug, clap::Args)]
#[command(long_about = ABOUT, after_long_help = EXAMPLES)]
pub struct RunArguments {
    /// The system, a text as docs/systems.md describes it; - is standard input
    #[arg(value_name = "SYSTEM.slip")]
    pub system: PathBuf,

    /// The value of a parameter; may be repeated
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting, help_heading = "System")]
    pub set: Vec<(String, f64)>,

    /// Where the run ends, instead of the end that the system says
    #[arg(long, value_name = "T", value_parser = time, allow_hyphen_values = true)]
    #[arg(help_heading = "System")]
    pub end: Option<f64>,

    /// The method
    #[arg(long, value_name = "NAME", help_heading = "Method", default_value = "dop853")]
    #[arg(value_parser = method())]
    pub method: EmbeddedPair,

    /// Relative tolerance of a step; 1e-15 to 0.1 [default: 1e-10]
    #[arg(long, value_name = "R", help_heading = "Method", value_parser = rtol)]
    #[arg(allow_hyphen_values = true)]
    pub rtol: Option<f64>,

    /// Absolute tolerance of a step; above 0 [default: 1e-12]
    #[arg(long, value_name = "T", help_heading = "Method", value_parser = atol)]
    #[arg(allow_hyphen_values = true)]
    pub atol: Option<f64>,

    /// How the result is printed
    #[arg(long, value_enum, default_value_t = Format::Table, help_heading = "Output")]
    pub format: Format,

    /// Add the work of the integrator to the table
    #[arg(long, help_heading = "Output")]
    pub verbose: bool,

    /// CSV file for the events, with the states before and after them
    #[arg(long, value_name = "FILE.csv", help_heading = "Output")]
    pub events: Option<PathBuf>,

    /// CSV file for the state against time, at even times and on both sides of every event
    #[arg(long, value_name = "FILE.csv", help_heading = "Output")]
    pub course: Option<PathBuf>,

    /// Number of even times of --course, with the start and the end; 2 to 10000000
    #[arg(long, value_name = "N", help_heading = "Output", requires = "course")]
    #[arg(default_value_t = 1000, allow_hyphen_values = true)]
    #[arg(value_parser = points())]
    pub points: usize,

    /// Picture of the state against time, with modes shaded and events marked
    #[arg(long, value_name = "FILE.svg|.png|.pdf", help_heading = "Output")]
    #[arg(value_parser = picture())]
    pub plot: Option<PictureFile>,
}

/// Runs the system, writes what is wanted, and prints how it ended.
pub fn run(arguments: &RunArguments) -> Result<(), Failure> {
    let RunArguments { set, method, events, course, plot, .. } = arguments;
    let (events, course, plot) = (events.as_deref(), course.as_deref(), plot.as_ref());
    let outputs = [("--events", events), ("--course", course), plotted(plot)];
    require_different(&outputs, &[("the system", Some(&*arguments.system))])?;
    let run = SystemRun::new(&arguments.system, set, arguments.end)?;
    let defaults = Options::default();
    let options = Options {
        rtol: arguments.rtol.unwrap_or(defaults.rtol),
        atol: arguments.atol.unwrap_or(defaults.atol),
        ..defaults
    };
    for path in [events, course] {
        path.map_or(Ok(()), CsvFile::probe)?;
    }
    plot.map_or(Ok(()), PictureFile::probe)?;
    let system = &run.system;
    let found = run.runnable.record(*method, run.end, &options);
    let found = found.map_err(|error| Failure::Run(system.explained(&error)))?;
    let events = events.map(|path| files::write_events(path, system, &found)).transpose()?;
    let follow = |path| files::write_course(path, arguments.points, system, &found);
    let course = course.map(follow).transpose()?;
    let picture = plot.map(|plot| plot.write(Ok(files::draw(&run, &found)))).transpose()?;
    deliver(events.into_iter().chain(course).chain(picture), "")?;
    print(|out| match arguments.format {
        Format::Json => json::lines(out, &document(&run, &found)),
        Format::Table => {
            table(out, &run, &found)?;
            if arguments.verbose { text::work(out, &found.run.statistics) } else { Ok(()) }
        }
    })
}

/// Reads the name of a method.
fn method() -> impl TypedValueParser<Value = EmbeddedPair> {
    let names = PossibleValuesParser::new(["dopri5", "dop853"]);
    names.map(|name| match name.as_str() {
        "dopri5" => EmbeddedPair::Dopri5,
        _ => EmbeddedPair::Dop853,
    })
}

/// The name of an event.
fn label(system: &System, event: &DynamicSwitch<usize>) -> String {
    system.modes[event.from].rules[event.guard].name(event.guard)
}

/// Why a run ended, and where events accumulate.
pub fn outcome(outcome: Outcome) -> (&'static str, Option<f64>) {
    let accumulation = match outcome {
        Outcome::Zeno { accumulation } => Some(accumulation),
        _ => None,
    };
    (outcome_name(outcome), accumulation)
}

/// The run as JSON.
fn document(run: &SystemRun, found: &Recording) -> Value {
    let system = &run.system;
    let state = |values: &[f64]| -> Map<String, Value> {
        let named = system.components.iter().zip(values);
        named.map(|(component, &value)| (component.name.clone(), json!(value))).collect()
    };
    let name = |mode: usize| system.modes[mode].name.clone();
    let parameters: Map<String, Value> = system
        .parameters
        .iter()
        .zip(&run.parameters)
        .map(|(parameter, &value)| (parameter.name.clone(), json!(value)))
        .collect();
    let events = found.events.iter().map(|event| {
        json!({
            "time": event.s,
            "event": label(system, event),
            "from": name(event.from),
            "to": name(event.to),
            "before": state(&event.before),
            "after": state(&event.after),
        })
    });
    let events: Vec<Value> = events.collect();
    let rest = |it: &Rest<usize>| json!({ "time": it.s, "error": it.error, "from": name(it.from), "to": name(it.to) });
    let rests: Vec<Value> = found.rests.iter().map(rest).collect();
    let (outcome, accumulation) = outcome(found.run.outcome);
    json!({
        "schema": schema::RUN,
        "system": run.name,
        "parameters": parameters,
        "outcome": outcome,
        "accumulation": accumulation,
        "time": found.run.s,
        "mode": name(found.run.mode),
        "state": state(&found.run.state),
        "decided": found.run.decided,
        "events": events,
        "rests": rests,
        "statistics": found.run.statistics,
    })
}

fn table(out: &mut dyn Write, run: &SystemRun, found: &Recording) -> io::Result<()> {
    let system = &run.system;
    for (parameter, value) in system.parameters.iter().zip(&run.parameters) {
        writeln!(out, "{} = {value}", parameter.name)?;
    }
    if !system.parameters.is_empty() {
        writeln!(out)?;
    }
    if found.events.is_empty() {
        writeln!(out, "No event.")?;
    } else {
        let header = ["event", "time", "from", "to"].map(str::to_owned);
        let row = |event: &DynamicSwitch<usize>| {
            let [from, to] = [event.from, event.to].map(|mode| system.modes[mode].name.clone());
            [label(system, event), number(event.s), from, to]
        };
        let rows = found.events.iter().take(MOST_LINES).map(row);
        text::aligned(out, &std::iter::once(header).chain(rows).collect::<Vec<_>>())?;
        if let more @ 1.. = found.events.len().saturating_sub(MOST_LINES) {
            writeln!(out, "and {more} more; --events writes all")?;
        }
    }
    writeln!(out)?;
    let ended = match outcome(found.run.outcome) {
        ("end", _) => "at its end".to_owned(),
        ("rule", _) => "by a rule".to_owned(),
        ("accumulation", Some(at)) => format!("events accumulate at {}", number(at)),
        (other, _) => other.replace('_', " "),
    };
    let mut lines = vec![
        ("the run ended", ended),
        ("time", number(found.run.s)),
        ("mode", system.modes[found.run.mode].name.clone()),
    ];
    let values = system.components.iter().zip(&found.run.state);
    lines.extend(values.map(|(it, &value)| (it.name.as_str(), number(value))));
    lines.push(("events", found.events.len().to_string()));
    if !found.rests.is_empty() {
        lines.push(("accumulations passed", found.rests.len().to_string()));
    }
    lines.push(("guards", if found.run.decided { "decided" } else { "sampled" }.to_owned()));
    text::pairs(out, &lines)
}

/// What `run --help` says first.
const ABOUT: &str = "\
Integrate a system of your own, given as a text, through every event: its modes, equations and rules \
are described in docs/systems.md. Guards are decided by bounds, so that no event is missed or invented.";

/// What `run --help` says last.
const EXAMPLES: &str = "\
Examples:
  stickslip run examples/systems/ball.slip
  stickslip run examples/systems/belt.slip --set belt=0.25 --plot belt.svg --events events.csv
  stickslip run examples/systems/relay.slip --end 20 --format json

A run that ends at a limit, or at an accumulation of events without a rest, is reported as such.

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
