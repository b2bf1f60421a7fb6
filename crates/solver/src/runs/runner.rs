//! A run of a hybrid system from switch to switch.
//!
//! `advance` takes one accepted step. The module `events` finds out whether the step contains a
//! switch.

mod instant;
mod last_part;
mod watcher;

use std::cmp::Ordering;

use crate::error::RunError;
use crate::events::{
    Event, Examination, Found, HERE, Note, Noticed, Notices, Phase, UNSEEN, all_clearly_away,
    dense_output, values_on,
};
use crate::hybrid::{HybridSystem, Observer, Outcome, Run, Start, Statistics};
use crate::lists::List;
use crate::method::control::{Controller, first_step_of};
use crate::method::{Method, StepOf, Store, TrialOf};
use crate::options::{Options, StepSize};
use crate::runs::clock::{Clock, Zeno};
use crate::runs::finite::{check_finite, is_finite};
use crate::runs::rejected::after_rejection;
use crate::runs::runner::instant::Instant;
use crate::runs::runner::last_part::last_part;
use crate::runs::runner::watcher::FixedWatcher;
use crate::system::{Fixed, PerGuard, Room, System};

pub(crate) use crate::runs::runner::watcher::{Watcher, switch_event};

/// Integrates `system` from `start` to `end`, through every switch on the way.
///
/// `end` may be infinite if a terminal guard ends the run. A run allocates no
/// memory, except on steps with many touches or poles, or with an event that
/// changes nothing.
///
/// # Errors
/// A [`RunError`] reports invalid options, a span that does not lead forward, a state or right-hand
/// side that is not finite, a guard that is not a number, that is identically zero or that cannot
/// be resolved, and a tolerance that no step meets.
pub fn run<M, S, O, const N: usize, const G: usize>(
    _method: M,
    system: &S,
    start: Start<S::Mode, N>,
    end: f64,
    options: &Options,
    observer: &mut O,
) -> Result<Run<S::Mode, N>, RunError>
where
    M: Method,
    S: HybridSystem<N, G>,
    O: Observer<S::Mode, N>,
{
    let mut watcher = FixedWatcher(observer);
    let state = &start.state;
    let from = (start.mode, start.s, state);
    run_any::<M, _, _>(&Fixed(system), from, end, options, &mut watcher).map(Run::from)
}

/// The end of a run.
pub(crate) struct End<S: System> {
    pub(crate) outcome: Outcome,
    pub(crate) s: f64,
    pub(crate) mode: S::Mode,
    pub(crate) state: S::State,
    pub(crate) decided: bool,
    pub(crate) statistics: Statistics,
}

impl<S: HybridSystem<N, G>, const N: usize, const G: usize> From<End<Fixed<'_, S, N, G>>>
    for Run<S::Mode, N>
{
    fn from(end: End<Fixed<'_, S, N, G>>) -> Self {
        let End { outcome, s, mode, state, decided, statistics } = end;
        Self { outcome, s, mode, state, decided, statistics }
    }
}

#[inline]
pub(crate) fn run_any<M: Method, S: System, O: Watcher<S>>(
    system: &S,
    start: (S::Mode, f64, &S::State),
    end: f64,
    options: &Options,
    observer: &mut O,
) -> Result<End<S>, RunError> {
    let mut runner = Runner::<S, O>::at::<M>(system, start, end, options, observer)?;
    let (mut step, mut event) = (StepOf::new(runner.room.n), None);
    let outcome = loop {
        if let Some(outcome) = runner.go_on::<M>(&mut step, &mut event)? {
            break outcome;
        }
    };
    Ok(runner.end(outcome))
}

/// The state of a run between two steps.
pub(crate) struct Runner<'a, S: System, O> {
    pub(super) system: &'a S,
    pub(super) options: &'a Options,
    pub(crate) observer: &'a mut O,
    pub(super) end: f64,
    /// The next time of a clock.
    due: f64,
    pub(super) clock: Clock,
    pub(super) phase: Phase<S>,
    pub(super) state: S::State,
    /// What rounding has cut off from the state.
    pub(super) rest: S::State,
    /// The derivative of the state.
    slope: S::State,
    /// The size of the next step.
    h: f64,
    /// The size of the first step of the next phase. It is taken over from the phase before the
    /// present one, since modes mostly alternate.
    other_h: Option<f64>,
    controller: Controller,
    pub(super) zeno: Zeno,
    /// How often each guard has fired.
    pub(super) fired: PerGuard<S, u32>,
    /// The events on the present step that change nothing.
    pub(super) notes: Vec<Note<S>>,
    /// The touches and poles on the present step.
    notices: Notices<S::Mode>,
    pub(super) statistics: Statistics,
    pub(super) room: Room<S>,
    /// The values of the guards at the nodes of a step.
    nodes: [PerGuard<S, f64>; 6],
    /// Whether a quick look at the values of a guard is sure.
    sure: PerGuard<S, bool>,
    instant: Instant<S>,
}

