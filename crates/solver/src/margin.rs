//! How near a run came to switching otherwise, and runs whose itinerary is prescribed.
//!
//! A guard that does not fire still tells how far it was from firing: by its value at each local minimum and at the end of
//! the run. These are the *margins* of the run. Where one of them passes through zero as the parameters of a system change, the
//! itinerary changes. To follow a margin through zero, and beyond, the itinerary that leads to it is prescribed: in every phase
//! only the guard that is to end it is looked at, so that the margin is a smooth function of the parameters on both sides.
//!
//! A minimum of a guard is a zero of its rate. It is found as any other switch is: decided on every step, and refined by steps of
//! the method itself.
//!
//! Where a system does not know its rates they are differences. Their reach follows the run: error control knows on which scale
//! the solution changes, so the reach is a small part of the longest step so far, whatever the unit of time. The rounding that
//! they bring is measured where a decision would fail for it.

use std::cell::Cell;
use std::cmp::Ordering;
use std::hash::{Hash, Hasher};

use crate::control::first_step;
use crate::error::RunError;
use crate::guard::{Direction, Guard};
use crate::hybrid::{HybridSystem, Observer, Outcome, Start, SwitchEvent, run};
use crate::method::{Method, State, Step, Trial};
use crate::options::{Options, StepSize};

/// A place in a phase, which moves with the parameters: two that differ in nothing else are the same.
#[derive(Clone, Copy, Debug)]
pub struct Hint(pub f64);

impl PartialEq for Hint {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Eq for Hint {}

impl PartialOrd for Hint {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Hint {
    fn cmp(&self, _: &Self) -> Ordering {
        Ordering::Equal
    }
}

impl Hash for Hint {
    fn hash<H: Hasher>(&self, _: &mut H) {}
}

/// How a phase of a prescribed run ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Exit {
    /// The guard that fires.
    pub guard: usize,
    /// Where the guard is looked at from: beyond its local minima, which it passes wherever they lie.
    pub after: Hint,
    /// The part of the phase which that is; 0 if the guard has no minima before.
    pub part: Hint,
}

/// Where a margin is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Place {
    /// At the local minimum of the guard that is nearest to a place.
    Minimum {
        /// Where it is to be looked for.
        near: Hint,
        /// Its number in its phase, from 0, where it was found.
        number: usize,
    },
    /// Where the run ends, at a terminal guard or at the end of its span.
    End,
}

/// Names a margin: in the phase that follows `exits`, the value of `guard` at `place`.
///
/// Hints say which of several minima is meant. As the parameters move away, [`margin`] returns the margin with hints
/// that have moved along.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Margin {
    /// The phases before.
    pub exits: Vec<Exit>,
    /// The guard that does not fire.
    pub guard: usize,
    /// Where.
    pub place: Place,
}

/// A margin of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct NearMiss {
    /// Which.
    pub margin: Margin,
    /// Where it was taken.
    pub s: f64,
    /// The guard's value there, with its sign turned if it fires while rising: positive where it does not fire.
    pub value: f64,
}

/// A free run as its switches and all its margins.
#[derive(Clone, Debug, PartialEq)]
pub struct Margins {
    /// The guards that fired, in order, without the one that ended the run.
    pub fired: Vec<usize>,
    /// In order of their phases.
    pub near_misses: Vec<NearMiss>,
    /// Why the run ended.
    pub outcome: Outcome,
}

/// Part of the run below which its last phase may be about to vanish: boundaries get their names from runs 1e-9 beside them, where
/// a phase that vanishes there is shorter. One taken for vanishing without need only costs a longer run.
const SHORT: f64 = 1e-6;

/// Part of a step over which differences reach: their fourth power leaves 1e-11 of a rate, their rounding some 1e-13.
const REACH: f64 = 1.0 / 256.0;

