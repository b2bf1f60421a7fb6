//! What computes a collision: an integrator with its tolerances, or the exact solution.

use stickslip_model::{
    Collider, Collision, CollisionError, Contact, EnergyLedger, History,
    exact::{self, ExactError},
};
use stickslip_solver::{Dop853, Dopri5, InvalidOption, Options, Statistics};

use crate::number;

/// A way to compute collisions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Engine {
    /// Dormand–Prince 8(5,3).
    Dop853(Tolerances),
    /// Dormand–Prince 5(4).
    Dopri5(Tolerances),
    /// The exact solution, without damping only.
    Exact,
}

impl Engine {
    /// Name of the method, as `--method` takes it.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Dop853(_) => "dop853",
            Self::Dopri5(_) => "dopri5",
            Self::Exact => "exact",
        }
    }

    /// The integrator's tolerances.
    pub fn tolerances(&self) -> Option<Tolerances> {
        match *self {
            Self::Dop853(tolerances) | Self::Dopri5(tolerances) => Some(tolerances),
            Self::Exact => None,
        }
    }

    /// Computes the collision of `contact`.
    ///
    /// The statistics are those of the integrator.
    ///
    /// # Errors
    /// What the integrator or the exact solution reports.
    pub fn collide(
        &self,
        contact: Contact,
    ) -> Result<(Collision, Option<Statistics>), EngineError> {
        let mut collision = Collision::before(contact);
        let statistics = match *self {
            Self::Dop853(Tolerances { rtol, atol }) => {
                let collider = Collider::with_tolerances(Dop853, rtol, atol);
                collider.collide_into(contact, &mut collision)?
            }
            Self::Dopri5(Tolerances { rtol, atol }) => {
                let collider = Collider::with_tolerances(Dopri5, rtol, atol);
                collider.collide_into(contact, &mut collision)?
            }
            Self::Exact => {
                exact::collide_into(contact, &mut collision)?;
                return Ok((collision, None));
            }
        };
        Ok((collision, Some(statistics)))
    }

    /// The course of the collision of `contact`; the exact solution's is that of Dormand–Prince
    /// 8(5,3).
    ///
    /// # Errors
    /// What the integrator reports.
    pub fn history(&self, contact: Contact) -> Result<History, EngineError> {
        let history = match *self {
            Self::Dop853(Tolerances { rtol, atol }) => {
                Collider::with_tolerances(Dop853, rtol, atol).history(contact)
            }
            Self::Dopri5(Tolerances { rtol, atol }) => {
                Collider::with_tolerances(Dopri5, rtol, atol).history(contact)
            }
            Self::Exact => Collider::default().history(contact),
        };
        Ok(history?)
    }
}

/// Tolerances of a step: its error stays below `atol + rtol·|y|`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Relative.
    pub rtol: f64,
    /// Absolute.
    pub atol: f64,
}

impl Tolerances {
    /// Defaults of Dormand–Prince 8(5,3), at which w is good to 1e-12.
    pub const DOP853: Self =
        Self { rtol: Collider::<Dop853>::RTOL, atol: Collider::<Dop853>::ATOL };
    /// Defaults of Dormand–Prince 5(4), which would need very many steps for the same.
    pub const DOPRI5: Self = Self { rtol: 1e-10, atol: 1e-10 };

    /// Reads a relative tolerance.
    ///
    /// # Errors
    /// What is wrong with it and what is expected.
    pub fn parse_rtol(text: &str) -> Result<f64, String> {
        parse(text, |rtol| Options { rtol, ..Options::default() })
    }

    /// Reads an absolute tolerance.
    ///
    /// # Errors
    /// What is wrong with it and what is expected.
    pub fn parse_atol(text: &str) -> Result<f64, String> {
        parse(text, |atol| Options { atol, ..Options::default() })
    }
}

/// Why there is no result.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum EngineError {
    /// The integration failed.
    #[error(transparent)]
    Collision(#[from] CollisionError),
    /// The exact solution does not take the contact.
    #[error(transparent)]
    Exact(#[from] ExactError),
    /// A number of the result is beyond the range of doubles.
    #[error("{name} is not a finite number")]
    NotFinite {
        /// Which.
        name: &'static str,
    },
}

/// Refuses a collision with a result that is no finite number.
///
/// # Errors
/// [`EngineError::NotFinite`] names the first.
pub fn require_finite(collision: &Collision) -> Result<(), EngineError> {
    let results = [
        ("eps_n", collision.eps_n),
        ("eps_t", collision.eps_t()),
        ("w_final", collision.final_velocity),
        ("contact_time", collision.contact_time),
    ];
    let switches = collision.switches.iter().flat_map(|switch| {
        [
            ("the time of a switch", switch.time),
            ("the time left at a switch", switch.time_left),
            ("the spring at a switch", switch.spring),
            ("the velocity at a switch", switch.velocity),
        ]
    });
    all_finite(results.into_iter().chain(switches))
}

/// Refuses a ledger with an entry that is no finite number.
///
/// # Errors
/// [`EngineError::NotFinite`] names the first.
pub fn require_finite_energy(ledger: &EnergyLedger) -> Result<(), EngineError> {
    all_finite([
        ("tangential_initial", ledger.tangential_initial),
        ("tangential_final", ledger.tangential_final),
        ("sliding", ledger.sliding),
        ("spring_left", ledger.spring_left),
        ("normal_initial", ledger.normal_initial),
        ("normal_final", ledger.normal_final),
        ("damping", ledger.damping),
        ("compression_left", ledger.compression_left),
    ])
}

/// Refuses results, given with their names, of which one is no finite number.
///
/// # Errors
/// [`EngineError::NotFinite`] names the first.
pub fn all_finite(
    values: impl IntoIterator<Item = (&'static str, f64)>,
) -> Result<(), EngineError> {
    match values.into_iter().find(|(_, value)| !value.is_finite()) {
        Some((name, _)) => Err(EngineError::NotFinite { name }),
        None => Ok(()),
    }
}

/// The number in `text`, if `options` made with it are valid.
fn parse(text: &str, options: impl Fn(f64) -> Options) -> Result<f64, String> {
    let expected = |value: f64| match options(value).validate() {
        Ok(()) => None,
        Err(InvalidOption { expected, .. }) => Some(expected),
    };
    let range = expected(f64::NAN).unwrap_or("a number");
    let value = number::parse(text).map_err(|problem| format!("{problem}; expected {range}"))?;
    match expected(value) {
        None => Ok(value),
        Some(range) => Err(format!("out of range; expected {range}")),
    }
}