impl<'a, S: System, O: Watcher<S>> Runner<'a, S, O> {
    /// A run that has not moved yet.
    #[inline]
    pub(crate) fn at<M: Method>(
        system: &'a S,
        (mode, s, state): (S::Mode, f64, &S::State),
        end: f64,
        options: &'a Options,
        observer: &'a mut O,
    ) -> Result<Self, RunError> {
        options.validate()?;
        if !(s.is_finite() && end > s) {
            return Err(RunError::Span { from: s, to: end });
        }
        let n = state.size();
        let room = || S::State::room(n);
        let row = || PerGuard::<S, f64>::of(0, 0.0);
        let mut runner = Runner {
            system,
            options,
            observer,
            end,
            due: f64::INFINITY,
            clock: Clock::new(s),
            phase: Phase::new(mode),
            state: state.clone(),
            rest: room(),
            slope: room(),
            other_h: None,
            h: 0.0,
            controller: Controller::new(),
            zeno: Zeno::new(s),
            fired: List::of(0, 0),
            notes: Vec::new(),
            notices: Notices::new(),
            statistics: Statistics { guards: 1, ..Statistics::default() },
            room: Room::new(n),
            nodes: [row(), row(), row(), row(), row(), row()],
            sure: List::of(0, true),
            instant: Instant::new(n),
        };
        runner.phase.enter(system, mode, (s, state), &mut runner.fired)?;
        // A clock that is due at the start fires there.
        runner.due = runner.next_due(s.next_down())?;
        runner.refresh_slope()?;
        runner.h = match (options.step_size, options.first_step) {
            (StepSize::Fixed(h), _) | (StepSize::Adaptive, Some(h)) => h,
            (StepSize::Adaptive, None) => runner.estimate_first_step::<M>(),
        };
        Ok(runner)
    }

    /// Goes on by a step, and through the switches at its end. Returns the outcome if the run ends.
    #[inline]
    pub(crate) fn go_on<M: Method>(
        &mut self,
        step: &mut StepOf<S::State>,
        event: &mut Option<Event<S>>,
    ) -> Result<Option<Outcome>, RunError> {
        if let Some(outcome) = self.advance::<M>(step, event)? {
            return Ok(Some(outcome));
        }
        if let Some(event) = event
            && let Some(outcome) = self.switch(event)?
        {
            return Ok(Some(outcome));
        }
        // Behind an event, no step shows what remains within rounding.
        if self.clock.until(self.end) <= 0.0 || event.is_some() && self.clock.is_at(self.end) {
            self.clock.arrive(self.end);
            check_finite(self.clock.s, self.state.parts())?;
            return Ok(Some(Outcome::ReachedEnd));
        }
        Ok(self.observer.stops(self.clock.s).then_some(Outcome::Stopped))
    }

    /// The end of the run.
    pub(crate) fn end(&mut self, outcome: Outcome) -> End<S> {
        self.observer.on_end(self.phase.mode, self.clock.s, &self.state);
        End {
            outcome,
            s: self.clock.s,
            mode: self.phase.mode,
            state: self.state.clone(),
            decided: !self.phase.undecided,
            statistics: self.statistics,
        }
    }

