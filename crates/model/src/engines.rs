//! What computes a collision: an integrator with its tolerances, or the exact solution.
//!
//! A further engine is a module beside [`integrator`], or a crate beside `stickslip-exact`, and a
//! variant of [`Engine`].

use stickslip_contact::{Collision, Contact, Law, Regime, Side};
use stickslip_exact::exact::{self};
use stickslip_exact::linear;
use stickslip_solver::{Dop853, Dopri5, InvalidValue, Options, Statistics};

pub(crate) mod domain;
pub mod error;
mod estimate;
pub mod history;
pub mod integrator;
pub mod sensitivity;

use error::CollisionError;
pub use estimate::Estimate;
use history::History;
use integrator::Collider;

/// A way to compute collisions.
///
/// ```
/// use stickslip_model::{Contact, Engine};
///
/// let contact = Contact::new(63.0, 0.5, 0.1)?;
/// let (collision, statistics) = Engine::Auto.collide(contact)?;
/// // There is an exact solution, which takes no steps.
/// assert_eq!(Engine::Auto.resolved(&contact), Engine::Exact);
/// assert_eq!(collision.itinerary(), "o+o-o+o-");
/// assert!(statistics.is_none());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Engine {
    /// Dormand–Prince 8(5,3).
    Dop853(Tolerances),
    /// Dormand–Prince 5(4).
    Dopri5(Tolerances),
    /// The exact solution of the paper's law, also without a tangential force, or of a linear
    /// contact.
    Exact,
    /// The best engine for a contact: the exact solution where its law is the paper's, otherwise
    /// Dormand–Prince 8(5,3).
    Auto,
}

/// Tolerances of a step, whose error in a component y stays below `atol + rtol·|y|`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Relative tolerance, 1e-15 to 0.1.
    pub rtol: f64,
    /// Absolute tolerance, above 0.
    pub atol: f64,
}

impl Tolerances {
    /// Defaults of Dormand–Prince 8(5,3), with which w is within 1e-12.
    pub const DOP853: Self = Self { rtol: Collider::RTOL, atol: Collider::ATOL };
    /// Defaults of Dormand–Prince 5(4). It would need very many steps for the accuracy of 8(5,3).
    pub const DOPRI5: Self = Self { rtol: 1e-10, atol: 1e-10 };
}

impl Engine {
    /// The engine that a program's options choose: a method by its [`Self::name`], and tolerances,
    /// whose defaults depend on the method.
    ///
    /// `auto` is the exact solution, whose range contains the range of the integrators, unless a
    /// tolerance requires an integration.
    ///
    /// # Errors
    /// [`InvalidValue`]: no method has this name, or a tolerance is out of range. A tolerance that
    /// would have no effect is said in a [phrase](stickslip_solver::GivenValue::Phrase).
    pub fn chosen(
        method: &str,
        rtol: Option<f64>,
        atol: Option<f64>,
    ) -> Result<Self, InvalidValue> {
        let tolerances = |usual: Tolerances| Tolerances {
            rtol: rtol.unwrap_or(usual.rtol),
            atol: atol.unwrap_or(usual.atol),
        };
        let given = [("rtol", rtol), ("atol", atol)];
        let given = given.into_iter().find_map(|(name, value)| Some((name, value?)));
        let engine = match (method, given) {
            ("dop853", _) | ("auto", Some(_)) => Self::Dop853(tolerances(Tolerances::DOP853)),
            ("dopri5", _) => Self::Dopri5(tolerances(Tolerances::DOPRI5)),
            ("exact" | "auto", None) => Self::Exact,
            ("exact", Some((name, value))) => {
                let phrase = format!(
                    "{value:?} has no effect with the method exact, which has no tolerances"
                );
                return Err(InvalidValue::phrase(name, phrase, "with dop853 and dopri5 only"));
            }
            (other, _) => {
                let expected = "\"auto\", \"exact\", \"dop853\" or \"dopri5\"";
                return Err(InvalidValue::new("method", other, expected));
            }
        };
        if let Some(Tolerances { rtol, atol }) = engine.tolerances() {
            Options { rtol, atol, ..Options::default() }.validate()?;
        }
        Ok(engine)
    }

    /// As [`Self::chosen`], for collisions with a law: `auto` is the best engine for it.
    ///
    /// # Errors
    /// As [`Self::chosen`].
    pub fn chosen_for(
        law: (Law, f64),
        method: &str,
        rtol: Option<f64>,
        atol: Option<f64>,
    ) -> Result<Self, InvalidValue> {
        let papers = law == (Law::PAPER, 0.0);
        let method = if method == "auto" && !papers { "dop853" } else { method };
        Self::chosen(method, rtol, atol)
    }

