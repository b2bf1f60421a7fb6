//! A system with numbers for its parameters, as the solver sees it.

use std::sync::Arc;

use stickslip_number::Number;
use stickslip_solver::dynamic::{DynamicStart, ReadableDynamic};
use stickslip_solver::{Guard, InvalidValue, Options, Schedule, Times};

use crate::continuation::Continuation;
use crate::program::Program;
use crate::resets::Resets;
use crate::system::Next;

/// A system that can run.
#[derive(Clone, Debug)]
pub struct Runnable {
    pub(crate) modes: Vec<Mode>,
    pub(crate) slides: Vec<Continuation>,
    /// The times of each rule of each mode.
    pub(crate) ticks: Vec<Vec<Ticks>>,
    pub(crate) first: usize,
    pub(crate) start: f64,
    pub(crate) end: f64,
    pub(crate) state: Vec<f64>,
    /// Relative and absolute tolerances of components, if they have their own.
    pub(crate) tolerances: Vec<(f64, f64)>,
    /// The same system with its branches as events, and what its further components are on a state.
    pub(crate) branched: Option<Box<(Self, Program)>>,
}

#[derive(Clone, Debug)]
pub(crate) struct Mode {
    pub(crate) slopes: Program,
    pub(crate) guards: Arc<[Guard]>,
    /// The numbers under which rules are counted.
    pub(crate) counters: Arc<[usize]>,
    pub(crate) values: Program,
    /// The components that guards read, none if these are all.
    pub(crate) reads: Arc<[usize]>,
    pub(crate) reactions: Vec<Reaction>,
}

/// What happens when a guard fires.
#[derive(Clone, Debug)]
pub(crate) struct Reaction {
    pub(crate) resets: Resets,
    pub(crate) next: Next,
    pub(crate) condition: Program,
    pub(crate) rest: Option<Rest>,
}

/// What happens where events accumulate.
#[derive(Clone, Debug)]
pub(crate) struct Rest {
    pub(crate) next: usize,
    pub(crate) resets: Resets,
}

#[derive(Clone, Debug)]
pub(crate) enum Ticks {
    Never,
    At(Times),
    Every(f64, f64),
}

impl Runnable {
    /// Where a run starts, in the first mode.
    #[must_use]
    pub fn start(&self) -> DynamicStart<'_, usize> {
        DynamicStart { mode: self.first, s: self.start, state: &self.state }
    }

    /// The same system with another start, where one is given: mode, time and state.
    ///
    /// # Errors
    /// [`InvalidValue`] if there is no such mode, or if the state has another length or is not
    /// finite.
    pub fn starting(
        mut self,
        mode: Option<usize>,
        s: Option<f64>,
        state: Option<&[f64]>,
    ) -> Result<Self, InvalidValue> {
        if let Some(mode) = mode {
            let accepted = mode < self.modes.len();
            InvalidValue::check("the first mode", mode, "a mode of the system", accepted)?;
            self.first = mode;
        }
        if let Some(s) = s {
            InvalidValue::check("the start", s, "a finite number", s.is_finite())?;
            self.start = s;
        }
        if let Some(state) = state {
            let (count, accepted) = (state.len(), state.len() == self.state.len());
            InvalidValue::check("the number of components", count, "that of the system", accepted)?;
            for &value in state {
                let (name, accepted) = ("a component of the state", value.is_finite());
                InvalidValue::check(name, value, "a finite number", accepted)?;
            }
            self.state = state.to_vec();
        }
        Ok(self.on_sides())
    }

    /// The same system, starting on the sides of surfaces where its state is.
    pub(crate) fn on_sides(mut self) -> Self {
        // A part of a slide that was decided stays.
        let slide = self.slides.iter().find(|slide| slide.first == self.first);
        if let Some(slide) = slide {
            self.first = slide.start(self.start, &self.state);
        }
        self
    }

    /// The same system with a relative and an absolute tolerance for each of its first components,
    /// in the place of those of the options.
    ///
    /// # Errors
    /// [`InvalidValue`] if there are more than components, or if one is out of its range.
    pub fn with_tolerances(mut self, tolerances: Vec<(f64, f64)>) -> Result<Self, InvalidValue> {
        let (count, accepted) = (tolerances.len(), tolerances.len() <= self.state.len());
        InvalidValue::check("the number of tolerances", count, "that of components", accepted)?;
        for &(rtol, atol) in &tolerances {
            let options = Options { rtol, atol, ..Options::default() };
            options.validate()?;
        }
        self.tolerances = tolerances;
        Ok(self)
    }

    /// The same run with branches as events, if there are any.
    pub(crate) fn with_branches(&self) -> Option<Self> {
        let (branched, starts) = &**self.branched.as_ref()?;
        let mut branches = vec![f64::NAN; branched.state.len() - self.state.len()];
        starts.run(self.start, &self.state, &mut branches);
        let state = [&self.state[..], &branches].concat();
        let finite = branches.iter().all(|it| it.is_finite());
        let (first, start, end) = (self.first, self.start, self.end);
        let tolerances = self.tolerances.clone();
        finite.then(|| Self { first, start, end, state, tolerances, ..branched.clone() })
    }

    /// Where a run ends; infinite if the system does not say.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.end
    }
}

