//! A run of a hybrid system from switch to switch.
//!
//! `advance` takes one accepted step. The module `events` finds out whether the step contains a
//! switch.

use std::cmp::Ordering;

use crate::error::RunError;
use crate::events::{
    Event, Examination, Found, Noticed, Notices, Phase, all_clearly_away, bit, dense_output,
    values_on,
};
use crate::hybrid::{HybridSystem, Observer, Outcome, Run, Start, Statistics, SwitchEvent};
use crate::method::control::{Controller, first_step};
use crate::method::{Method, State, Step, Trial};
use crate::options::{Options, StepSize};
use crate::runs::clock::{Clock, Zeno};
use crate::runs::finite::{check_finite, is_finite};
use crate::runs::last_part::last_part;
use crate::runs::rejected::after_rejection;

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
    options.validate()?;
    if !(start.s.is_finite() && end > start.s) {
        return Err(RunError::Span { from: start.s, to: end });
    }
    let mut runner = Runner {
        system,
        options,
        observer,
        end,
        clock: Clock::new(start.s),
        phase: Phase::enter(system, start.mode, (start.s, &start.state), &[0; G])?,
        state: start.state,
        rest: State::zeros(),
        slope: State::zeros(),
        other_h: None,
        h: 0.0,
        controller: Controller::new(),
        zeno: Zeno::new(start.s),
        fired: [0; G],
        notes: Vec::new(),
        notices: Notices::new(),
        statistics: Statistics { guards: 1, ..Statistics::default() },
    };
    let outcome = runner.run::<M>()?;
    runner.observer.on_end(runner.phase.mode, runner.clock.s, &runner.state);
    Ok(Run {
        outcome,
        s: runner.clock.s,
        mode: runner.phase.mode,
        state: runner.state,
        statistics: runner.statistics,
    })
}

/// The state of a run between two steps.
struct Runner<'a, S: HybridSystem<N, G>, O, const N: usize, const G: usize> {
    system: &'a S,
    options: &'a Options,
    observer: &'a mut O,
    end: f64,
    clock: Clock,
    phase: Phase<S::Mode, G>,
    state: State<N>,
    /// What rounding has cut off from the state.
    rest: State<N>,
    /// The derivative of the state.
    slope: State<N>,
    /// The size of the next step.
    h: f64,
    /// The size of the first step of the next phase. It is taken over from the phase before the
    /// present one, since modes mostly alternate.
    other_h: Option<f64>,
    controller: Controller,
    zeno: Zeno,
    /// How often each guard has fired.
    fired: [u32; G],
    /// The events on the present step that change nothing.
    notes: Vec<SwitchEvent<S::Mode, N>>,
    /// The touches and poles on the present step.
    notices: Notices<S::Mode>,
    statistics: Statistics,
}

