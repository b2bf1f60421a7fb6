//! Everything that the examination of a dynamic step needs.

use crate::dynamic::curve::Work;
use crate::dynamic::event::Event;
use crate::dynamic::phase::Phase;
use crate::dynamic::step::{Origin, Step};
use crate::dynamic::system::{DynamicSystem, SignedGuard};
use crate::events::Notices;
use crate::events::isolate::Beginning;
use crate::events::one_guard::Status;
use crate::events::quick::NODES;
use crate::hybrid::Statistics;
use crate::method::Method;

/// What is known about each guard on a step.
#[derive(Default)]
pub(crate) struct Tables {
    /// The values at the nodes, node by node.
    pub(crate) nodes: Vec<f64>,
    /// The values at the end of the step, on the side from which the guards came.
    pub(crate) ends: Vec<f64>,
    /// Whether values between the nodes agree with those at the nodes.
    pub(crate) confirmed: Vec<bool>,
    /// What the guard does. `None` if the step is too coarse to tell.
    pub(crate) statuses: Vec<Option<Status>>,
    /// Where the part of the step begins that is still to be examined.
    pub(crate) beginnings: Vec<Beginning>,
}

impl Tables {
    /// The values of a guard at the nodes, of `count` guards.
    pub(crate) fn column(&self, guard: usize, count: usize) -> [f64; 6] {
        std::array::from_fn(|node| self.nodes[node * count + guard])
    }

    /// The value of a guard at the end of the step.
    pub(crate) fn end_of(&self, guard: usize) -> f64 {
        let count = self.nodes.len() / NODES.len();
        self.nodes[(NODES.len() - 1) * count + guard]
    }
}

/// The data that the examination of a step needs.
pub(crate) struct Examination<'a, S: DynamicSystem> {
    pub(crate) system: &'a S,
    pub(crate) phase: &'a Phase<S::Mode>,
    pub(crate) origin: Origin<'a>,
    /// The shortest time on which a guard may change, infinite if it is not known.
    pub(crate) guard_scale: f64,
    /// The relative and the absolute tolerance.
    pub(crate) tolerances: (f64, f64),
    /// The events on this step that change nothing.
    pub(crate) notes: &'a mut Vec<Event>,
    pub(crate) tables: &'a mut Tables,
    pub(crate) work: &'a mut Work,
    pub(crate) statistics: &'a mut Statistics,
    /// The touches and poles on this step.
    pub(crate) notices: &'a mut Notices<S::Mode>,
}

impl<'a, S: DynamicSystem> Examination<'a, S> {
    /// The right-hand side of the active mode.
    pub(crate) fn field(&self) -> impl Fn(f64, &[f64], &mut [f64]) + use<'a, S> {
        let (system, mode) = (self.system, self.phase.mode);
        move |s, y, slope| system.field(mode, s, y, slope)
    }

    /// A guard of the active mode, times `sign`.
    pub(crate) fn signed(&self, guard: usize, sign: f64) -> SignedGuard<'a, S> {
        SignedGuard { system: self.system, mode: self.phase.mode, guard, sign }
    }

    /// Makes the dense output of `step` known.
    pub(crate) fn extend<M: Method>(&mut self, step: &mut Step) {
        let field = self.field();
        self.statistics.field += step.extend::<M>(&field, self.origin);
    }

    /// The notes of a guard on this step.
    pub(crate) fn notes_of(&self, guard: usize) -> impl Iterator<Item = &Event> {
        self.notes.iter().filter(move |note| {
            note.guard == guard || note.simultaneous.binary_search(&guard).is_ok()
        })
    }
}