    /// Takes one step that is good enough. The step ends at a switch if it meets one that changes
    /// something. Other events on it are reported. Returns the outcome if the run ends here.
    ///
    /// An event contains a step. It is written to the place where it stays: to return it would copy
    /// it on every step, which was 8 % of a collision's instructions.
    fn advance<M: Method>(
        &mut self,
        step: &mut StepOf<S::State>,
        event: &mut Option<Event<S>>,
    ) -> Result<Option<Outcome>, RunError> {
        *event = None;
        let (system, mode) = (self.system, self.phase.mode);
        let count = self.phase.count();
        self.room.guards = count;
        if self.clock.until(self.due) <= 0.0 {
            self.tick_at_once(step, event);
            return Ok(None);
        }
        let mut cuts = 0;
        loop {
            if self.statistics.tried() >= self.options.max_steps {
                return Ok(Some(Outcome::StepLimit));
            }
            let h = self.h.min(self.options.max_step);
            let stop = self.end.min(self.due);
            let (h, last) = self.clock.step_towards(stop, h);
            let trial = TrialOf {
                s: self.clock.s,
                y: &self.state,
                rest: &self.rest,
                slope: &self.slope,
                h,
                tolerances: (self.options.rtol, self.options.atol),
            };
            system.step::<M>(mode, &trial, step);
            self.statistics.field += M::STAGES - 1 + usize::from(M::ERROR_USES_END);
            let error = self.error_of(step);
            // NaN is not good.
            if !matches!(error.partial_cmp(&1.0), Some(Ordering::Less)) {
                let finite = is_finite(step.y1.parts());
                let work = (&mut self.controller, &mut self.statistics);
                self.h =
                    after_rejection::<M>(work, self.options, (self.clock.s, h), error, finite)?;
                continue;
            }
            self.notes.clear();
            let [a, b, c, d, e, f] = &mut self.nodes;
            let mut values = [a, b, c, d, e, f].map(|row| {
                row.fit(count, 0.0);
                row.lend(0.0)
            });
            self.sure.fit(count, true);
            let mut sure = self.sure.lend(true);
            values_on(system, &self.phase, step, &mut values, &mut self.statistics);
            let (phase, statistics) = (&self.phase, &mut self.statistics);
            let scale = self.options.scale_of_guards();
            let room = &mut self.room;
            let away =
                all_clearly_away(system, phase, scale, step, &values, statistics, room, &mut sure);
            let close = if away && !last {
                self.phase.advance(&values[5], || false);
                None
            } else {
                self.look_closely::<M>(h, step, event, (&values, away), last)?
            };
            let known = close.is_none_or(|guard| values.iter().all(|row| !row[guard].is_nan()));
            let [a, b, c, d, e, f] = values;
            for (row, values) in self.nodes.iter_mut().zip([a, b, c, d, e, f]) {
                row.back(values);
            }
            self.sure.back(sure);
            if let Some(guard) = close {
                self.statistics.too_coarse += 1;
                cuts += 1;
                // A step may become so short that it is less than the rest.
                self.rest.parts_mut().fill(0.0);
                self.h = 0.2 * h;
                // A step that does not move the time is useless.
                if cuts > 60 || self.h <= f64::EPSILON * self.clock.s.abs() {
                    return Err(RunError::unresolved(guard, (self.clock.s, h), known));
                }
                continue;
            }
            self.statistics.accepted += 1;
            match self.options.step_size {
                StepSize::Fixed(h) => self.h = h,
                // The last step was cut at the end.
                StepSize::Adaptive if last && event.is_none() => {}
                StepSize::Adaptive => self.h = self.controller.accepted::<M>(h, error),
            }
            if !self.notes.is_empty()
                && let Some(outcome) = self.report_notes()
            {
                let (s, statistics) = (self.clock.s, &mut self.statistics);
                let room = &mut self.room;
                last_part::<M, S, O>(system, mode, step, s, statistics, self.observer, room);
                return Ok(Some(outcome));
            }
            if let Some(event) = event {
                self.tell_until(self.clock.s + event.elapsed);
                if event.step.h > 0.0 {
                    self.show::<M>(mode, &mut event.step);
                }
                let arrives = event.elapsed == self.clock.until(stop);
                self.clock.advance(event.elapsed);
                if arrives {
                    self.clock.arrive(stop);
                }
                return Ok(None);
            }
            self.accept::<M>(step, last.then_some(stop))?;
            return Ok(None);
        }
    }

    /// The error of a step, which does not matter if all steps have one size.
    #[inline(always)]
    fn error_of(&self, step: &StepOf<S::State>) -> f64 {
        match self.options.step_size {
            StepSize::Adaptive => step.error,
            StepSize::Fixed(_) if is_finite(step.y1.parts()) => 0.0,
            StepSize::Fixed(_) => f64::NAN,
        }
    }