/// Runs `system` freely and returns every margin that the run leaves.
///
/// Guards that fire in either direction leave none, and terminal guards none. A minimum takes about one step more than the run
/// itself; the margins of a phase take a run over that phase for each of its guards.
///
/// # Errors
/// Those of [`run`].
pub fn margins<M, S, const N: usize, const G: usize>(
    method: M,
    system: &S,
    start: Start<S::Mode, N>,
    end: f64,
    options: &Options,
) -> Result<Margins, RunError>
where
    M: Method,
    S: HybridSystem<N, G>,
{
    let mut phases = Phases { starts: vec![start], fired: Vec::new() };
    let free = run(method, system, start, end, options, &mut phases)?;
    let Phases { mut starts, mut fired } = phases;
    if let Outcome::EndedByGuard { .. } = free.outcome {
        starts.pop();
        fired.pop();
    }
    let mut exits = Vec::with_capacity(fired.len());
    let mut near_misses = Vec::new();
    for (k, &start) in starts.iter().enumerate() {
        let exit = fired.get(k).copied();
        let exited = starts.get(k + 1).map_or(end, |next| next.s);
        // Where the last phase shrinks to nothing, the one before it lasts to the end.
        let lasts = k + 1 == starts.len()
            || (k + 2 == starts.len() && free.s - exited <= SHORT * (free.s - starts[0].s));
        let until = if lasts { end } else { exited };
        let mut after = start.s;
        for (guard, about) in system.guards(start.mode).into_iter().enumerate() {
            if !leaves_margins(about) || exited <= start.s {
                continue;
            }
            let watched = (guard, f64::INFINITY);
            let found = watch(method, system, start, until, options, &[], watched)?;
            let Some(found) = found else { continue };
            let mut add = |place, at: Extremum| {
                let margin = Margin { exits: exits.clone(), guard, place };
                near_misses.push(NearMiss { margin, s: at.s, value: at.value });
            };
            let minima = found.minima.iter().take_while(|minimum| minimum.s < exited);
            for (number, &minimum) in minima.enumerate() {
                add(Place::Minimum { near: Hint(minimum.s), number }, minimum);
                after = if exit == Some(guard) { 0.5 * (minimum.s + exited) } else { after };
            }
            if let Some(at_end) = found.end.filter(|_| lasts && exit != Some(guard)) {
                add(Place::End, at_end);
            }
        }
        if let Some(guard) = exit {
            let part = if after > start.s { (after - start.s) / (exited - start.s) } else { 0.0 };
            exits.push(Exit { guard, after: Hint(after), part: Hint(part) });
        }
    }
    Ok(Margins { fired, near_misses, outcome: free.outcome })
}

/// The margin `margin` of the run of `system` whose itinerary up to there is prescribed.
///
/// `None` where that itinerary cannot be followed or there is no such minimum.
///
/// # Errors
/// Those of [`run`].
pub fn margin<M, S, const N: usize, const G: usize>(
    method: M,
    system: &S,
    start: Start<S::Mode, N>,
    end: f64,
    options: &Options,
    margin: &Margin,
) -> Result<Option<NearMiss>, RunError>
where
    M: Method,
    S: HybridSystem<N, G>,
{
    let exits = &margin.exits;
    let enough = match margin.place {
        // The minimum nearest to a place is the last one before it or the first one after it.
        Place::Minimum { near, .. } => near.0,
        Place::End => f64::INFINITY,
    };
    let watched = (margin.guard, enough);
    let watched = watch(method, system, start, end, options, exits, watched)?;
    let Some(watched) = watched else { return Ok(None) };
    let (place, at) = match margin.place {
        Place::End => (Place::End, watched.end),
        Place::Minimum { near, number } => {
            let distance = |minimum: &Extremum| (minimum.s - near.0).abs();
            let nearest = watched.minima.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
            let near = nearest.map_or(near, |minimum| Hint(minimum.s));
            (Place::Minimum { near, number }, nearest.copied())
        }
    };
    let mut began = start.s;
    let exits = margin.exits.iter().zip(&watched.exits).map(|(exit, &s)| {
        let after = Hint(began + exit.part.0 * (s - began));
        began = s;
        Exit { after, ..*exit }
    });
    let moved = Margin { exits: exits.collect(), guard: margin.guard, place };
    Ok(at.map(|at| NearMiss { margin: moved, s: at.s, value: at.value }))
}

/// Whether the direction of a guard says on which side of zero it does not fire.
fn leaves_margins(guard: Guard) -> bool {
    let either = matches!(guard.direction(), Direction::Off | Direction::Either);
    !either && !guard.ends_run()
}

/// A guard at a local minimum, or at the end of the run.
#[derive(Clone, Copy)]
struct Extremum {
    s: f64,
    value: f64,
}

/// What was seen of the guard that is watched.
struct Watched {
    /// Where the exits before happened.
    exits: Vec<f64>,
    minima: Vec<Extremum>,
    end: Option<Extremum>,
}

/// Follows `exits` and then watches `guard` to its first minimum after `enough`, or to the end of the run; `None` if that ends
/// before.
fn watch<M, S, const N: usize, const G: usize>(
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
    // A prescribed run may pass switches as close together as it likes.
    let options = Options { zeno: 0.0, ..*options };
    let mut watching = Watching::<S, G> {
        prescribed: &prescribed,
        seen: Watched { exits: Vec::with_capacity(exits.len()), minima: Vec::new(), end: None },
    };
    let mode = PhaseMode { mode: start.mode, phase: 0, part: Part::Start };
    let start = Start { mode, s: start.s, state: start.state };
    let run = run(method, &prescribed, start, end, &options, &mut watching)?;
    if run.mode.phase < exits.len() {
        return Ok(None);
    }
    let mut seen = watching.seen;
    let ended = matches!(run.outcome, Outcome::EndedByGuard { .. } | Outcome::ReachedEnd);
    if ended && run.mode.part != Part::Done {
        let value = prescribed.value(run.mode.mode, guard, run.s, &run.state);
        seen.end = Some(Extremum { s: run.s, value });
    }
    Ok(Some(seen))
}