impl ReadableDynamic for Runnable {
    type Mode = usize;
    const ON_FIXED_STATES: bool = true;

    fn most_guards(&self) -> usize {
        let most = |mode: &Mode| mode.counters.iter().map(|counter| counter + 1).max().unwrap_or(0);
        self.modes.iter().map(|mode| most(mode).max(mode.guards.len())).max().unwrap_or(0)
    }
    #[inline]
    fn field<T: Number>(&self, mode: usize, s: T, y: &[T], slope: &mut [T]) {
        self.modes[mode].slopes.run(s, y, slope);
    }
    fn guards(&self, mode: usize) -> &[Guard] {
        &self.modes[mode].guards
    }
    #[inline]
    fn guard_values<T: Number>(&self, mode: usize, s: T, y: &[T], values: &mut [T]) {
        self.modes[mode].values.run(s, y, values);
    }
    fn tolerances(&self) -> &[(f64, f64)] {
        &self.tolerances
    }
    fn reads(&self, mode: usize) -> &[usize] {
        &self.modes[mode].reads
    }
    fn counter(&self, mode: usize, guard: usize) -> usize {
        // Places beyond the guards of a mode may be asked for.
        self.modes[mode].counters.get(guard).copied().unwrap_or(guard)
    }
    fn schedule(&self, mode: usize, guard: usize) -> Schedule<'_> {
        match &self.ticks[mode][guard] {
            Ticks::Never => Schedule::NEVER,
            Ticks::At(times) => Schedule::at(times),
            &Ticks::Every(period, phase) => Schedule::every(period, phase),
        }
    }
    fn transition_condition(&self, mode: usize, guard: usize, s: f64, y: &[f64]) -> f64 {
        let reaction = &self.modes[mode].reactions[guard];
        if let Next::Slide { slide, guard } = reaction.next {
            return self.slides[slide].condition(mode, guard, &reaction.resets, (s, y));
        }
        let mut condition = [f64::NAN];
        reaction.condition.run(s, y, &mut condition);
        condition[0]
    }
    fn transition(&self, mode: usize, guard: usize, s: f64, y: &mut [f64]) -> usize {
        let reaction = &self.modes[mode].reactions[guard];
        let next = match reaction.next {
            Next::Stay => mode,
            Next::Mode(next) => next,
            Next::Branch(_, above, below) => {
                let condition = ReadableDynamic::transition_condition(self, mode, guard, s, y);
                if condition >= 0.0 { above } else { below }
            }
            Next::Slide { slide, guard } => {
                return self.slides[slide].next(mode, guard, &reaction.resets, (s, y));
            }
        };
        reaction.resets.apply(s, y);
        next
    }
    fn rest(&self, mode: usize, guard: usize, s: f64, y: &mut [f64]) -> Option<usize> {
        let rest = self.modes[mode].reactions.get(guard)?.rest.as_ref()?;
        rest.resets.apply(s, y);
        Some(rest.next)
    }
}
