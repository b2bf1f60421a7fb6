//! A run of a dynamic system from switch to switch: the loop of [`crate::runs::runner`] on buffers.

use std::cmp::Ordering;

use crate::dynamic::curve::Work;
use crate::dynamic::event::{Event, Found};
use crate::dynamic::examination::{Examination, Tables};
use crate::dynamic::first_step::first_step;
use crate::dynamic::phase::Phase;
use crate::dynamic::results::{DynamicObserver, DynamicRun};
use crate::dynamic::step::{Origin, Step};
use crate::dynamic::system::{DynamicStart, DynamicSystem};
use crate::error::RunError;
use crate::events::{Noticed, Notices};
use crate::hybrid::{Outcome, Statistics};
use crate::method::Method;
use crate::method::control::Controller;
use crate::options::{Options, StepSize};
use crate::runs::clock::{Clock, Zeno};
use crate::runs::finite::{check_finite, is_finite};
use crate::runs::rejected::after_rejection;

/// Integrates `system` from `start` to `end`, through every switch on the way.
///
/// It does what [`run`](crate::run) does for a system of black boxes, with the same options,
/// outcomes, errors and defined answers; see [`mod@crate::dynamic`] for what differs. `end` may be
/// infinite if a terminal guard ends the run. All buffers are allocated when the run starts; a step
/// without event allocates nothing.
///
/// # Errors
/// A [`RunError`] reports invalid options, a span that does not lead forward, a state or right-hand
/// side that is not finite, a guard that is not a number, that is identically zero or that cannot
/// be resolved, and a tolerance that no step meets.
pub fn run_dynamic<M, S, O>(
    _method: M,
    system: &S,
    start: DynamicStart<'_, S::Mode>,
    end: f64,
    options: &Options,
    observer: &mut O,
) -> Result<DynamicRun<S::Mode>, RunError>
where
    M: Method,
    S: DynamicSystem,
    O: DynamicObserver<S::Mode>,
{
    options.validate()?;
    if !(start.s.is_finite() && end > start.s) {
        return Err(RunError::Span { from: start.s, to: end });
    }
    let mut phase = Phase::new(start.mode);
    phase.enter(system, start.mode, (start.s, start.state), &[])?;
    let n = start.state.len();
    let mut runner = Runner {
        system,
        options,
        observer,
        end,
        clock: Clock::new(start.s),
        phase,
        state: start.state.to_vec(),
        rest: vec![0.0; n],
        slope: vec![0.0; n],
        other_h: None,
        h: 0.0,
        controller: Controller::new(),
        zeno: Zeno::new(start.s),
        fired: Vec::new(),
        notes: Vec::new(),
        notices: Notices::new(),
        step: Step::new(n),
        work: Work::new(n),
        stand: Vec::new(),
        tables: Tables::default(),
        statistics: Statistics { guards: 1, ..Statistics::default() },
    };
    let outcome = runner.run::<M>()?;
    runner.observer.on_end(runner.phase.mode, runner.clock.s, &runner.state);
    Ok(DynamicRun {
        outcome,
        s: runner.clock.s,
        mode: runner.phase.mode,
        state: runner.state,
        statistics: runner.statistics,
    })
}

/// The state of a run between two steps, and its buffers.
struct Runner<'a, S: DynamicSystem, O> {
    system: &'a S,
    options: &'a Options,
    observer: &'a mut O,
    end: f64,
    clock: Clock,
    phase: Phase<S::Mode>,
    state: Vec<f64>,
    /// What rounding has cut off from the state.
    rest: Vec<f64>,
    /// The derivative of the state.
    slope: Vec<f64>,
    /// The size of the next step.
    h: f64,
    /// As in [`crate::runs::runner`].
    other_h: Option<f64>,
    controller: Controller,
    zeno: Zeno,
    /// How often each guard has fired.
    fired: Vec<u32>,
    /// The events on the present step that change nothing.
    notes: Vec<Event>,
    /// The touches and poles on the present step.
    notices: Notices<S::Mode>,
    step: Step,
    work: Work,
    /// Which guards stand on their zero where a phase begins.
    stand: Vec<bool>,
    tables: Tables,
    statistics: Statistics,
}

