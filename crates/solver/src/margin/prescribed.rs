//! Runs with a prescribed itinerary, which watch a guard in their last phase.
//!
//! If a system does not know its rates, they are replaced by differences. The reach of these
//! differences is a small part of the longest step so far. Error control knows the scale on which
//! the solution changes, so this works in any unit of time. The rounding of the differences is
//! measured if a decision depends on it.

use std::cell::Cell;

use crate::error::RunError;
use crate::hybrid::{Direction, Guard, HybridSystem, Observer, Outcome, Start, SwitchEvent};
use crate::margin::name::Exit;
use crate::method::control::first_step;
use crate::method::{Method, State, Step, Trial};
use crate::options::{Options, StepSize};
use crate::runs::run;

/// The part of a step over which differences reach. Its fourth power makes an error of 1e-11 of a
/// rate, and rounding one of some 1e-13.
const REACH: f64 = 1.0 / 256.0;

/// A guard at a local minimum, or at the end of the run.
#[derive(Clone, Copy)]
pub(crate) struct Extremum {
    pub s: f64,
    pub value: f64,
}

/// What a prescribed run finds about the guard that it watches.
pub(crate) struct Watched {
    /// The places of the prescribed exits.
    pub exits: Vec<f64>,
    /// The local minima of the guard in the last phase.
    pub minima: Vec<Extremum>,
    /// The guard at the end of the run, if the run got there.
    pub end: Option<Extremum>,
}

/// Follows `exits` and then watches `guard` up to its first minimum after `enough`, or to the end
/// of the run. The result is `None` if the run ends before all exits have happened.
pub(crate) fn watch<M, S, const N: usize, const G: usize>(
    method: M,
    system: &S,
    start: Start<S::Mode, N>,
    end: f64,
    options: &Options,
    exits: &[Exit],
    (guard, enough): (usize, f64),
) -> Result<Option<Watched>, RunError>
where
    M: Method,
    S: HybridSystem<N, G>,
{
    let reach = Reach::new::<M, S, N, G>(system, &start, end, options);
    let prescribed = Prescribed { system, exits, watched: guard, enough, reach };
    // In a prescribed run, switches may be as close together as they like.
    let options = Options { zeno: 0.0, ..*options };
    let mut watching = Watching::<S, G> {
        prescribed: &prescribed,
        seen: Watched { exits: Vec::with_capacity(exits.len()), minima: Vec::new(), end: None },
    };
    let mode = PhaseMode { mode: start.mode, phase: 0, progress: Progress::Start };
    let start = Start { mode, s: start.s, state: start.state };
    let run = run(method, &prescribed, start, end, &options, &mut watching)?;
    if run.mode.phase < exits.len() {
        return Ok(None);
    }
    let mut seen = watching.seen;
    let ended = matches!(run.outcome, Outcome::EndedByGuard { .. } | Outcome::ReachedEnd);
    if ended && run.mode.progress != Progress::Done {
        let value = prescribed.value(run.mode.mode, guard, run.s, &run.state);
        seen.end = Some(Extremum { s: run.s, value });
    }
    let nowhere = seen.minima.iter().chain(&seen.end).find(|extremum| extremum.value.is_nan());
    if let Some(&Extremum { s, .. }) = nowhere {
        return Err(RunError::GuardNotANumber { guard, s });
    }
    Ok(Some(seen))
}

/// A system whose guards fire only as prescribed. The value of one guard, the subject, is replaced
/// by what the run waits for: a place, the guard itself, or its rate.
struct Prescribed<'a, S> {
    system: &'a S,
    exits: &'a [Exit],
    /// The guard to watch after all exits.
    watched: usize,
    /// The guard is watched up to its first minimum after this place.
    enough: f64,
    reach: Reach,
}

/// The reach of the differences that replace unknown rates.
struct Reach {
    /// The start of the present step.
    start: Cell<f64>,
    /// The distance over which the differences reach.
    distance: Cell<f64>,
}

