//! The time of Rayleigh waves, in which many users measure their steps.

use stickslip_model::Sphere;

/// The time π R √(ρ/G)/(0.1631 ν + 0.8766) in s that a Rayleigh wave takes from one pole of a
/// sphere to the other, with the mean density ρ and G = Y/(2(1 + ν)).
///
/// Particle codes recommend steps of some 10 to 30 % of it, the least of all spheres'. It does not
/// depend on the velocity of an impact, unlike the contact time.
///
/// Source: C. Thornton and C. W. Randall, in Micromechanics of Granular Materials (1988), 133; Y. Li,
/// Y. Xu and C. Thornton, Powder Technol. 160, 219 (2005).
///
/// ```
/// use stickslip_model::{Material, Sphere};
/// use stickslip_practice::time_steps::rayleigh_time_s;
///
/// let steel = Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3: 7850.0 };
/// let time = rayleigh_time_s(&Sphere::homogeneous(0.02, &steel));
/// // A sphere of 4 cm, and waves of 2.97 km/s.
/// assert!((time - 21.2e-6).abs() < 0.1e-6);
/// ```
#[must_use]
pub fn rayleigh_time_s(sphere: &Sphere) -> f64 {
    let ratio = sphere.elasticity.poisson_ratio;
    let density = sphere.mass_kg / Sphere::homogeneous_mass(sphere.radius_m, 1.0);
    let shear_modulus = sphere.elasticity.young_modulus_pa / (2.0 * (1.0 + ratio));
    let slowness = (density / shear_modulus).sqrt() / (0.1631 * ratio + 0.8766);
    std::f64::consts::PI * sphere.radius_m * slowness
}
