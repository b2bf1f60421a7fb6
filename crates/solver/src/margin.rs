//! Margins: how near a run came to other switches.
//!
//! The *margins* of a run are the numbers below. As the parameters of a system change, the
//! itinerary changes where one of them passes through zero:
//!
//! - a guard at a local extremum, where it touches zero ([`Place::Minimum`], [`Place::Maximum`])
//! - a guard at the end of the run ([`Place::End`])
//! - a guard at the start of a phase or of the run ([`Place::Start`])
//! - a guard where another one ends the phase: behind zero, it would have fired first
//!   ([`Place::Exit`])
//! - the condition of a transition that branches
//!   ([`HybridSystem::transition_condition`], [`Place::Branch`])
//!
//! There are no others, as long as the starts of the run and all transitions are smooth. A start
//! that exists for some parameters only is smooth under conditions ([`Place::Condition`]), which
//! are not the system's but those of whoever starts it. Up to the
//! first change, two runs have the same exits, and their states depend smoothly on the parameters.
//! In the phase where they differ, a guard fires in one of them and not at nearly the same place in
//! the other one. So a zero of that guard is not simple, or it lies at the start or the end of the
//! phase. Or both runs leave by the same guard for different modes. A phase ends at the zero of
//! another guard, or with the run.
//!
//! Not listed are zeros of order three and more at a start, guards that jump or have poles, and
//! transitions that branch without a condition. The tracer reports a label that changes there as
//! unresolved.
//!
//! To follow a margin to zero and beyond, the itinerary up to it is prescribed: in every phase,
//! only the guard that should end the phase may fire. The margin is then a smooth function of the
//! parameters on both sides of zero. Two kinds of margins exist on one side only. The margin of a
//! phase behind a transition that branches exists up to where the other branch begins. The margin
//! of a phase behind a guard that fires exists up to where this guard is beyond zero as its phase
//! begins.
//!
//! The zero of a guard at the start of a phase or at an exit need not change the itinerary: a guard
//! that is negative from the start on fires as it would have done soon after.
//!
//! Where a guard starts its phase from a zero of known order
//! ([`Guard::from_zero`](crate::Guard::from_zero)), the extrema are taken of the guard divided by
//! that power of the time since the start. They vanish together with the guard's own extrema. But
//! near the start the guard's own extrema merge in pairs, and change little with the parameters.
//! For example, the minimum of aθ + bθ² + cθ³ grazes zero at a = b²/(4c) and merges with the
//! maximum close behind, at a = b²/(3c). Divided by θ, the minimum exists for every a and changes
//! as a does.
//!
//! An extremum of a guard is a zero of its rate. It is found like a zero of a black box: the rate
//! is sampled on every step, also in a readable system, and steps of the method locate its zeros.
//!
//! Only a rate that cannot be rounding counts: a guard must first move towards zero by a rate that
//! exceeds its rounding. Otherwise a flat guard would have extrema without number, for example in a
//! system that leaves rest like t⁴ or slower. The rounding of a rate is bounded by enclosures if
//! the system is readable. For a black box it is the effect of one rounding of each value on a
//! difference, and the noise, measured where each step starts.

mod free;
mod name;
mod prescribed;
mod rate;

use crate::dynamic::few::on_fixed_states;
use crate::dynamic::{DynamicRun, DynamicStart, DynamicSystem};
use crate::error::RunError;
use crate::hybrid::{Direction, Guard, HybridSystem, Outcome, Run, Start};
use crate::lists::List;
use crate::margin::prescribed::{Kind, Taken, Watch, Watched, watch};
use crate::method::Method;
use crate::options::Options;
use crate::runs::runner::End;
use crate::system::{Fixed, Free, PerGuard, System};

pub use name::{Exit, Hint, Margin, Place, Way};

/// A margin of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct NearMiss {
    /// The name of the margin.
    pub margin: Margin,
    /// The place where it was taken.
    pub s: f64,
    /// The guard's value at that place; at an extremum, divided by the power of time with which it
    /// starts from zero. At an extremum, at an exit, and at the end of the run it is positive where
    /// the guard does not fire; a guard that fires in either direction keeps its sign at exits and
    /// at the end.
    pub value: f64,
}

/// The switches and all margins of a free run, whose itinerary is not prescribed.
#[derive(Clone, Debug, PartialEq)]
pub struct Margins {
    /// The guards that fired, in order, without the guard that ended the run.
    pub fired: Vec<usize>,
    /// The margins, in the order of their phases.
    pub near_misses: Vec<NearMiss>,
    /// Why the run ended.
    pub outcome: Outcome,
}

