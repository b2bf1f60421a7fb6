//! A collision integrated from first touch to separation: start reading here.

use stickslip_contact::adhesive::{AdhesiveContact, HELD};
use stickslip_contact::domain::OutOfDomain;
use stickslip_contact::general::{ContactSystem, GeneralContact};
use stickslip_contact::phase::{END, Phase};
use stickslip_contact::regularized::Regularized;
use stickslip_contact::regularized::components::{DAMPING, STATE, T, U};
use stickslip_contact::{Collision, Contact, EnergyLedger, Regime};
use stickslip_solver::{
    EmbeddedPair, HybridSystem, Observer, Options, Outcome, Start, Statistics, run_with,
};

mod account;
mod general;
mod last_slip;
mod refine;
mod reversals;

use super::domain;
use super::error::CollisionError;
use super::history::{Course, Followed, History, Record};
use account::{Account, Observed};

/// Flatness of a switch, in s, above which its time would be clearly less accurate than the state.
/// Such a collision is refined.
const FLAT: f64 = 30.0;

/// Longest step in s. A contact without damping lasts 2.62.
///
/// Close to both ends of contact u is nearly linear, and the embedded estimates miss most of the
/// error. There the step is limited to the length on which u bends elsewhere.
const LONGEST_STEP: f64 = 0.1;

/// Impact ratio ψ below which steps are shorter. The change of v is part of w, and what the
/// estimates miss of it counts in units of ψ: as h¹⁰ of a step at the ends of contact.
const SMALL: f64 = 0.01;

/// Stiffness κ above which the tolerances are finer than given: errors add up over √κ oscillations.
const STIFF: f64 = 3e3;
/// Stiffness κ above which they are still finer, since the errors of so many steps have one sign.
/// Far above it steps would be too many.
const VERY_STIFF: f64 = 4e4;
const STILL_FINER: f64 = 0.2;
/// The finest tolerance that this may give.
const FINEST: f64 = 1e-15;

/// Length in s of the first stick phase of a damped contact below which the first step is as short
/// as that phase.
const BRIEF: f64 = 1e-9;

/// Most steps divided by √κ. Dormand–Prince 5(4) takes 170 at tolerances of 1e-15.
const MOST_STEPS_PER_OSCILLATION: f64 = 400.0;

/// Integrates collisions with one pair and one set of options.
///
/// The pair is chosen at run time, so that collisions are compiled once, in this crate.
///
/// ```
/// use stickslip_model::{Collider, Contact};
///
/// let collision = Collider::default().collide(Contact::new(63.0, 0.5, 0.0)?)?;
/// assert_eq!(collision.itinerary(), "+o-o+o-");
/// assert_eq!(collision.switches.len(), 6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Collider {
    pair: EmbeddedPair,
    options: Options,
    /// Whether the options are made finer where a contact needs it.
    refined: bool,
    /// Whether collisions near a graze are computed once more with twice the digits.
    digits: bool,
}

impl Default for Collider {
    fn default() -> Self {
        Self::new(EmbeddedPair::Dop853)
    }
}

impl Collider {
    /// Relative tolerance with which Dormand–Prince 8(5,3) computes w to 1e-12.
    pub const RTOL: f64 = 4e-13;
    /// Absolute tolerance that goes with [`Self::RTOL`].
    pub const ATOL: f64 = 4e-13;

    /// A collider with the tolerances [`Self::RTOL`] and [`Self::ATOL`], whatever the pair:
    /// [`Dop853`](stickslip_solver::Dop853), [`Dopri5`](stickslip_solver::Dopri5) or an
    /// [`EmbeddedPair`].
    pub fn new(pair: impl Into<EmbeddedPair>) -> Self {
        Self::with_tolerances(pair, Self::RTOL, Self::ATOL)
    }

