//! Models of the spring, and the collisions that they make.

use stickslip_model::{Collider, Collision, Contact, Engine, largest};

use super::unreset;
use crate::error::{CollisionFailure, StudyError};

/// A model of the spring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spring {
    /// The paper's: reset to the limit as long as that is active.
    Reset,
    /// Never reset.
    Unreset,
}

impl Spring {
    /// The name of the model in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Reset => "reset",
            Self::Unreset => "unreset-spring",
        }
    }

    /// The collision, by the exact solution where there is one.
    pub fn collide(self, kappa: f64, psi: f64, damping: f64) -> Result<Collision, StudyError> {
        let contact = Contact::new(kappa, psi, damping)?;
        match self {
            Self::Reset => {
                let collided = Engine::Auto.collide(contact);
                let failed = |source| CollisionFailure::new(&contact, source);
                Ok(collided.map(|(collision, _)| collision).map_err(failed)?)
            }
            Self::Unreset => self.integrate(kappa, psi, damping),
        }
    }

    /// The collision, integrated.
    pub fn integrate(self, kappa: f64, psi: f64, damping: f64) -> Result<Collision, StudyError> {
        let contact = Contact::new(kappa, psi, damping)?;
        let collision = match self {
            Self::Reset => Collider::default().collide(contact),
            Self::Unreset => unreset::collide(contact).map(|unreset| unreset.collision),
        };
        Ok(collision.map_err(|source| CollisionFailure::new(&contact, source))?)
    }

    /// The largest elongation of the spring without damping.
    pub fn largest_elongation(self, kappa: f64, psi: f64) -> Result<f64, StudyError> {
        match self {
            Self::Reset => largest::spring(&self.collide(kappa, psi, 0.0)?)
                .ok_or(StudyError::NoSpring { kappa, psi }),
            Self::Unreset => {
                let contact = Contact::new(kappa, psi, 0.0)?;
                let collided = unreset::collide(contact);
                let failed = |source| CollisionFailure::new(&contact, source);
                Ok(collided.map(|unreset| unreset.largest_spring).map_err(failed)?)
            }
        }
    }
}
