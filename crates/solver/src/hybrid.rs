//! A run of a hybrid system from switch to switch: start reading here.
//!
//! [`HybridSystem`] is what a user writes, [`run`] what it is for, [`Observer`] how results come out while
//! the run goes on. One accepted step is `advance`; whether it contains a switch is the business of
//! `event`.

use std::fmt;

use crate::clock::{Clock, Zeno};
use crate::control::{Controller, first_step};
use crate::error::RunError;
use crate::event::{Event, Examination, Found, Phase};
use crate::guard::Guard;
use crate::method::{Dense, Method, State, Step, Trial};
use crate::options::{Options, StepSize};

/// A piecewise-smooth ODE of `N` components with at most `G` guards in a mode.
///
/// The right-hand side and the guards of a mode must be smooth also a little beyond the guards' zeros, since
/// a trial step may end there.
pub trait HybridSystem<const N: usize, const G: usize> {
    /// A smooth regime, with all that its right-hand side and guards depend on beside the state.
    type Mode: Copy + PartialEq + fmt::Debug;

    /// The derivative of the state in `mode`.
    fn field(&self, mode: Self::Mode, s: f64, y: &State<N>) -> State<N>;

    /// The guards of `mode`; [`Guard::OFF`] fills unused places.
    fn guards(&self, mode: Self::Mode) -> [Guard; G];

    /// The values of the guards of `mode`; those of unused places are ignored.
    fn guard_values(&self, mode: Self::Mode, s: f64, y: &State<N>) -> [f64; G];

    /// The rates at which the guards of `mode` change along the solution through `y`, whose zeros are the guards' extrema; each may
    /// be multiplied by anything positive. NaN where they are not known, as in the provided version.
    ///
    /// Only margins use them. Rates that are not known are replaced by differences of the guards along the field, of fourth order,
    /// over a small part of the longest step so far ([`mod@crate::margin`]): five times the guards, and some 1e-13 of rounding. A
    /// guard that changes on a much shorter scale than the solution needs its own rate, or a `max_step` on that scale.
    fn guard_rates(&self, _mode: Self::Mode, _s: f64, _y: &State<N>) -> [f64; G] {
        [f64::NAN; G]
    }

    /// The mode in which a phase goes on once its first step is done.
    ///
    /// A mode that starts from a known zero may need more state for its first step than later, or another
    /// form of its guards; it then gives way here to one that has the same solutions.
    #[inline]
    fn settle(&self, mode: Self::Mode) -> Self::Mode {
        mode
    }

    /// Takes the step `trial` in `mode`.
    ///
    /// The provided one serves every system. A system whose modes have right-hand sides of different cost
    /// may give each mode a step of its own, compiled for that right-hand side alone.
    #[inline]
    fn step<M: Method>(&self, mode: Self::Mode, trial: &Trial<'_, N>, step: &mut Step<N>) {
        step.take::<M>(&mut |s, y| self.field(mode, s, y), trial);
    }

    /// The mode and state that follow when `guard` of `mode` fires at `y`.
    ///
    /// The provided one changes nothing. It serves guards that end the run, and those that take note of a crossing and go on.
    fn transition(
        &self,
        mode: Self::Mode,
        _guard: usize,
        _s: f64,
        y: &State<N>,
    ) -> (Self::Mode, State<N>) {
        (mode, *y)
    }
}

/// Where a run starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start<Mode, const N: usize> {
    /// The first mode.
    pub mode: Mode,
    /// The independent variable.
    pub s: f64,
    /// The state.
    pub state: State<N>,
}

/// A guard fired.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SwitchEvent<Mode, const N: usize> {
    /// Where.
    pub s: f64,
    /// The guard that fired.
    pub guard: usize,
    /// Further guards of the mode that vanish at the same place, one bit each. Of guards that fire together
    /// the one listed first decides the transition, unless it gives way ([`Guard::yielding`]).
    pub simultaneous: u32,
    /// The guard's largest value in the phase over its slope here, in units of s: an error of the guard relative to that value
    /// moves the switch by the error times this. Large near a graze.
    pub flatness: f64,
    /// The mode that ended.
    pub from: Mode,
    /// The mode that begins; `from` if the run ends here.
    pub to: Mode,
    /// State on the guard, before the transition.
    pub before: State<N>,
    /// State after the transition; `before` if the run ends here.
    pub after: State<N>,
}

/// A guard came so close to zero without firing, or fired so briefly, that the dense output could not tell;
/// a step of the method to the extremum did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grazing<Mode> {
    /// Where.
    pub s: f64,
    /// The mode.
    pub mode: Mode,
    /// The guard.
    pub guard: usize,
    /// Its value at the extremum, by the method.
    pub margin: f64,
}

/// Receives what a run finds, in order.
pub trait Observer<Mode, const N: usize> {
    /// Whether [`Self::on_segment`] is wanted: dense output costs further stages.
    const WANTS_SEGMENTS: bool = false;

