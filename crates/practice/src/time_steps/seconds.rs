//! Time steps in seconds, and the time of Rayleigh waves, in which many users measure their steps.

use stickslip_model::spheres::{Encounter, Sphere};

use super::stepped::undamped_contact_time;

/// The times of an impact in SI units to which steps are compared.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Seconds {
    /// The undamped contact time t_c in s.
    pub contact_time_s: f64,
    /// The least [`rayleigh_time_s`] of the spheres, in s.
    pub rayleigh_time_s: f64,
}

impl Seconds {
    /// The times of `encounter`.
    pub fn new(encounter: &Encounter) -> Self {
        let law = encounter.contact().law();
        Self {
            contact_time_s: undamped_contact_time(law) * encounter.impact.time_unit_s,
            rayleigh_time_s: encounter.spheres().map(rayleigh_time_s).fold(f64::INFINITY, f64::min),
        }
    }

    /// The step in s for `steps_per_contact` steps in the undamped contact time.
    pub fn step_s(&self, steps_per_contact: f64) -> f64 {
        self.contact_time_s / steps_per_contact
    }
}

/// The time π R √(ρ/G)/(0.1631 ν + 0.8766) in s that a Rayleigh wave takes from one pole of a
/// sphere to the other, with the mean density ρ and G = Y/(2(1 + ν)).
///
/// Particle codes recommend steps of some 10 to 30 % of it, the least of all spheres'. It does not
/// depend on the velocity of an impact, unlike the contact time.
///
/// Source: C. Thornton and C. W. Randall, in Micromechanics of Granular Materials (1988), 133; Y.
/// Li, Y. Xu and C. Thornton, Powder Technol. 160, 219 (2005).
///
/// ```
/// use stickslip_model::spheres::{Material, Sphere};
/// use stickslip_practice::time_steps::rayleigh_time_s;
///
/// let steel = Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3: 7850.0 };
/// let time = rayleigh_time_s(&Sphere::homogeneous(0.02, &steel));
/// // A sphere of 4 cm, and waves of 2.97 km/s.
/// assert!((time - 21.2e-6).abs() < 0.1e-6);
/// ```
pub fn rayleigh_time_s(sphere: &Sphere) -> f64 {
    let ratio = sphere.elasticity.poisson_ratio;
    let density = sphere.mass_kg / Sphere::homogeneous_mass(sphere.radius_m, 1.0);
    let shear_modulus = sphere.elasticity.young_modulus_pa / (2.0 * (1.0 + ratio));
    let slowness = (density / shear_modulus).sqrt() / (0.1631 * ratio + 0.8766);
    std::f64::consts::PI * sphere.radius_m * slowness
}
