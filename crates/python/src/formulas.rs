//! Systems of formulas, which are read from a text and run without the interpreter.

use std::sync::OnceLock;

use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyDictMethods};
use stickslip_expression::{By, Compiled, Recording, Runnable, SensitivityError, System};
use stickslip_solver::dynamic::{DynamicSegment, DynamicSwitch};
use stickslip_solver::{EmbeddedPair, Options, Outcome, Statistics};

use stickslip_figure::pictures::studies as pictures;
use stickslip_studies::{StudyError, own_system};

use crate::arrays::numbers;
use crate::background::Signals;
use crate::failure::{bad_input, failed, keeping};
use crate::parallel::in_pieces;
use crate::studies;

/// A parameter: its name, its value and its range.
type Parameter = (String, f64, Option<(f64, f64)>);

/// The mode, the time and the state at the start, where they are not those of the system.
type Start = (Option<usize>, Option<f64>, Option<Vec<f64>>);

/// Method, tolerances (also those of components, if these have their own), longest and first step,
/// and the largest numbers of switches and steps.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Settings {
    method: String,
    rtol: f64,
    atol: f64,
    max_step: f64,
    first_step: Option<f64>,
    max_switches: usize,
    max_steps: usize,
    pub tolerances: Vec<(f64, f64)>,
}

impl Settings {
    /// The method and the options, checked.
    pub fn checked(&self) -> PyResult<(EmbeddedPair, Options)> {
        let method = self.method.parse().map_err(bad_input)?;
        let options = Options {
            rtol: self.rtol,
            atol: self.atol,
            max_step: self.max_step,
            first_step: self.first_step,
            max_switches: self.max_switches,
            max_steps: self.max_steps,
            ..Options::default()
        };
        options.validate().map_err(bad_input)?;
        Ok((method, options))
    }
}

/// A system that is made of formulas.
#[pyclass(frozen, module = "stickslip._native")]
pub struct FormulaSystem {
    pub system: System,
    /// The system ready for parameters, once it has run.
    compiled: OnceLock<Compiled>,
}

#[pymethods]
impl FormulaSystem {
    #[new]
    fn parse(text: &str) -> PyResult<Self> {
        System::parse(text).map(Self::of).map_err(|error| PyValueError::new_err(error.to_string()))
    }

    /// The system of a text whose modes all slide along the same surfaces, with these names.
    #[staticmethod]
    fn sliding(text: &str, surfaces: Vec<String>) -> PyResult<Self> {
        let read = Self::parse(text)?.system;
        let unslid = read.unslid.map_or_else(System::default, |it| *it);
        let along = unslid.surfaces.first().cloned().unwrap_or_default();
        unslid.sliding_on(&along, &surfaces).map(Self::of).map_err(bad_input)
    }

    fn text(&self) -> String {
        self.system.text()
    }

    /// The system with other names of parameters, components and modes.
    fn renamed(
        &self,
        parameters: Vec<String>,
        components: Vec<String>,
        modes: Vec<String>,
    ) -> PyResult<Self> {
        let mut system = self.system.clone();
        let counts = [system.parameters.len(), system.components.len(), system.modes.len()];
        if [parameters.len(), components.len(), modes.len()] != counts {
            return Err(bad_input(format!("expected as many names as there are: {counts:?}")));
        }
        let own = system.parameters.iter_mut().map(|it| &mut it.name);
        let own = own.chain(system.components.iter_mut().map(|it| &mut it.name));
        let own = own.chain(system.modes.iter_mut().map(|it| &mut it.name));
        let names = parameters.into_iter().chain(components).chain(modes);
        own.zip(names).for_each(|(own, name)| *own = name);
        Ok(Self::of(system))
    }

    fn parameters(&self) -> Vec<Parameter> {
        let all = self.system.parameters.iter();
        all.map(|it| (it.name.clone(), it.value, it.range)).collect()
    }

    /// Names, and whether only rules change them.
    fn components(&self) -> Vec<(String, bool)> {
        self.system.components.iter().map(|it| (it.name.clone(), it.discrete)).collect()
    }

