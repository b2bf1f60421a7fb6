//! Many runs of one system of formulas, on all threads.

use numpy::{IntoPyArray, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyDictMethods};
use rayon::prelude::*;
use stickslip_expression::System;
use stickslip_plane::progress::{Progress, Report};
use stickslip_solver::dynamic::{DynamicRun, DynamicSwitch};

use crate::background::watched;
use crate::formulas::{FormulaSystem, Settings, word};

/// Runs a system with many parameters, one row of `parameters` for each run, and from many
/// states, if there are any. Returns columns with an entry for each run, and for each event.
#[expect(clippy::too_many_arguments, reason = "they are those of a run")]
#[pyfunction]
#[pyo3(signature = (
    system, parameters, states, start, end, settings, times, threads, progress=None
))]
pub fn run_many<'py>(
    py: Python<'py>,
    system: &FormulaSystem,
    parameters: PyReadonlyArray2<'py, f64>,
    states: Option<PyReadonlyArray2<'py, f64>>,
    start: (Option<usize>, Option<f64>),
    end: Option<f64>,
    settings: Settings,
    times: Option<Vec<f64>>,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let (method, options) = settings.checked()?;
    let tolerances = settings.tolerances;
    let compiled = system.compiled()?.clone();
    let rows_of = |array: &PyReadonlyArray2<'_, f64>| -> Vec<Vec<f64>> {
        array.as_array().rows().into_iter().map(|row| row.to_vec()).collect()
    };
    let (parameters, states) = (rows_of(&parameters), states.as_ref().map(rows_of));
    let (count, wanted) = (parameters.len(), times.as_ref().map_or(0, Vec::len));
    let (ends_itself, system) = (system.system.ends_itself(), system.system.clone());
    let explaining = system.clone();
    let one = move |index: usize| -> Result<Ended, String> {
        let runnable = compiled.with(&parameters[index]).map_err(|error| error.to_string())?;
        let state = states.as_ref().map(|states| states[index].as_slice());
        let runnable =
            runnable.starting(start.0, start.1, state).map_err(|error| error.to_string())?;
        let runnable =
            runnable.with_tolerances(tolerances.clone()).map_err(|error| error.to_string())?;
        let (from, end) = (runnable.start().s, end.unwrap_or(runnable.end()));
        if end.is_nan() || end <= from || end.is_infinite() && !ends_itself {
            return Err(format!("the run ends at {end}; expected an end after {from}"));
        }
        if let Some(times) = &times {
            let found = runnable.record(method, end, &options);
            let found = found.map_err(|error| explaining.explained(&error))?;
            let samples = times.iter().flat_map(|&s| {
                found.at(s).unwrap_or_else(|| vec![f64::NAN; found.run.state.len()])
            });
            let samples = samples.collect();
            return Ok(Ended { run: found.run, events: found.events, samples });
        }
        let mut events = Vec::new();
        let run = runnable.events(method, end, &options, &mut events);
        let run = run.map_err(|error| explaining.explained(&error))?;
        Ok(Ended { run, events, samples: Vec::new() })
    };
    let work = move |report: Report<'_>| {
        report(Progress::Begin { steps: count });
        let reported = |index| {
            let ended = one(index);
            report(Progress::Advance { steps: 1 });
            ended
        };
        (0..count).into_par_iter().map(reported).collect::<Vec<_>>()
    };
    let ended = watched(py, threads, progress.as_ref(), work)?;
    rows(py, &system, ended, wanted)
}

/// A run of many.
struct Ended {
    run: DynamicRun<usize>,
    events: Vec<DynamicSwitch<usize>>,
    /// States at the times that are wanted.
    samples: Vec<f64>,
}

/// Columns of many runs.
fn rows<'py>(
    py: Python<'py>,
    system: &System,
    ended: Vec<Result<Ended, String>>,
    times: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let (n, columns) = (system.components.len(), PyDict::new(py));
    let (mut t, mut y, mut modes, mut outcomes) = (vec![], vec![], vec![], vec![]);
    let (mut counts, mut decided, mut samples) = (vec![], vec![], Vec::new());
    let (mut event_runs, mut event_times, mut event_from) = (vec![], vec![], vec![]);
    let (mut event_to, mut event_guards) = (vec![], vec![]);
    let (mut before, mut after) = (Vec::new(), Vec::new());
    let mut failures = Vec::new();
    for (index, found) in ended.into_iter().enumerate() {
        let Ended { run, events, samples: own } = match found {
            Ok(ended) => ended,
            Err(message) => {
                t.push(f64::NAN);
                y.extend(std::iter::repeat_n(f64::NAN, n));
                samples.extend(std::iter::repeat_n(f64::NAN, n * times));
                modes.push(-1);
                outcomes.push("failed");
                counts.push(-1);
                decided.push(false);
                failures.push((index, message));
                continue;
            }
        };
        t.push(run.s);
        y.extend_from_slice(&run.state);
        samples.extend(own);
        modes.push(i64::try_from(run.mode).unwrap_or(i64::MAX));
        outcomes.push(word(run.outcome));
        counts.push(i64::try_from(events.len()).unwrap_or(i64::MAX));
        decided.push(run.decided);
        for event in events {
            event_runs.push(index);
            event_times.push(event.s);
            event_guards.push(event.guard);
            event_from.push(event.from);
            event_to.push(event.to);
            before.extend(event.before);
            after.extend(event.after);
        }
    }
    columns.set_item("t", t.into_pyarray(py))?;
    columns.set_item("y", y.into_pyarray(py))?;
    columns.set_item("samples", samples.into_pyarray(py))?;
    columns.set_item("modes", modes.into_pyarray(py))?;
    columns.set_item("outcomes", outcomes)?;
    columns.set_item("counts", counts.into_pyarray(py))?;
    columns.set_item("decided", decided.into_pyarray(py))?;
    columns.set_item("failures", failures)?;
    columns.set_item("event_runs", event_runs.into_pyarray(py))?;
    columns.set_item("event_times", event_times.into_pyarray(py))?;
    columns.set_item("event_guards", event_guards.into_pyarray(py))?;
    columns.set_item("event_from", event_from.into_pyarray(py))?;
    columns.set_item("event_to", event_to.into_pyarray(py))?;
    columns.set_item("event_before", before.into_pyarray(py))?;
    columns.set_item("event_after", after.into_pyarray(py))?;
    Ok(columns)
}