    /// A guard fired.
    fn on_switch(&mut self, _event: &SwitchEvent<Mode, N>) {}

    /// A guard touched zero or nearly so.
    fn on_grazing(&mut self, _grazing: &Grazing<Mode>) {}

    /// A step was accepted; `dense` covers it.
    fn on_segment(&mut self, _mode: Mode, _dense: &Dense<N>) {}
}

/// Observes nothing.
impl<Mode, const N: usize> Observer<Mode, N> for () {}

/// Why a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// A terminal guard fired.
    EndedByGuard {
        /// Which.
        guard: usize,
    },
    /// The end of the span.
    ReachedEnd,
    /// [`Options::max_steps`] was reached.
    StepLimit,
    /// [`Options::max_switches`] was reached.
    SwitchLimit,
    /// The switches accumulate.
    Zeno {
        /// Where, extrapolated geometrically.
        accumulation: f64,
    },
}

/// Work done by a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Accepted steps, those that end on a switch included.
    pub accepted: usize,
    /// Steps rejected for their error.
    pub rejected: usize,
    /// Steps rejected because a guard was not resolved.
    pub too_coarse: usize,
    /// Evaluations of the right-hand side.
    pub field: usize,
    /// Evaluations of all guards of a mode at a state.
    pub guards: usize,
    /// Steps repeated to end on a switch or on an extremum.
    pub resteps: usize,
    /// Guards on steps that needed the full isolation.
    pub isolations: usize,
    /// Switches.
    pub switches: usize,
    /// Touches.
    pub grazings: usize,
}