    /// Names, with those of their rules.
    fn modes(&self) -> Vec<(String, Vec<String>)> {
        let modes = self.system.modes.iter();
        modes
            .map(|mode| {
                let rules = mode.rules.iter().enumerate();
                (mode.name.clone(), rules.map(|(place, rule)| rule.name(place)).collect())
            })
            .collect()
    }

    /// Runs the system with derivatives by parameters and by values of components at the start:
    /// times and states of events and of the end, the derivatives of times, shape (places, by), and
    /// those of states, shape (places, by, components); and rules and modes of the events.
    #[expect(clippy::too_many_arguments, reason = "they are those of Python")]
    fn sensitivities<'py>(
        &self,
        py: Python<'py>,
        by: Vec<(bool, usize)>,
        parameters: Vec<f64>,
        start: Start,
        end: Option<f64>,
        settings: Settings,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (method, options) = settings.checked()?;
        let (runnable, last) = self.started(&parameters, start.clone(), end)?;
        let by: Vec<By> = by
            .into_iter()
            .map(|(start, place)| if start { By::Start(place) } else { By::Parameter(place) })
            .collect();
        let mut system = self.system.clone();
        let (mode, s, state) = start;
        system.first = mode.unwrap_or(system.first);
        if let Some(s) = s {
            system.start = Some(system.graph.constant(s));
        }
        if let Some(state) = state {
            for (component, value) in system.components.iter_mut().zip(state) {
                component.start = system.graph.constant(value);
            }
        }
        let signals = Signals::new(progress, [runnable.start().s, last]);
        let stops = |s| signals.stop(s);
        let found = py.detach(|| {
            system.sensitivities_unless(&stops, &by, &parameters, method, end, &options)
        });
        if let Some(interrupted) = signals.raised() {
            return Err(interrupted);
        }
        let found = found.map_err(|error| match error {
            SensitivityError::Parameters(error) => bad_input(error),
            error => failed(error),
        })?;
        let columns = PyDict::new(py);
        let reals = |values: Vec<f64>| values.into_pyarray(py);
        let places = || found.places.iter();
        columns.set_item("t", reals(places().map(|it| it.s).collect()))?;
        columns.set_item("t_by", reals(places().flat_map(|it| it.s_by.clone()).collect()))?;
        columns.set_item("y", reals(places().flat_map(|it| it.state.clone()).collect()))?;
        let of_states = places().flat_map(|it| it.state_by.concat());
        columns.set_item("y_by", reals(of_states.collect()))?;
        let events = &found.recording.events;
        let rules: Vec<(usize, usize)> = events.iter().map(|it| (it.from, it.guard)).collect();
        columns.set_item("rules", rules)?;
        columns.set_item("outcome", word(found.recording.run.outcome))?;
        Ok(columns)
    }

    /// The states at the start, one row of parameters after another.
    fn starts(&self, parameters: PyReadonlyArray2<'_, f64>) -> PyResult<Vec<f64>> {
        let compiled = self.compiled()?;
        let mut states = Vec::new();
        for row in parameters.as_array().rows() {
            let runnable = compiled.with(&row.to_vec()).map_err(bad_input)?;
            states.extend_from_slice(runnable.start().state);
        }
        Ok(states)
    }

    /// Runs the system, and returns what it found as columns, with the coefficients of dense output
    /// if it is wanted, and with samples to be compared.
    #[pyo3(signature = (
        parameters, start, end, settings, times, dense, progress=None, compared=false
    ))]
    #[expect(clippy::too_many_arguments, reason = "they are those of Python")]
    fn run<'py>(
        &self,
        py: Python<'py>,
        parameters: Vec<f64>,
        start: Start,
        end: Option<f64>,
        settings: Settings,
        times: Option<PyReadonlyArray1<'py, f64>>,
        dense: bool,
        progress: Option<Py<PyAny>>,
        compared: bool,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (runnable, end) = self.started(&parameters, start, end)?;
        let (method, options) = settings.checked()?;
        let times = times.map(|times| numbers(&times)).transpose()?;
        let runnable = runnable.with_tolerances(settings.tolerances).map_err(bad_input)?;
        let signals = Signals::new(progress, [runnable.start().s, end]);
        let stops = |s| signals.stop(s);
        let found = py.detach(|| runnable.record_unless(&stops, method, end, &options));
        let (found, interrupted) = match (found, signals.raised()) {
            (Ok(found), interrupted) => (found, interrupted),
            (Err(_), Some(interrupted)) => return Err(interrupted),
            (Err(error), None) => return Err(failed(self.system.explained(&error))),
        };
        let columns = columns(py, &self.system, &found, times, dense)?;
        if compared {
            let samples = samples(found.steps(), found.run.state.len());
            columns.set_item(intern!(py, "samples"), samples)?;
        }
        // As of functions of Python: with the stages of dense output, and a look at the start.
        let stages = if method == EmbeddedPair::Dop853 { 3 } else { 0 };
        let work = found.run.statistics.field + stages * found.steps().len() + 1;
        columns.set_item(intern!(py, "nfev"), work)?;
        match interrupted {
            Some(error) => Err(keeping(py, error, || Ok(columns.clone().into_any()))),
            None => Ok(columns),
        }
    }

    /// The study of how accurate a run is. `name` is that of the system in titles.
    #[pyo3(signature = (name, parameters, start, end, threads, progress=None))]
    #[expect(clippy::too_many_arguments, reason = "they are those of Python")]
    fn converge<'py>(
        &self,
        py: Python<'py>,
        name: String,
        parameters: Vec<f64>,
        start: Start,
        end: Option<f64>,
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (runnable, end) = self.started(&parameters, start, end)?;
        let settings =
            own_system::OwnSystemSettings { name, system: self.system.clone(), runnable, end };
        studies::run(py, threads, progress.as_ref(), move |report| {
            let measured = own_system::run(&settings, report)?;
            Ok::<_, StudyError>((measured.study(), pictures::own_system::draw(&measured)))
        })
    }
}

