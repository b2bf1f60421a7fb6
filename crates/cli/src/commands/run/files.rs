//! The files of a run: its events, its course and its picture.

use std::path::Path;

use stickslip_expression::{Recording, System};
use stickslip_figure::Svg;
use stickslip_figure::pictures::{self, run::RunPicture};
use stickslip_files::output::csv::CsvFile;
use stickslip_files::output::file::StoredFile;

use super::label;
use crate::error::Failure;
use crate::shared::system::SystemRun;

/// So many components are drawn.
const MOST_PANELS: usize = 8;

/// Writes the events with the states on both sides of them, all but the name of the file.
pub fn write_events(
    path: &Path,
    system: &System,
    found: &Recording,
) -> Result<StoredFile, Failure> {
    let mut file = CsvFile::create(path)?;
    file.rows.fields(["time", "event", "mode_before", "mode_after"]);
    for side in ["before", "after"] {
        file.rows.fields(system.components.iter().map(|it| format!("{}_{side}", it.name)));
    }
    file.end()?;
    for event in &found.events {
        let rows = &mut file.rows;
        rows.number(event.s);
        rows.field(label(system, event));
        rows.fields([event.from, event.to].map(|mode| system.modes[mode].name.as_str()));
        event.before.iter().chain(&event.after).for_each(|&value| rows.number(value));
        file.end()?;
    }
    Ok(file.store()?)
}

/// Writes the state at `points` even times and on both sides of every event, all but the name of
/// the file.
pub fn write_course(
    path: &Path,
    points: usize,
    system: &System,
    found: &Recording,
) -> Result<StoredFile, Failure> {
    let mut file = CsvFile::create(path)?;
    file.rows.fields(["time", "mode", "event"]);
    file.rows.fields(system.components.iter().map(|it| it.name.as_str()));
    file.end()?;
    let mut row = |s: f64, mode: usize, event: Option<usize>, state: &[f64]| {
        let rows = &mut file.rows;
        rows.number(s);
        rows.field(&system.modes[mode].name);
        match event {
            Some(event) => rows.count(event),
            None => rows.field(""),
        }
        for &value in state {
            rows.number(value);
        }
        file.end()
    };
    let (start, end) = (found.start(), found.run.s);
    let mut events = found.events.iter().enumerate().peekable();
    for point in 0..points {
        let part = point as f64 / (points - 1) as f64;
        let s = if point + 1 == points { end } else { start + part * (end - start) };
        while let Some((index, event)) = events.next_if(|(_, event)| event.s <= s) {
            row(event.s, event.from, Some(index), &event.before)?;
            row(event.s, event.to, Some(index), &event.after)?;
        }
        if let Some(state) = found.at(s) {
            row(s, found.mode_at(s), None, &state)?;
        }
    }
    Ok(file.store()?)
}

/// The picture of a run: its first components, those that only events change last.
pub fn draw(run: &SystemRun, found: &Recording) -> Svg {
    let SystemRun { system, name, parameters, .. } = run;
    let mut shown: Vec<usize> = (0..system.components.len()).collect();
    shown.sort_by_key(|&component| system.components[component].discrete);
    shown.truncate(MOST_PANELS);
    let pick = |state: &[f64]| shown.iter().map(|&component| state[component]).collect();
    let values = system.parameters.iter().zip(parameters);
    let values = values.map(|(it, value)| format!("{} = {}", it.name, short(*value)));
    let values: Vec<String> = values.take(6).collect();
    let title = format!("{name}:  {}", values.join(", "));
    let title = title.strip_suffix(":  ").unwrap_or(&title);
    pictures::run::draw(&RunPicture {
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
pub fn short(value: f64) -> String {
    stickslip_figure::number(value, 6)
}