impl<S, O, const N: usize, const G: usize> Runner<'_, S, O, N, G>
where
    S: HybridSystem<N, G>,
    O: Observer<S::Mode, N>,
{
    fn run<M: Method>(&mut self) -> Result<Outcome, RunError> {
        self.refresh_slope()?;
        self.h = match (self.options.step_size, self.options.first_step) {
            (StepSize::Fixed(h), _) | (StepSize::Adaptive, Some(h)) => h,
            (StepSize::Adaptive, None) => self.estimate_first_step::<M>(),
        };
        let (mut step, mut event) = (Step::blank(), None);
        loop {
            if let Some(outcome) = self.advance::<M>(&mut step, &mut event)? {
                return Ok(outcome);
            }
            if let Some(event) = &event
                && let Some(outcome) = self.switch(event)?
            {
                return Ok(outcome);
            }
            if self.clock.until(self.end) <= 0.0 {
                check_finite(self.clock.s, self.state.as_slice())?;
                return Ok(Outcome::ReachedEnd);
            }
            if self.observer.stops() {
                return Ok(Outcome::Stopped);
            }
        }
    }

    /// Takes one step that is good enough. The step ends at a switch if it meets one that changes
    /// something. Other events on it are reported. Returns the outcome if the run ends here.
    ///
    /// An event contains a step. It is written to the place where it stays, since returning it
    /// would copy it on every step.
    fn advance<M: Method>(
        &mut self,
        step: &mut Step<N>,
        event: &mut Option<Event<N>>,
    ) -> Result<Option<Outcome>, RunError> {
        *event = None;
        let (system, mode) = (self.system, self.phase.mode);
        let mut field = |s: f64, y: &State<N>| system.field(mode, s, y);
        let mut cuts = 0;
        loop {
            if self.statistics.tried() >= self.options.max_steps {
                return Ok(Some(Outcome::StepLimit));
            }
            let h = self.h.min(self.options.max_step);
            let (h, last) = self.clock.step_towards(self.end, h);
            let trial = Trial {
                s: self.clock.s,
                y: &self.state,
                rest: &self.rest,
                slope: &self.slope,
                h,
                tolerances: (self.options.rtol, self.options.atol),
            };
            system.step::<M>(mode, &trial, step);
            self.statistics.field += M::STAGES - 1 + usize::from(M::ERROR_USES_END);
            let error = match self.options.step_size {
                StepSize::Adaptive => step.error,
                StepSize::Fixed(_) if is_finite(step.y1.as_slice()) => 0.0,
                StepSize::Fixed(_) => f64::NAN,
            };
            // NaN is not good.
            if !matches!(error.partial_cmp(&1.0), Some(Ordering::Less)) {
                let finite = is_finite(step.y1.as_slice());
                let work = (&mut self.controller, &mut self.statistics);
                self.h =
                    after_rejection::<M>(work, self.options, (self.clock.s, h), error, finite)?;
                continue;
            }
            self.notes.clear();
            let values = values_on(system, &self.phase, step, &mut self.statistics);
            let (phase, statistics) = (&self.phase, &mut self.statistics);
            let scale = self.options.scale_of_guards();
            let away = all_clearly_away(system, phase, scale, step, &values, statistics);
            if away && !last {
                self.phase.advance(values[5]);
            } else if let Some(guard) =
                self.look_closely::<M>(h, step, event, (&values, away), last)?
            {
                self.statistics.too_coarse += 1;
                cuts += 1;
                // A step may become so short that it is less than the rest.
                self.rest = State::zeros();
                self.h = 0.2 * h;
                // A step that does not move the time is useless.
                if cuts > 60 || self.h <= f64::EPSILON * self.clock.s.abs() {
                    let known = values.iter().all(|value| !value[guard].is_nan());
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
                last_part::<M, S, O, N, G>(system, mode, step, s, statistics, self.observer);
                return Ok(Some(outcome));
            }
            if let Some(event) = event {
                self.tell_until(self.clock.s + event.elapsed);
                if event.step.h > 0.0 {
                    self.show::<M>(mode, &mut event.step);
                }
                self.clock.advance(event.elapsed);
                if last && event.elapsed == h {
                    self.clock.arrive(self.end);
                }
                return Ok(None);
            }
            self.tell_until(f64::INFINITY);
            self.show::<M>(mode, step);
            (self.state, self.rest) = (step.y1, step.rest);
            self.slope = step.finish::<M>(&mut field);
            self.statistics.field += usize::from(!M::ERROR_USES_END);
            self.clock.advance(h);
            if last {
                self.clock.arrive(self.end);
            }
            let settled = system.settle(mode);
            if settled != mode {
                let largest = self.phase.largest;
                let place = (self.clock.s, &self.state);
                self.phase = Phase::enter(system, settled, place, &self.fired)?;
                self.phase = Phase { at_zero: false, zero_orders: [0; G], largest, ..self.phase };
                self.statistics.guards += 1;
                self.refresh_slope()?;
            }
            return Ok(None);
        }
    }

    /// Examines a `step` of size `h` whose guards have these `values` at its nodes. Returns the
    /// guard for which the step is too coarse, if there is one.
    #[inline(never)]
    fn look_closely<M: Method>(
        &mut self,
        h: f64,
        step: &mut Step<N>,
        event: &mut Option<Event<N>>,
        (values, away): (&[[f64; G]; 6], bool),
        last: bool,
    ) -> Result<Option<usize>, RunError> {
        self.notices.clear();
        let tolerances = (self.options.rtol, self.options.atol);
        let (y, rest, slope) = (&self.state, &self.rest, &self.slope);
        let trial = Trial { s: self.clock.s, y, rest, slope, h, tolerances };
        let mut examination = Examination {
            system: self.system,
            phase: &self.phase,
            trial: &trial,
            guard_scale: self.options.scale_of_guards(),
            notes: &mut self.notes,
            statistics: &mut self.statistics,
            wants_segments: O::WANTS_SEGMENTS,
            notices: &mut self.notices,
        };
        let at_end = match examination.look::<M>(step, event, values, away)? {
            Found::Nothing(at_end) => at_end,
            Found::Event => return Ok(None),
            Found::TooCoarse(guard) => return Ok(Some(guard)),
        };
        if last {
            examination.arrive(step, event);
        }
        if event.is_none() {
            self.phase.advance(at_end);
        }
        Ok(None)
    }

    /// Shows an accepted step to the observer, if it wants to see steps.
    #[inline(always)]
    fn show<M: Method>(&mut self, mode: S::Mode, step: &mut Step<N>) {
        if O::WANTS_SEGMENTS {
            let dense = dense_output::<_, M, N, G>(self.system, mode, step);
            self.observer.on_segment(mode, &dense);
        }
    }

    /// Tells of touches and poles on the step, up to the place `until`.
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
        for index in 0..self.notes.len() {
            let note = self.notes[index];
            self.tell_until(note.s);
            self.observer.on_switch(&note);
            let others = (0..G).filter(|&other| note.simultaneous & bit(other) != 0);
            for guard in others.chain([note.guard]) {
                self.fired[guard] += 1;
                self.phase.guards[guard] = self.phase.guards[guard].fired(1);
            }
            self.statistics.switches += 1;
            let outcome = if self.statistics.switches >= self.options.max_switches {
                Outcome::SwitchLimit
            } else if self.observer.stops() {
                Outcome::Stopped
            } else {
                continue;
            };
            (self.state, self.rest) = (note.after, State::zeros());
            self.clock.arrive(note.s);
            return Some(outcome);
        }
        None
    }

    /// Reports the switch and enters the next phase, or ends the run.
    fn switch(&mut self, event: &Event<N>) -> Result<Option<Outcome>, RunError> {
        let (s, from, guard) = (self.clock.s, self.phase.mode, event.guard);
        check_finite(s, event.state.as_slice())?;
        let ends = self.phase.guards[guard].ends_run();
        let (to, after) = if ends {
            (from, event.state)
        } else {
            self.system.transition(from, guard, s, &event.state)
        };
        self.fired[guard] += 1;
        self.statistics.switches += usize::from(!ends);
        let largest = self.phase.largest[guard];
        // A guard that has always been zero has no size.
        let flatness = if largest == 0.0 { 0.0 } else { largest / event.slope };
        self.observer.on_switch(&SwitchEvent {
            s,
            guard,
            simultaneous: event.simultaneous,
            flatness,
            jump: event.jump,
            from,
            to,
            before: event.state,
            after,
        });
        (self.state, self.rest) = (after, State::zeros());
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
        let stood = if self.clock.phase == 0.0 { self.phase.forgiven } else { [false; G] };
        self.clock.phase = 0.0;
        self.phase = Phase::enter(self.system, to, (s, &after), &self.fired)?;
        self.phase.forgive(self.system, (s, &after), event, (from, largest), &stood);
        self.statistics.guards += 1;
        if self.options.step_size == StepSize::Adaptive {
            let h = self.other_h.replace(self.h).unwrap_or(self.h);
            let longest = self.system.longest_first_step(to, s, &after);
            // A length that is none would keep the run where it is.
            self.h = if longest > 0.0 { h.min(longest) } else { h };
            self.controller.begin();
        }
        self.refresh_slope()?;
        Ok(None)
    }

    fn refresh_slope(&mut self) -> Result<(), RunError> {
        let s = self.clock.s;
        check_finite(s, self.state.as_slice())?;
        self.slope = self.system.field(self.phase.mode, s, &self.state);
        self.statistics.field += 1;
        if is_finite(self.slope.as_slice()) {
            Ok(())
        } else {
            Err(RunError::Field { s, step: self.statistics.tried() })
        }
    }

    fn estimate_first_step<M: Method>(&mut self) -> f64 {
        let (system, mode) = (self.system, self.phase.mode);
        let mut field = |s: f64, y: &State<N>| system.field(mode, s, y);
        self.statistics.field += 1;
        let longest = self.clock.until(self.end).min(self.options.max_step);
        let tolerances = (self.options.rtol, self.options.atol);
        first_step::<M, N>(&mut field, self.clock.s, &self.state, &self.slope, tolerances, longest)
    }
}
