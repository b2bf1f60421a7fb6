//! What the formulas of a system say of an itinerary: its clock, and what need not come back.

use stickslip_expression::{
    Formula, Graph, Inputs, InvalidValue, Next, Program, System, Trigger, Variable,
};
use stickslip_solver::GivenValue;

use super::Draft;
use super::event::by_each;
use super::flow::narrow;
use crate::error::OrbitError;
use crate::itinerary::Leg;

/// Whether a component need not come back at the end of an itinerary: nothing changes it, or it is
/// a counter or an integral, which nothing else reads and which only adds to itself.
pub(crate) fn is_apart(system: &System, legs: &[Leg], place: usize) -> bool {
    let component = Variable::Component(narrow(place));
    let mut graph = system.graph.clone();
    let (mut is_still, mut adds, mut others) = (true, true, Vec::new());
    let mut by = |formula: Formula| {
        let by = graph.slope(formula, &mut |graph, variable| {
            graph.constant(f64::from(u8::from(variable == component)))
        });
        graph.value(by)
    };
    for leg in legs {
        let mode = &system.modes[leg.mode];
        is_still &= system.graph.value(mode.slopes[place]) == Some(0.0)
            && leg.rule(system).changes.iter().all(|(own, _)| *own != place);
        adds &= by(mode.slopes[place]) == Some(0.0);
        let slopes = mode.slopes.iter().enumerate().filter(|(own, _)| *own != place);
        others.extend(slopes.map(|(_, slope)| *slope));
        for rule in &mode.rules {
            for &(own, change) in &rule.changes {
                if own == place {
                    adds &= matches!(by(change), Some(0.0 | 1.0));
                } else {
                    others.push(change);
                }
            }
            if let Trigger::When(guard, _) = rule.trigger {
                others.push(guard);
            }
            if let Next::Branch(condition, ..) = rule.next {
                others.push(condition);
            }
        }
    }
    is_still || adds && !system.graph.reads(&others).contains(&component)
}

/// Whether an itinerary gives back the value that a component has at its start, whatever that is:
/// a discrete state, as one that n := 1 − n turns on and off. It only moves at events, and its next
/// value is a linear function of itself alone.
pub(super) fn is_held(system: &System, legs: &[Leg], place: usize, start: f64) -> bool {
    let component = Variable::Component(narrow(place));
    let (components, parameters) = (system.components.len(), system.values());
    let inputs = Inputs { components, parameters: parameters.len(), fixed: true };
    let mut graph = system.graph.clone();
    let (mut value, mut by) = (start, 1.0);
    for leg in legs {
        if graph.value(system.modes[leg.mode].slopes[place]) != Some(0.0) {
            return false;
        }
        for &(_, change) in leg.rule(system).changes.iter().filter(|(own, _)| *own == place) {
            let slope = graph.slope(change, &mut |graph, variable| {
                graph.constant(f64::from(u8::from(variable == component)))
            });
            let slope = graph.value(slope);
            let alone = graph.reads(&[change]).iter().all(|it| *it == component);
            let (Some(slope), true) = (slope, alone) else { return false };
            let mut state = vec![0.0; components];
            state[place] = value;
            let mut after = [f64::NAN];
            Program::compile(&graph, &[change], inputs).with(&parameters).run(
                f64::NAN,
                &state,
                &mut after,
            );
            (value, by) = (after[0], slope * by);
        }
    }
    by == 1.0 && (value - start).abs() <= f64::EPSILON * start.abs().max(1.0)
}

/// The number of the tick at the end of each segment.
pub(super) fn ticks(system: &System, draft: &Draft) -> Result<Vec<Option<f64>>, OrbitError> {
    let starts = draft.starts();
    let ticks = draft.legs.iter().enumerate().map(|(i, leg)| {
        let Trigger::Every { period, phase } = leg.rule(system).trigger else { return Ok(None) };
        let [period, phase] = clock_values(system, &draft.parameters, period, phase)?;
        Ok(Some(((starts[i] + draft.durations[i] - phase) / period).round()))
    });
    ticks.collect()
}

/// The period and the phase of a clock.
///
/// # Errors
/// They are not usable numbers.
pub(crate) fn clock_values(
    system: &System,
    parameters: &[f64],
    period: Formula,
    phase: Formula,
) -> Result<[f64; 2], OrbitError> {
    let inputs = Inputs { components: 0, parameters: parameters.len(), fixed: true };
    let program = Program::compile(&system.graph, &[period, phase], inputs).with(parameters);
    let mut values = [f64::NAN; 2];
    program.run(f64::NAN, &[], &mut values);
    let usable = values[0] > 0.0 && values.iter().all(|it| it.is_finite());
    let expected = "a finite number above 0, with a finite phase";
    InvalidValue::check("the period of a clock", values[0], expected, usable)?;
    Ok(values)
}

/// The clocks of the itinerary: the period of each with its derivatives, and how often it ticks.
pub(super) fn clocks(
    graph: &mut Graph,
    system: &System,
    legs: &[Leg],
    active: &[usize],
) -> Result<Vec<(Program, f64)>, OrbitError> {
    let ticks = legs.iter().filter_map(|leg| match leg.rule(system).trigger {
        Trigger::Every { period, phase } => Some((period, phase)),
        _ => None,
    });
    let ticks: Vec<(Formula, Formula)> = ticks.collect();
    if ticks.is_empty() {
        let explicit = legs.iter().any(|leg| reads_time(system, *leg));
        let expected = "a rule `every …` among the itinerary, whose period is that of what depends \
                        on the time";
        let found = GivenValue::Phrase("has no clock, and equations depend on the time".into());
        InvalidValue::check("itinerary", found, expected, !explicit)?;
    }
    let inputs = Inputs { components: 0, parameters: system.parameters.len(), fixed: true };
    let is_first = |(place, own): &(usize, &(Formula, Formula))| !ticks[..*place].contains(own);
    let clocks = ticks.iter().enumerate().filter(is_first).map(|(_, own)| {
        let mut formulas = vec![own.0];
        formulas.extend(by_each(graph, own.0, 0, active).into_iter().skip(1));
        let count = ticks.iter().filter(|it| *it == own).count();
        (Program::compile(graph, &formulas, inputs), count as f64)
    });
    Ok(clocks.collect())
}

/// Whether a segment depends on the time.
fn reads_time(system: &System, leg: Leg) -> bool {
    let rule = leg.rule(system);
    let mut formulas = system.modes[leg.mode].slopes.clone();
    formulas.extend(rule.changes.iter().map(|(_, formula)| *formula));
    if let Trigger::When(guard, _) = rule.trigger {
        formulas.push(guard);
    }
    system.graph.reads(&formulas).contains(&Variable::Time)
}
