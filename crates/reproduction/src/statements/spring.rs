//! Models of the spring, and the collisions with each.

use stickslip_model::limits::largest;
use stickslip_model::{Collider, Collision, CollisionError, CollisionFailure, Contact, Engine};
use stickslip_studies::unreset;

use crate::error::ReproductionError;

/// A model of the spring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spring {
    /// The paper's model: the spring is reset to its limit as long as the limit is active.
    Reset,
    /// The spring is never reset.
    Unreset,
}

impl Spring {
    /// The name of the model in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Reset => "reset",
            Self::Unreset => "unreset-spring",
        }
    }

    /// The collision, by the exact solution where there is one.
    ///
    /// # Errors
    /// [`ReproductionError`]: the collision cannot be computed.
    pub fn collide(
        self,
        kappa: f64,
        psi: f64,
        damping: f64,
    ) -> Result<Collision, ReproductionError> {
        let contact = Contact::new(kappa, psi, damping)?;
        match self {
            Self::Reset => {
                let collided = Engine::Auto.collide(contact).map(|(collision, _)| collision);
                computed(&contact, collided)
            }
            Self::Unreset => self.integrate(kappa, psi, damping),
        }
    }

    /// The collision, integrated.
    ///
    /// # Errors
    /// [`ReproductionError`]: the collision cannot be computed.
    pub fn integrate(
        self,
        kappa: f64,
        psi: f64,
        damping: f64,
    ) -> Result<Collision, ReproductionError> {
        let contact = Contact::new(kappa, psi, damping)?;
        match self {
            Self::Reset => computed(&contact, Collider::default().collide(contact)),
            Self::Unreset => Ok(computed(&contact, unreset::collide(contact))?.collision),
        }
    }

    /// The largest elongation of the spring without damping.
    ///
    /// # Errors
    /// [`ReproductionError`]: the collision cannot be computed.
    pub fn largest_elongation(self, kappa: f64, psi: f64) -> Result<f64, ReproductionError> {
        match self {
            Self::Reset => largest::spring(&self.collide(kappa, psi, 0.0)?)
                .ok_or(ReproductionError::NoElongation { kappa, psi }),
            Self::Unreset => {
                let contact = Contact::new(kappa, psi, 0.0)?;
                Ok(computed(&contact, unreset::collide(contact))?.largest_spring)
            }
        }
    }
}

/// `result`, with its contact named if it is a failure.
fn computed<T>(
    contact: &Contact,
    result: Result<T, impl Into<CollisionError>>,
) -> Result<T, ReproductionError> {
    Ok(result.map_err(|source| CollisionFailure::new(contact, source))?)
}
