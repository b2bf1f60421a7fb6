//! Runs of systems that are texts.

use std::io::{self, Write};
use std::path::Path;

use serde::Serialize;
use serde_json::{Map, Value, json};
use stickslip_expression::{Recording, System, outcome_name};
use stickslip_figure::pictures;
use stickslip_files::output::csv::{CsvFile, Rows};
use stickslip_files::output::file::{StoredFile, publish};
use stickslip_files::output::json;
use stickslip_files::output::picture::PictureFile;
use stickslip_solver::{DynamicSwitch, Outcome, Rest};

use crate::args::{Format, SystemArguments};
use crate::error::Failure;
use crate::output::console::print;
use crate::output::text::{self, number};
use crate::plan::{RunPlan, read};
use crate::schema;

/// So many components are drawn.
const MOST_PANELS: usize = 8;
/// So many events are printed.
const MOST_LINES: usize = 200;
/// Rows are written when they are so many.
const ROWS_AT_ONCE: usize = 10_000;

/// Runs the system, writes what is wanted, and prints how it ended.
///
/// # Errors
/// The run fails, or a file or standard output cannot be written.
pub fn run(plan: &RunPlan) -> Result<(), Failure> {
    let RunPlan { system, runnable, end, method, options, events, course, plot, .. } = plan;
    for path in [events.as_deref(), course.as_ref().map(|(path, _)| &**path)] {
        path.map_or(Ok(()), CsvFile::probe)?;
    }
    plot.as_ref().map_or(Ok(()), PictureFile::probe)?;
    let found = runnable.record(*method, *end, options);
    let found = found.map_err(|error| Failure::Run(system.explained(&error)))?;
    let events = events.as_deref().map(|path| write_events(path, system, &found)).transpose()?;
    let course = course.as_ref().map(|it| write_course(it, system, &found)).transpose()?;
    let picture = plot.as_ref().map(|plot| plot.write(Ok(draw(plan, &found)))).transpose()?;
    publish(events.into_iter().chain(course).chain(picture))?;
    print(|out| match plan.format {
        Format::Json => json::lines(out, &document(plan, &found)),
        Format::Table => table(out, plan, &found),
    })
}

