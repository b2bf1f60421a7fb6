//! Stacks of families: atlases over a third parameter.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex};

use pyo3::prelude::*;
use stickslip_tracer::{
    AtlasOptions,
    hybrid::Itinerary,
    stack::{Change, Layer, Stack, StackOptions},
};

use crate::failure::bad_input;
use crate::families::atlas::{FamilyAtlas, Label, expect_like, label};
use crate::families::failure::{of_trace, with_value};
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
    let mut atlas: AtlasOptions = serde_json::from_str(options.0).map_err(bad_input)?;
    // A stack follows boundaries up to the window's edges.
    atlas.trace.beyond = 0.0;
    let options = StackOptions { atlas, width: options.1, atlases: options.2 };
    let families = Families::new(py, function, &values)?;
    let threads = families.first.get().threads(threads);
    let trouble = families.trouble.clone();
    let found = watched(py, &trouble, threads, &callbacks, |executor, watch| {
        let family = |value| families.runner(value, threads.is_none());
        Stack::watched(family, &window_of(window), &values, &options, executor, watch)
    });
    let (made, wish) = found.map_err(|error| with_value(py, error, lock(&families.kept).value))?;
    let stack = made.map_err(|error| of_trace(py, &error))?;
    let objection = stack.objection();
    let Stack { layers, changes, atlases, finished, .. } = stack;
    let of_layer = |layer: Layer<_, _>| {
        let names = families.at(py, layer.value)?.get().names.clone();
        Ok(FamilyAtlas::new(layer.atlas, options.atlas, names))
    };
    let layers = layers.into_iter().map(of_layer).collect::<PyResult<_>>()?;
    let changes = changes.iter().map(fields).collect();
    let wish = wish.map(|error| error.into_value(py).into_any());
    Ok((layers, changes, atlases, finished, objection, wish))
}

/// The families over the third parameter.
struct Families {
    function: Py<PyAny>,
    first: Py<HybridFamily>,
    /// The values at which atlases stay.
    values: Vec<f64>,
    kept: Mutex<Kept>,
    trouble: Arc<Trouble>,
}

/// Families that are likely to be asked for again.
struct Kept {
    /// Those of layers, and the last other ones.
    families: VecDeque<(f64, Py<HybridFamily>)>,
    /// The value that was asked for last.
    value: f64,
}

impl Families {
    fn new(py: Python<'_>, function: Py<PyAny>, values: &[f64]) -> PyResult<Self> {
        let Some(&value) = values.first() else {
            return Err(bad_input("values are empty; expected two or more"));
        };
        let first = made(py, &function, value).map_err(|error| with_value(py, error, value))?;
        let families = VecDeque::from([(value, first.clone_ref(py))]);
        let kept = Mutex::new(Kept { families, value });
        let trouble = Arc::new(Trouble::patient());
        Ok(Self { function, first, values: values.to_vec(), kept, trouble })
    }

    /// The family at a value.
    #[expect(clippy::float_cmp, reason = "the same value is asked for again")]
    fn at(&self, py: Python<'_>, value: f64) -> PyResult<Py<HybridFamily>> {
        /// The number of families that are not those of layers.
        const RECENT: usize = 4;
        {
            let mut kept = lock(&self.kept);
            kept.value = value;
            if let Some((_, known)) = kept.families.iter().find(|(own, _)| *own == value) {
                return Ok(known.clone_ref(py));
            }
        }
        let family = made(py, &self.function, value)?;
        let first = self.first.get();
        expect_like(&family.get().names, &first.names)?;
        if first.made.is_compiled() && !family.get().made.is_compiled() {
            return Err(bad_input(
                "the family has functions of Python; expected compiled ones, as in the first one",
            ));
        }
        let families = &mut lock(&self.kept).families;
        families.push_back((value, family.clone_ref(py)));
        let is_recent = |(own, _): &(f64, _)| !self.values.contains(own);
        if families.iter().filter(|one| is_recent(one)).count() > RECENT
            && let Some(oldest) = families.iter().position(is_recent)
        {
            families.remove(oldest);
        }
        Ok(family)
    }

    /// The runs of the family at a value. If there is none, they fail. An interruption that only
    /// asks for an end does not spoil the call, which is repeated.
    fn runner(&self, value: f64, looks: bool) -> Runner {
        let made = Python::attach(|py| {
            while !self.trouble.has_failed() {
                match self.at(py, value) {
                    Ok(family) => return family.get().made.clone(),
                    Err(error) => {
                        if let Some(error) = self.trouble.postpone(error) {
                            self.trouble.fail(error);
                        }
                    }
                }
            }
            self.first.get().made.clone()
        });
        Runner::new(&made, self.trouble.clone(), looks)
    }
}

/// Calls the function of Python that makes families.
fn made(py: Python<'_>, function: &Py<PyAny>, value: f64) -> PyResult<Py<HybridFamily>> {
    Ok(function.call1(py, (value,))?.extract(py)?)
}

/// A change as Python gets it.
fn fields(change: &Change<Itinerary>) -> ChangeFields {
    let meeting = change
        .meeting
        .map(|meeting| (meeting.kind.name(), meeting.value, meeting.point.x, meeting.point.y));
    let effects = change.effects.iter().map(|effect| (effect.name(), label(effect.label())));
    (change.between, meeting, change.is_doubtful(), effects.collect())
}
