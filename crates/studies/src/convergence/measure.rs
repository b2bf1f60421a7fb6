//! One collision, integrated in ways that keep accuracy or lose it, and its errors.
//!
//! [`integrate`] takes the coordinates and whether switches are located.
//! [`Approximation::deviation`] compares with a [`reference()`]. [`measure`] does so for several
//! collisions at once: their errors together show the order, while the error of a single one passes
//! through zero now and then.

use serde::Serialize;
use stickslip_model::exact;
use stickslip_model::regularized::{self, Phase, Regularized};
use stickslip_model::{Collider, Collision, CollisionError, Contact, Regime, Side};
use stickslip_solver::runs::run_over_switches;
use stickslip_solver::{
    Dop853, Dopri5, EmbeddedPair, HybridSystem, Observer, Options, Outcome, Run, RunError, Start,
    Statistics, SwitchEvent, run_with,
};

use super::plain_time::{self, PlainTime};

/// Variables in which a collision is integrated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Formulation {
    /// The coordinates of [`stickslip_model::regularized`], in which everything is smooth.
    Regularized,
    /// The coordinates of [`super::plain_time`], in which the ends of contact are not smooth.
    PlainTime,
}

/// How an integration treats switches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LocationSettings {
    /// Each switch ends a step: [`run`](stickslip_solver::run).
    Located {
        /// Step sizes or tolerances.
        options: Options,
    },
    /// Switches take effect where a step happens to end, as in codes without event location:
    /// [`run_over_switches`].
    AtStepEnds {
        /// The size of the steps, in the independent variable of the coordinates.
        step_size: f64,
        /// The most steps taken.
        max_steps: usize,
    },
}

/// The result of one way to integrate a collision.
#[derive(Clone, Debug, PartialEq)]
pub struct Approximation {
    /// Reduced tangential velocity w at the end of contact.
    pub final_velocity: f64,
    /// Every switch: its time, and the regime and side that follow, as in
    /// [`stickslip_model::Switch`].
    pub switches: Vec<(f64, Regime, Side)>,
    /// The work of the integration.
    pub statistics: Statistics,
}

/// The absolute errors of an [`Approximation`].
#[derive(Clone, Debug, PartialEq)]
pub struct Deviation {
    /// The error of the final velocity w. The error of ε_t is this over ψ.
    pub velocity: f64,
    /// The error of the time of each switch; `None` if the switches are others, so that their
    /// times have nothing to compare with.
    pub switch_times: Option<Vec<f64>>,
}

impl Approximation {
    /// The absolute errors, with `reference` for the truth.
    pub fn deviation(&self, reference: &Collision) -> Deviation {
        let velocity = (self.final_velocity - reference.final_velocity).abs();
        let pairs = || self.switches.iter().zip(&reference.switches);
        let same = self.switches.len() == reference.switches.len()
            && pairs().all(|(found, expected)| (found.1, found.2) == (expected.to, expected.side));
        let times = pairs().map(|(found, expected)| (found.0 - expected.time).abs());
        Deviation { velocity, switch_times: same.then(|| times.collect()) }
    }
}

/// The collision to compare with: without damping the exact solution, with damping or in other
/// laws than the paper's Dormand–Prince 8(5,3) at a tolerance of 1e-15.
///
/// # Errors
/// [`CollisionError`]: the exact solution or the integrator fails.
pub fn reference(contact: Contact) -> Result<Collision, CollisionError> {
    if contact.damping() > 0.0 || !contact.obeys_paper() {
        Ok(Collider::with_tolerances(EmbeddedPair::Dop853, 1e-15, 1e-15).collide(contact)?)
    } else {
        Ok(exact::collide(contact)?)
    }
}

/// Integrates the collision of `contact`.
///
/// ```
/// use stickslip_model::Contact;
/// use stickslip_studies::convergence::{Formulation, LocationSettings, integrate, reference};
/// use stickslip_solver::EmbeddedPair;
///
/// let contact = Contact::new(63.0, 0.5, 0.0)?;
/// let coarse = LocationSettings::AtStepEnds { step_size: 1e-3, max_steps: 10_000 };
/// let found = integrate(EmbeddedPair::Dop853, contact, Formulation::PlainTime, &coarse)?;
/// let error = found.deviation(&reference(contact)?);
/// // A switch is late by up to a step, whatever the order of the method.
/// assert!(error.switch_times.is_some_and(|times| times.iter().any(|time| *time > 3e-4)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`CollisionError`]: invalid options, or a contact that does not end within the limits.
pub fn integrate(
    pair: EmbeddedPair,
    contact: Contact,
    coordinates: Formulation,
    switching: &LocationSettings,
) -> Result<Approximation, CollisionError> {
    contact.require_paper("the convergence")?;
    let phase = Phase::first(&contact);
    let mut switches = SwitchRecord { found: Vec::new(), clock: coordinates, elapsed: 0.0 };
    let (outcome, final_velocity, statistics) = match coordinates {
        Formulation::Regularized => {
            let system = Regularized::new(contact);
            let start = Start { mode: phase, s: 0.0, state: system.start() };
            let run = follow(pair, &system, start, switching, &mut switches)?;
            (run.outcome, system.velocity(&run.state), run.statistics)
        }
        Formulation::PlainTime => {
            let system = PlainTime::new(contact);
            let start = Start { mode: phase, s: 0.0, state: system.start() };
            let run = follow(pair, &system, start, switching, &mut switches)?;
            (run.outcome, run.state[plain_time::W], run.statistics)
        }
    };
    // The guard of the end is the first in both coordinates.
    if outcome != (Outcome::EndedByGuard { guard: regularized::END }) {
        return Err(CollisionError::Unfinished { outcome, time: switches.elapsed });
    }
    Ok(Approximation { final_velocity, switches: switches.found, statistics })
}

