//! Runs with a prescribed itinerary, which watch a guard in their last phase.

use crate::error::RunError;
use crate::hybrid::{Direction, Guard, HybridSystem, Observer, Outcome, Run, Start, SwitchEvent};
use crate::margin::name::{Exit, Way};
use crate::margin::rate::{Reach, derivative};
use crate::method::{Method, State, Step, Trial};
use crate::options::Options;
use crate::runs::run;

/// The rounding of a guard or of its rate, as a part of it; that of time is a sixteenth.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// What a run watches in the phase after its last exit.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Watch {
    /// A derivative of the guard at the start of the phase.
    Start { derivative: u32 },
    /// The minima of the guard, or its maxima, up to the first one after `enough`.
    Extrema { kind: Kind, enough: f64 },
    /// The guard at the last exit.
    Exit,
    /// The condition of the transition at the last exit.
    Branch,
    /// The guard at the end of the run.
    End,
    /// No guard.
    Nothing,
}

/// On which side of zero an extremum is watched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Where the guard comes nearest to firing.
    Minimum,
    /// Where it comes nearest to the side from which it fires.
    Maximum,
}

/// A guard at a place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Taken {
    pub s: f64,
    pub value: f64,
}

/// What a prescribed run finds about the guard that it watches.
pub(super) struct Watched {
    /// The places of the prescribed exits.
    pub exits: Vec<f64>,
    /// The values that were watched, in order.
    pub taken: Vec<Taken>,
}

/// A run that has followed its exits, and what it found.
type Ended<Mode, const N: usize> = (Run<Mode, N>, Watched);

/// Follows `exits` and then watches `guard`. The result is `None` if the run cannot follow all
/// exits. If the run fails while it looks for extrema, those before are the second result.
pub(super) fn watch<M, S, const N: usize, const G: usize>(
    method: M,
    system: &S,
    start: Start<S::Mode, N>,
    end: f64,
    options: &Options,
    exits: &[Exit],
    what: (usize, Watch),
) -> Result<Option<Watched>, (RunError, Watched)>
where
    M: Method,
    S: HybridSystem<N, G>,
{
    let followed = follow(method, system, start, end, options, exits, what)?;
    Ok(followed.map(|(_, watched)| watched))
}

/// As [`watch`], with the run itself.
pub(super) fn follow<M, S, const N: usize, const G: usize>(
    method: M,
    system: &S,
    start: Start<S::Mode, N>,
    end: f64,
    options: &Options,
    exits: &[Exit],
    (guard, watch): (usize, Watch),
) -> Result<Option<Ended<S::Mode, N>>, (RunError, Watched)>
where
    M: Method,
    S: HybridSystem<N, G>,
{
    let reach = Reach::new::<M, S, N, G>(system, &start, end, options);
    let prescribed = Prescribed { system, exits, watched: guard, watch, reach };
    // In a prescribed run, switches may be as close together as they like, and there are more of
    // them: places and extrema count too.
    let limits = (usize::MAX, usize::MAX);
    let (max_switches, max_at_one_instant) = limits;
    let options = Options { zeno: 0.0, max_switches, max_at_one_instant, ..*options };
    let mut watching = Watching::<S, G> {
        prescribed: &prescribed,
        seen: Watched { exits: Vec::with_capacity(exits.len()), taken: Vec::new() },
    };
    let mode = prescribed.enter(start.mode, 0, start.s);
    let start = Start { mode, s: start.s, state: start.state };
    let ended = run(method, &prescribed, start, end, &options, &mut watching);
    let mut seen = watching.seen;
    let run = match ended {
        Ok(run) => run,
        Err(error) => return Err((error, seen)),
    };
    if run.mode.progress == Progress::Lost || seen.exits.len() < exits.len() {
        return Ok(None);
    }
    seen.taken.extend(prescribed.at_last::<M, N, G>(&run, &options));
    if let Some(&Taken { s, .. }) = seen.taken.iter().find(|taken| taken.value.is_nan()) {
        return Err((RunError::GuardNotANumber { guard, s }, seen));
    }
    let Run { outcome, s, mode, state, statistics } = run;
    Ok(Some((Run { outcome, s, mode: mode.mode, state, statistics }, seen)))
}

/// Whether the condition of a transition is positive; `None` if it has none.
pub(super) fn branch<S, const N: usize, const G: usize>(
    system: &S,
    mode: S::Mode,
    guard: usize,
    (s, y): (f64, &State<N>),
) -> Option<bool>
where
    S: HybridSystem<N, G>,
{
    let condition = system.transition_condition(mode, guard, s, y);
    (!condition.is_nan()).then_some(condition > 0.0)
}

/// The sign with which a guard is multiplied, so that it is positive where it does not fire.
pub(super) fn sense(guard: Guard) -> f64 {
    if guard.direction() == Direction::Rising { -1.0 } else { 1.0 }
}