impl Reach {
    /// The reach for the first step of a run.
    fn new<M, S, const N: usize, const G: usize>(
        system: &S,
        start: &Start<S::Mode, N>,
        end: f64,
        options: &Options,
    ) -> Self
    where
        M: Method,
        S: HybridSystem<N, G>,
    {
        let Start { mode, s, state } = *start;
        let longest = (end - s).min(options.max_step);
        let first = match (options.step_size, options.first_step) {
            (StepSize::Fixed(h), _) | (_, Some(h)) => h.min(longest),
            _ => {
                let mut field = |s: f64, y: &State<N>| system.field(mode, s, y);
                let slope = field(s, &state);
                let tolerances = (options.rtol, options.atol);
                first_step::<M, N>(&mut field, s, &state, &slope, tolerances, longest)
            }
        };
        Self { start: Cell::new(s), distance: Cell::new(REACH * first) }
    }

    /// Adapts the reach to the step before, which was accepted up to `s`, where a step now starts.
    fn follow(&self, s: f64) {
        let distance = REACH * (s - self.start.replace(s));
        // It changes seldom, so that rates seldom change between two steps.
        if distance >= 2.0 * self.distance.get() {
            self.distance.set(distance);
        }
    }
}

/// A mode of the system and the progress of the prescribed run.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PhaseMode<Mode> {
    mode: Mode,
    /// The number of exits that have happened.
    phase: usize,
    progress: Progress,
}

/// The progress within a phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Progress {
    /// Nothing that the run waits for has happened yet.
    Start,
    /// The run has passed the place after which the guard of the exit may fire.
    Armed,
    /// The run has passed a minimum of the guard that it watches.
    Minimum,
    /// The run has passed the last minimum that it has to find.
    Done,
}

/// What the run waits for.
enum Awaited {
    /// The run waits for this place.
    Place(f64),
    /// The run waits for the zero of the subject.
    Guard,
    /// The run waits for a minimum of the subject.
    Minimum,
    /// The run waits for nothing any more.
    Nothing,
}

impl<S> Prescribed<'_, S> {
    /// The subject, which is the guard that counts, and what the run waits for.
    fn subject<Mode>(&self, at: &PhaseMode<Mode>) -> (usize, Awaited) {
        match self.exits.get(at.phase) {
            Some(exit) if at.progress == Progress::Start && exit.part.0 > 0.0 => {
                (exit.guard, Awaited::Place(exit.after.0))
            }
            Some(exit) => (exit.guard, Awaited::Guard),
            None if at.progress == Progress::Done => (self.watched, Awaited::Nothing),
            None => (self.watched, Awaited::Minimum),
        }
    }

    /// The rate of `guard`, by differences if it is not known.
    fn rate<const N: usize, const G: usize>(
        &self,
        mode: <S as HybridSystem<N, G>>::Mode,
        guard: usize,
        s: f64,
        y: &State<N>,
    ) -> f64
    where
        S: HybridSystem<N, G>,
    {
        let rate = self.system.guard_rates(mode, s, y)[guard];
        if !rate.is_nan() {
            return rate;
        }
        let (slope, reach) = (self.system.field(mode, s, y), self.reach.distance.get());
        let at =
            |reach: f64| self.system.guard_values(mode, s + reach, &(y + slope * reach))[guard];
        let near = at(reach) - at(-reach);
        let far = at(2.0 * reach) - at(-2.0 * reach);
        (8.0 * near - far) / (12.0 * reach)
    }

    /// The guard's value, positive where it does not fire.
    fn value<const N: usize, const G: usize>(
        &self,
        mode: <S as HybridSystem<N, G>>::Mode,
        guard: usize,
        s: f64,
        y: &State<N>,
    ) -> f64
    where
        S: HybridSystem<N, G>,
    {
        let rises = self.system.guards(mode)[guard].direction() == Direction::Rising;
        let value = self.system.guard_values(mode, s, y)[guard];
        if rises { -value } else { value }
    }
}