impl FormulaSystem {
    pub fn of(system: System) -> Self {
        Self { system, compiled: OnceLock::new() }
    }

    /// The system ready for parameters. It is compiled once.
    pub fn compiled(&self) -> PyResult<&Compiled> {
        if let Some(compiled) = self.compiled.get() {
            return Ok(compiled);
        }
        let compiled = self.system.compile().map_err(bad_input)?;
        Ok(self.compiled.get_or_init(|| compiled))
    }

    /// The system with its parameters and its start, and the end of its run.
    fn started(
        &self,
        parameters: &[f64],
        (mode, s, state): Start,
        end: Option<f64>,
    ) -> PyResult<(Runnable, f64)> {
        let runnable = self.compiled()?.with(parameters).map_err(bad_input)?;
        let runnable = runnable.starting(mode, s, state.as_deref()).map_err(bad_input)?;
        let end = end.unwrap_or(runnable.end());
        if end.is_nan() || end <= runnable.start().s {
            let s = runnable.start().s;
            return Err(bad_input(format!("the run ends at {end}; expected an end after {s}")));
        }
        if end.is_infinite() && !self.system.ends_itself() {
            return Err(bad_input(
                "the system has no end and no rule that ends it; expected t_span",
            ));
        }
        Ok((runnable, end))
    }
}

/// Why a run ended, in a word.
pub fn word(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::ReachedEnd => "reached_end",
        Outcome::EndedByGuard { .. } => "ended_by_guard",
        Outcome::SwitchLimit => "switch_limit",
        Outcome::Zeno { .. } => "zeno",
        Outcome::StepLimit | Outcome::Stopped => "step_limit",
    }
}

