//! The result of examining a step: the guards that fire at one instant, or none.
//!
//! An event is what happens at one instant, not what one guard does. Two times are one instant if
//! the errors of their location overlap; the error is the rounding of time and state over the slope
//! of the guard. That a guard has crossed zero is a fact, which a transition at the same instant
//! cannot undo. So all guards of an instant are found before the first one acts.

use crate::lists::List;
use crate::method::StepOf;
use crate::system::{PerGuard, System};

/// How a guard crosses zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Crossed {
    /// The absolute slope of the guard where it fires.
    pub(crate) slope: f64,
    /// Whether it jumps over zero.
    pub(crate) jump: bool,
    /// The sign of the guard before it fired.
    pub(crate) sign: f64,
}

impl Crossed {
    /// A guard that is beyond zero where it is looked at. It has not been located, and hides
    /// nothing.
    pub(crate) const AT_ONCE: Self = Self { slope: f64::INFINITY, jump: false, sign: 1.0 };
}

/// A guard fires on a step, and others perhaps at the same instant.
#[derive(Debug)]
pub(crate) struct Event<S: System> {
    /// The guard that acts first.
    pub(crate) guard: usize,
    /// All guards that cross zero at this instant, with this one among them.
    pub(crate) crossed: PerGuard<S, Option<Crossed>>,
    /// Further guards that are zero there.
    pub(crate) simultaneous: PerGuard<S, bool>,
    /// The time from the start of the step to the event.
    pub(crate) elapsed: f64,
    /// The state on the guard.
    pub(crate) state: S::State,
    /// The latest time at which errors may put a guard of this instant, if there are several.
    pub(crate) latest: Option<f64>,
    /// The time of the first event of this instant that has been noted and not taken back, infinite
    /// if there is none.
    pub(crate) since: f64,
    /// The absolute value of the guard at that state, which is zero up to rounding.
    pub(crate) residual: f64,
    /// The time from the start of the step to a place behind the event, up to which the guard does
    /// not cross zero again.
    pub(crate) beyond: f64,
    /// The step that ends at the event.
    pub(crate) step: StepOf<S::State>,
}

impl<S: System> Event<S> {
    /// The event of one guard, of `count`, at the end of `step`, which begins at the start of the
    /// step of the run.
    pub(crate) fn alone(
        (guard, count): (usize, usize),
        crossed: Crossed,
        (elapsed, state): (f64, S::State),
        step: StepOf<S::State>,
    ) -> Self {
        let simultaneous = List::of(count, false);
        let crossed = only(count, guard, crossed);
        let (latest, since, residual, beyond) = (None, f64::INFINITY, 0.0, elapsed);
        Self { guard, crossed, simultaneous, elapsed, state, latest, since, residual, beyond, step }
    }

    /// How the guard that acts first crosses zero.
    pub(crate) fn own(&self) -> Crossed {
        self.crossed[self.guard].unwrap_or(Crossed::AT_ONCE)
    }

    /// Lets another guard of the instant act first, which has this value there in size.
    pub(crate) fn led_by(&mut self, guard: usize, residual: f64) {
        (self.guard, self.residual) = (guard, residual);
    }

    /// Takes further guards of the same instant, which act after this one's.
    pub(crate) fn take_in(&mut self, others: &PerGuard<S, Option<Crossed>>) {
        let crossed = self.crossed.parts_mut().iter_mut().zip(others.parts());
        for (own, crossed) in crossed {
            *own = own.or(*crossed);
        }
    }
}

/// The list of guards that cross zero in which there is only one.
#[inline(always)]
pub(crate) fn only<L: List<Option<Crossed>>>(count: usize, guard: usize, crossed: Crossed) -> L {
    let mut list = L::of(count, None);
    list[guard] = Some(crossed);
    list
}

/// The result of examining a step.
pub(crate) enum Found<S: System> {
    /// No guard fires. These are the values of the guards at the end of the step.
    Nothing(PerGuard<S, f64>),
    /// A guard fires. The event has been written to the place that was passed for it.
    Event,
    /// This guard is not resolved, so that a shorter step is needed.
    TooCoarse(usize),
}

/// An event that changes nothing, or a switch.
pub(crate) struct Note<S: System> {
    pub(crate) s: f64,
    pub(crate) guard: usize,
    pub(crate) simultaneous: PerGuard<S, bool>,
    pub(crate) flatness: f64,
    /// How the guard, and those that were noted with it, cross zero.
    pub(crate) crossed: PerGuard<S, Option<Crossed>>,
    pub(crate) from: S::Mode,
    pub(crate) to: S::Mode,
    pub(crate) before: S::State,
    pub(crate) after: S::State,
}

impl<S: System> Note<S> {
    /// Whether the guard jumps over zero.
    pub(crate) fn jump(&self) -> bool {
        self.crossed[self.guard].is_some_and(|crossed| crossed.jump)
    }
}