/// Prints what a system consists of, or its text in the usual form.
///
/// # Errors
/// It cannot be read, or standard output cannot be written.
pub fn describe(arguments: &SystemArguments) -> Result<(), Failure> {
    let (system, text) = read(&arguments.system)?;
    // A text that reads as a system consists of words and signs.
    let formatted = stickslip_expression::format(&text);
    print(|out| {
        let text = if arguments.format { formatted.ok() } else { None };
        write!(out, "{}", text.unwrap_or_else(|| system.text()))
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

fn write_events(path: &Path, system: &System, found: &Recording) -> Result<StoredFile, Failure> {
    let mut file = CsvFile::create(path)?;
    let mut rows = Rows::default();
    rows.fields(["time", "event", "mode_before", "mode_after"]);
    for side in ["before", "after"] {
        rows.fields(system.components.iter().map(|it| format!("{}_{side}", it.name)));
    }
    rows.end();
    for (index, event) in found.events.iter().enumerate() {
        rows.number(event.s);
        rows.field(label(system, event));
        rows.fields([event.from, event.to].map(|mode| system.modes[mode].name.as_str()));
        event.before.iter().chain(&event.after).for_each(|&value| rows.number(value));
        rows.end();
        if index % ROWS_AT_ONCE == 0 {
            file.write(&rows)?;
            rows.clear();
        }
    }
    file.write(&rows)?;
    Ok(file.store()?)
}

fn write_course(
    (path, points): &(std::path::PathBuf, usize),
    system: &System,
    found: &Recording,
) -> Result<StoredFile, Failure> {
    let mut file = CsvFile::create(path)?;
    let mut rows = Rows::default();
    rows.fields(["time", "mode", "event"]);
    rows.fields(system.components.iter().map(|it| it.name.as_str()));
    rows.end();
    let mut written = 0;
    let mut row = |s: f64, mode: usize, event: Option<usize>, state: &[f64]| {
        rows.number(s);
        rows.field(&system.modes[mode].name);
        match event {
            Some(event) => rows.count(event),
            None => rows.field(""),
        }
        for &value in state {
            rows.number(value);
        }
        rows.end();
        written += 1;
        if written % ROWS_AT_ONCE == 0 {
            file.write(&rows)?;
            rows.clear();
        }
        Ok::<(), Failure>(())
    };
    let (start, end) = (found.start(), found.run.s);
    let mut events = found.events.iter().enumerate().peekable();
    for point in 0..*points {
        let part = point as f64 / (points - 1) as f64;
        let s = if point + 1 == *points { end } else { start + part * (end - start) };
        while let Some((index, event)) = events.next_if(|(_, event)| event.s <= s) {
            row(event.s, event.from, Some(index), &event.before)?;
            row(event.s, event.to, Some(index), &event.after)?;
        }
        if let Some(state) = found.at(s) {
            row(s, found.mode_at(s), None, &state)?;
        }
    }
    file.write(&rows)?;
    Ok(file.store()?)
}

/// The picture of a run: its first components, those that only events change last.
fn draw(plan: &RunPlan, found: &Recording) -> stickslip_figure::Svg {
    let RunPlan { system, name, parameters, .. } = plan;
    let mut shown: Vec<usize> = (0..system.components.len()).collect();
    shown.sort_by_key(|&component| system.components[component].discrete);
    shown.truncate(MOST_PANELS);
    let pick = |state: &[f64]| shown.iter().map(|&component| state[component]).collect();
    let values = system.parameters.iter().zip(parameters);
    let values = values.map(|(it, value)| format!("{} = {}", it.name, short(*value)));
    let values: Vec<String> = values.take(6).collect();
    let title = format!("{name}:  {}", values.join(", "));
    let title = title.strip_suffix(":  ").unwrap_or(&title);
    pictures::run::draw(&pictures::run::Run {
        title,
        time: "time t",
        names: shown.iter().map(|&component| &*system.components[component].name).collect(),
        curve: found.curve(12).into_iter().map(|(s, state)| (s, pick(&state))).collect(),
        modes: system.modes.iter().map(|mode| &*mode.name).collect(),
        stays: found.stays().into_iter().map(|stay| (stay.mode, stay.from, stay.to)).collect(),
        events: found.events.iter().map(|event| event.s).collect(),
    })
}

/// A number for a title.
fn short(value: f64) -> String {
    stickslip_figure::number(value, 6)
}

#[derive(Serialize)]
struct Event {
    time: f64,
    #[serde(rename = "event")]
    label: String,
    from: String,
    to: String,
    before: Map<String, Value>,
    after: Map<String, Value>,
}

/// The run as JSON.
fn document(plan: &RunPlan, found: &Recording) -> Value {
    let system = &plan.system;
    let state = |values: &[f64]| -> Map<String, Value> {
        let named = system.components.iter().zip(values);
        named.map(|(component, &value)| (component.name.clone(), json!(value))).collect()
    };
    let name = |mode: usize| system.modes[mode].name.clone();
    let parameters: Map<String, Value> = system
        .parameters
        .iter()
        .zip(&plan.parameters)
        .map(|(parameter, &value)| (parameter.name.clone(), json!(value)))
        .collect();
    let events: Vec<Event> = found
        .events
        .iter()
        .map(|event| Event {
            time: event.s,
            label: label(system, event),
            from: name(event.from),
            to: name(event.to),
            before: state(&event.before),
            after: state(&event.after),
        })
        .collect();
    let rest = |it: &Rest<usize>| json!({ "time": it.s, "error": it.error, "from": name(it.from), "to": name(it.to) });
    let rests: Vec<Value> = found.rests.iter().map(rest).collect();
    let (outcome, accumulation) = outcome(found.run.outcome);
    json!({
        "schema": schema::RUN,
        "system": plan.name,
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

fn table(out: &mut dyn Write, plan: &RunPlan, found: &Recording) -> io::Result<()> {
    let system = &plan.system;
    for (parameter, value) in system.parameters.iter().zip(&plan.parameters) {
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
    text::pairs(out, &lines)?;
    text::work(out, &found.run.statistics)
}