/// A system whose guards fire only as prescribed. The value of one guard, the subject, is replaced
/// by what the run waits for: a place, the guard itself, or its rate.
struct Prescribed<'a, S> {
    system: &'a S,
    exits: &'a [Exit],
    /// The guard to watch after all exits.
    watched: usize,
    watch: Watch,
    reach: Reach,
}

/// A mode of the system and the progress of the prescribed run.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PhaseMode<Mode> {
    mode: Mode,
    /// The number of exits that have happened.
    phase: usize,
    progress: Progress,
    /// Where the phase began.
    began: f64,
    /// The order of the zero from which the subject starts there.
    order: u32,
}

/// The progress within a phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Progress {
    /// Nothing that the run waits for has happened yet.
    Start,
    /// The run has passed the place after which the guard of the exit may fire.
    Armed,
    /// The run has passed an extremum of the guard that it watches.
    Extremum,
    /// The run has passed the last extremum that it has to find.
    Done,
    /// The run cannot follow the exits.
    Lost,
}

/// What the run waits for.
#[derive(Clone, Copy)]
enum Awaited {
    /// The run waits for this place.
    Place(f64),
    /// The run waits for the subject to fire in this way.
    Guard(Way),
    /// The run waits for an extremum of the subject.
    Extremum(Kind),
    /// The run waits for its end.
    End,
    /// The run waits for nothing any more.
    Nothing,
}

