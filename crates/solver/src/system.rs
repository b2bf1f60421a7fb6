//! A hybrid system as the engine sees it, whatever its states and lists of guards are stored in.
//!
//! The loop and the events are generic over a `System`; states are arrays of a fixed size, or
//! buffers where the dimension is known at run time only.

use std::cell::RefCell;
use std::fmt::Debug;

use smallvec::SmallVec;

use crate::dynamic::DynamicSystem;
use crate::events::isolate::Beginning;
use crate::events::status::Status;
use crate::hybrid::{Guard, HybridSystem};
use crate::lists::{AnyShape, FixedShape, List, ReadShape, Shape};
use crate::method::{DenseOf, Method, State, StepOf, Store, TrialOf};
use stickslip_number::{Enclosure, Interval};

/// A list with an entry for each guard, and one with an entry for each component.
pub(crate) type PerGuard<S, T> = <<S as System>::Guards as Shape>::Of<T>;
pub(crate) type PerComponent<S, T> = <<S as System>::Components as Shape>::Of<T>;

/// Room for what lives during one call: new arrays, which cost nothing, or buffers that are used
/// again.
pub(crate) struct Room<S: System> {
    /// The number of components, and the number of guards of the active mode.
    pub(crate) n: usize,
    pub(crate) guards: usize,
    state: Vec<S::State>,
    dense: Vec<DenseOf<S::State>>,
    step: Vec<StepOf<S::State>>,
    row: Vec<PerGuard<S, f64>>,
    statuses: Vec<PerGuard<S, Status>>,
    beginnings: Vec<PerGuard<S, Beginning>>,
    bools: Vec<PerGuard<S, bool>>,
}

macro_rules! lends {
    ($($lend:ident $give:ident: $type:ty = |$n:ident| $new:expr;)*) => {$(
        #[inline(always)]
        pub(crate) fn $lend(&mut self) -> $type {
            let $n = self.n;
            let kept = if S::State::KEEPS { self.$lend.pop() } else { None };
            kept.unwrap_or_else(|| $new)
        }
        #[inline(always)]
        pub(crate) fn $give(&mut self, lent: $type) {
            if S::State::KEEPS {
                self.$lend.push(lent);
            }
        }
    )*};
}

macro_rules! lists {
    ($($lend:ident $give:ident: $type:ty = $value:expr;)*) => {$(
        #[inline(always)]
        pub(crate) fn $lend(&mut self) -> PerGuard<S, $type> {
            let n = self.guards;
            let mut list = match S::State::KEEPS.then(|| self.$lend.pop()).flatten() {
                Some(list) => list,
                None => PerGuard::<S, $type>::of(n, $value),
            };
            list.fit(n, $value);
            list
        }
        #[inline(always)]
        pub(crate) fn $give(&mut self, lent: PerGuard<S, $type>) {
            if S::State::KEEPS {
                self.$lend.push(lent);
            }
        }
    )*};
}

impl<S: System> Room<S> {
    lends! {
        state give: S::State = |n| S::State::room(n);
        dense give_dense: DenseOf<S::State> = |n| DenseOf::room(n);
        step give_step: StepOf<S::State> = |n| StepOf::new(n);
    }
    lists! {
        row give_row: f64 = 0.0;
        statuses give_statuses: Status = Status::Clear;
        beginnings give_beginnings: Beginning =
            Beginning { theta: 0.0, value: 0.0, zero_order: 0 };
        bools give_bools: bool = true;
    }

    pub(crate) fn new(n: usize) -> Self {
        let (state, dense, step, row) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let (statuses, beginnings, bools) = (Vec::new(), Vec::new(), Vec::new());
        Self { n, guards: 0, state, dense, step, row, statuses, beginnings, bools }
    }
    /// A guard's value.
    #[inline(always)]
    pub(crate) fn value(
        &mut self,
        system: &S,
        (mode, guard): (S::Mode, usize),
        s: f64,
        y: &S::State,
    ) -> f64 {
        let mut values = self.row();
        system.guard_values(mode, s, y, &mut values);
        let value = values[guard];
        self.give_row(values);
        value
    }
}

/// A hybrid system.
pub(crate) trait System: Sized {
    type Mode: Copy + PartialEq + Debug;
    type State: Store;
    type Components: Shape;
    type Guards: Shape;
    const READABLE: bool;