/// The size of several values; NaN for an empty list.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// The root mean square.
    pub root_mean_square: f64,
    /// The largest absolute value.
    pub largest: f64,
}

/// Errors over several collisions, and the work.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// Collisions that could not be integrated. The other fields leave them out.
    pub failed: usize,
    /// Collisions with other switches than the truth.
    pub other_switches: usize,
    /// The errors of the final velocities w.
    pub velocity: Spread,
    /// The errors of all switch times of the collisions that have the right switches.
    pub switch_time: Spread,
    /// Evaluations of the right-hand side, all collisions together.
    pub right_hand_sides: usize,
}

impl Errors {
    /// Whether all collisions have the right switches.
    pub fn comparable(&self) -> bool {
        self.failed == 0 && self.other_switches == 0
    }
}

/// The errors of one way to integrate, over the collisions of `references`.
///
/// ```
/// use stickslip_model::Contact;
/// use stickslip_studies::convergence::{Formulation, LocationSettings, measure, reference};
/// use stickslip_solver::{EmbeddedPair, Options, StepSize};
///
/// let contacts = [Contact::new(18.0, 0.4, 0.0)?, Contact::new(63.0, 0.5, 0.0)?];
/// let references = contacts.map(reference).into_iter().collect::<Result<Vec<_>, _>>()?;
/// let [coarse, fine] = [0.04, 0.02].map(|h| {
///     let options = Options { step_size: StepSize::Fixed(h), ..Options::default() };
///     let located = LocationSettings::Located { options };
///     measure(EmbeddedPair::Dop853, &references, Formulation::Regularized, &located)
/// });
/// assert!(coarse.comparable() && fine.comparable());
/// let ratio = coarse.velocity.root_mean_square / fine.velocity.root_mean_square;
/// assert!((ratio.log2() - 8.0).abs() < 0.5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn measure(
    pair: EmbeddedPair,
    references: &[Collision],
    coordinates: Formulation,
    switching: &LocationSettings,
) -> Errors {
    let (mut failed, mut other_switches, mut right_hand_sides) = (0, 0, 0);
    let (mut velocities, mut times) = (Vec::new(), Vec::new());
    for reference in references {
        let Ok(found) = integrate(pair, reference.contact, coordinates, switching) else {
            failed += 1;
            continue;
        };
        let error = found.deviation(reference);
        right_hand_sides += found.statistics.field;
        velocities.push(error.velocity);
        other_switches += usize::from(error.switch_times.is_none());
        times.extend(error.switch_times.into_iter().flatten());
    }
    let (velocity, switch_time) = (Spread::of(&velocities), Spread::of(&times));
    Errors { failed, other_switches, velocity, switch_time, right_hand_sides }
}

impl Spread {
    fn of(values: &[f64]) -> Self {
        let square = values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64;
        let largest = values.iter().fold(f64::NAN, |largest, value| largest.max(value.abs()));
        Self { root_mean_square: square.sqrt(), largest }
    }
}

fn follow<S, const N: usize, const G: usize>(
    pair: EmbeddedPair,
    system: &S,
    start: Start<Phase, N>,
    switching: &LocationSettings,
    switches: &mut SwitchRecord,
) -> Result<Run<Phase, N>, RunError>
where
    S: HybridSystem<N, G, Mode = Phase>,
    SwitchRecord: Observer<Phase, N>,
{
    match *switching {
        LocationSettings::Located { options } => {
            run_with(pair, system, start, f64::INFINITY, &options, switches)
        }
        LocationSettings::AtStepEnds { step_size, max_steps } => {
            let (end, most) = (f64::INFINITY, max_steps);
            match pair {
                EmbeddedPair::Dopri5 => {
                    run_over_switches(Dopri5, system, start, end, step_size, most, switches)
                }
                EmbeddedPair::Dop853 => {
                    run_over_switches(Dop853, system, start, end, step_size, most, switches)
                }
            }
        }
    }
}

/// Records switches with their times.
struct SwitchRecord {
    found: Vec<(f64, Regime, Side)>,
    clock: Formulation,
    /// The time of the last switch.
    elapsed: f64,
}

impl<const N: usize> Observer<Phase, N> for SwitchRecord {
    fn on_switch(&mut self, event: &SwitchEvent<Phase, N>) {
        match self.clock {
            // Time runs from 0 in every phase.
            Formulation::Regularized => self.elapsed += event.before[regularized::T],
            Formulation::PlainTime => self.elapsed = event.s,
        }
        if event.guard != regularized::END {
            self.found.push((self.elapsed, event.to.regime, event.to.side));
        }
    }
}