    /// Goes on at the end of a step. If the step has arrived at a place that is known exactly, the
    /// run continues from that place.
    #[inline(always)]
    fn accept<M: Method>(
        &mut self,
        step: &mut StepOf<S::State>,
        arrived: Option<f64>,
    ) -> Result<(), RunError> {
        let (system, mode) = (self.system, self.phase.mode);
        self.tell_until(f64::INFINITY);
        self.show::<M>(mode, step);
        self.state.set(&step.y1);
        self.rest.set(&step.rest);
        let mut field =
            |s: f64, y: &S::State, slope: &mut S::State| system.field(mode, s, y, slope);
        self.slope.set(step.end_slope(&mut field));
        self.statistics.field += usize::from(!M::ERROR_USES_END);
        self.clock.advance(step.h);
        if let Some(place) = arrived {
            self.clock.arrive(place);
        }
        let settled = system.settle(mode, &self.state);
        if settled != mode {
            let largest = self.phase.largest.clone();
            let place = (self.clock.s, &self.state);
            self.phase.enter(system, settled, place, &mut self.fired)?;
            self.phase.forget_zeros();
            self.phase.largest = largest;
            self.statistics.guards += 1;
            self.refresh_slope()?;
        }
        Ok(())
    }

    /// Examines a `step` of size `h` whose guards have these `values` at its nodes. Returns the
    /// guard for which the step is too coarse, if there is one.
    #[inline(never)]
    fn look_closely<M: Method>(
        &mut self,
        h: f64,
        step: &mut StepOf<S::State>,
        event: &mut Option<Event<S>>,
        (values, away): (&[PerGuard<S, f64>; 6], bool),
        last: bool,
    ) -> Result<Option<usize>, RunError> {
        self.notices.clear();
        let tolerances = (self.options.rtol, self.options.atol);
        let (y, rest, slope) = (&self.state, &self.rest, &self.slope);
        let trial = TrialOf { s: self.clock.s, y, rest, slope, h, tolerances };
        let mut examination = Examination {
            system: self.system,
            phase: &self.phase,
            trial: &trial,
            age: self.clock.phase,
            drift: self.clock.drift(),
            usual: self.h,
            guard_scale: self.options.scale_of_guards(),
            notes: &mut self.notes,
            statistics: &mut self.statistics,
            wants_segments: O::WANTS_SEGMENTS,
            notices: &mut self.notices,
            room: &mut self.room,
        };
        // On a last step that time hardly resolves, guards that end up at zero have crossed.
        let away = away || last && h <= UNSEEN * f64::EPSILON * self.clock.s.abs();
        let at_end = match examination.look::<M>(step, event, values, away)? {
            Found::Nothing(at_end) => Some(at_end),
            Found::Event => None,
            Found::TooCoarse(guard) => return Ok(Some(guard)),
        };
        if last && event.is_none() {
            examination.arrive(step, event);
        }
        let left = self.clock.until(self.due);
        if self.due <= self.end && (last || event.is_some() && left <= 2.0 * h) {
            examination.tick(step, (self.due, left), event);
        }
        if let Some(event) = event {
            examination.take_back(event);
        }
        if let Some(at_end) = at_end {
            if event.is_none() {
                let clock = &self.clock;
                self.phase.advance(&at_end, || clock.phase + h <= HERE * clock.drift());
            }
            self.room.give_row(at_end);
        }
        Ok(None)
    }

    /// Lets the clocks fire that are due where the run stands, which happens at its start.
    #[cold]
    fn tick_at_once(&mut self, step: &mut StepOf<S::State>, event: &mut Option<Event<S>>) {
        self.notes.clear();
        self.notices.clear();
        let (s, tolerances) = (self.clock.s, (self.options.rtol, self.options.atol));
        let (y, rest, slope) = (&self.state, &self.rest, &self.slope);
        let trial = TrialOf { s, y, rest, slope, h: 0.0, tolerances };
        step.stand(&trial);
        let mut examination = Examination {
            system: self.system,
            phase: &self.phase,
            trial: &trial,
            age: self.clock.phase,
            drift: self.clock.drift(),
            usual: self.h,
            guard_scale: self.options.scale_of_guards(),
            notes: &mut self.notes,
            statistics: &mut self.statistics,
            wants_segments: O::WANTS_SEGMENTS,
            notices: &mut self.notices,
            room: &mut self.room,
        };
        examination.tick(step, (self.due, 0.0), event);
    }

