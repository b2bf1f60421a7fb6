//! What is measured of full collisions at one stiffness.

use super::limit::{self as stiff, Crest};
use stickslip_model::{Collider, Contact, exact};

use crate::error::{CollisionFailure, StudyError};

/// Up to this stiffness the integrator, whose work grows with √κ, repeats what the exact engine
/// found.
const MOST_INTEGRATED: f64 = 1e8;

/// One stiffness and one ψ.
#[derive(Clone, Debug)]
pub struct Measured {
    pub kappa: f64,
    pub psi: f64,
    /// The top of the oscillation around ψ.
    pub crest: Crest,
    /// |w_final| there by dop853; NaN above the largest stiffness integrated.
    pub integrated: f64,
    /// Number of switches at ψ itself.
    pub switch_count: usize,
    /// That number over √κ t_c/π.
    pub count_ratio: f64,
    /// The same if all half swings lasted π/√κ, and none had switches while the spring cannot
    /// reach its limit.
    pub count_expected: f64,
}

impl Measured {
    /// # Errors
    /// A collision cannot be computed.
    pub fn measure(kappa: f64, psi: f64) -> Result<Self, StudyError> {
        let crest = stiff::envelope(kappa, psi)?;
        let integrated = if kappa <= MOST_INTEGRATED { integrated(&crest)? } else { f64::NAN };
        let collision = exact::collide(contact(kappa, psi)?).map_err(stiff::StiffError::from)?;
        let contact_time = collision.contact_time;
        // Without a switch nothing swings.
        let time_of_switches =
            collision.switches.first().map_or(0.0, |first| first.time.min(first.time_left));
        Ok(Self {
            kappa,
            psi,
            crest,
            integrated,
            switch_count: collision.switches.len(),
            count_ratio: collision.switches.len() as f64 * std::f64::consts::PI
                / (kappa.sqrt() * contact_time),
            count_expected: 2.0 * time_of_switches / contact_time,
        })
    }

    /// κ^{5/4} |w_final| at the top.
    pub fn scaled(&self) -> f64 {
        self.crest.velocity * self.kappa.powf(1.25)
    }
}

/// From where on the largest |ε_t| is looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lowest {
    /// ψ = 1/√κ times this: the bound (27) is 1 over this.
    Bound(f64),
    /// This ψ.
    Psi(f64),
}

impl Lowest {
    /// All that are measured.
    pub const ALL: [Self; 3] = [Self::Bound(1.0), Self::Bound(10.0), Self::Psi(0.3)];

    /// In words.
    pub fn name(self) -> String {
        match self {
            Self::Bound(1.0) => "1/√κ".to_owned(),
            Self::Bound(factor) => format!("{factor}/√κ"),
            Self::Psi(psi) => format!("{psi}"),
        }
    }

    fn psi(self, kappa: f64) -> f64 {
        match self {
            Self::Bound(factor) => factor / kappa.sqrt(),
            Self::Psi(psi) => psi,
        }
    }
}

/// The largest |ε_t| of a range of ψ up to 2.
#[derive(Clone, Debug)]
pub struct Restitution {
    pub kappa: f64,
    pub from: Lowest,
    /// Where the range starts.
    pub lowest: f64,
    /// None if the range is empty.
    pub largest: Option<Crest>,
}

impl Restitution {
    /// # Errors
    /// A collision cannot be computed.
    pub fn measure(kappa: f64, from: Lowest) -> Result<Self, StudyError> {
        let lowest = from.psi(kappa);
        let largest =
            (lowest < 2.0).then(|| stiff::largest_restitution(kappa, lowest)).transpose()?;
        Ok(Self { kappa, from, lowest, largest })
    }

    /// The largest |ε_t|; NaN if the range is empty.
    pub fn eps_t(&self) -> f64 {
        self.largest.map_or(f64::NAN, |crest| crest.velocity / crest.psi)
    }
}

fn contact(kappa: f64, psi: f64) -> Result<Contact, StudyError> {
    Ok(Contact::new(kappa, psi, 0.0).map_err(stiff::StiffError::from)?)
}

fn integrated(crest: &Crest) -> Result<f64, StudyError> {
    let contact = contact(crest.kappa, crest.psi)?;
    let collision = Collider::default().collide(contact);
    let failed = |error| CollisionFailure::new(&contact, error);
    Ok(collision.map_err(failed)?.final_velocity.abs())
}
