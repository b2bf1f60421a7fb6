//! Cases as texts of systems.

use std::time::Instant;

use serde_json::Value;
use stickslip::solver::{Direction, EmbeddedPair, RunError};
use stickslip_expression::{Component, Graph, Mode, Next, Rule, System, Trigger};

use super::expression::formula;
use super::running::{Report, options, report};
use super::{Case, Place, each, index};

/// The text of a case.
pub fn of(case: &Value) -> Option<String> {
    let mut graph = Graph::default();
    let start = &case["start"];
    let component = |(place, value): (usize, f64)| Component {
        name: format!("y{place}"),
        start: graph.constant(value),
        discrete: false,
    };
    let state = each(&start["state"], Value::as_f64)?;
    let components = state.into_iter().enumerate().map(component).collect();
    let mut modes = Vec::new();
    for (number, mode) in case["modes"].as_array()?.iter().enumerate() {
        let mut slopes = Vec::new();
        for slope in mode["field"].as_array()? {
            slopes.push(formula(&mut graph, slope)?);
        }
        let rules = mode["guards"].as_array()?.iter().map(|guard| rule(&mut graph, guard));
        modes.push(Mode {
            name: format!("mode{number}"),
            slopes,
            rules: rules.collect::<Option<_>>()?,
        });
    }
    let (begin, end) =
        (graph.constant(start["time"].as_f64()?), graph.constant(case["end"].as_f64()?));
    let first = index(&start["mode"])?;
    let (start, end) = (Some(begin), Some(end));
    let system = System { graph, components, modes, first, start, end, ..System::default() };
    Some(system.text())
}

fn rule(graph: &mut Graph, guard: &Value) -> Option<Rule> {
    let direction = match guard["direction"].as_str()? {
        "below" => Direction::Below,
        "falling" => Direction::Falling,
        "rising" => Direction::Rising,
        "either" => Direction::Either,
        _ => return None,
    };
    let mut changes = Vec::new();
    for (place, value) in guard["reset"].as_array().into_iter().flatten().enumerate() {
        changes.push((place, formula(graph, value)?));
    }
    let trigger = Trigger::When(formula(graph, &guard["value"])?, direction);
    Some(Rule {
        ends_after: u32::from(guard["terminal"] == true),
        from_zero: guard["zero_order"].as_u64().unwrap_or(0).try_into().ok()?,
        changes,
        next: index(&guard["to"]).map_or(Next::Stay, Next::Mode),
        ..Rule::new(trigger)
    })
}

/// Runs the text of a case.
///
/// # Panics
/// The text is no system.
pub fn run(pair: EmbeddedPair, case: &Case) -> Report {
    let system = System::parse(&case.text).unwrap_or_else(|it| panic!("{it}\n{}", case.text));
    let runnable = system.with(&[]).unwrap_or_else(|it| panic!("{it}\n{}", case.text));
    let begin = Instant::now();
    let mut events = Vec::new();
    let result = runnable.events(pair, runnable.end(), &options(case, None), &mut events);
    let result = result.map(|run| (run.outcome, run.statistics.field));
    let mut places: Vec<Place> = Vec::new();
    for event in events {
        places.push((event.s, event.guard));
        let guard = &case.modes[event.from].guards[event.guard];
        if guard.is_noted() && !guard.guard.ends_run() {
            places.extend(event.simultaneous.into_iter().map(|guard| (event.s, guard)));
        }
    }
    // The error names the transitions of a chain without end, which are no events.
    if let Err(RunError::Cycle { s, cycle, .. }) = &result {
        places.extend(cycle.first().map(|&(guard, _)| (*s, guard)));
    }
    report(case, places, result, begin)
}
