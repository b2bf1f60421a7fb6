//! Atlases of a family with a third parameter, and where their structure changes.
//!
//! Atlases are made at the given values, and neighbours are compared as graphs of labelled regions.
//! Where two neighbours differ, candidates are stretches of the arrangement around these regions
//! whose ends may meet: three conditions, which Newton's method solves for the place and the value.
//! A solution counts if atlases on both sides of it agree with runs and differ. Otherwise the
//! interval is bisected. Then both rests are searched in the same way.
//!
//! In reading order:
//!
//! - `structure`: atlases compared as planar graphs with labels
//! - `candidates`: which codimension-2 points may have met between two atlases
//! - `conditions`: what holds where they meet
//! - `meeting`: where that is, by Newton's method in all three parameters
//! - `change`: what a change does to the regions
//! - `search`: how changes are isolated
//! - `document`: the file of a stack (feature `serde`)

mod candidates;
pub(crate) mod change;
pub(crate) mod conditions;
#[cfg(feature = "serde")]
pub(crate) mod document;
pub(crate) mod meeting;
mod search;
mod structure;

pub use change::{Change, Effect};
pub use conditions::MeetingKind;
#[cfg(feature = "serde")]
pub use document::{LayerDocument, StackDocument};
pub use meeting::StackMeeting;

use std::fmt::Debug;

use crate::atlas::{Atlas, AtlasOptions};
use crate::executor::{Executor, Serial};
use crate::family::Family;
use crate::options::TraceError;
use crate::stack::search::Search;
use crate::stack::structure::Structure;
use crate::survey::Surveyor;
use crate::watch::{Progress, Watch};
use crate::window::Window;

/// The options of a [`Stack`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StackOptions {
    /// The options of every atlas. Boundaries are followed up to the window's edges only.
    pub atlas: AtlasOptions,
    /// The width of the bracket in which a change is isolated, relative to the greater one of the
    /// two values, from 1e-9 to 0.1. Around a change that is solved for, the bracket is wider if
    /// narrower ones have atlases that are in doubt, up to 100 widths, or in which a region is too
    /// small to be seen, up to 450 widths.
    pub width: f64,
    /// The greatest number of atlases. Changes for which no atlases are left are brackets in doubt.
    pub atlases: usize,
}

impl Default for StackOptions {
    fn default() -> Self {
        Self { atlas: AtlasOptions::default(), width: 1e-5, atlases: 2000 }
    }
}

/// Atlases of a family at several values of a third parameter, and the changes of their structure
/// between these values.
///
/// Atlases have the same structure if their regions form planar graphs that do not differ in
/// labels. Where neighbours differ, atlases between them isolate each change. What changes is the
/// way in which codimension-2 points are connected, so two of them meet, or one meets the edge of
/// the window, or a boundary touches another one or the edge, or shrinks to a point. Three
/// conditions hold there, which Newton's method solves for the place and the value. A solution
/// counts only if the atlases on both sides of it differ in structure. Changes that undo each other
/// between two values at which there is an atlas are not seen.
///
/// ```
/// use std::convert::Infallible;
/// use stickslip_tracer::{Family, FreeRun, Point, Window, stack::{Stack, StackOptions}};
///
/// /// A guard that fires inside a circle, whose radius is the third parameter.
/// struct Disc(f64);
///
/// impl Family for Disc {
///     type Label = bool;
///     type Margin = ();
///     type Error = Infallible;
///     fn label(&self, p: &Point) -> Result<bool, Infallible> {
///         Ok(p.norm() < self.0)
///     }
///     fn margin(&self, p: &Point, (): &()) -> Result<Option<f64>, Infallible> {
///         Ok(Some(p.norm_squared() - self.0 * self.0))
///     }
///     fn free_run(&self, p: &Point) -> Result<FreeRun<bool, ()>, Infallible> {
///         Ok(FreeRun { label: self.label(p)?, margins: vec![((), p.norm_squared() - self.0 * self.0)] })
///     }
/// }
///
/// let window = Window { low: Point::new(-1.0, -1.0), high: Point::new(1.0, 2.0) };
/// let stack = Stack::of(Disc, &window, &[0.5, 1.2], &StackOptions::default())?;
/// // The circle touches three sides of the window at once, and cuts off the corners below.
/// let change = &stack.changes[0];
/// assert!((change.meeting.unwrap().value - 1.0).abs() < 1e-9);
/// assert_eq!(stack.changes.len(), 1);
/// # Ok::<(), stickslip_tracer::TraceError<Infallible>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Stack<Label, Margin> {
    /// The atlases at the given values; only the first atlases, if the search was cancelled.
    pub layers: Vec<Layer<Label, Margin>>,
    /// The changes of the structure, in the order of the third parameter.
    pub changes: Vec<Change<Label>>,
    /// The number of atlases that were traced.
    pub atlases: usize,
    /// Whether the search came to its end. If it was cancelled, changes that were not isolated by
    /// then are brackets in doubt.
    pub finished: bool,
    /// The structures of the first and the last layer that is not in doubt, and the structure
    /// behind each change.
    structures: Vec<(f64, Structure<Label>)>,
}

