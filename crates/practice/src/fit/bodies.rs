//! The bodies of a fit, and the numbers that may be fitted.

use stickslip_model::spheres::{BodyPair, Sphere, Surface, quantity};
use stickslip_model::{InvalidValue, Law, Normal, Tangential};

/// Two bodies whose surfaces are fitted; the second one is at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FittedBodies {
    /// What the contact feels. Those properties of the surfaces that are fitted do not count.
    pub pair: BodyPair,
    /// Distance of the centre of the first sphere from the contact over its moment of inertia, in
    /// 1/(kg m), which makes a spin of an impulse. `None` in scaled units.
    pub arm_per_inertia: Option<f64>,
}

/// The numbers on which the impacts at all angles depend.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Values {
    /// κ at normal incidence.
    pub kappa: f64,
    /// Coefficient of friction μ.
    pub mu: f64,
    /// Tangential damping b = (γ_t/γ_n)/α.
    pub tangential_damping: f64,
    /// Damping a at normal incidence.
    pub damping: f64,
}

/// Damping time for which the scaled damping is computed. It is proportional to it, and this one is
/// small enough for all laws.
const SMALL_TIME: f64 = 1e-200;

impl FittedBodies {
    /// A sphere that hits another body.
    pub fn of_sphere(sphere: &Sphere, pair: BodyPair) -> Self {
        let arm_per_inertia = Some(sphere.radius_m / sphere.moment_of_inertia_kg_m2);
        Self { pair, arm_per_inertia }
    }

    /// Bodies for which only α is known, with `values` for what is not fitted. All their impacts
    /// have the same speed, which is 1.
    ///
    /// # Errors
    /// [`InvalidValue`]: α is not above 0 and at most 1.
    pub fn scaled(law: Law, alpha: f64, values: &Values) -> Result<Self, InvalidValue> {
        let alpha = quantity::INERTIA.check(alpha)?;
        // With g_n = 1 the units of mass, length and time are 1.
        let surface = Surface {
            friction: values.mu,
            tangential_stiffness_kg_per_s2: values.kappa * alpha,
            damping_time_s: values.damping,
        };
        let pair = BodyPair {
            effective_mass_kg: 1.0,
            effective_radius_m: 1.0,
            elastic_constant: 1.0,
            stiffness_ratio: 1.0,
            alpha,
            surface,
            law,
            tangential_damping_ratio: values.tangential_damping * alpha,
        };
        Ok(Self { pair, arm_per_inertia: None })
    }

    /// Whether lengths and velocities are scaled.
    pub fn are_scaled(&self) -> bool {
        self.arm_per_inertia.is_none()
    }

    /// The units of a speed.
    pub(super) fn units(&self, speed_m_per_s: f64) -> Result<Units, InvalidValue> {
        let surface = Surface {
            friction: 1.0,
            tangential_stiffness_kg_per_s2: 1.0,
            damping_time_s: SMALL_TIME,
        };
        let pair = BodyPair { surface, tangential_damping_ratio: 0.0, ..self.pair };
        let contact = pair.impact(speed_m_per_s, speed_m_per_s)?.contact;
        Ok(Units {
            speed_m_per_s,
            kappa: contact.kappa(),
            damping_per_s: contact.damping() / SMALL_TIME,
        })
    }

    /// What the bodies have where nothing is fitted.
    pub(super) fn values(&self, units: &Units) -> Values {
        let Surface { friction, tangential_stiffness_kg_per_s2, damping_time_s } =
            self.pair.surface;
        Values {
            kappa: units.kappa * tangential_stiffness_kg_per_s2,
            mu: friction,
            tangential_damping: self.pair.tangential_damping(),
            damping: units.damping_per_s * damping_time_s,
        }
    }

    /// The pair with other values. Friction that decays keeps μ_d/μ_s, and the decay β in s/m, or B
    /// in scaled units.
    pub(super) fn with(&self, units: &Units, values: &Values) -> BodyPair {
        let damped = units.damping_per_s > 0.0;
        let surface = Surface {
            friction: values.mu,
            tangential_stiffness_kg_per_s2: values.kappa / units.kappa,
            damping_time_s: if damped { values.damping / units.damping_per_s } else { 0.0 },
        };
        let tangential_damping_ratio = values.tangential_damping * self.pair.alpha;
        let mut law = self.pair.law;
        if !self.are_scaled() {
            law.friction.decay *= values.mu / self.pair.surface.friction;
        }
        BodyPair { surface, tangential_damping_ratio, law, ..self.pair }
    }

    /// κ at normal incidence of the tangential stiffness that Mindlin's theory gives the materials:
    /// a constant one has it at the largest compression. `None` if they are not known, or if the
    /// normal force is linear.
    pub(super) fn mindlin_kappa(&self, units: &Units) -> Option<f64> {
        let BodyPair { law, stiffness_ratio, elastic_constant, .. } = self.pair;
        if self.are_scaled() || law.normal == Normal::Linear {
            return None;
        }
        Some(match law.tangential {
            Tangential::Constant => self.pair.mindlin_kappa(),
            Tangential::Mindlin => units.kappa * 1.5 * stiffness_ratio * elastic_constant,
        })
    }
}

/// What makes scaled numbers of those in SI units, at normal incidence with one speed.
#[derive(Clone, Copy, Debug)]
pub struct Units {
    /// The speed in m/s.
    pub speed_m_per_s: f64,
    /// κ of a tangential stiffness of 1.
    pub kappa: f64,
    /// Scaled damping of a damping time of 1 s; 0 if the law has no damping.
    pub damping_per_s: f64,
}
