//! What Python calls of a family.

use std::ops::Range;
use std::sync::Arc;

use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use rayon::prelude::*;
use stickslip_expression::{RuleOrder, SystemFamily};
use stickslip_plane::progress::{Progress, Report};
use stickslip_tracer::{
    Accumulation, AtlasOptions, Family, Point, RunNames, TraceOptions, Watch, Window,
    tracing::{Monitor, follow},
};

use crate::background::watched;
use crate::failure::{bad_input, failed};
use crate::families::atlas::{
    Description, FamilyAtlas, Label, expect, followed, label, place, points,
};
use crate::families::blueprint::Blueprint;
use crate::families::failure::of_trace;
use crate::families::runner::{Made, Runner};
use crate::families::survey::{self, Callbacks, survey};
use crate::formulas::{FormulaSystem, Settings as FormulaSettings};
use crate::hybrid::Level;
use crate::hybrid::arguments::{
    ChangeArguments, FunctionArguments, Settings, StartArguments, SystemArguments,
};
use crate::hybrid::trouble::Trouble;
use crate::parallel::Threads;

/// A margin: the guards that have fired before, the guard, the name of the place, and the value.
type MarginFields = (Vec<usize>, usize, &'static str, f64);

/// A family of systems of one's own.
#[pyclass(frozen, module = "stickslip._native")]
pub struct HybridFamily {
    pub made: Made,
    pub names: RunNames,
}

#[pymethods]
impl HybridFamily {
    /// A family with a system whose modes all have the guards of the family, the start, what
    /// changes it and what it requires, the end, and what files say about it.
    #[new]
    fn new(
        py: Python<'_>,
        system: SystemArguments,
        args: Bound<'_, PyTuple>,
        start: (StartArguments<'_>, ChangeArguments, Vec<FunctionArguments>),
        end: f64,
        settings: Settings,
        description: Description,
    ) -> PyResult<Self> {
        let blueprint = Blueprint::new(py, system, &args, start, end, &settings)?;
        let events = blueprint.options.max_switches;
        Ok(Self { made: Made::Functions(Arc::new(blueprint), events), names: description.into() })
    }

    /// The family of a system of formulas over two of its parameters, with the values of all, the
    /// end unless the system has one, what files say about it, a name and those of the axes, and
    /// the names of the guards with their places in each mode, unless these follow from the system.
    #[staticmethod]
    fn of_formulas(
        system: &FormulaSystem,
        axes: [usize; 2],
        parameters: Vec<f64>,
        end: Option<f64>,
        settings: FormulaSettings,
        names: (String, [String; 2]),
        order: Option<(Vec<String>, Vec<Vec<usize>>)>,
    ) -> PyResult<Self> {
        let (name, names) = names;
        let order = order.map(|(names, places)| RuleOrder { names, places });
        let order = order.unwrap_or_else(|| RuleOrder::of(&system.system));
        let (_, options) = settings.checked()?;
        let family =
            SystemFamily::ordered(&system.system, order, axes, &parameters, (end, options));
        let family = family.map_err(bad_input)?;
        let guards = family.rules().to_vec();
        let names = RunNames { family: name, axes: names, guards };
        Ok(Self { made: Made::Formulas(Arc::new(family)), names })
    }

    /// The names of the guards.
    fn guards(&self) -> Vec<String> {
        self.names.guards.clone()
    }

    /// Whether events accumulate in runs of a window: the events up to which they should be told
    /// apart, and in how many of how many runs.
    fn accumulation(
        &self,
        py: Python<'_>,
        window: ((f64, f64), (f64, f64)),
    ) -> PyResult<Option<(usize, usize, usize)>> {
        let _level = Level::enter()?;
        let few = self.up_to(Accumulation::EVENTS);
        let window = window_of(window);
        let found =
            few.by_runs(py, (1, None), move |runner, _| Accumulation::seen(runner, &window))?;
        Ok(found.map(|it| (it.events, it.runs, it.of)))
    }

    /// The same family, whose runs are told apart up to so many events.
    fn up_to(&self, events: usize) -> Self {
        Self { made: self.made.up_to(events), names: self.names.clone() }
    }

    /// Traces the boundaries between two values of each parameter. Returns the atlas, and an
    /// exception that has ended the trace early.
    fn trace(
        &self,
        py: Python<'_>,
        window: ((f64, f64), (f64, f64)),
        options: &str,
        threads: usize,
        callbacks: Callbacks,
    ) -> PyResult<(FamilyAtlas, Option<Py<PyAny>>)> {
        let _level = Level::enter()?;
        let options: AtlasOptions = serde_json::from_str(options).map_err(bad_input)?;
        let (window, trouble) = (window_of(window), Trouble::patient());
        let threads = self.threads(threads);
        let runner = self.runner(trouble, threads.is_none());
        let (atlas, wish) =
            survey(py, &runner, options, threads, &callbacks, |surveyor, runner| {
                surveyor.atlas(runner, &window)
            })?;
        let atlas = FamilyAtlas::new(atlas, options, self.names.clone());
        Ok((atlas, wish.map(|error| error.into_value(py).into_any())))
    }

    /// Goes on with an atlas that was cancelled.
    fn resume(
        &self,
        py: Python<'_>,
        atlas: &FamilyAtlas,
        threads: usize,
        callbacks: Callbacks,
    ) -> PyResult<(FamilyAtlas, Option<Py<PyAny>>)> {
        let _level = Level::enter()?;
        expect(&atlas.names, &self.names)?;
        let threads = self.threads(threads);
        let runner = self.runner(Trouble::patient(), threads.is_none());
        let (begun, options) = (&atlas.atlas, atlas.options);
        let (atlas, wish) =
            survey(py, &runner, options, threads, &callbacks, |surveyor, runner| {
                surveyor.resume(runner, begun.clone())
            })?;
        let atlas = FamilyAtlas::new(atlas, options, self.names.clone());
        Ok((atlas, wish.map(|error| error.into_value(py).into_any())))
    }

    /// The labels of the runs at points.
    fn labels(
        &self,
        py: Python<'_>,
        x: PyReadonlyArray1<'_, f64>,
        y: PyReadonlyArray1<'_, f64>,
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Vec<Label>> {
        let _level = Level::enter()?;
        self.labels_at(py, &points(&x, &y)?, threads, progress)
    }

    /// The labels of points of an atlas, by runs where its regions do not tell them; `None` outside
    /// its window.
    fn decide(
        &self,
        py: Python<'_>,
        atlas: &FamilyAtlas,
        x: PyReadonlyArray1<'_, f64>,
        y: PyReadonlyArray1<'_, f64>,
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Vec<Option<Label>>> {
        expect(&atlas.names, &self.names)?;
        let points = points(&x, &y)?;
        let (mut labels, open) = atlas.told(&points);
        let places: Vec<Point> = open.iter().map(|&index| points[index]).collect();
        let found = self.labels_at(py, &places, threads, progress)?;
        for (index, found) in open.into_iter().zip(found) {
            labels[index] = Some(found);
        }
        Ok(labels)
    }

    /// The margins of the run at a point: the guards that have fired before, the guard, the name of
    /// the place, and the value.
    fn margins(&self, py: Python<'_>, x: f64, y: f64) -> PyResult<(Label, Vec<MarginFields>)> {
        let _level = Level::enter()?;
        let point = Point::new(x, y);
        let found = self.by_runs(py, (1, None), move |runner, _| runner.free_run(&point))?;
        let found = found.map_err(bad_input)?;
        let margins = found.margins.into_iter().map(|(margin, value)| {
            let exits = margin.exits.iter().map(|exit| exit.guard).collect();
            (exits, margin.guard, place(&margin), value)
        });
        Ok((label(&found.label), margins.collect()))
    }

    /// The boundary between two points of a window, with monitors; `None` if there is none.
    fn follow<'py>(
        &self,
        py: Python<'py>,
        window: ((f64, f64), (f64, f64)),
        options: &str,
        between: ((f64, f64), (f64, f64)),
        monitors: Vec<Py<PyAny>>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Option<Bound<'py, PyDict>>> {
        let _level = Level::enter()?;
        let options: TraceOptions = serde_json::from_str(options).map_err(bad_input)?;
        let between = [between.0, between.1].map(|(x, y)| Point::new(x, y));
        let threads = self.threads(1);
        let runner = self.runner(Trouble::default(), threads.is_none());
        let trouble = runner.trouble();
        let monitor = |function: &Py<PyAny>, point: &Point| {
            if trouble.has_failed() {
                return f64::NAN;
            }
            let value = Python::attach(|py| function.call1(py, (point.x, point.y))?.extract(py));
            value.unwrap_or_else(|error| {
                trouble.fail(error);
                f64::NAN
            })
        };
        let work = |_, watch: Watch<'_>| {
            let monitors: Vec<_> =
                monitors.iter().map(|one| move |point: &Point| monitor(one, point)).collect();
            let monitors: Vec<_> = monitors.iter().map(|one| one as Monitor<'_>).collect();
            follow(&runner, &window_of(window), &options, &between, &monitors, watch)
        };
        let (found, wish) =
            survey::watched(py, trouble, threads, &Callbacks::telling(progress), work)?;
        if let Some(error) = wish {
            return Err(error);
        }
        let Some(found) = found.map_err(|error| of_trace(py, &error))? else { return Ok(None) };
        Ok(Some(followed(py, &found)?))
    }
}

impl HybridFamily {
    /// The threads that the runs may have; `None` if they need this one.
    pub fn threads(&self, threads: usize) -> Option<usize> {
        self.made.is_compiled().then_some(threads)
    }

    /// What `work` makes of runs, of which it may report the steps, on so many threads. If no run
    /// needs this thread, Ctrl-C does not wait for the one that is under way.
    fn by_runs<T: Send + 'static>(
        &self,
        py: Python<'_>,
        (threads, progress): (usize, Option<&Py<PyAny>>),
        work: impl FnOnce(&Runner, Report<'_>) -> T + Send + 'static,
    ) -> PyResult<T> {
        let trouble = Arc::new(Trouble::default());
        let runner = Runner::new(&self.made, Arc::clone(&trouble), !self.made.is_compiled());
        let found = if self.made.is_compiled() {
            watched(py, threads, progress, move |report| work(&runner, report))
        } else {
            Ok(work(&runner, &|_| ()))
        };
        if let Some(error) = trouble.take_failure() {
            return Err(error);
        }
        if found.is_err() {
            // Nobody waits for the runs that would follow.
            trouble.fail(failed("abandoned"));
        }
        found
    }

    fn runner(&self, trouble: Trouble, looks: bool) -> Runner {
        Runner::new(&self.made, Arc::new(trouble), looks)
    }

    /// The labels of the runs at points.
    fn labels_at(
        &self,
        py: Python<'_>,
        points: &[Point],
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Vec<Label>> {
        if self.made.is_compiled() {
            let points = points.to_vec();
            let found = self.by_runs(py, (threads, progress.as_ref()), move |runner, report| {
                report(Progress::Begin { steps: points.len() });
                let one = |point: &Point| {
                    let found = runner.label(point).map(|one| label(&one));
                    report(Progress::Advance { steps: 1 });
                    found
                };
                points.par_iter().map(one).collect::<Vec<_>>()
            })?;
            return found.into_iter().collect::<Result<_, _>>().map_err(bad_input);
        }
        let runner = self.runner(Trouble::default(), true);
        let mut labels = Vec::with_capacity(points.len());
        let work = |part: Range<usize>| {
            let labels =
                points[part].iter().map(|point| runner.label(point).map(|one| label(&one)));
            labels.collect::<Result<Vec<_>, _>>()
        };
        let threads = Threads::new(1, points.len())?.telling(progress);
        threads.each(py, points.len(), work, |part| {
            labels.extend(part.map_err(|error| runner.why(&error))?);
            Ok(())
        })?;
        if labels.len() == points.len() { Ok(labels) } else { Err(failed("labels are missing")) }
    }
}

/// The window between two values of each parameter.
pub fn window_of(((left, right), (bottom, top)): ((f64, f64), (f64, f64))) -> Window {
    Window { low: Point::new(left, bottom), high: Point::new(right, top) }
}