/// What a run found, as `hybrid::record` has it.
fn columns<'py>(
    py: Python<'py>,
    system: &System,
    found: &Recording,
    times: Option<Vec<f64>>,
    dense: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let columns = PyDict::new(py);
    let (steps, n) = (found.steps(), found.run.state.len());
    let most = times.as_ref().map_or(steps.len() + found.events.len(), Vec::len) + 1;
    let (mut t, mut modes) = (Vec::with_capacity(most), Vec::with_capacity(most));
    let mut y = Vec::with_capacity(most * n);
    let mut point = |s: f64, mode: usize, state: &[f64]| {
        t.push(s);
        modes.push(mode);
        y.extend_from_slice(state);
    };
    if let Some(times) = times {
        // A run that ends early ends with a point, whatever times are wanted.
        let last = times.iter().any(|&s| s > found.run.s).then_some(found.run.s);
        let wanted = times.into_iter().take_while(|&s| s <= found.run.s).chain(last);
        let wanted: Vec<f64> = wanted.collect();
        in_pieces(py, wanted.len(), None, |piece| {
            for &s in &wanted[piece] {
                if let Some(state) = found.at(s) {
                    point(s, found.mode_at(s), &state);
                }
            }
            Ok(())
        })?;
    } else {
        let changes = |it: &&DynamicSwitch<usize>| it.before != it.after;
        let mut events = found.events.iter().filter(changes).peekable();
        for step in steps {
            while let Some(event) = events.next_if(|event| event.s <= step.s) {
                point(event.s, event.from, &event.before);
            }
            point(step.s, step.mode, &step.coefficients[..n]);
        }
        events.for_each(|event| point(event.s, event.from, &event.before));
        point(found.run.s, found.run.mode, &found.run.state);
    }
    columns.set_item(intern!(py, "t"), t.into_pyarray(py))?;
    columns.set_item(intern!(py, "y"), y.into_pyarray(py))?;
    columns.set_item(intern!(py, "modes"), modes.into_pyarray(py))?;
    let events = &found.events;
    let numbers = |of: fn(&DynamicSwitch<usize>) -> usize| {
        events.iter().map(of).collect::<Vec<_>>().into_pyarray(py)
    };
    let reals = |values: Vec<f64>| -> Bound<'py, PyArray1<f64>> { values.into_pyarray(py) };
    columns.set_item(intern!(py, "event_times"), reals(events.iter().map(|it| it.s).collect()))?;
    columns.set_item(intern!(py, "event_guards"), numbers(|it| it.guard))?;
    columns.set_item(intern!(py, "event_from"), numbers(|it| it.from))?;
    columns.set_item(intern!(py, "event_to"), numbers(|it| it.to))?;
    columns.set_item(
        intern!(py, "event_flatness"),
        reals(events.iter().map(|it| it.flatness).collect()),
    )?;
    let jumps: Vec<bool> = events.iter().map(|it| it.jump).collect();
    columns.set_item(intern!(py, "event_jump"), jumps.into_pyarray(py))?;
    let together: Vec<_> = events.iter().map(|it| it.simultaneous.clone()).collect();
    columns.set_item(intern!(py, "event_simultaneous"), together)?;
    let states = |of: fn(&DynamicSwitch<usize>) -> &Vec<f64>| {
        reals(events.iter().flat_map(|it| of(it).iter().copied()).collect())
    };
    columns.set_item(intern!(py, "event_before"), states(|it| &it.before))?;
    columns.set_item(intern!(py, "event_after"), states(|it| &it.after))?;
    let touches: Vec<_> =
        found.touches.iter().map(|it| (it.s, it.mode, it.guard, it.margin)).collect();
    columns.set_item(intern!(py, "touches"), touches)?;
    let poles: Vec<_> = found.poles.iter().map(|it| (it.s, it.mode, it.guard)).collect();
    columns.set_item(intern!(py, "poles"), poles)?;
    let preempted: Vec<_> = found.preempted.iter().map(|it| (it.s, it.mode, it.guard)).collect();
    columns.set_item(intern!(py, "preempted"), preempted)?;
    let rests = found.rests.iter().map(|it| (it.s, it.error, it.guard, it.from, it.to));
    columns.set_item(intern!(py, "rests"), rests.collect::<Vec<_>>())?;
    if dense {
        columns.set_item(intern!(py, "starts"), reals(steps.iter().map(|it| it.s).collect()))?;
        columns.set_item(intern!(py, "sizes"), reals(steps.iter().map(|it| it.h).collect()))?;
        let step_modes: Vec<usize> = steps.iter().map(|it| it.mode).collect();
        columns.set_item(intern!(py, "segment_modes"), step_modes.into_pyarray(py))?;
        let count = steps.iter().map(|it| it.coefficients.len()).sum();
        let mut coefficients = Vec::with_capacity(count);
        for step in steps {
            coefficients.extend_from_slice(&step.coefficients);
        }
        columns.set_item(intern!(py, "coefficients"), reals(coefficients))?;
    }
    columns.set_item(intern!(py, "start_time"), found.start())?;
    columns.set_item(intern!(py, "end_time"), found.run.s)?;
    columns.set_item(intern!(py, "end_mode"), found.run.mode)?;
    columns.set_item(intern!(py, "end_state"), reals(found.run.state.clone()))?;
    columns.set_item(intern!(py, "decided"), found.run.decided)?;
    ending(&columns, system, found)?;
    columns.set_item(intern!(py, "statistics"), statistics(py, &found.run.statistics)?)?;
    Ok(columns)
}

