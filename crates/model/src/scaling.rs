//! From spheres in SI units to the numbers that decide a collision, and back.
//!
//! Source: Schwager, Becker and Pöschel, Eur. Phys. J. E 27, 107 (2008), equations (1), (12), (21)–(24).

use crate::contact::{Contact, InvalidParameter};

/// An elastic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Young's modulus Y in Pa.
    pub young_modulus_pa: f64,
    /// Poisson's ratio ν.
    pub poisson_ratio: f64,
    /// Density in kg/m³.
    pub density_kg_per_m3: f64,
}

/// How the two surfaces act on each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Coulomb's coefficient of friction μ.
    pub friction: f64,
    /// Stiffness k_t of the tangential spring in kg/s².
    pub tangential_stiffness_kg_per_s2: f64,
    /// Damping time A in s: F_n = ρ(ξ^{3/2} + A √ξ ξ̇). Many papers write (3/2) A where this one writes A.
    pub damping_time_s: f64,
}

/// Two colliding bodies reduced to what their contact feels.
///
/// ```
/// use stickslip_model::{Material, Pair, Surface};
///
/// let steel = Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3: 7850.0 };
/// let surface = Surface { friction: 0.4, tangential_stiffness_kg_per_s2: 1e12, damping_time_s: 0.0 };
/// let pair = Pair::equal_spheres(0.02, &steel, &surface)?;
/// let impact = pair.impact(20.0, 4.0)?;
/// // Largest normal force F = ρ ξ^{3/2}, with ξ from the energy balance: 146.4 kN.
/// let force = 1.25_f64.powf(0.6) * impact.force_unit_n();
/// assert!((force / 146.4e3 - 1.0).abs() < 1e-3);
/// # Ok::<(), stickslip_model::InvalidParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Effective mass m = m_i m_j/(m_i + m_j) in kg.
    pub effective_mass_kg: f64,
    /// Elastic constant ρ = 2Y √R/(3(1 − ν²)) in kg m^{−1/2} s^{−2}, with the effective radius R.
    pub elastic_constant: f64,
    /// α = 1/(1 + m R_i²/J_i + m R_j²/J_j); 2/7 for homogeneous spheres.
    pub alpha: f64,
    /// The surfaces.
    pub surface: Surface,
}

impl Pair {
    /// Two equal homogeneous spheres of `radius_m`.
    ///
    /// # Errors
    /// [`InvalidParameter`] names the first quantity that is out of its range.
    pub fn equal_spheres(
        radius_m: f64,
        material: &Material,
        surface: &Surface,
    ) -> Result<Self, InvalidParameter> {
        let positive = "a finite number above 0";
        let quantities = [
            ("radius_m", radius_m, positive, radius_m > 0.0),
            (
                "young_modulus_pa",
                material.young_modulus_pa,
                positive,
                material.young_modulus_pa > 0.0,
            ),
            (
                "poisson_ratio",
                material.poisson_ratio,
                "a number above -1, at most 0.5",
                material.poisson_ratio > -1.0 && material.poisson_ratio <= 0.5,
            ),
            (
                "density_kg_per_m3",
                material.density_kg_per_m3,
                positive,
                material.density_kg_per_m3 > 0.0,
            ),
            ("friction", surface.friction, positive, surface.friction > 0.0),
            (
                "tangential_stiffness_kg_per_s2",
                surface.tangential_stiffness_kg_per_s2,
                positive,
                surface.tangential_stiffness_kg_per_s2 > 0.0,
            ),
            (
                "damping_time_s",
                surface.damping_time_s,
                "a finite number, 0 or above",
                surface.damping_time_s >= 0.0,
            ),
        ];
        for (name, value, accepted, ok) in quantities {
            if !(ok && value.is_finite()) {
                return Err(InvalidParameter { name, value, accepted });
            }
        }
        let mass = 4.0 / 3.0 * std::f64::consts::PI * radius_m.powi(3) * material.density_kg_per_m3;
        let effective_radius = 0.5 * radius_m;
        let compliance = 3.0 * (1.0 - material.poisson_ratio * material.poisson_ratio);
        Ok(Self {
            effective_mass_kg: 0.5 * mass,
            elastic_constant: 2.0 * material.young_modulus_pa * effective_radius.sqrt()
                / compliance,
            alpha: 2.0 / 7.0,
            surface: *surface,
        })
    }

    /// The impact of this pair with normal velocity `normal_m_per_s` and tangential velocity
    /// `tangential_m_per_s` of the surfaces at the contact.
    ///
    /// # Errors
    /// [`InvalidParameter`] if a velocity is not positive and finite, or the scaled parameters leave the range
    /// of numbers.
    pub fn impact(
        &self,
        normal_m_per_s: f64,
        tangential_m_per_s: f64,
    ) -> Result<Impact, InvalidParameter> {
        let accepted = "a finite number above 0";
        for (name, value) in
            [("normal_m_per_s", normal_m_per_s), ("tangential_m_per_s", tangential_m_per_s)]
        {
            if !(value > 0.0 && value.is_finite()) {
                return Err(InvalidParameter { name, value, accepted });
            }
        }
        let beta = self.elastic_constant / self.effective_mass_kg;
        let time = 1.0 / (beta.powf(0.4) * normal_m_per_s.powf(0.2));
        let Surface { friction, tangential_stiffness_kg_per_s2, damping_time_s } = self.surface;
        let kappa =
            tangential_stiffness_kg_per_s2 * time * time / (self.alpha * self.effective_mass_kg);
        let psi = tangential_m_per_s / normal_m_per_s * self.alpha / friction;
        Ok(Impact {
            contact: Contact::new(kappa, psi, damping_time_s / time)?,
            pair: *self,
            normal_m_per_s,
            time_unit_s: time,
        })
    }
}

/// One impact of a pair: its scaled parameters and the units that lead back to SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// The scaled collision.
    pub contact: Contact,
    /// The bodies.
    pub pair: Pair,
    /// Normal impact velocity g_n in m/s, the unit of velocity.
    pub normal_m_per_s: f64,
    /// β^{−2/5} g_n^{−1/5} in s, the unit of time.
    pub time_unit_s: f64,
}

impl Impact {
    /// Unit of length g_n^{4/5} β^{−2/5} in m.
    #[must_use]
    pub fn length_unit_m(&self) -> f64 {
        self.normal_m_per_s * self.time_unit_s
    }

    /// Unit of force m g_n/time in N.
    #[must_use]
    pub fn force_unit_n(&self) -> f64 {
        self.pair.effective_mass_kg * self.normal_m_per_s / self.time_unit_s
    }

    /// Elongation ζ in m of a spring with reduced elongation y: ζ = (μ/α) y length units.
    #[must_use]
    pub fn spring_m(&self, spring: f64) -> f64 {
        self.pair.surface.friction / self.pair.alpha * spring * self.length_unit_m()
    }

    /// Tangential velocity in m/s for the reduced velocity w: (μ/α) w g_n.
    #[must_use]
    pub fn velocity_m_per_s(&self, velocity: f64) -> f64 {
        self.pair.surface.friction / self.pair.alpha * velocity * self.normal_m_per_s
    }
}