    /// The name of the method: `dop853`, `dopri5`, `exact` or `auto`.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Dop853(_) => "dop853",
            Self::Dopri5(_) => "dopri5",
            Self::Exact => "exact",
            Self::Auto => "auto",
        }
    }

    /// The tolerances of an integrator; `None` for [`Self::Exact`] and [`Self::Auto`].
    pub fn tolerances(&self) -> Option<Tolerances> {
        match *self {
            Self::Dop853(tolerances) | Self::Dopri5(tolerances) => Some(tolerances),
            Self::Exact | Self::Auto => None,
        }
    }

    /// The engine that computes the collision of `contact`: itself, or what [`Self::Auto`] chooses.
    pub fn resolved(self, contact: &Contact) -> Self {
        match self {
            // The range of the exact solution contains the range of the integrators.
            Self::Auto if contact.obeys_paper() => Self::Exact,
            Self::Auto => Self::Dop853(Tolerances::DOP853),
            chosen => chosen,
        }
    }

    /// Computes the collision of `contact`, with the statistics of the run if it is integrated.
    ///
    /// # Errors
    /// [`CollisionError`]: the contact is out of the engine's range, the integration fails, or a
    /// result is beyond the range of doubles. Energies are not checked; see
    /// [`EnergyLedger::require_finite`](crate::EnergyLedger::require_finite).
    pub fn collide(
        &self,
        contact: Contact,
    ) -> Result<(Collision, Option<Statistics>), CollisionError> {
        let mut collision = Collision::before(contact);
        let statistics = self.collide_into(contact, &mut collision)?;
        Ok((collision, statistics))
    }

    /// As [`Self::collide`], with the result written to `collision`, whose memory is used again.
    ///
    /// # Errors
    /// As [`Self::collide`]. What is in `collision` then has no meaning.
    pub fn collide_into(
        &self,
        contact: Contact,
        collision: &mut Collision,
    ) -> Result<Option<Statistics>, CollisionError> {
        let statistics = match self.resolved(&contact) {
            Self::Dop853(Tolerances { rtol, atol }) => {
                let collider = Collider::with_tolerances(Dop853, rtol, atol);
                Some(collider.collide_into(contact, collision)?)
            }
            Self::Dopri5(Tolerances { rtol, atol }) => {
                let collider = Collider::with_tolerances(Dopri5, rtol, atol);
                Some(collider.collide_into(contact, collision)?)
            }
            Self::Exact | Self::Auto if contact.obeys_paper() => {
                exact::collide_into(contact, collision)?;
                None
            }
            Self::Exact | Self::Auto => {
                match of_paper_without_tangential_force(&contact) {
                    Some(sliding) => without_tangential_force(contact, sliding, collision)?,
                    None => linear::collide_into(contact, collision)?,
                }
                None
            }
        };
        collision.require_finite()?;
        Ok(statistics)
    }

    /// The collision of `contact` with its course. An integrator computes both with one run.
    ///
    /// The collision equals the result of [`Self::collide`], bit for bit. The integrator's work
    /// belongs to the run that keeps the course, which repeats some steps.
    ///
    /// # Errors
    /// As [`Self::collide`] and [`Self::history`].
    pub fn followed(
        &self,
        contact: Contact,
    ) -> Result<(Collision, Option<Statistics>, History), CollisionError> {
        let (collision, statistics, history) = match self.resolved(&contact) {
            Self::Dop853(Tolerances { rtol, atol }) => {
                Collider::with_tolerances(Dop853, rtol, atol).followed(contact)?
            }
            Self::Dopri5(Tolerances { rtol, atol }) => {
                Collider::with_tolerances(Dopri5, rtol, atol).followed(contact)?
            }
            Self::Exact | Self::Auto => {
                let (collision, statistics) = self.collide(contact)?;
                let history = if contact.obeys_paper() {
                    History::of_exact(collision.clone())?
                } else {
                    self.history(contact)?
                };
                return Ok((collision, statistics, history));
            }
        };
        collision.require_finite()?;
        Ok((collision, Some(statistics), history))
    }

    /// The course of the collision of `contact` in time. For [`Self::Exact`] and [`Self::Auto`] it
    /// is the exact solution of the paper's law; that of another law is integrated by
    /// Dormand–Prince 8(5,3) at its default tolerances.
    ///
    /// ```
    /// use stickslip_model::{Contact, Engine};
    ///
    /// let (collision, _, history) = Engine::Auto.followed(Contact::new(63.0, 0.5, 0.1)?)?;
    /// let end = history.at(history.duration()).ok_or("outside the contact")?;
    /// assert!((end.velocity - collision.final_velocity).abs() < 1e-15);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`CollisionError`]: the contact is out of the engine's range, the integration fails, or
    /// there are more than [`History::MOST_STEPS`] steps or switches.
    pub fn history(&self, contact: Contact) -> Result<History, CollisionError> {
        match *self {
            Self::Dop853(Tolerances { rtol, atol }) => {
                Collider::with_tolerances(Dop853, rtol, atol).history(contact)
            }
            Self::Dopri5(Tolerances { rtol, atol }) => {
                Collider::with_tolerances(Dopri5, rtol, atol).history(contact)
            }
            Self::Exact | Self::Auto if contact.obeys_paper() => History::exact(contact),
            Self::Exact | Self::Auto => Collider::default().history(contact),
        }
    }
}

/// A contact with the paper's law that has the normal motion of `contact`, if this is the paper's
/// but for a tangential force, which it has not.
fn of_paper_without_tangential_force(contact: &Contact) -> Option<Contact> {
    let (law, damping) = (contact.law(), contact.damping());
    let force = law.remembers() || damping * contact.tangential_damping() > 0.0;
    let (history, tangential) = (Law::PAPER.history, Law::PAPER.tangential);
    let friction = Law::PAPER.friction;
    let beside = Law { history, tangential, rescaled: false, friction, ..law };
    let of_paper = !force && beside.acts_as_paper(damping, 0.0);
    // It slides from beginning to end.
    of_paper.then(|| Contact::new(1.0, 3.0, damping).ok()).flatten()
}

/// The collision of a contact without a tangential force, which has the normal motion of `sliding`.
fn without_tangential_force(
    contact: Contact,
    sliding: Contact,
    collision: &mut Collision,
) -> Result<(), CollisionError> {
    exact::collide_into(sliding, collision)?;
    collision.contact = contact;
    (collision.start, collision.start_side) = (Regime::Stick, Side::Positive);
    collision.final_velocity = contact.psi();
    collision.switches.clear();
    collision.reversals = 0;
    let energy = &mut collision.energy;
    energy.tangential_initial = 0.5 * contact.psi() * contact.psi();
    energy.tangential_final = energy.tangential_initial;
    (energy.sliding, energy.spring_left) = (0.0, 0.0);
    Ok(())
}