impl<S, const N: usize, const G: usize> HybridSystem<N, G> for Prescribed<'_, S>
where
    S: HybridSystem<N, G>,
{
    type Mode = PhaseMode<S::Mode>;

    #[inline]
    fn field(&self, at: Self::Mode, s: f64, y: &State<N>) -> State<N> {
        self.system.field(at.mode, s, y)
    }

    fn guards(&self, at: Self::Mode) -> [Guard; G] {
        let (subject, awaited) = self.subject(&at);
        let own = self.system.guards(at.mode);
        let guard_of = |guard: usize| {
            // A zero at the start of the phase matters only there.
            let order = if at.progress == Progress::Start { own[guard].zero_order() } else { 0 };
            if own[guard].ends_run() {
                return Guard::new(own[guard].direction()).from_zero(order).terminal();
            }
            if guard != subject {
                return Guard::OFF;
            }
            match awaited {
                Awaited::Place(_) => Guard::new(Direction::Below),
                // Not `Below`: after a graze it may still be negative, and must rise first.
                Awaited::Guard => Guard::new(Direction::Falling).from_zero(order),
                Awaited::Minimum => {
                    // The rate rises from zero after a minimum.
                    let after_minimum = at.progress == Progress::Minimum;
                    let order = if after_minimum { 1 } else { order.saturating_sub(1) };
                    Guard::new(Direction::Rising).from_zero(order)
                }
                Awaited::Nothing => Guard::new(Direction::Below).terminal(),
            }
        };
        // Place and rate of a smooth guard are smooth too.
        std::array::from_fn(|guard| guard_of(guard).as_smooth_as(&own[guard]))
    }

    #[inline]
    fn guard_values(&self, at: Self::Mode, s: f64, y: &State<N>) -> [f64; G] {
        let (subject, awaited) = self.subject(&at);
        let mut values = self.system.guard_values(at.mode, s, y);
        let rises = self.system.guards(at.mode)[subject].direction() == Direction::Rising;
        let sign = if rises { -1.0 } else { 1.0 };
        values[subject] = match awaited {
            Awaited::Place(place) => place - s,
            Awaited::Guard => sign * values[subject],
            Awaited::Minimum => sign * self.rate(at.mode, subject, s, y),
            Awaited::Nothing => -1.0,
        };
        values
    }

    fn longest_first_step(&self, at: Self::Mode, s: f64, y: &State<N>) -> f64 {
        self.system.longest_first_step(at.mode, s, y)
    }

    fn settle(&self, at: Self::Mode) -> Self::Mode {
        PhaseMode { mode: self.system.settle(at.mode), ..at }
    }

    fn step<M: Method>(&self, at: Self::Mode, trial: &Trial<'_, N>, step: &mut Step<N>) {
        self.reach.follow(trial.s);
        self.system.step::<M>(at.mode, trial, step);
    }

    fn transition(
        &self,
        at: Self::Mode,
        guard: usize,
        s: f64,
        y: &State<N>,
    ) -> (Self::Mode, State<N>) {
        let progress = match self.subject(&at).1 {
            Awaited::Guard => {
                let (mode, y) = self.system.transition(at.mode, guard, s, y);
                return (PhaseMode { mode, phase: at.phase + 1, progress: Progress::Start }, y);
            }
            Awaited::Place(_) => Progress::Armed,
            Awaited::Minimum if s < self.enough => Progress::Minimum,
            Awaited::Minimum | Awaited::Nothing => Progress::Done,
        };
        (PhaseMode { progress, ..at }, *y)
    }
}

/// Records the exits, and the minima of the guard that is watched.
struct Watching<'a, S, const G: usize> {
    prescribed: &'a Prescribed<'a, S>,
    seen: Watched,
}

impl<S, const N: usize, const G: usize> Observer<PhaseMode<S::Mode>, N> for Watching<'_, S, G>
where
    S: HybridSystem<N, G>,
{
    fn on_switch(&mut self, event: &SwitchEvent<PhaseMode<S::Mode>, N>) {
        let (guard, awaited) = self.prescribed.subject(&event.from);
        if event.guard != guard {
            return;
        }
        match awaited {
            Awaited::Place(_) | Awaited::Nothing => {}
            Awaited::Guard => self.seen.exits.push(event.s),
            Awaited::Minimum => {
                let value = self.prescribed.value(event.from.mode, guard, event.s, &event.before);
                self.seen.minima.push(Extremum { s: event.s, value });
            }
        }
    }
}
