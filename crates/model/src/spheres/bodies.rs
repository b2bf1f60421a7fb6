//! Spheres, walls and their materials.

use stickslip_contact::InvalidValue;

use super::quantity;

/// A homogeneous elastic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Young's modulus Y in Pa.
    pub young_modulus_pa: f64,
    /// Poisson's ratio ν.
    pub poisson_ratio: f64,
    /// Density in kg/m³.
    pub density_kg_per_m3: f64,
}

impl Material {
    /// The elastic constants, on which a contact depends.
    pub fn elasticity(&self) -> Elasticity {
        Elasticity { young_modulus_pa: self.young_modulus_pa, poisson_ratio: self.poisson_ratio }
    }
}

/// The elastic constants of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elasticity {
    /// Young's modulus Y in Pa.
    pub young_modulus_pa: f64,
    /// Poisson's ratio ν.
    pub poisson_ratio: f64,
}

impl Elasticity {
    /// Checks both constants.
    ///
    /// # Errors
    /// [`InvalidValue`] names the first that is out of its range.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        quantity::YOUNG_MODULUS.check(self.young_modulus_pa)?;
        quantity::POISSON_RATIO.check(self.poisson_ratio)?;
        Ok(())
    }

    /// (1 − ν²)/Y in 1/Pa, the part of the body in 1/E*.
    pub(crate) fn normal_compliance(&self) -> f64 {
        (1.0 - self.poisson_ratio * self.poisson_ratio) / self.young_modulus_pa
    }

    /// (2 − ν)/G in 1/Pa with G = Y/(2(1 + ν)), the part of the body in 1/G*.
    pub(crate) fn tangential_compliance(&self) -> f64 {
        (2.0 - self.poisson_ratio) * 2.0 * (1.0 + self.poisson_ratio) / self.young_modulus_pa
    }
}

/// A sphere whose mass is distributed around its centre equally in all directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Radius R in m.
    pub radius_m: f64,
    /// Mass in kg.
    pub mass_kg: f64,
    /// Moment of inertia J about any axis through the centre, in kg m².
    pub moment_of_inertia_kg_m2: f64,
    /// Elastic constants.
    pub elasticity: Elasticity,
}

impl Sphere {
    /// A homogeneous sphere.
    pub fn homogeneous(radius_m: f64, material: &Material) -> Self {
        let mass_kg = Self::homogeneous_mass(radius_m, material.density_kg_per_m3);
        Self {
            radius_m,
            mass_kg,
            moment_of_inertia_kg_m2: Self::homogeneous_moment(radius_m, mass_kg),
            elasticity: material.elasticity(),
        }
    }

    /// Mass (4/3)πR³ density in kg of a homogeneous sphere.
    pub fn homogeneous_mass(radius_m: f64, density_kg_per_m3: f64) -> f64 {
        4.0 / 3.0 * std::f64::consts::PI * radius_m.powi(3) * density_kg_per_m3
    }

    /// Moment of inertia (2/5) m R² in kg m² of a homogeneous sphere.
    pub fn homogeneous_moment(radius_m: f64, mass_kg: f64) -> f64 {
        0.4 * mass_kg * radius_m * radius_m
    }

    /// Checks all quantities.
    ///
    /// # Errors
    /// [`InvalidValue`] names the first that is out of its range.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        quantity::RADIUS.check(self.radius_m)?;
        quantity::MASS.check(self.mass_kg)?;
        quantity::MOMENT_OF_INERTIA.check(self.moment_of_inertia_kg_m2)?;
        self.elasticity.validate()
    }
}

/// A plane wall: a sphere in the limit of infinite radius, mass and moment of inertia.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    /// Elastic constants; `None` is a rigid wall.
    pub elasticity: Option<Elasticity>,
}

/// The body that a sphere hits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Body {
    /// Another sphere.
    Sphere(Sphere),
    /// A wall.
    Wall(Wall),
}

impl Body {
    /// Checks all quantities.
    ///
    /// # Errors
    /// [`InvalidValue`] names the first that is out of its range.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        match self {
            Self::Sphere(sphere) => sphere.validate(),
            Self::Wall(Wall { elasticity }) => elasticity.map_or(Ok(()), |e| e.validate()),
        }
    }
}

/// The properties of the two surfaces together.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Surface {
    /// Coulomb's coefficient of friction μ; without friction, 0, ε_t is 1.
    pub friction: f64,
    /// Stiffness k_t of the tangential spring in kg/s².
    pub tangential_stiffness_kg_per_s2: f64,
    /// Damping time A in s in F_n = ρ(ξ^{3/2} + A √ξ ξ̇). The dissipative constant of Brilliantov
    /// and Pöschel, which has (3/2) before it in the force, is 2/3 of this A, and not its name.
    pub damping_time_s: f64,
}

impl Surface {
    /// Checks all quantities.
    ///
    /// # Errors
    /// [`InvalidValue`] names the first that is out of its range.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        quantity::FRICTION.check(self.friction)?;
        quantity::TANGENTIAL_STIFFNESS.check(self.tangential_stiffness_kg_per_s2)?;
        quantity::DAMPING_TIME.check(self.damping_time_s)?;
        Ok(())
    }
}

/// The numbers μ and α that reduce the impact ratio: ψ = (g_t/g_n)·α/μ, equation (23) of Schwager,
/// Becker and Pöschel (2008).
///
/// ```
/// use stickslip_model::Reduction;
///
/// // Homogeneous spheres with μ = 0.4: from g_t/g_n = 2μ/α on, where ψ = 2, there is sliding only.
/// let reduction = Reduction::default();
/// assert!((reduction.ratio(2.0) - 2.8).abs() < 1e-15);
/// assert!((reduction.psi(2.8) - 2.0).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Reduction {
    /// Coulomb's coefficient of friction μ.
    pub mu: f64,
    /// Tangential inertia α: 2/7 for homogeneous spheres, at most 1.
    pub alpha: f64,
}

impl Reduction {
    /// μ = 0.4 and α = 2/7, homogeneous spheres: the values of all figures of the paper.
    pub const HOMOGENEOUS: Self = Self { mu: 0.4, alpha: 2.0 / 7.0 };

    /// ψ at the impact ratio g_t/g_n. Without friction, where ψ has no meaning, (g_t/g_n) α: what
    /// its place in a contact [without friction](stickslip_contact::Contact::without_friction) has.
    pub fn psi(&self, ratio: f64) -> f64 {
        ratio * self.alpha / self.friction_unit()
    }

    /// The impact ratio g_t/g_n at ψ.
    pub fn ratio(&self, psi: f64) -> f64 {
        psi * self.friction_unit() / self.alpha
    }

    /// μ, or 1 without friction.
    pub fn friction_unit(&self) -> f64 {
        if self.mu > 0.0 { self.mu } else { 1.0 }
    }
}

impl Default for Reduction {
    /// [`Self::HOMOGENEOUS`].
    fn default() -> Self {
        Self::HOMOGENEOUS
    }
}