/// The work of a run, by name.
fn statistics<'py>(py: Python<'py>, work: &Statistics) -> PyResult<Bound<'py, PyDict>> {
    let statistics = PyDict::new(py);
    for (name, value) in [
        (intern!(py, "accepted"), work.accepted),
        (intern!(py, "rejected"), work.rejected),
        (intern!(py, "too_coarse"), work.too_coarse),
        (intern!(py, "field"), work.field),
        (intern!(py, "guards"), work.guards),
        (intern!(py, "resteps"), work.resteps),
        (intern!(py, "isolations"), work.isolations),
        (intern!(py, "switches"), work.switches),
    ] {
        statistics.set_item(name, value)?;
    }
    Ok(statistics)
}

/// Times, modes and states within a few steps, at no events.
fn samples(steps: &[DynamicSegment<usize>], n: usize) -> Vec<(f64, usize, Vec<f64>)> {
    const PLACES: usize = 8;
    /// An irrational part of a step.
    const PART: f64 = 0.61803;
    let last = steps.len().saturating_sub(1);
    let count = steps.len().min(PLACES);
    let chosen = (0..count).map(|place| &steps[place * last / count.saturating_sub(1).max(1)]);
    let sample = |step: &DynamicSegment<usize>| {
        let s = step.s + PART * step.h;
        (s, step.mode, step.at(s, n))
    };
    chosen.map(sample).collect()
}

/// How the run ended.
fn ending(columns: &Bound<'_, PyDict>, system: &System, found: &Recording) -> PyResult<()> {
    let (py, s) = (columns.py(), found.run.s);
    let (status, accumulation, message) = match found.run.outcome {
        Outcome::ReachedEnd => (0, None, "The end was reached.".to_owned()),
        Outcome::EndedByGuard { guard } => {
            let rule = system.modes[found.run.mode].rules[guard].name(guard);
            (1, None, format!("At t = {s:?}, rule {rule:?} ended the run."))
        }
        Outcome::SwitchLimit => {
            (-1, None, format!("Stopped at t = {s:?}: max_switches was reached."))
        }
        Outcome::Zeno { accumulation } => {
            let message =
                format!("Stopped at t = {s:?}: the switches accumulate at {accumulation:?}.");
            (-1, Some(accumulation), message)
        }
        Outcome::StepLimit | Outcome::Stopped => {
            (-1, None, format!("Stopped at t = {s:?}: too many steps."))
        }
    };
    columns.set_item(intern!(py, "outcome"), word(found.run.outcome))?;
    columns.set_item(intern!(py, "status"), status)?;
    columns.set_item(intern!(py, "accumulation"), accumulation)?;
    columns.set_item(intern!(py, "message"), message)
}