    /// Shows an accepted step to the observer, if it wants to see steps.
    #[inline(always)]
    fn show<M: Method>(&mut self, mode: S::Mode, step: &mut StepOf<S::State>) {
        if O::WANTS_SEGMENTS {
            let mut dense = self.room.dense();
            dense_output::<_, M>(self.system, mode, step, &mut dense);
            self.observer.on_segment(mode, &dense);
            self.room.give_dense(dense);
        }
    }

    /// Reports touches and poles on the step, up to the place `until`.
    #[inline]
    fn tell_until(&mut self, until: f64) {
        while let Some(noticed) = self.notices.next_until(until) {
            match noticed {
                Noticed::Touch(touch) => {
                    self.statistics.grazings += 1;
                    self.observer.on_grazing(&touch);
                }
                Noticed::Pole(pole) => self.observer.on_pole(&pole),
            }
        }
    }

    /// Reports the events on the step that change nothing. The run may end at one of them.
    fn report_notes(&mut self) -> Option<Outcome> {
        self.instant.note(&self.notes, self.clock.drift());
        for index in 0..self.notes.len() {
            self.tell_until(self.notes[index].s);
            let note = &self.notes[index];
            self.observer.on_switch(note);
            let (phase, fired) = (&mut self.phase.guards, &mut self.fired);
            let together = |guard: &usize| *guard == note.guard || note.simultaneous[*guard];
            for guard in (0..phase.parts().len()).filter(together) {
                fired[self.system.counter(self.phase.mode, guard)] += 1;
                phase[guard] = phase[guard].fired(1);
            }
            self.statistics.switches += 1;
            let outcome = if self.statistics.switches >= self.options.max_switches {
                Outcome::SwitchLimit
            } else if self.observer.stops(note.s) {
                Outcome::Stopped
            } else {
                continue;
            };
            self.state.set(&note.after);
            self.rest.parts_mut().fill(0.0);
            self.clock.arrive(note.s);
            return Some(outcome);
        }
        None
    }

    /// Enters the phase after the events of an instant.
    pub(super) fn begin(&mut self) -> Result<(), RunError> {
        if self.options.step_size == StepSize::Adaptive {
            let (to, s) = (self.phase.mode, self.clock.s);
            // A phase much shorter than the one before shows little about the steps of its mode.
            let least = Controller::FIRST_CUT * self.h;
            let h = self.other_h.replace(self.h).unwrap_or(self.h).max(least);
            let longest = self.system.longest_first_step(to, s, &self.state);
            // A step of length 0 or below would not advance the run.
            self.h = if longest > 0.0 { h.min(longest) } else { h };
            self.controller.begin();
        }
        self.due = self.next_due(self.clock.s)?;
        self.refresh_slope()
    }

    /// The first time after `s` at which a clock of the mode fires.
    fn next_due(&self, s: f64) -> Result<f64, RunError> {
        let clocks = (0..self.phase.count()).filter(|&guard| self.phase.is_clock(guard));
        clocks.map(|guard| self.system.next_time(self.phase.mode, guard, s)).try_fold(
            f64::INFINITY,
            |least, next| match next {
                next if next.is_nan() => Err(RunError::Schedule { s }),
                next => Ok(least.min(next)),
            },
        )
    }

    fn refresh_slope(&mut self) -> Result<(), RunError> {
        let s = self.clock.s;
        check_finite(s, self.state.parts())?;
        self.system.field(self.phase.mode, s, &self.state, &mut self.slope);
        self.statistics.field += 1;
        if is_finite(self.slope.parts()) {
            Ok(())
        } else {
            Err(RunError::Field { s, step: self.statistics.tried() })
        }
    }

    fn estimate_first_step<M: Method>(&mut self) -> f64 {
        let (system, mode) = (self.system, self.phase.mode);
        let mut field =
            |s: f64, y: &S::State, slope: &mut S::State| system.field(mode, s, y, slope);
        self.statistics.field += 1;
        let longest = self.clock.until(self.end).min(self.options.max_step);
        let tolerances = (self.options.rtol, self.options.atol);
        let (mut moved, mut slope) = (self.room.state(), self.room.state());
        let h = first_step_of::<M, _>(
            &mut field,
            (self.clock.s, &self.state, &self.slope),
            tolerances,
            longest,
            (&mut moved, &mut slope),
        );
        self.room.give(moved);
        self.room.give(slope);
        h
    }
}