impl<S: DynamicSystem, O: DynamicObserver<S::Mode>> Runner<'_, S, O> {
    fn run<M: Method>(&mut self) -> Result<Outcome, RunError> {
        self.refresh_slope()?;
        self.h = match (self.options.step_size, self.options.first_step) {
            (StepSize::Fixed(h), _) | (StepSize::Adaptive, Some(h)) => h,
            (StepSize::Adaptive, None) => self.estimate_first_step::<M>(),
        };
        loop {
            if let Some(outcome) = self.advance::<M>()? {
                return Ok(outcome);
            }
            if self.clock.until(self.end) <= 0.0 {
                check_finite(self.clock.s, &self.state)?;
                return Ok(Outcome::ReachedEnd);
            }
            if self.observer.stops() {
                return Ok(Outcome::Stopped);
            }
        }
    }

    /// Takes one step that is good enough, up to the first switch that changes something, and that
    /// switch. Other events on the step are reported. Returns the outcome if the run ends here.
    fn advance<M: Method>(&mut self) -> Result<Option<Outcome>, RunError> {
        let mut cuts = 0;
        // The place of an event up to which the step is taken.
        let mut target = None;
        loop {
            if self.statistics.tried() >= self.options.max_steps {
                return Ok(Some(Outcome::StepLimit));
            }
            let h = target.unwrap_or(self.h.min(self.options.max_step));
            let (h, last) = self.clock.step_towards(self.end, h);
            let error = self.take::<M>(h);
            // NaN is not good.
            if !matches!(error.partial_cmp(&1.0), Some(Ordering::Less)) {
                target = None;
                let finite = is_finite(&self.step.y1);
                let work = (&mut self.controller, &mut self.statistics);
                self.h =
                    after_rejection::<M>(work, self.options, (self.clock.s, h), error, finite)?;
                continue;
            }
            let event = match self.examine::<M>(last)? {
                Ok(event) => event,
                Err((guard, place)) => {
                    self.statistics.too_coarse += 1;
                    cuts += 1;
                    self.rest.fill(0.0);
                    // A step to the event is tried once, then shorter ones.
                    let again = target.is_some();
                    target = place.filter(|&place| !again && place < h);
                    if target.is_none() {
                        self.h = 0.2 * h;
                    }
                    // A step that does not move the time is useless.
                    if cuts > 60 || self.h <= f64::EPSILON * self.clock.s.abs() {
                        let column = self.tables.column(guard, self.phase.values.len());
                        let known = !column.iter().any(|value| value.is_nan());
                        return Err(RunError::unresolved(guard, (self.clock.s, h), known));
                    }
                    continue;
                }
            };
            self.statistics.accepted += 1;
            match self.options.step_size {
                StepSize::Fixed(h) => self.h = h,
                // The last step was cut at the end.
                StepSize::Adaptive if last && event.is_none() => {}
                StepSize::Adaptive => self.h = self.controller.accepted::<M>(h, error),
            }
            if let Some(outcome) = self.report_notes::<M>() {
                return Ok(Some(outcome));
            }
            if let Some(event) = event {
                self.tell_until(self.clock.s + event.elapsed);
                self.show_part::<M>(event.elapsed);
                self.clock.advance(event.elapsed);
                if last && event.elapsed == h {
                    self.clock.arrive(self.end);
                }
                return self.switch(&event);
            }
            self.tell_until(f64::INFINITY);
            self.accept::<M>(h);
            if last {
                self.clock.arrive(self.end);
            }
            return Ok(None);
        }
    }

    /// Takes a step of size `h`. Returns its error.
    fn take<M: Method>(&mut self, h: f64) -> f64 {
        let (system, mode) = (self.system, self.phase.mode);
        let field = |s: f64, y: &[f64], slope: &mut [f64]| system.field(mode, s, y, slope);
        let origin =
            Origin { s: self.clock.s, y: &self.state, rest: &self.rest, slope: &self.slope };
        self.step.take::<M>(&field, origin, h, (self.options.rtol, self.options.atol));
        self.statistics.field += M::STAGES - 1 + usize::from(M::ERROR_USES_END);
        match self.options.step_size {
            StepSize::Adaptive => self.step.error,
            StepSize::Fixed(_) if is_finite(&self.step.y1) => 0.0,
            StepSize::Fixed(_) => f64::NAN,
        }
    }

    /// Looks for events on the step that was taken, which is the `last` one of the span or not. The
    /// inner error is a guard that is not resolved, with the place of an event before.
    #[expect(clippy::type_complexity, reason = "the inner result lives for one line")]
    fn examine<M: Method>(
        &mut self,
        last: bool,
    ) -> Result<Result<Option<Event>, (usize, Option<f64>)>, RunError> {
        self.notes.clear();
        self.notices.clear();
        let mut examination = Examination {
            system: self.system,
            phase: &self.phase,
            origin: Origin {
                s: self.clock.s,
                y: &self.state,
                rest: &self.rest,
                slope: &self.slope,
            },
            guard_scale: self.options.scale_of_guards(),
            tolerances: (self.options.rtol, self.options.atol),
            notes: &mut self.notes,
            tables: &mut self.tables,
            work: &mut self.work,
            statistics: &mut self.statistics,
            notices: &mut self.notices,
        };
        let event = match examination.look::<M>(&mut self.step)? {
            Found::Nothing if last => examination.arrive(&self.step),
            Found::Nothing => None,
            Found::Event(event) => Some(event),
            Found::TooCoarse(guard, place) => return Ok(Err((guard, place))),
        };
        if event.is_none() {
            self.phase.advance(&self.tables.ends);
        }
        Ok(Ok(event))
    }

    /// Goes on at the end of the step.
    fn accept<M: Method>(&mut self, h: f64) {
        let (system, mode) = (self.system, self.phase.mode);
        let field = |s: f64, y: &[f64], slope: &mut [f64]| system.field(mode, s, y, slope);
        let origin =
            Origin { s: self.clock.s, y: &self.state, rest: &self.rest, slope: &self.slope };
        if O::WANTS_SEGMENTS {
            self.statistics.field += self.step.extend::<M>(&field, origin);
            self.observer.on_segment(mode, &self.step.dense::<M>(origin.s));
        }
        self.statistics.field += self.step.finish::<M>(&field, origin);
        self.state.copy_from_slice(&self.step.y1);
        self.rest.copy_from_slice(&self.step.rest);
        self.slope.copy_from_slice(self.step.slope_at_end::<M>());
        self.clock.advance(h);
    }

    /// Shows the first part of the step, of size `h`, to the observer.
    fn show_part<M: Method>(&mut self, h: f64) {
        if !O::WANTS_SEGMENTS || h <= 0.0 {
            return;
        }
        let (system, mode) = (self.system, self.phase.mode);
        let field = |s: f64, y: &[f64], slope: &mut [f64]| system.field(mode, s, y, slope);
        let origin =
            Origin { s: self.clock.s, y: &self.state, rest: &self.rest, slope: &self.slope };
        let part = &mut self.work.restep;
        part.take_end::<M>(&field, origin, h);
        self.statistics.field += M::STAGES - 1 + part.extend::<M>(&field, origin);
        self.statistics.resteps += 1;
        self.observer.on_segment(mode, &part.dense::<M>(origin.s));
    }

    /// Counts that a guard has fired.
    fn count(&mut self, guard: usize) {
        if self.fired.len() <= guard {
            self.fired.resize(guard + 1, 0);
        }
        self.fired[guard] += 1;
    }

    /// Tells of touches and poles on the step, up to the place `until`.
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
    fn report_notes<M: Method>(&mut self) -> Option<Outcome> {
        let mode = self.phase.mode;
        for index in 0..self.notes.len() {
            let (elapsed, guard) = (self.notes[index].elapsed, self.notes[index].guard);
            let s = self.clock.s + elapsed;
            self.tell_until(s);
            let note = &self.notes[index];
            let largest = self.phase.largest[guard];
            self.observer.on_switch(&note.shown(s, largest, (mode, mode), &note.state));
            for other in 0..=self.notes[index].simultaneous.len() {
                let fired = self.notes[index].simultaneous.get(other).copied().unwrap_or(guard);
                self.count(fired);
                self.phase.guards[fired] = self.phase.guards[fired].fired(1);
            }
            self.statistics.switches += 1;
            let outcome = if self.statistics.switches >= self.options.max_switches {
                Outcome::SwitchLimit
            } else if self.observer.stops() {
                Outcome::Stopped
            } else {
                continue;
            };
            self.show_part::<M>(elapsed);
            self.state.copy_from_slice(&self.notes[index].state);
            self.rest.fill(0.0);
            self.clock.arrive(s);
            return Some(outcome);
        }
        None
    }

    /// Reports the switch and enters the next phase, or ends the run.
    fn switch(&mut self, event: &Event) -> Result<Option<Outcome>, RunError> {
        let (s, from, guard) = (self.clock.s, self.phase.mode, event.guard);
        check_finite(s, &event.state)?;
        let s_scale = s.abs().max((s - event.elapsed).abs());
        for ((scale, start), end) in self.work.scale.iter_mut().zip(&self.state).zip(&event.state) {
            *scale = start.abs().max(end.abs());
        }
        let ends = self.phase.guards[guard].ends_run();
        self.state.copy_from_slice(&event.state);
        self.rest.fill(0.0);
        let to = if ends { from } else { self.system.transition(from, guard, s, &mut self.state) };
        self.count(guard);
        self.statistics.switches += usize::from(!ends);
        let largest = self.phase.largest[guard];
        self.observer.on_switch(&event.shown(s, largest, (from, to), &self.state));
        if ends {
            return Ok(Some(Outcome::EndedByGuard { guard }));
        }
        self.phase.mode = to;
        if self.statistics.switches >= self.options.max_switches {
            return Ok(Some(Outcome::SwitchLimit));
        }
        if let Some(outcome) = self.zeno.after_switch(s, self.clock.phase, self.options) {
            return Ok(Some(outcome));
        }
        self.stand.clear();
        if self.clock.phase == 0.0 {
            self.stand.extend_from_slice(&self.phase.forgiven);
        }
        self.clock.phase = 0.0;
        for (scale, after) in self.work.scale.iter_mut().zip(&self.state) {
            *scale = scale.max(after.abs());
        }
        let (system, place) = (self.system, (s, &self.state[..]));
        self.phase.enter(system, to, place, &self.fired)?;
        self.statistics.guards += 1;
        self.keep_standing(from, s, event);
        let same = (to == from || self.stand[guard], &self.stand[..]);
        self.statistics.guards +=
            self.phase.forgive(system, (s, &self.state), event, same, s_scale, &mut self.work);
        if self.options.step_size == StepSize::Adaptive {
            let h = self.other_h.replace(self.h).unwrap_or(self.h);
            self.h = h;
            self.controller.begin();
        }
        self.refresh_slope()?;
        Ok(None)
    }

    /// Of the guards that stood on their zero at this instant, and of that which fired in the mode
    /// `from`, keeps those that seem to be guards of the new mode too: where the state goes on
    /// unchanged, they have the same values or their negatives.
    fn keep_standing(&mut self, from: S::Mode, s: f64, event: &Event) {
        self.stand.resize(self.phase.values.len().max(event.guard + 1), false);
        self.stand[event.guard] = !event.jump;
        if self.state != event.state || !self.stand.contains(&true) {
            self.stand.fill(false);
            return;
        }
        self.statistics.guards += 1;
        let values = &mut self.work.values;
        values.resize(self.system.guards(from).len(), f64::NAN);
        self.system.guard_values(from, s, &event.state, values);
        for (guard, stands) in self.stand.iter_mut().enumerate() {
            *stands &=
                values.get(guard).map(|v| v.abs()) == self.phase.values.get(guard).map(|v| v.abs());
        }
    }

    fn refresh_slope(&mut self) -> Result<(), RunError> {
        let s = self.clock.s;
        check_finite(s, &self.state)?;
        self.system.field(self.phase.mode, s, &self.state, &mut self.slope);
        self.statistics.field += 1;
        if is_finite(&self.slope) {
            Ok(())
        } else {
            Err(RunError::Field { s, step: self.statistics.tried() })
        }
    }

    fn estimate_first_step<M: Method>(&mut self) -> f64 {
        let (system, mode) = (self.system, self.phase.mode);
        let field = |s: f64, y: &[f64], slope: &mut [f64]| system.field(mode, s, y, slope);
        self.statistics.field += 1;
        let longest = self.clock.until(self.end).min(self.options.max_step);
        let origin =
            Origin { s: self.clock.s, y: &self.state, rest: &self.rest, slope: &self.slope };
        let tolerances = (self.options.rtol, self.options.atol);
        let Work { moved, state, .. } = &mut self.work;
        first_step::<M>(&field, origin, tolerances, longest, (moved, state))
    }
}