/// Runs `system` freely and returns every margin that the run leaves.
///
/// The margins of a phase take one run over that phase for each of its guards, two for a guard that
/// does not bound the domain of its mode, and each extremum takes about two steps more. A guard
/// that changes by no more than its rounding has no extrema. It has no margins behind a place where
/// its rate cannot be followed, for instance because it is zero from there on. A run that ends
/// early has no margins, except that a run that ends at [`Options::max_switches`] has the margins
/// of its phases up to there.
///
/// # Errors
/// Those of [`run`](crate::run).
pub fn margins<M, S, const N: usize, const G: usize>(
    _method: M,
    system: &S,
    start: Start<S::Mode, N>,
    end: f64,
    options: &Options,
) -> Result<Margins, RunError>
where
    M: Method,
    S: HybridSystem<N, G>,
{
    free::margins::<M, _>(&Fixed(system), (start.mode, start.s, &start.state), end, options)
}

/// As [`fn@margins`], for a system whose dimension is known at run time.
///
/// # Errors
/// Those of [`run_dynamic`](crate::dynamic::run_dynamic).
pub fn margins_dynamic<M, S>(
    method: M,
    system: &S,
    start: DynamicStart<'_, S::Mode>,
    end: f64,
    options: &Options,
) -> Result<Margins, RunError>
where
    M: Method,
    S: DynamicSystem,
{
    on_fixed_states!(system, start, |padded, from, n| margins(method, &padded, from, end, options));
    let (system, from) = (Free::new(system, start.state.len()), start.state.to_vec());
    free::margins::<M, _>(&system, (start.mode, start.s, &from), end, options)
}

/// The value of `margin` for `system`, by a run that follows the itinerary in its name.
///
/// The result is `None` if the run cannot follow that itinerary, if there is no such minimum, or if
/// the system does not have the guards in the name.
///
/// # Errors
/// Those of [`run`](crate::run).
pub fn margin<M, S, const N: usize, const G: usize>(
    _method: M,
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
    let from = (start.mode, start.s, &start.state);
    near_miss::<M, _>(&Fixed(system), from, end, options, margin)
}

/// As [`margin()`], for a system whose dimension is known at run time.
///
/// # Errors
/// Those of [`run_dynamic`](crate::dynamic::run_dynamic).
pub fn margin_dynamic<M, S>(
    method: M,
    system: &S,
    start: DynamicStart<'_, S::Mode>,
    end: f64,
    options: &Options,
    margin: &Margin,
) -> Result<Option<NearMiss>, RunError>
where
    M: Method,
    S: DynamicSystem,
{
    on_fixed_states!(system, start, |padded, from, n| {
        self::margin(method, &padded, from, end, options, margin)
    });
    let (system, from) = (Free::new(system, start.state.len()), start.state.to_vec());
    near_miss::<M, _>(&system, (start.mode, start.s, &from), end, options, margin)
}

/// A run that has followed an itinerary.
#[derive(Clone, Debug, PartialEq)]
pub struct FollowedRun<Run> {
    /// The exits, whose hints have moved along.
    pub exits: Vec<Exit>,
    /// The run.
    pub run: Run,
}

/// The run that follows an itinerary.
///
/// The state at which a run arrives has kinks where the itinerary changes. With the itinerary
/// prescribed it is a smooth function of the parameters. The result is `None` if the run cannot
/// follow the itinerary, or if the system does not have its guards.
///
/// # Errors
/// Those of [`run`](crate::run).
pub fn follow<M, S, const N: usize, const G: usize>(
    _method: M,
    system: &S,
    start: Start<S::Mode, N>,
    end: f64,
    options: &Options,
    exits: &[Exit],
) -> Result<Option<FollowedRun<Run<S::Mode, N>>>, RunError>
where
    M: Method,
    S: HybridSystem<N, G>,
{
    let from = (start.mode, start.s, &start.state);
    let followed = followed::<M, _>(&Fixed(system), from, end, options, exits)?;
    Ok(followed.map(|FollowedRun { exits, run }| FollowedRun { exits, run: run.into() }))
}

/// As [`follow`], for a system whose dimension is known at run time.
///
/// # Errors
/// Those of [`run_dynamic`](crate::dynamic::run_dynamic).
pub fn follow_dynamic<M, S>(
    method: M,
    system: &S,
    start: DynamicStart<'_, S::Mode>,
    end: f64,
    options: &Options,
    exits: &[Exit],
) -> Result<Option<FollowedRun<DynamicRun<S::Mode>>>, RunError>
where
    M: Method,
    S: DynamicSystem,
{
    on_fixed_states!(system, start, |padded, from, n| {
        let followed = follow(method, &padded, from, end, options, exits)?;
        Ok(followed.map(|FollowedRun { exits, run }| FollowedRun {
            exits,
            run: DynamicRun::of_few(run, n),
        }))
    });
    let (system, from) = (Free::new(system, start.state.len()), start.state.to_vec());
    let from = (start.mode, start.s, &from);
    let followed = followed::<M, _>(&system, from, end, options, exits)?;
    Ok(followed.map(|FollowedRun { exits, run }| FollowedRun { exits, run: run.into() }))
}