impl Statistics {
    /// Steps taken, good or not.
    fn tried(&self) -> usize {
        self.accepted + self.rejected + self.too_coarse
    }
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run<Mode, const N: usize> {
    /// Why it ended.
    pub outcome: Outcome,
    /// Where it ended.
    pub s: f64,
    /// In which mode.
    pub mode: Mode,
    /// The state there.
    pub state: State<N>,
    /// The work done.
    pub statistics: Statistics,
}

/// Integrates `system` from `start` to `end`, through every switch on the way.
///
/// `end` may be infinite where a terminal guard ends the run. Nothing is allocated.
///
/// # Errors
/// [`RunError`]: invalid options, a right-hand side or guard that is not finite, a tolerance that no step
/// meets, a guard that is identically zero.
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
        phase: Phase::enter(system, start.mode, start.s, &start.state)?,
        state: start.state,
        slope: State::zeros(),
        other_h: None,
        h: 0.0,
        controller: Controller::new(),
        zeno: Zeno::new(start.s),
        statistics: Statistics { guards: 1, ..Statistics::default() },
    };
    let outcome = runner.run::<M>()?;
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
    /// Derivative of the state.
    slope: State<N>,
    /// Size of the next step.
    h: f64,
    /// The same for the phase after this one, as the phase before this one left it: modes mostly alternate.
    other_h: Option<f64>,
    controller: Controller,
    zeno: Zeno,
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
            if self.statistics.tried() >= self.options.max_steps {
                return Ok(Outcome::StepLimit);
            }
            self.advance::<M>(&mut step, &mut event)?;
            if let Some(event) = &event {
                if let Some(outcome) = self.switch(event)? {
                    return Ok(outcome);
                }
            } else if self.clock.s >= self.end {
                return Ok(Outcome::ReachedEnd);
            }
        }
    }

    /// Takes one step that is good enough; if it meets a switch, it ends there. Takes none beyond the limit of steps.
    ///
    /// Events hold a step: they are written where they stay, since to return them would copy one on every step.
    fn advance<M: Method>(
        &mut self,
        step: &mut Step<N>,
        event: &mut Option<Event<N>>,
    ) -> Result<(), RunError> {
        *event = None;
        let (system, mode) = (self.system, self.phase.mode);
        let mut field = |s: f64, y: &State<N>| system.field(mode, s, y);
        let mut cuts = 0;
        loop {
            if self.statistics.tried() >= self.options.max_steps {
                return Ok(());
            }
            let left = self.clock.until(self.end);
            let h = self.h.min(self.options.max_step);
            let (h, last) = if h >= left { (left, true) } else { (h, false) };
            let trial = Trial {
                s: self.clock.s,
                y: &self.state,
                slope: &self.slope,
                h,
                tolerances: (self.options.rtol, self.options.atol),
            };
            system.step::<M>(mode, &trial, step);
            self.statistics.field += M::STAGES - 1 + usize::from(M::ERROR_USES_END);
            let error = match self.options.step_size {
                StepSize::Adaptive => step.error,
                StepSize::Fixed(_) => step.y1.sum() * 0.0,
            };
            // Written so that NaN rejects.
            let good = error < 1.0;
            if !good {
                self.reject::<M>(h, error)?;
                continue;
            }
            let mut examination = Examination {
                system,
                phase: &self.phase,
                trial: &trial,
                statistics: &mut self.statistics,
                observer: self.observer,
            };
            match examination.look::<M>(step, event)? {
                Found::Nothing(values) => self.phase.advance(values),
                Found::Event => {}
                Found::TooCoarse(guard) => {
                    self.statistics.too_coarse += 1;
                    cuts += 1;
                    self.h = 0.2 * h;
                    // A step that does not move the time gets nowhere.
                    if cuts > 60 || self.h <= f64::EPSILON * self.clock.s.abs() {
                        return Err(RunError::GuardUnresolved { guard, s: self.clock.s, h });
                    }
                    continue;
                }
            }
            self.statistics.accepted += 1;
            if self.options.step_size == StepSize::Adaptive {
                self.h = if last && event.is_none() {
                    self.h
                } else {
                    self.controller.accepted::<M>(h, error)
                };
            } else if let StepSize::Fixed(h) = self.options.step_size {
                self.h = h;
            }
            if let Some(event) = event {
                if O::WANTS_SEGMENTS && event.step.h > 0.0 {
                    let dense = event.step.dense::<M>(&mut field);
                    self.observer.on_segment(mode, &dense);
                }
                self.clock.advance(event.elapsed);
                return Ok(());
            }
            if O::WANTS_SEGMENTS {
                let dense = step.dense::<M>(&mut field);
                self.observer.on_segment(mode, &dense);
            }
            self.state = step.y1;
            self.slope = step.finish::<M>(&mut field);
            self.statistics.field += usize::from(!M::ERROR_USES_END);
            self.clock.advance(h);
            if last {
                self.clock.arrive(self.end);
            }
            let settled = system.settle(mode);
            if settled != mode {
                let largest = self.phase.largest;
                self.phase = Phase::enter(system, settled, self.clock.s, &self.state)?;
                self.phase = Phase { at_zero: false, zero_orders: [0; G], largest, ..self.phase };
                self.statistics.guards += 1;
                self.refresh_slope()?;
            }
            return Ok(());
        }
    }

    fn reject<M: Method>(&mut self, h: f64, error: f64) -> Result<(), RunError> {
        self.statistics.rejected += 1;
        let step = self.statistics.accepted + self.statistics.rejected;
        let s = self.clock.s;
        if let StepSize::Fixed(_) = self.options.step_size {
            return Err(RunError::Field { s, step });
        }
        self.h = self.controller.rejected::<M>(h, error);
        if self.h <= f64::EPSILON * s.abs().max(f64::MIN_POSITIVE) {
            return Err(if error.is_finite() {
                RunError::Tolerance { s, h, step }
            } else {
                RunError::Field { s, step }
            });
        }
        Ok(())
    }

    /// Reports the switch and enters the next phase, or ends the run.
    fn switch(&mut self, event: &Event<N>) -> Result<Option<Outcome>, RunError> {
        let (s, from, guard) = (self.clock.s, self.phase.mode, event.guard);
        let ends = self.phase.guards[guard].ends_run();
        let (to, after) = if ends {
            (from, event.state)
        } else {
            self.system.transition(from, guard, s, &event.state)
        };
        self.statistics.switches += usize::from(!ends);
        self.observer.on_switch(&SwitchEvent {
            s,
            guard,
            simultaneous: event.simultaneous,
            flatness: self.phase.largest[guard] / event.slope,
            from,
            to,
            before: event.state,
            after,
        });
        self.state = after;
        if ends {
            return Ok(Some(Outcome::EndedByGuard { guard }));
        }
        if self.statistics.switches >= self.options.max_switches {
            return Ok(Some(Outcome::SwitchLimit));
        }
        if let Some(accumulation) = self.zeno.after_switch(s, self.clock.phase, self.options.zeno) {
            return Ok(Some(Outcome::Zeno { accumulation }));
        }
        self.clock.phase = 0.0;
        self.phase = Phase::enter(self.system, to, s, &after)?;
        self.statistics.guards += 1;
        if self.options.step_size == StepSize::Adaptive {
            let h = self.other_h.replace(self.h).unwrap_or(self.h);
            self.h = h;
            self.controller.begin();
        }
        if to == from {
            self.phase.resume(event, after == event.state);
        }
        self.refresh_slope()?;
        Ok(None)
    }

    fn refresh_slope(&mut self) -> Result<(), RunError> {
        let s = self.clock.s;
        if let Some(component) = self.state.iter().position(|v| !v.is_finite()) {
            return Err(RunError::State { s, component });
        }
        self.slope = self.system.field(self.phase.mode, s, &self.state);
        self.statistics.field += 1;
        if self.slope.iter().all(|v| v.is_finite()) {
            Ok(())
        } else {
            Err(RunError::Field { s, step: self.statistics.accepted + self.statistics.rejected })
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