/// The stack of a family.
pub type StackOf<F> = Stack<<F as Family>::Label, <F as Family>::Margin>;

/// An atlas at a value of the third parameter.
#[derive(Clone, Debug)]
pub struct Layer<Label, Margin> {
    /// The value.
    pub value: f64,
    /// The atlas. If it does not [agree](Atlas::agrees), its structure is not compared.
    pub atlas: Atlas<Label, Margin>,
}

impl<Label: Clone + Ord, Margin: Clone + PartialEq> Stack<Label, Margin> {
    /// The stack of the family that `family` gives at each value of the third parameter, with
    /// atlases at `values`, which ascend. `family` is only called between the first and the last
    /// value.
    ///
    /// # Errors
    /// The values or the options are not possible, or an atlas fails. An atlas that is in doubt is
    /// not an error: changes are then searched between its neighbours.
    pub fn of<F>(
        family: impl Fn(f64) -> F,
        window: &Window,
        values: &[f64],
        options: &StackOptions,
    ) -> Result<Self, TraceError<F::Error>>
    where
        F: Family<Label = Label, Margin = Margin>,
    {
        Self::watched(family, window, values, options, Serial, Watch::SILENT)
    }

    /// The same stack, bit for bit, whose runs `executor` computes; `family` is called on this
    /// thread. `watch` sees each atlas as a step, and can cancel; the result is then [not
    /// finished](Self::finished).
    ///
    /// # Errors
    /// As [`of`](Self::of).
    pub fn watched<F, E>(
        family: impl Fn(f64) -> F,
        window: &Window,
        values: &[f64],
        options: &StackOptions,
        executor: E,
        watch: Watch<'_>,
    ) -> Result<Self, TraceError<F::Error>>
    where
        F: Family<Label = Label, Margin = Margin>,
        E: Executor<F>,
    {
        let ascend = values.windows(2).all(|pair| pair[0] < pair[1]);
        if values.len() < 2 || !ascend || !values.iter().all(|value| value.is_finite()) {
            return Err(TraceError::Values);
        }
        if !(1e-9..=0.1).contains(&options.width) {
            return Err(TraceError::Width(options.width));
        }
        // Places beyond the window's edges say nothing about changes inside.
        let mut options = *options;
        options.atlas.trace.beyond = 0.0;
        let surveyor = Surveyor { options: options.atlas, executor, watch: watch.silently() };
        let range = [values[0], values[values.len() - 1]];
        let mut search = Search::new(&family, *window, options, surveyor, watch, range);
        watch.report(Progress::Begin { steps: values.len() });
        let mut samples = Vec::with_capacity(values.len());
        for &value in values {
            let sample = search.sample(value)?;
            if !sample.atlas.is_finished() {
                break;
            }
            samples.push(sample);
            watch.report(Progress::Advance { steps: 1 });
        }
        let sure: Vec<_> = samples.iter().filter(|sample| sample.atlas.agrees()).collect();
        for pair in sure.windows(2) {
            search.refine(pair[0], pair[1])?;
        }
        let first = sure.first().map(|sample| (sample.value, sample.structure.clone()));
        let last = sure.last().map(|sample| (sample.value, sample.structure.clone()));
        let mut structures: Vec<_> = first.into_iter().collect();
        let (atlases, finished) = (search.count(), search.is_finished());
        let (changes, behind): (Vec<_>, Vec<_>) = search.joined().into_iter().unzip();
        let ends = changes.iter().map(|change: &Change<Label>| change.between[1]);
        structures.extend(ends.zip(behind));
        structures.extend(last);
        let layers = samples
            .into_iter()
            .map(|sample| Layer { value: sample.value, atlas: sample.atlas })
            .collect();
        Ok(Self { layers, changes, atlases, finished, structures })
    }

    /// What speaks against the stack, in one sentence: it is not finished, or a layer or a change
    /// is in doubt. `None` if nothing does.
    #[must_use]
    pub fn objection(&self) -> Option<String>
    where
        Label: Debug,
    {
        if !self.finished {
            return Some("it is not finished".to_owned());
        }
        let of_layer = |layer: &Layer<Label, Margin>| {
            Some(format!("at the value {:?}: {}", layer.value, layer.atlas.objection()?))
        };
        let layers = self.layers.iter().find_map(of_layer);
        layers.or_else(|| self.changes.iter().find_map(|change| change.objection("values")))
    }

    /// The labels of all regions at a value of the third parameter, in order; `None` inside the
    /// bracket of a change, and beyond the layers that are not in doubt.
    #[must_use]
    pub fn labels(&self, value: f64) -> Option<Vec<Label>> {
        let inside =
            |change: &Change<Label>| change.between[0] < value && value < change.between[1];
        let (first, last) = (self.structures.first()?.0, self.structures.last()?.0);
        if !(first..=last).contains(&value) || self.changes.iter().any(inside) {
            return None;
        }
        let before = self.structures.partition_point(|(start, _)| *start <= value);
        Some(self.structures[before.checked_sub(1)?].1.labels())
    }
}