/// A system whose guards fire only as prescribed. In the place of the guard that counts stands what is waited for: the place from
/// which it is looked at, the guard itself, or its rate.
struct Prescribed<'a, S> {
    system: &'a S,
    exits: &'a [Exit],
    /// The guard to watch once they are done.
    watched: usize,
    /// It is not watched beyond its first minimum after this place.
    enough: f64,
    reach: Reach,
}

/// How far the differences reach that stand in for unknown rates.
struct Reach {
    /// Where the step at hand starts.
    start: Cell<f64>,
    distance: Cell<f64>,
}

impl Reach {
    /// For a run that is yet to take its first step.
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

    /// A step is tried from `s`, so that the one before it was accepted as far as there.
    fn follow(&self, s: f64) {
        let distance = REACH * (s - self.start.replace(s));
        // Seldom, so that rates seldom change between two steps.
        if distance >= 2.0 * self.distance.get() {
            self.distance.set(distance);
        }
    }
}

/// A mode with what has happened so far.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PhaseMode<Mode> {
    mode: Mode,
    /// Exits behind.
    phase: usize,
    part: Part,
}

/// How far a phase is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    /// Nothing has been waited for yet.
    Start,
    /// The guard of the exit is looked at, from a place inside the phase on.
    Armed,
    /// A minimum of the guard that is watched is behind.
    Minimum,
    /// The minimum that was asked for is behind.
    Done,
}

/// What is waited for.
enum Awaited {
    /// This place.
    Place(f64),
    /// The guard's zero.
    Guard,
    /// A minimum of the guard.
    Minimum,
    /// Nothing any more.
    Nothing,
}

impl<S> Prescribed<'_, S> {
    /// The guard that counts, and what is waited for.
    fn subject<Mode>(&self, at: &PhaseMode<Mode>) -> (usize, Awaited) {
        match self.exits.get(at.phase) {
            Some(exit) if at.part == Part::Start && exit.part.0 > 0.0 => {
                (exit.guard, Awaited::Place(exit.after.0))
            }
            Some(exit) => (exit.guard, Awaited::Guard),
            None if at.part == Part::Done => (self.watched, Awaited::Nothing),
            None => (self.watched, Awaited::Minimum),
        }
    }

    /// The rate of `guard`, or differences where it is not known.
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
        std::array::from_fn(|guard| {
            // In the middle of a phase its start lies behind.
            let order = if at.part == Part::Start { own[guard].zero_order() } else { 0 };
            if own[guard].ends_run() {
                return Guard::new(own[guard].direction()).from_zero(order).terminal();
            }
            if guard != subject {
                return Guard::OFF;
            }
            match awaited {
                Awaited::Place(_) => Guard::new(Direction::Below),
                // Not `Below`: past a graze it is still negative, and to rise first.
                Awaited::Guard => Guard::new(Direction::Falling).from_zero(order),
                Awaited::Minimum => {
                    // The rate rises from zero after a minimum.
                    let after_minimum = at.part == Part::Minimum;
                    let order = if after_minimum { 1 } else { order.saturating_sub(1) };
                    Guard::new(Direction::Rising).from_zero(order)
                }
                Awaited::Nothing => Guard::new(Direction::Below).terminal(),
            }
        })
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
        let part = match self.subject(&at).1 {
            Awaited::Guard => {
                let (mode, y) = self.system.transition(at.mode, guard, s, y);
                return (PhaseMode { mode, phase: at.phase + 1, part: Part::Start }, y);
            }
            Awaited::Place(_) => Part::Armed,
            Awaited::Minimum if s < self.enough => Part::Minimum,
            Awaited::Minimum | Awaited::Nothing => Part::Done,
        };
        (PhaseMode { part, ..at }, *y)
    }
}

/// Takes down the exits and the minima of the guard that is watched.
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

/// Takes down where the phases of a run start.
struct Phases<Mode, const N: usize> {
    starts: Vec<Start<Mode, N>>,
    fired: Vec<usize>,
}

impl<Mode: Copy, const N: usize> Observer<Mode, N> for Phases<Mode, N> {
    fn on_switch(&mut self, event: &SwitchEvent<Mode, N>) {
        self.fired.push(event.guard);
        self.starts.push(Start { mode: event.to, s: event.s, state: event.after });
    }
}
