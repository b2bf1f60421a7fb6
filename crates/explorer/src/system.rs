//! Systems that are texts: read, run, and over a plane of two parameters.

use std::collections::BTreeMap;

use serde::Deserialize;
use serde_json::{Map, Value, json};
use stickslip_expression::{System, SystemFamily, outcome_name};
use stickslip_solver::{EmbeddedPair, Options, Outcome};
use stickslip_tracer::{Point, hybrid::DynamicFired};

use crate::axis::MapPoint;
use crate::itinerary;

/// A run as a page asks for it.
#[derive(Deserialize)]
pub struct RunRequest {
    text: String,
    /// Values of parameters that differ from those of the text.
    #[serde(default)]
    set: BTreeMap<String, f64>,
    end: Option<f64>,
}

/// The runs of a system over two of its parameters, as a page describes them.
#[derive(Deserialize)]
pub struct SystemRequest {
    #[serde(flatten)]
    run: RunRequest,
    /// The names of the parameters on both axes.
    across: String,
    up: String,
    /// The number of events up to which runs are told apart.
    most_events: usize,
}

/// The runs of a system over two of its parameters.
pub struct SystemPlane {
    family: SystemFamily,
    fields: [String; 4],
}

/// So many steps of a run are computed.
const MOST_STEPS: usize = 200_000;
/// So many events of a run are shown.
const MOST_EVENTS: usize = 20_000;
/// So many points of a course are shown.
const MOST_POINTS: usize = 6_000;

/// What a text consists of.
pub fn parse(text: &str) -> Result<Value, Value> {
    let system = read(text)?;
    let parameters = system.parameters.iter().map(|parameter| {
        json!({ "name": parameter.name, "value": parameter.value, "range": parameter.range })
    });
    let components = system
        .components
        .iter()
        .map(|component| json!({ "name": component.name, "discrete": component.discrete }));
    let modes: Vec<&str> = system.modes.iter().map(|mode| mode.name.as_str()).collect();
    Ok(json!({
        "parameters": parameters.collect::<Vec<_>>(),
        "components": components.collect::<Vec<_>>(),
        "modes": modes,
        "ends": system.end.is_some() || system.ends_itself(),
        "text": stickslip_expression::format(text).unwrap_or_else(|_| system.text()),
    }))
}

fn read(text: &str) -> Result<System, Value> {
    System::parse(text).map_err(
        |error| json!({ "error": error.message, "line": error.line, "column": error.column }),
    )
}

fn said(error: impl std::fmt::Display) -> Value {
    json!({ "error": format!("{error}") })
}

/// The values of the parameters of a system, some of which are set.
fn values(system: &System, set: &BTreeMap<String, f64>) -> Vec<f64> {
    let value = |parameter: &stickslip_expression::Parameter| {
        set.get(&parameter.name).copied().unwrap_or(parameter.value)
    };
    system.parameters.iter().map(value).collect()
}

impl RunRequest {
    /// The run: its events, its course, and how it ended.
    pub fn run(&self) -> Result<Value, Value> {
        let system = read(&self.text)?;
        let runnable = system.with(&values(&system, &self.set)).map_err(said)?;
        let end = self.end.unwrap_or(runnable.end());
        if self.end.is_none() && system.end.is_none() && !system.ends_itself() {
            return Err(said("the system says no end; expected `end = …` or a rule -> end"));
        }
        if end.is_nan() || end <= runnable.start().s {
            return Err(said(format!("the run ends at {end}, before it starts")));
        }
        let options =
            Options { max_steps: MOST_STEPS, max_switches: MOST_EVENTS, ..Options::default() };
        let found = runnable.record(EmbeddedPair::Dop853, end, &options);
        let found = found.map_err(|error| said(system.explained(&error)))?;
        let name = |mode: usize| system.modes[mode].name.as_str();
        let events = found.events.iter().map(|event| {
            json!({
                "time": event.s,
                "event": system.modes[event.from].rules[event.guard].name(event.guard),
                "from": name(event.from),
                "to": name(event.to),
                "before": event.before,
                "after": event.after,
            })
        });
        let stays = found.stays();
        let stays = stays.iter().map(|stay| json!([stay.mode, stay.from, stay.to]));
        let points = found.steps().len().max(1);
        let curve = found.curve((MOST_POINTS / points).clamp(1, 12));
        let course = curve.iter().map(|(time, state)| {
            let mut row = Vec::with_capacity(1 + state.len());
            row.push(*time);
            row.extend(state);
            row
        });
        let accumulation = match found.run.outcome {
            Outcome::Zeno { accumulation } => Some(accumulation),
            _ => None,
        };
        let state = system.components.iter().zip(&found.run.state);
        let state: Map<String, Value> =
            state.map(|(component, value)| (component.name.clone(), json!(value))).collect();
        Ok(json!({
            "outcome": outcome_name(found.run.outcome),
            "accumulation": accumulation,
            "time": found.run.s,
            "mode": name(found.run.mode),
            "state": state,
            "decided": found.run.decided,
            "statistics": found.run.statistics,
            "events": events.collect::<Vec<_>>(),
            "stays": stays.collect::<Vec<_>>(),
            "course": course.collect::<Vec<_>>(),
        }))
    }
}

impl SystemPlane {
    /// The plane that a page describes.
    pub fn new(request: &SystemRequest) -> Result<Self, Value> {
        let SystemRequest { run, across, up, most_events } = request;
        let system = read(&run.text)?;
        let place = |name: &str| {
            let place = system.parameters.iter().position(|parameter| parameter.name == name);
            place.ok_or_else(|| said(format!("the system has no parameter {name}")))
        };
        let axes = [place(across)?, place(up)?];
        let options = Options {
            max_switches: (*most_events).clamp(1, MOST_EVENTS),
            max_steps: MOST_STEPS,
            ..Options::with_tolerance(1e-10)
        };
        let values = values(&system, &run.set);
        let family = SystemFamily::new(&system, axes, &values, run.end, options).map_err(said)?;
        let mut components = system.components.iter();
        let mut field = |or: &str| {
            components
                .next()
                .map_or_else(|| or.to_owned(), |own| format!("{} at the end", own.name))
        };
        let fields = ["time at the end".to_owned(), field(""), field(""), field("")];
        Ok(Self { family, fields })
    }

    /// The names of the values of a point; empty if there are fewer components.
    pub fn fields(&self) -> [&str; 4] {
        self.fields.each_ref().map(String::as_str)
    }

    /// The runs as a family.
    pub fn family(&self) -> &SystemFamily {
        &self.family
    }

    /// The result at a point.
    pub fn point(&self, [x, y]: [f64; 2]) -> MapPoint {
        let Ok(Some(DynamicFired { run, fired })) = self.family.run(&Point::new(x, y)) else {
            return MapPoint::FAILED;
        };
        #[expect(clippy::cast_possible_truncation, reason = "for a picture")]
        let component = |place: usize| run.state.get(place).map_or(f32::NAN, |&it| it as f32);
        #[expect(clippy::cast_possible_truncation, reason = "for a picture")]
        let values = [run.s as f32, component(0), component(1), component(2)];
        let count = u16::try_from(fired.len()).unwrap_or(u16::MAX - 1);
        MapPoint { values, count, code: itinerary::of_run(&fired, run.outcome) }
    }
}