    /// A collider with these tolerances, which are checked when it is used.
    pub fn with_tolerances(pair: impl Into<EmbeddedPair>, rtol: f64, atol: f64) -> Self {
        let first_step = Some(LONGEST_STEP);
        let max_step = LONGEST_STEP;
        let options = Options { rtol, atol, first_step, max_step, ..Options::default() };
        Self { pair: pair.into(), options, refined: true, digits: true }
    }

    /// A collider with these options that returns what the pair computes, for convergence
    /// studies.
    ///
    /// The other colliders compute collisions near a graze once more with twice the digits.
    pub fn unrefined(pair: impl Into<EmbeddedPair>, options: Options) -> Self {
        Self { pair: pair.into(), options, refined: false, digits: false }
    }

    /// The default collider without the second run that gives collisions near a graze twice the
    /// digits: the switches are the same, their times and states are as the integrator finds them.
    ///
    /// For callers who only need the switches of a collision. Where most collisions are near a
    /// graze, as for small ψ without damping, it takes a fraction of the time.
    ///
    /// ```
    /// use stickslip_model::{Collider, Contact};
    ///
    /// let contact = Contact::new(63.0, 1e-4, 0.0)?;
    /// let decided = Collider::deciding().collide(contact)?;
    /// assert_eq!(decided.itinerary(), Collider::default().collide(contact)?.itinerary());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn deciding() -> Self {
        Self { digits: false, ..Self::default() }
    }

    /// Integrates one collision.
    ///
    /// # Errors
    /// [`CollisionError`]: the contact is out of range, the integration fails (also for invalid
    /// options), or the contact does not end within the limits.
    pub fn collide(&self, contact: Contact) -> Result<Collision, CollisionError> {
        let mut collision = Collision::before(contact);
        self.collide_into(contact, &mut collision)?;
        Ok(collision)
    }

    /// As [`Self::collide`], into a collision whose memory is used again.
    ///
    /// That saves a copy, and for collisions with more than [`FEW_SWITCHES`](crate::FEW_SWITCHES)
    /// switches it saves memory. Other collisions allocate nothing in either case.
    ///
    /// # Errors
    /// As [`Self::collide`]; `collision` then contains what was found so far.
    pub fn collide_into(
        &self,
        contact: Contact,
        collision: &mut Collision,
    ) -> Result<Statistics, CollisionError> {
        let options = self.options_for(&contact)?;
        if contact.obeys_paper() {
            return self.observe(contact, &options, collision, &mut ());
        }
        if contact.law().normal.is_adhesive() {
            let system = AdhesiveContact::new(contact);
            return general::collide(self.pair, system, &options, collision, &mut ());
        }
        general::collide(self.pair, GeneralContact::new(contact), &options, collision, &mut ())
    }

    /// As [`Self::collide`], and then follows the same switches once more by a Taylor method with
    /// twice the digits: all results but the energy taken by damping are the true ones, rounded.
    /// Only switches too short for the integrator, just before the end, stay as they are. This is
    /// for references; it takes a hundred times as long.
    ///
    /// `None` if a switch is not found again.
    ///
    /// ```
    /// use stickslip_model::{Collider, Contact};
    ///
    /// let contact = Contact::new(63.0, 0.5, 0.01)?;
    /// let collider = Collider::default();
    /// // To 25 digits ε_t is −0.04117643391621580654375917.
    /// let error = |found: f64| (found + 0.041_176_433_916_215_807).abs();
    /// assert!(error(collider.collide(contact)?.eps_t()) < 2e-11);
    /// let finest = collider.collide_finely(contact)?.expect("its switches are found again");
    /// assert!(error(finest.eps_t()) < 1e-17);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`Self::collide`].
    pub fn collide_finely(&self, contact: Contact) -> Result<Option<Collision>, CollisionError> {
        contact.require_paper("the finest solution")?;
        let mut collision = self.collide(contact)?;
        let options = self.options_for(&contact)?;
        Ok(refine::refine(self.pair, &options, &mut collision).then_some(collision))
    }

    /// Integrates one collision and keeps its course in time, both with one run.
    ///
    /// The collision equals the result of [`Self::collide`], bit for bit, and the course the result
    /// of [`Self::history`], with its limit of steps. The statistics belong to this run, which
    /// repeats the step to every switch so that the course ends exactly there.
    ///
    /// # Errors
    /// As [`Self::collide`].
    pub fn followed(
        &self,
        contact: Contact,
    ) -> Result<(Collision, Statistics, History), CollisionError> {
        let options = self.recorded_options(&contact)?;
        let mut collision = Collision::before(contact);
        if contact.obeys_paper() {
            let mut record = Record::before(Regularized::new(contact));
            let statistics = self.observe(contact, &options, &mut collision, &mut record)?;
            return Ok((collision, statistics, History::of_paper(record)));
        }
        if contact.law().normal.is_adhesive() {
            let system = AdhesiveContact::new(contact).with_reversals();
            let mut record = Record::before(system);
            let statistics =
                general::collide(self.pair, system, &options, &mut collision, &mut record)?;
            require_separation(&collision)?;
            return Ok((collision, statistics, History::of_adhesive(record)));
        }
        let system = GeneralContact::new(contact).with_reversals();
        let mut record = Record::before(system);
        let statistics =
            general::collide(self.pair, system, &options, &mut collision, &mut record)?;
        Ok((collision, statistics, History::of_other(record)))
    }

    /// Integrates one collision into `collision`, while `course` observes the run too.
    fn observe<O: Observer<Phase, STATE>>(
        &self,
        contact: Contact,
        options: &Options,
        collision: &mut Collision,
        course: &mut O,
    ) -> Result<Statistics, CollisionError> {
        let system = Regularized::new(contact);
        collision.reset(contact);
        let phase = Phase::first(&contact);
        let start = Start { mode: phase, s: 0.0, state: system.start() };
        let account = Account::new(system, collision, start.state);
        let mut observed = Observed { account, course };
        let run = run_with(self.pair, &system, start, f64::INFINITY, options, &mut observed)?;
        let mut account = observed.account;
        if run.outcome != (Outcome::EndedByGuard { guard: END }) {
            let time = account.elapsed + run.state[T];
            return Err(CollisionError::Unfinished { outcome: run.outcome, time });
        }
        let last_slip = account.finish(run.mode, &run.state);
        let (sliding, flatness) = (account.sliding, account.flatness);
        collision.contact_time = collision.switches.last().map_or(0.0, |s| s.time) + last_slip;
        let mut left = last_slip;
        for switch in collision.switches.iter_mut().rev() {
            // Until here `time_left` is the duration of the phase that the switch ended.
            left += std::mem::replace(&mut switch.time_left, left);
        }
        // Without damping the contact ends at u = 0, and rounding may make u negative.
        let compression = run.state[U].max(0.0).powi(5);
        collision.eps_n = -system.compression_rate(&run.state);
        collision.final_velocity = system.velocity(&run.state);
        collision.energy = EnergyLedger {
            tangential_initial: 0.5 * contact.psi() * contact.psi(),
            tangential_final: 0.5 * collision.final_velocity * collision.final_velocity,
            tangential_damping: 0.0,
            sliding,
            spring_left: 0.0,
            normal_initial: 0.5,
            normal_final: 0.5 * collision.eps_n * collision.eps_n,
            damping: run.state[DAMPING],
            compression_left: 0.4 * compression,
        };
        if self.digits && flatness > FLAT && run.mode.regime == Regime::Slip {
            refine::refine(self.pair, options, collision);
        }
        Ok(run.statistics)
    }

    pub(crate) fn pair(&self) -> EmbeddedPair {
        self.pair
    }

    /// Integrates one collision and keeps its course in time, in at most [`History::MOST_STEPS`]
    /// steps.
    ///
    /// # Errors
    /// As [`Self::collide`].
    pub fn history(&self, contact: Contact) -> Result<History, CollisionError> {
        let options = self.recorded_options(&contact)?;
        if contact.obeys_paper() {
            let record = self.record(Regularized::new(contact), &options)?;
            return Ok(History::of_paper(record));
        }
        if contact.law().normal.is_adhesive() {
            let system = AdhesiveContact::new(contact).with_reversals();
            return Ok(History::of_adhesive(self.record(system, &options)?));
        }
        let system = GeneralContact::new(contact).with_reversals();
        Ok(History::of_other(self.record(system, &options)?))
    }

    /// Runs the contact of `system` and keeps its course.
    fn record<S, const N: usize, const G: usize>(
        &self,
        system: S,
        options: &Options,
    ) -> Result<Record<S, N>, CollisionError>
    where
        S: Followed<N> + HybridSystem<N, G, Mode = <S as Followed<N>>::Mode>,
    {
        let mut record = Record::before(system);
        let start = system.start();
        let run = run_with(self.pair, &system, start, f64::INFINITY, options, &mut record)?;
        match run.outcome {
            Outcome::EndedByGuard { guard: END } => Ok(record),
            Outcome::EndedByGuard { guard: HELD } => {
                Err(CollisionError::Adheres { time: record.duration() })
            }
            outcome => Err(CollisionError::Unfinished { outcome, time: record.duration() }),
        }
    }

    /// The options for `contact` where its course is kept.
    fn recorded_options(&self, contact: &Contact) -> Result<Options, CollisionError> {
        let options = self.options_for(contact)?;
        Ok(Options { max_steps: options.max_steps.min(History::MOST_STEPS), ..options })
    }

    /// Checks that `contact` is in the range of the integrators.
    ///
    /// # Errors
    /// [`OutOfDomain`] names the parameter and its range.
    pub fn require(contact: &Contact) -> Result<(), OutOfDomain> {
        domain::integrated(contact)
    }

    /// The options for `contact`, if it can be integrated.
    pub(crate) fn options_for(&self, contact: &Contact) -> Result<Options, OutOfDomain> {
        domain::integrated(contact)?;
        let mut options = self.options;
        if self.refined {
            let small = (contact.psi() / SMALL).min(1.0).powf(0.1);
            let above = |stiff: f64| (stiff / contact.kappa()).min(1.0).sqrt();
            let stiff = above(STIFF) * above(VERY_STIFF).max(STILL_FINER);
            options.max_step *= small;
            options.first_step = options.first_step.map(|h| h * small);
            for tolerance in [&mut options.rtol, &mut options.atol] {
                // A tolerance that is finer than rounding stays unchanged.
                *tolerance = (*tolerance * stiff).max(FINEST).min(*tolerance);
            }
            // Where rounding keeps a contact from ending, the general limit would take hours.
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "κ is within 0 and 1e10"
            )]
            let most = 50_000 + (MOST_STEPS_PER_OSCILLATION * contact.kappa().sqrt()) as usize;
            options.max_steps = options.max_steps.min(most);
        }
        let onset = contact.damping() / (contact.kappa() * contact.psi());
        // A first phase so much shorter than a step is lost in the rounding of the guard that ends
        // it.
        let damped = contact.damping() > 0.0 && contact.law().damping.is_viscous();
        if contact.law().normal.is_adhesive() {
            // The length of the first phase in s, up to a factor.
            let pull = contact.kappa() * contact.psi();
            let brief = contact.law().pull_off.sqrt() / pull.sqrt().max(4.0 * pull);
            options.first_step = options.first_step.map(|h| h.min(4.0 * brief));
        } else if damped && onset < BRIEF {
            options.first_step = options.first_step.map(|h| h.min(4.0 * onset));
        }
        Ok(options)
    }
}

/// Refuses the course of bodies that stay together, which has no end.
fn require_separation(collision: &Collision) -> Result<(), CollisionError> {
    let time = collision.contact_time;
    if collision.adheres { Err(CollisionError::Adheres { time }) } else { Ok(()) }
}
