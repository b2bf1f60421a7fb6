//! Impacts of one speed at all angles.

use stickslip_model::spheres::BodyPair;
use stickslip_model::{Contact, InvalidValue, Reduction};

/// Two bodies that collide at one speed. The angle θ from the normal decides the normal velocity
/// and the impact ratio g_t/g_n = tan θ = ψ μ/α.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oblique {
    /// The bodies.
    pub pair: BodyPair,
    /// The speed in m/s.
    pub speed_m_per_s: f64,
    /// κ at normal incidence.
    kappa: f64,
}

impl Oblique {
    /// The impacts of a pair at a speed in m/s.
    ///
    /// # Errors
    /// [`InvalidValue`]: the speed, or a property of the pair, is out of its range.
    pub fn new(pair: BodyPair, speed_m_per_s: f64) -> Result<Self, InvalidValue> {
        let kappa = pair.impact(speed_m_per_s, speed_m_per_s)?.contact.kappa();
        InvalidValue::check("kappa", kappa, "a finite number above 0", kappa > 0.0)?;
        Ok(Self { pair, speed_m_per_s, kappa })
    }

    /// κ at normal incidence.
    pub fn kappa(&self) -> f64 {
        self.kappa
    }

    fn reduction(&self) -> Reduction {
        Reduction { mu: self.pair.surface.friction, alpha: self.pair.alpha }
    }

    /// ψ of an angle in rad.
    pub fn psi(&self, angle_rad: f64) -> f64 {
        self.reduction().psi(angle_rad.tan())
    }

    /// The angle of ψ in rad.
    pub fn angle_rad(&self, psi: f64) -> f64 {
        self.reduction().ratio(psi).atan()
    }

    /// The contact at ψ, of bodies with another κ at normal incidence.
    pub(crate) fn at(&self, kappa: f64, psi: f64) -> Result<Contact, InvalidValue> {
        let ratio = self.reduction().ratio(psi);
        let normal = self.speed_m_per_s / ratio.hypot(1.0);
        let contact = self.pair.impact(normal, normal * ratio)?.contact;
        Contact::new(contact.kappa() * (kappa / self.kappa), psi, contact.damping())?
            .with_law(contact.law(), contact.tangential_damping())
    }

    /// The contact at an angle in rad.
    ///
    /// # Errors
    /// [`InvalidValue`]: the angle is not above 0 and below π/2.
    pub fn contact(&self, angle_rad: f64) -> Result<Contact, InvalidValue> {
        self.at(self.kappa, self.psi(angle_rad))
    }
}