impl<S> Prescribed<'_, S> {
    /// Whether the guard is watched in this phase.
    fn is_last(&self, phase: usize) -> bool {
        let at_exit = matches!(self.watch, Watch::Exit | Watch::Branch);
        phase + usize::from(at_exit) == self.exits.len()
    }

    /// The subject, which is the guard that counts, and what the run waits for.
    fn subject<Mode>(&self, at: &PhaseMode<Mode>) -> (usize, Awaited) {
        let stopped = matches!(at.progress, Progress::Done | Progress::Lost);
        let awaited = match (self.exits.get(at.phase), self.watch) {
            (Some(exit), _) if !stopped => {
                let passes = at.progress == Progress::Start && exit.part.0 > 0.0;
                let place = Awaited::Place(exit.after.0);
                return (exit.guard, if passes { place } else { Awaited::Guard(exit.way) });
            }
            (None, Watch::Extrema { kind, .. }) if !stopped => Awaited::Extremum(kind),
            (None, Watch::End | Watch::Nothing) if !stopped => Awaited::End,
            _ => Awaited::Nothing,
        };
        (self.watched, awaited)
    }

    /// The beginning of a phase in `mode`. The run is lost if the guard that counts is not part of
    /// the mode.
    fn enter<const N: usize, const G: usize>(
        &self,
        mode: S::Mode,
        phase: usize,
        began: f64,
    ) -> PhaseMode<S::Mode>
    where
        S: HybridSystem<N, G>,
    {
        let at = PhaseMode { mode, phase, progress: Progress::Start, began, order: 0 };
        let (subject, guards) = (self.subject(&at).0, self.system.guards(mode));
        let off = |guard: usize| guards[guard].direction() == Direction::Off;
        let watches = self.is_last(phase) && self.watch != Watch::Nothing;
        let waits = watches || phase < self.exits.len();
        let lost = (waits && off(subject)) || (watches && off(self.watched));
        let progress = if lost { Progress::Lost } else { Progress::Start };
        PhaseMode { progress, order: guards[subject].zero_order(), ..at }
    }

    /// What is left of the guard that is watched, or of its extremum, where the zero from which it
    /// starts is divided out.
    fn divided<Mode>(at: &PhaseMode<Mode>, s: f64, value: f64) -> f64 {
        #[expect(clippy::cast_possible_wrap, reason = "an order is a small number")]
        let power = (s - at.began).powi(at.order as i32);
        if at.order == 0 { value } else { value / power }
    }

    /// The value of the guard that is watched, positive where it does not fire.
    fn value<const N: usize, const G: usize>(&self, mode: S::Mode, (s, y): (f64, &State<N>)) -> f64
    where
        S: HybridSystem<N, G>,
    {
        let sign = sense(self.system.guards(mode)[self.watched]);
        sign * self.system.guard_values(mode, s, y)[self.watched]
    }

    /// What is watched where the run has ended, if it is watched there.
    fn at_last<M: Method, const N: usize, const G: usize>(
        &self,
        run: &Run<PhaseMode<S::Mode>, N>,
        options: &Options,
    ) -> Option<Taken>
    where
        S: HybridSystem<N, G>,
    {
        let (mode, s) = (run.mode.mode, run.s);
        let place = (s, &run.state);
        let regular = matches!(run.outcome, Outcome::EndedByGuard { .. } | Outcome::ReachedEnd);
        let value = match self.watch {
            Watch::Start { derivative: which } => {
                let (mode, which) = ((mode, options), (self.watched, which));
                derivative::<M, S, N, G>(self.system, &self.reach, mode, which, place)?
            }
            Watch::Exit => self.value(mode, place),
            Watch::Branch => self.system.transition_condition(mode, self.watched, s, &run.state),
            Watch::End if regular => self.value(mode, place),
            Watch::End | Watch::Extrema { .. } | Watch::Nothing => return None,
        };
        Some(Taken { s, value })
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
        let mut system = self.system.guards(at.mode);
        for exit in &self.exits[..at.phase.min(self.exits.len())] {
            system[exit.guard] = system[exit.guard].fired(1);
        }
        let last = self.is_last(at.phase);
        let guard_of = |guard: usize| {
            let own = system[guard];
            // A zero at the start of the phase matters only there.
            let order = if at.progress == Progress::Start { own.zero_order() } else { 0 };
            let watched = self.watch != Watch::Nothing && guard == self.watched;
            if own.ends_run() && !(last && watched) {
                return Guard::new(own.direction()).from_zero(order).terminal();
            }
            if guard != subject {
                return Guard::OFF;
            }
            match awaited {
                Awaited::Place(_) => Guard::new(Direction::Below),
                Awaited::Guard(way) => {
                    // Not `Below`: after a graze it may still be negative, and must rise first.
                    let guard = match way {
                        Way::AtOnce => Guard::new(Direction::Below),
                        Way::Falling | Way::Rising => {
                            Guard::new(Direction::Falling).from_zero(order)
                        }
                    };
                    if last { guard.terminal() } else { guard }
                }
                Awaited::Extremum(_) => {
                    // The rate rises from zero after a minimum.
                    let after_minimum = at.progress == Progress::Extremum;
                    let order = u32::from(after_minimum);
                    Guard::new(Direction::Rising).from_zero(order)
                }
                Awaited::End => Guard::OFF,
                Awaited::Nothing => Guard::new(Direction::Below).terminal(),
            }
        };
        // Place and rate of a smooth guard are smooth too.
        std::array::from_fn(|guard| guard_of(guard).as_smooth_as(&system[guard]))
    }

    #[inline]
    fn guard_values(&self, at: Self::Mode, s: f64, y: &State<N>) -> [f64; G] {
        let (subject, awaited) = self.subject(&at);
        let mut values = self.system.guard_values(at.mode, s, y);
        values[subject] = match awaited {
            Awaited::Place(place) => place - s,
            Awaited::Guard(Way::Falling) | Awaited::End => values[subject],
            Awaited::Guard(Way::Rising) => -values[subject],
            Awaited::Extremum(kind) => {
                let rate = self.reach.rate(self.system, at.mode, subject, (s, y));
                let (rate, rounding) = match at.order {
                    0 => (rate, 0.0),
                    // The zero is divided out. Both terms are nearly equal soon after it.
                    order => {
                        let (since, due) = (s - at.began, values[subject] * f64::from(order));
                        let terms = rate.abs() * (since + s.abs() / 16.0) + due.abs();
                        (rate * since - due, ROUNDING * terms)
                    }
                };
                let rises = self.system.guards(at.mode)[subject].direction() == Direction::Rising;
                let rate = if rises == (kind == Kind::Minimum) { -rate } else { rate };
                // A guard that does not change, or by less than its rounding, has passed its
                // extremum.
                if rate == 0.0 { f64::MIN_POSITIVE } else { rate + rounding }
            }
            Awaited::Guard(Way::AtOnce) | Awaited::Nothing => -1.0,
        };
        values
    }

    fn longest_first_step(&self, at: Self::Mode, s: f64, y: &State<N>) -> f64 {
        self.system.longest_first_step(at.mode, s, y)
    }

    fn settle(&self, at: Self::Mode, y: &State<N>) -> Self::Mode {
        PhaseMode { mode: self.system.settle(at.mode, y), ..at }
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
            Awaited::Guard(_)
                if self.exits[at.phase].branch != branch(self.system, at.mode, guard, (s, y)) =>
            {
                Progress::Lost
            }
            Awaited::Guard(_) => {
                let (mode, after) = self.system.transition(at.mode, guard, s, y);
                return (self.enter(mode, at.phase + 1, s), after);
            }
            Awaited::Place(_) => Progress::Armed,
            Awaited::Extremum(_) if matches!(self.watch, Watch::Extrema { enough, .. } if s < enough) => {
                Progress::Extremum
            }
            Awaited::Extremum(_) | Awaited::End | Awaited::Nothing => Progress::Done,
        };
        (PhaseMode { progress, ..at }, *y)
    }
}

/// Records the exits, and the extrema of the guard that is watched.
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
            Awaited::Place(_) | Awaited::End | Awaited::Nothing => {}
            Awaited::Guard(_) => self.seen.exits.push(event.s),
            Awaited::Extremum(kind) => {
                let at = &event.from;
                let value = self.prescribed.value(at.mode, (event.s, &event.before));
                let value = Prescribed::<S>::divided(at, event.s, value);
                let value = if kind == Kind::Minimum { value } else { -value };
                self.seen.taken.push(Taken { s: event.s, value });
            }
        }
    }
}
