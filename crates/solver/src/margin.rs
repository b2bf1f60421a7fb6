//! How near a run came to switching otherwise, and runs whose itinerary is prescribed.
//!
//! A guard that does not fire still tells how far it was from firing: by its value at each local minimum and at the end of
//! the run. These are the *margins* of the run. Where one of them passes through zero as the parameters of a system change, the
//! itinerary changes. To follow a margin through zero, and beyond, the itinerary that leads to it is prescribed: in every phase
//! only the guard that is to end it is looked at, so that the margin is a smooth function of the parameters on both sides.
//!
//! A minimum of a guard is a zero of its rate. It is found as any other switch is: decided on every step, and refined by steps of
//! the method itself.

use crate::error::RunError;
use crate::guard::{Direction, Guard};
use crate::hybrid::{HybridSystem, Observer, Outcome, Start, SwitchEvent, run};
use crate::method::{Method, State, Step, Trial};
use crate::options::Options;

/// How a phase of a prescribed run ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Exit {
    /// The guard that fires.
    pub guard: usize,
    /// Local minima of that guard which come before: until then it is not looked at, wherever they lie.
    pub minima: usize,
}

/// Where a margin is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Place {
    /// At a local minimum of the guard, counted from 0 in its phase.
    Minimum(usize),
    /// Where a terminal guard ends the run.
    End,
}

/// Names a margin: in the phase that follows `exits`, the value of `guard` at `place`.
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
        let end = starts.get(k + 1).map_or(end, |next| next.s);
        let mut minima_of_exit = 0;
        for (guard, about) in system.guards(start.mode).iter().enumerate() {
            if !leaves_margins(about) || end <= start.s {
                continue;
            }
            let found = watch(method, system, start, end, options, &[], guard, usize::MAX)?;
            let Some(found) = found else { continue };
            // Rounding may put a minimum on the wrong side of the phase's end.
            let minima = found.minima.iter().filter(|minimum| minimum.s < end);
            let mut add = |place, at: Extremum| {
                let margin = Margin { exits: exits.clone(), guard, place };
                near_misses.push(NearMiss { margin, s: at.s, value: at.value });
            };
            for (index, &minimum) in minima.enumerate() {
                add(Place::Minimum(index), minimum);
                minima_of_exit = if exit == Some(guard) { index + 1 } else { minima_of_exit };
            }
            if let (None, Some(at_end)) = (exit, found.end) {
                add(Place::End, at_end);
            }
        }
        if let Some(guard) = exit {
            exits.push(Exit { guard, minima: minima_of_exit });
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
    let wanted = match margin.place {
        Place::Minimum(index) => index + 1,
        Place::End => usize::MAX,
    };
    let exits = &margin.exits;
    let watched = watch(method, system, start, end, options, exits, margin.guard, wanted)?;
    let at = watched.and_then(|watched| match margin.place {
        Place::Minimum(index) => watched.minima.get(index).copied(),
        Place::End => watched.end,
    });
    Ok(at.map(|at| NearMiss { margin: margin.clone(), s: at.s, value: at.value }))
}

/// Whether the direction of a guard says on which side of zero it does not fire.
fn leaves_margins(guard: &Guard) -> bool {
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
    minima: Vec<Extremum>,
    end: Option<Extremum>,
}

/// Follows `exits` and then watches `guard` until it has had `wanted` minima or the run ends; `None` if it ends before.
#[expect(clippy::too_many_arguments, reason = "those of `run` and what to watch")]
fn watch<M, S, const N: usize, const G: usize>(
    method: M,
    system: &S,
    start: Start<S::Mode, N>,
    end: f64,
    options: &Options,
    exits: &[Exit],
    guard: usize,
    wanted: usize,
) -> Result<Option<Watched>, RunError>
where
    M: Method,
    S: HybridSystem<N, G>,
{
    let prescribed = Prescribed { system, exits, watched: guard };
    let before: usize = exits.iter().map(|exit| exit.minima + 1).sum();
    let options = Options {
        max_switches: before.saturating_add(wanted).min(options.max_switches),
        // A prescribed run may pass switches as close together as it likes.
        zeno: 0.0,
        ..*options
    };
    let mut watching = Watching::<S, G> { prescribed: &prescribed, minima: Vec::new() };
    let mode = PhaseMode { mode: start.mode, phase: 0, minima: 0 };
    let start = Start { mode, s: start.s, state: start.state };
    let run = run(method, &prescribed, start, end, &options, &mut watching)?;
    if run.mode.phase < exits.len() {
        return Ok(None);
    }
    let value = || prescribed.value(run.mode.mode, guard, run.s, &run.state);
    let ended = matches!(run.outcome, Outcome::EndedByGuard { .. });
    Ok(Some(Watched {
        minima: watching.minima,
        end: ended.then(|| Extremum { s: run.s, value: value() }),
    }))
}