/// The value of `margin`, with its name moved along.
fn near_miss<M: Method, S: System>(
    system: &S,
    start: (S::Mode, f64, &S::State),
    end: f64,
    options: &Options,
    margin: &Margin,
) -> Result<Option<NearMiss>, RunError> {
    let last = match margin.place {
        Place::Exit(exit) | Place::Branch(exit) => Some(exit),
        _ => None,
    };
    let mut exits = margin.exits.clone();
    exits.extend(last);
    // The extremum that is nearest to a place is the last one before or the first one after it.
    let what = match margin.place {
        Place::Start { derivative } => Watch::Start { derivative },
        Place::Minimum { near, .. } => Watch::Extrema { kind: Kind::Minimum, enough: near.0 },
        Place::Maximum { near, .. } => Watch::Extrema { kind: Kind::Maximum, enough: near.0 },
        Place::Exit(_) => Watch::Exit,
        Place::Branch(_) => Watch::Branch,
        Place::End => Watch::End,
        Place::Condition => return Ok(None),
    };
    let end = match what {
        // The guard that is watched may be the one that ends the run.
        Watch::Extrema { enough, .. } if end.is_infinite() => enough + (enough - start.1),
        _ => end,
    };
    let found = watch::<M, S>(system, start, end, options, &exits, (margin.guard, what));
    let Some((_, watched)) = found.map_err(|(error, _)| error)? else { return Ok(None) };
    move_along(&mut exits, start.1, &watched);
    let nearest = |near: Hint| {
        let distance = |taken: &&Taken| (taken.s - near.0).abs();
        watched.taken.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))
    };
    let at = match margin.place {
        Place::Minimum { near, .. } | Place::Maximum { near, .. } => nearest(near),
        _ => watched.taken.first(),
    };
    let Some(at) = at else { return Ok(None) };
    let near = Hint(at.s);
    let place = match (margin.place, exits.last()) {
        (Place::Minimum { number, .. }, _) => Place::Minimum { near, number },
        (Place::Maximum { number, .. }, _) => Place::Maximum { near, number },
        (Place::Exit(_), Some(&exit)) => Place::Exit(exit),
        (Place::Branch(_), Some(&exit)) => Place::Branch(exit),
        (place, _) => place,
    };
    exits.truncate(margin.exits.len());
    let moved = Margin { exits, guard: margin.guard, place };
    Ok(Some(NearMiss { margin: moved, s: at.s, value: at.value }))
}

/// The run that follows `exits`.
fn followed<M: Method, S: System>(
    system: &S,
    start: (S::Mode, f64, &S::State),
    end: f64,
    options: &Options,
    exits: &[Exit],
) -> Result<Option<FollowedRun<End<S>>>, RunError> {
    let found = watch::<M, S>(system, start, end, options, exits, (0, Watch::Nothing));
    Ok(found.map_err(|(error, _)| error)?.map(|(run, watched)| {
        let mut exits = exits.to_vec();
        move_along(&mut exits, start.1, &watched);
        FollowedRun { exits, run }
    }))
}

/// Moves the hints of exits to where these have happened.
fn move_along(exits: &mut [Exit], start: f64, watched: &Watched) {
    let mut began = start;
    for (exit, &s) in exits.iter_mut().zip(&watched.exits) {
        exit.after = Hint(began + exit.part.0 * (s - began));
        began = s;
    }
}

/// The guards of a mode.
fn guards_of<S: System>(system: &S, mode: S::Mode) -> PerGuard<S, Guard> {
    let mut guards = PerGuard::<S, Guard>::of(0, Guard::OFF);
    system.guards(mode, &mut guards);
    guards
}

/// The values of the guards of a mode.
fn values_of<S: System>(
    system: &S,
    mode: S::Mode,
    since: f64,
    (s, y): (f64, &S::State),
) -> PerGuard<S, f64> {
    let mut values = PerGuard::<S, f64>::of(0, f64::NAN);
    system.guard_values(mode, s, y, &mut values);
    let guards = guards_of(system, mode);
    for (guard, of) in guards.parts().iter().enumerate() {
        if of.direction() == Direction::Clock {
            values[guard] = system.next_time(mode, guard, since) - s;
        }
    }
    values
}
