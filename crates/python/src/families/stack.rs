//! Stacks of families: atlases over a third parameter.

use std::collections::HashMap;
use std::sync::{Arc, Mutex};

use pyo3::prelude::*;
use stickslip_tracer::{AtlasOptions, Change, Effect, Itinerary, MeetingKind, Stack, StackOptions};

use crate::failure::bad_input;
use crate::families::atlas::{FamilyAtlas, Label, label};
use crate::families::blueprint::Blueprint;
use crate::families::failure::{of_stack, with_value};
use crate::families::family::{HybridFamily, window_of};
use crate::families::runner::Runner;
use crate::families::survey::{Callbacks, watched};
use crate::hybrid::Level;
use crate::hybrid::trouble::{Trouble, lock};

/// A change: between which values, what happens where (value, x, y), whether it is in doubt, and
/// what becomes of regions.
type ChangeFields =
    ([f64; 2], Option<(&'static str, f64, f64, f64)>, bool, Vec<(&'static str, Label)>);

/// The atlases at the values, the changes, the number of atlases that were traced, whether the
/// search came to its end, what speaks against the stack, and an exception that has ended it early.
type StackFields =
    (Vec<FamilyAtlas>, Vec<ChangeFields>, usize, bool, Option<String>, Option<Py<PyAny>>);

/// Atlases of the families that `function` returns at `values` of a third parameter, and what
/// changes between them.
#[pyfunction]
pub fn stack_family(
    py: Python<'_>,
    function: Py<PyAny>,
    window: ((f64, f64), (f64, f64)),
    values: Vec<f64>,
    options: (&str, f64, usize),
    threads: usize,
    callbacks: Callbacks,
) -> PyResult<StackFields> {
    let _level = Level::enter()?;
    let atlas: AtlasOptions = serde_json::from_str(options.0).map_err(bad_input)?;
    let options = StackOptions { atlas, width: options.1, atlases: options.2 };
    let Some(&start) = values.first() else {
        return Err(bad_input("values are empty; expected two or more"));
    };
    let families = Families::new(py, function, start)?;
    let threads = families.first.get().threads(threads);
    let trouble = families.trouble.clone();
    let (made, wish) = watched(py, &trouble, threads, &callbacks, |executor, watch| {
        let family = |value| families.runner(value, threads.is_none());
        Stack::watched(family, &window_of(window), &values, &options, executor, watch)
    })?;
    let stack = made.map_err(|error| of_stack(py, &error))?;
    let objection = stack.objection();
    let Stack { layers, changes, atlases, finished, .. } = stack;
    let of_layer = |layer: stickslip_tracer::Layer<_, _>| {
        let description = families.at(py, layer.value)?.get().description.clone();
        Ok(FamilyAtlas::new(layer.atlas, options.atlas, description))
    };
    let layers = layers.into_iter().map(of_layer).collect::<PyResult<_>>()?;
    let changes = changes.iter().map(fields).collect();
    let wish = wish.map(|error| error.into_value(py).into_any());
    Ok((layers, changes, atlases, finished, objection, wish))
}

/// The families over the third parameter, each of which is made once.
struct Families {
    function: Py<PyAny>,
    first: Py<HybridFamily>,
    made: Mutex<HashMap<u64, Py<HybridFamily>>>,
    trouble: Arc<Trouble>,
}

impl Families {
    fn new(py: Python<'_>, function: Py<PyAny>, start: f64) -> PyResult<Self> {
        let first = made(py, &function, start)?;
        let trouble = Arc::new(Trouble::patient());
        let made = Mutex::new(HashMap::from([(start.to_bits(), first.clone_ref(py))]));
        Ok(Self { function, first, made, trouble })
    }

    /// The family at a value.
    fn at(&self, py: Python<'_>, value: f64) -> PyResult<Py<HybridFamily>> {
        if let Some(known) = lock(&self.made).get(&value.to_bits()) {
            return Ok(known.clone_ref(py));
        }
        let family = made(py, &self.function, value)?;
        let first = self.first.get();
        let is_like = family.get().description.expect_like(&first.description);
        is_like.map_err(|error| with_value(py, error, value))?;
        let compiled = |family: &HybridFamily| family.blueprint.is_compiled();
        if compiled(first) && !compiled(family.get()) {
            return Err(bad_input(format!(
                "the family at {value:?} has functions of Python; expected compiled ones, as in \
                 the first one"
            )));
        }
        lock(&self.made).insert(value.to_bits(), family.clone_ref(py));
        Ok(family)
    }

    /// The runs of the family at a value. If there is none, they fail.
    fn runner(&self, value: f64, looks: bool) -> Runner {
        let blueprint: Arc<Blueprint> = Python::attach(|py| {
            let found = if self.trouble.has_failed() { None } else { Some(self.at(py, value)) };
            let family = match found {
                Some(Ok(family)) => family,
                Some(Err(error)) => {
                    self.trouble.fail(error);
                    self.first.clone_ref(py)
                }
                None => self.first.clone_ref(py),
            };
            family.get().blueprint.clone()
        });
        Runner::new(&blueprint, self.trouble.clone(), looks)
    }
}

/// Calls the function of Python that makes families.
fn made(py: Python<'_>, function: &Py<PyAny>, value: f64) -> PyResult<Py<HybridFamily>> {
    let made = function.call1(py, (value,)).map_err(|error| with_value(py, error, value))?;
    Ok(made.extract(py)?)
}

/// A change as Python gets it.
fn fields(change: &Change<Itinerary>) -> ChangeFields {
    let meeting = change.meeting.map(|meeting| {
        let kind = match meeting.kind {
            MeetingKind::Crossing => "crossing",
            MeetingKind::Touch => "touch",
            MeetingKind::Flat => "flat",
            MeetingKind::Edge => "edge",
            MeetingKind::EdgeTouch => "edge-touch",
            MeetingKind::Corner => "corner",
            MeetingKind::Swallowtail => "swallowtail",
        };
        (kind, meeting.value, meeting.point.x, meeting.point.y)
    });
    let effects = change.effects.iter().map(|effect| match effect {
        Effect::Born(region) => ("born", label(region)),
        Effect::Dies(region) => ("dies", label(region)),
        Effect::Merge(region) => ("merge", label(region)),
        Effect::Splits(region) => ("splits", label(region)),
    });
    (change.between, meeting, change.doubtful || change.meeting.is_none(), effects.collect())
}