    fn field(&self, mode: Self::Mode, s: f64, y: &Self::State, slope: &mut Self::State);
    /// The guards of a mode, whose list has had room for others.
    fn guards(&self, mode: Self::Mode, guards: &mut PerGuard<Self, Guard>);
    fn guard_values(
        &self,
        mode: Self::Mode,
        s: f64,
        y: &Self::State,
        values: &mut PerGuard<Self, f64>,
    );
    fn enclose(
        &self,
        mode: Self::Mode,
        s: Enclosure,
        y: &PerComponent<Self, Enclosure>,
    ) -> PerGuard<Self, Enclosure>;
    fn reads(&self, mode: Self::Mode) -> <Self::Components as Shape>::Read;
    /// The rates of the guards, NaN where they are not known.
    fn guard_rates(
        &self,
        mode: Self::Mode,
        s: f64,
        y: &Self::State,
        rates: &mut PerGuard<Self, f64>,
    );
    /// Bounds of a guard's rate, where time and state are known up to their last digit.
    fn enclose_rate(&self, mode: Self::Mode, s: f64, y: &Self::State, guard: usize) -> Interval;
    /// The number whose sign says which branch a transition takes, NaN if it does not branch.
    fn transition_condition(&self, mode: Self::Mode, guard: usize, s: f64, y: &Self::State) -> f64;
    fn settle(&self, mode: Self::Mode, y: &Self::State) -> Self::Mode;
    fn longest_first_step(&self, mode: Self::Mode, s: f64, y: &Self::State) -> f64;
    /// The mode behind an accumulation of switches at `s`, if the run goes on there.
    fn rest(
        &self,
        mode: Self::Mode,
        guard: usize,
        s: f64,
        y: &mut Self::State,
    ) -> Option<Self::Mode>;
    /// The number under which firings of a guard are counted.
    fn counter(&self, mode: Self::Mode, guard: usize) -> usize;
    /// The first time after `s` at which a clock fires.
    fn next_time(&self, mode: Self::Mode, guard: usize, s: f64) -> f64;
    fn step<M: Method>(
        &self,
        mode: Self::Mode,
        trial: &TrialOf<'_, Self::State>,
        step: &mut StepOf<Self::State>,
    );
    fn transition(&self, mode: Self::Mode, guard: usize, s: f64, y: &mut Self::State)
    -> Self::Mode;
}

/// A system of fixed dimension.
pub(crate) struct Fixed<'a, S, const N: usize, const G: usize>(pub(crate) &'a S);

impl<S: HybridSystem<N, G>, const N: usize, const G: usize> System for Fixed<'_, S, N, G> {
    type Mode = S::Mode;
    type State = State<N>;
    type Components = FixedShape<N>;
    type Guards = FixedShape<G>;
    const READABLE: bool = S::READABLE;

    #[inline(always)]
    fn field(&self, mode: S::Mode, s: f64, y: &State<N>, slope: &mut State<N>) {
        *slope = self.0.field(mode, s, y);
    }
    #[inline(always)]
    fn guards(&self, mode: S::Mode, guards: &mut [Guard; G]) {
        *guards = self.0.guards(mode);
    }
    #[inline(always)]
    fn guard_values(&self, mode: S::Mode, s: f64, y: &State<N>, values: &mut [f64; G]) {
        *values = self.0.guard_values(mode, s, y);
    }
    #[inline(always)]
    fn enclose(&self, mode: S::Mode, s: Enclosure, y: &[Enclosure; N]) -> [Enclosure; G] {
        self.0.enclose_guards(mode, s, y)
    }
    #[inline(always)]
    fn reads(&self, _: S::Mode) {}
    #[inline(always)]
    fn guard_rates(&self, mode: S::Mode, s: f64, y: &State<N>, rates: &mut [f64; G]) {
        *rates = self.0.guard_rates(mode, s, y);
    }
    fn enclose_rate(&self, mode: S::Mode, s: f64, y: &State<N>, guard: usize) -> Interval {
        let y = std::array::from_fn(|i| up_to_last_digit(y[i]));
        self.0.enclose_rates(mode, up_to_last_digit(s), &y)[guard]
    }
    #[inline(always)]
    fn transition_condition(&self, mode: S::Mode, guard: usize, s: f64, y: &State<N>) -> f64 {
        self.0.transition_condition(mode, guard, s, y)
    }
    #[inline(always)]
    fn settle(&self, mode: S::Mode, y: &State<N>) -> S::Mode {
        self.0.settle(mode, y)
    }
    fn rest(&self, mode: S::Mode, guard: usize, s: f64, y: &mut State<N>) -> Option<S::Mode> {
        let (to, after) = self.0.rest(mode, guard, s, y)?;
        *y = after;
        Some(to)
    }
    #[inline(always)]
    fn counter(&self, mode: S::Mode, guard: usize) -> usize {
        self.0.counter(mode, guard)
    }
    fn next_time(&self, mode: S::Mode, guard: usize, s: f64) -> f64 {
        self.0.schedule(mode, guard).next_after(s)
    }
    #[inline(always)]
    fn longest_first_step(&self, mode: S::Mode, s: f64, y: &State<N>) -> f64 {
        self.0.longest_first_step(mode, s, y)
    }
    #[inline(always)]
    fn step<M: Method>(
        &self,
        mode: S::Mode,
        trial: &TrialOf<'_, State<N>>,
        step: &mut StepOf<State<N>>,
    ) {
        self.0.step::<M>(mode, trial, step);
    }
    #[inline(always)]
    fn transition(&self, mode: S::Mode, guard: usize, s: f64, y: &mut State<N>) -> S::Mode {
        let to;
        (to, *y) = self.0.transition(mode, guard, s, y);
        to
    }
}