/// A system whose guards fire only as prescribed, with the rate of a guard in the guard's place where its minima count.
struct Prescribed<'a, S> {
    system: &'a S,
    exits: &'a [Exit],
    /// The guard to watch once they are done.
    watched: usize,
}

/// A mode with what has happened so far.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PhaseMode<Mode> {
    mode: Mode,
    /// Exits behind.
    phase: usize,
    /// Minima behind in this phase, of the guard that counts.
    minima: usize,
}

impl<S> Prescribed<'_, S> {
    /// The guard that counts, and whether it is its rate that does.
    fn subject<Mode>(&self, at: &PhaseMode<Mode>) -> (usize, bool) {
        match self.exits.get(at.phase) {
            Some(exit) => (exit.guard, at.minima < exit.minima),
            None => (self.watched, true),
        }
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
        let (subject, by_rate) = self.subject(&at);
        let own = self.system.guards(at.mode);
        std::array::from_fn(|guard| {
            // A guard that has been watched in this phase has left its start behind.
            let order = if at.minima > 0 { 0 } else { own[guard].zero_order() };
            if own[guard].ends_run() {
                Guard::new(own[guard].direction()).from_zero(order).terminal()
            } else if guard != subject {
                Guard::OFF
            } else if by_rate {
                // The rate rises from zero after a minimum.
                let order = if at.minima > 0 { 1 } else { order.saturating_sub(1) };
                Guard::new(Direction::Rising).from_zero(order)
            } else {
                // Not `Below`: past a graze it is still negative, and to rise first.
                Guard::new(Direction::Falling).from_zero(order)
            }
        })
    }

    #[inline]
    fn guard_values(&self, at: Self::Mode, s: f64, y: &State<N>) -> [f64; G] {
        let (subject, by_rate) = self.subject(&at);
        let mut values = self.system.guard_values(at.mode, s, y);
        let rises = self.system.guards(at.mode)[subject].direction() == Direction::Rising;
        let value =
            if by_rate { self.system.guard_rates(at.mode, s, y)[subject] } else { values[subject] };
        values[subject] = if rises { -value } else { value };
        values
    }

    fn settle(&self, at: Self::Mode) -> Self::Mode {
        PhaseMode { mode: self.system.settle(at.mode), ..at }
    }

    fn step<M: Method>(&self, at: Self::Mode, trial: &Trial<'_, N>, step: &mut Step<N>) {
        self.system.step::<M>(at.mode, trial, step);
    }

    fn transition(
        &self,
        at: Self::Mode,
        guard: usize,
        s: f64,
        y: &State<N>,
    ) -> (Self::Mode, State<N>) {
        if self.subject(&at).1 {
            return (PhaseMode { minima: at.minima + 1, ..at }, *y);
        }
        let (mode, y) = self.system.transition(at.mode, guard, s, y);
        (PhaseMode { mode, phase: at.phase + 1, minima: 0 }, y)
    }
}

/// Takes down the minima of the guard that is watched.
struct Watching<'a, S, const G: usize> {
    prescribed: &'a Prescribed<'a, S>,
    minima: Vec<Extremum>,
}

impl<S, const N: usize, const G: usize> Observer<PhaseMode<S::Mode>, N> for Watching<'_, S, G>
where
    S: HybridSystem<N, G>,
{
    fn on_switch(&mut self, event: &SwitchEvent<PhaseMode<S::Mode>, N>) {
        if event.from.phase == self.prescribed.exits.len() && event.guard == self.prescribed.watched
        {
            let guard = self.prescribed.watched;
            let value = self.prescribed.value(event.from.mode, guard, event.s, &event.before);
            self.minima.push(Extremum { s: event.s, value });
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
