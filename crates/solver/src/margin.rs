//! Margins: how near a run came to other switches.
//!
//! A guard that does not fire still tells how far it was from firing, by its value at each local
//! minimum and at the end of the run. These values are the *margins* of the run. The itinerary
//! changes where a margin passes through zero as the parameters of a system change.
//!
//! To follow a margin to zero and beyond, the itinerary up to it is prescribed: in every phase,
//! only the guard that should end the phase may fire. The margin is then a smooth function of the
//! parameters on both sides of zero.
//!
//! A minimum of a guard is a zero of its rate. It is found like a zero of a black box: the rate is
//! sampled on every step, also that of a readable system, and steps of the method locate its zeros.

mod name;
mod prescribed;

use crate::error::RunError;
use crate::hybrid::{Direction, Guard, HybridSystem, Observer, Outcome, Start, SwitchEvent};
use crate::margin::prescribed::{Extremum, watch};
use crate::method::Method;
use crate::options::Options;
use crate::runs::run;

pub use name::{Exit, Hint, Margin, Place};

/// A margin of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct NearMiss {
    /// The name of the margin.
    pub margin: Margin,
    /// The place where it was taken.
    pub s: f64,
    /// The guard's value at that place. Its sign is reversed for a guard that fires while rising,
    /// so that it is positive where the guard does not fire.
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

/// If the last phase is shorter than this part of the run, it may be about to vanish. Boundaries
/// get their names from runs 1e-9 beside them, where a vanishing phase is shorter than this. If the
/// phase does not vanish, the only cost is a longer run.
const SHORT: f64 = 1e-6;

/// Runs `system` freely and returns every margin that the run leaves.
///
/// Terminal guards and guards that fire in either direction have no margins. The margins of a phase
/// take one run over that phase for each of its guards, and each minimum takes about one step more.
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
        // If the last phase is about to vanish, the phase before it lasts to the end.
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

/// The value of `margin` for `system`, by a run that follows the itinerary in its name.
///
/// The result is `None` if the run cannot follow that itinerary, if there is no such minimum, or if
/// the system does not have the guards in the name.
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
    if margin.guard >= G || exits.iter().any(|exit| exit.guard >= G) {
        return Ok(None);
    }
    let enough = match margin.place {
        // The minimum that is nearest to a place is the last one before or the first one after it.
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

/// Whether the guard has margins: its direction tells the side of zero where it does not fire.
fn leaves_margins(guard: Guard) -> bool {
    let either = matches!(guard.direction(), Direction::Off | Direction::Either);
    !either && !guard.ends_run()
}

/// Records the starts of the phases of a run.
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