/// A number that is known up to its last digit.
fn up_to_last_digit(x: f64) -> Interval {
    Interval::around(x, f64::EPSILON * x.abs())
}

/// A system whose dimension is known at run time.
pub(crate) struct Free<'a, S>(pub(crate) &'a S, RefCell<Vec<Enclosure>>);

impl<'a, S> Free<'a, S> {
    /// A system of `n` components.
    pub(crate) fn new(system: &'a S, n: usize) -> Self {
        Self(system, RefCell::new(vec![Enclosure::ENTIRE; n]))
    }
}

impl<S: DynamicSystem> System for Free<'_, S> {
    type Mode = S::Mode;
    type State = Vec<f64>;
    type Components = ReadShape;
    type Guards = AnyShape;
    const READABLE: bool = S::READABLE;

    fn field(&self, mode: S::Mode, s: f64, y: &Vec<f64>, slope: &mut Vec<f64>) {
        self.0.field(mode, s, y, slope);
    }
    fn guards(&self, mode: S::Mode, guards: &mut Vec<Guard>) {
        guards.clear();
        guards.extend_from_slice(self.0.guards(mode));
    }
    fn guard_values(&self, mode: S::Mode, s: f64, y: &Vec<f64>, values: &mut Vec<f64>) {
        values.resize(self.0.guards(mode).len(), f64::NAN);
        self.0.guard_values(mode, s, y, values);
    }
    fn enclose(&self, mode: S::Mode, s: Enclosure, y: &SmallVec<[Enclosure; 8]>) -> Vec<Enclosure> {
        let all = &mut *self.1.borrow_mut();
        match self.0.reads(mode) {
            [] => all.copy_from_slice(y),
            reads => reads.iter().zip(y).for_each(|(&place, &y)| all[place] = y),
        }
        let mut values = vec![Enclosure::ENTIRE; self.0.guards(mode).len()];
        self.0.enclose_guards(mode, s, all, &mut values);
        values
    }
    fn reads(&self, mode: S::Mode) -> SmallVec<[usize; 8]> {
        match self.0.reads(mode) {
            [] => (0..self.1.borrow().len()).collect(),
            reads => reads.into(),
        }
    }
    fn guard_rates(&self, mode: S::Mode, s: f64, y: &Vec<f64>, rates: &mut Vec<f64>) {
        rates.resize(self.0.guards(mode).len(), f64::NAN);
        self.0.guard_rates(mode, s, y, rates);
    }
    fn enclose_rate(&self, mode: S::Mode, s: f64, y: &Vec<f64>, guard: usize) -> Interval {
        let y: Vec<_> = y.iter().copied().map(up_to_last_digit).collect();
        let mut rates = vec![Interval::ENTIRE; self.0.guards(mode).len()];
        self.0.enclose_rates(mode, up_to_last_digit(s), &y, &mut rates);
        rates[guard]
    }
    fn transition_condition(&self, mode: S::Mode, guard: usize, s: f64, y: &Vec<f64>) -> f64 {
        self.0.transition_condition(mode, guard, s, y)
    }
    fn settle(&self, mode: S::Mode, _: &Vec<f64>) -> S::Mode {
        mode
    }
    fn rest(&self, mode: S::Mode, guard: usize, s: f64, y: &mut Vec<f64>) -> Option<S::Mode> {
        self.0.rest(mode, guard, s, y)
    }
    #[inline(always)]
    fn counter(&self, mode: S::Mode, guard: usize) -> usize {
        self.0.counter(mode, guard)
    }
    fn next_time(&self, mode: S::Mode, guard: usize, s: f64) -> f64 {
        self.0.schedule(mode, guard).next_after(s)
    }
    fn longest_first_step(&self, _: S::Mode, _: f64, _: &Vec<f64>) -> f64 {
        f64::INFINITY
    }
    fn step<M: Method>(
        &self,
        mode: S::Mode,
        trial: &TrialOf<'_, Vec<f64>>,
        step: &mut StepOf<Vec<f64>>,
    ) {
        // Dispatched at run time, so that it is compiled once for each method.
        let mut field =
            |s: f64, y: &Vec<f64>, slope: &mut Vec<f64>| self.0.field(mode, s, y, slope);
        step.take_buffers::<M>(&mut field, trial, self.0.tolerances());
    }
    fn transition(&self, mode: S::Mode, guard: usize, s: f64, y: &mut Vec<f64>) -> S::Mode {
        self.0.transition(mode, guard, s, y)
    }
}
