//! From spheres in SI units to the parameters of a collision, and back.
//!
//! Source: Schwager, Becker and Pöschel, Eur. Phys. J. E 27, 107 (2008), equations (1), (12),
//! (21)–(24).

use stickslip_contact::{Contact, Damping, Friction, InvalidValue, Law, Normal, Tangential};

use super::bodies::{Body, Material, Reduction, Sphere, Surface};
use super::forces::Forces;
use super::quantity;
use super::units::Units;

const POSITIVE: &str = "a finite number above 0";

/// Two colliding bodies, reduced to the numbers on which their contact depends.
///
/// ```
/// use stickslip_model::spheres::{BodyPair, Material, Surface};
///
/// let steel = Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3: 7850.0 };
/// let surface = Surface { friction: 0.4, tangential_stiffness_kg_per_s2: 1e12, damping_time_s: 0.0
/// }; let pair = BodyPair::equal_spheres(0.02, &steel, &surface)?;
/// let impact = pair.impact(20.0, 4.0)?;
/// assert!((impact.largest_normal_force_n() / 146.4e3 - 1.0).abs() < 1e-3);
/// # Ok::<(), stickslip_model::InvalidValue>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BodyPair {
    /// Effective mass m = m_i m_j/(m_i + m_j) in kg.
    pub effective_mass_kg: f64,
    /// Effective radius R = R_i R_j/(R_i + R_j) in m.
    pub effective_radius_m: f64,
    /// Elastic constant ρ = (4/3) E* √R in kg m^{−1/2} s^{−2}; 2Y √R/(3(1 − ν²)) for equal
    /// materials. Where the normal force is linear, its stiffness k in kg/s².
    pub elastic_constant: f64,
    /// Stiffness ratio 4G*/E* of tangential and normal motion without slip, where 1/G* is the sum
    /// of (2 − ν)/G over both bodies; 2(1 − ν)/(2 − ν) for equal materials.
    pub stiffness_ratio: f64,
    /// α = 1/(1 + m R_i²/J_i + m R_j²/J_j); 2/7 for homogeneous spheres.
    pub alpha: f64,
    /// The properties of the surfaces. In other laws than the paper's, the stiffness is the
    /// constant K in kg/(s² √m) where it is Mindlin's, and the damping time is the damping γ over
    /// the elastic constant, in their units. Where the force is hysteretic, the damping time is
    /// k₂/k₁ − 1, or what that is in 1/m of the greatest overlap; see
    /// [`Constants`](super::forces::Constants).
    pub surface: Surface,
    /// The contact law. The decay of its friction is that at a normal velocity of 1 m/s, to which
    /// it is proportional. Its pull-off force is in N.
    #[cfg_attr(feature = "serde", serde(default))]
    pub law: Law,
    /// Ratio of tangential and normal damping; 0 in the paper's law.
    #[cfg_attr(feature = "serde", serde(default))]
    pub tangential_damping_ratio: f64,
}

impl BodyPair {
    /// The pair of a sphere and the body that it hits.
    ///
    /// As in Hertz' contact, 1/E* = (1 − ν_i²)/Y_i + (1 − ν_j²)/Y_j. A wall has infinite radius,
    /// mass and moment of inertia: R and m belong to the sphere, and α = 1/(1 + m R²/J).
    ///
    /// The paper's law has a [`Surface`], other laws have [`Forces`].
    ///
    /// # Errors
    /// [`InvalidValue`] names the first quantity or result that is out of its range.
    pub fn new(
        sphere: &Sphere,
        other: &Body,
        forces: impl Into<Forces>,
    ) -> Result<Self, InvalidValue> {
        let forces = forces.into();
        sphere.validate()?;
        other.validate()?;
        let one = Reciprocals::of_sphere(sphere);
        let two = match other {
            Body::Sphere(other) => Reciprocals::of_sphere(other),
            Body::Wall(wall) => Reciprocals {
                normal_compliance: wall.elasticity.map_or(0.0, |e| e.normal_compliance()),
                tangential_compliance: wall.elasticity.map_or(0.0, |e| e.tangential_compliance()),
                ..Reciprocals::default()
            },
        };
        let effective_mass_kg = 1.0 / (one.mass + two.mass);
        let effective_radius_m = 1.0 / (one.radius + two.radius);
        let modulus = 1.0 / (one.normal_compliance + two.normal_compliance);
        let shear_modulus = 1.0 / (one.tangential_compliance + two.tangential_compliance);
        let hertz = 4.0 / 3.0 * modulus * effective_radius_m.sqrt();
        let stiffness_ratio = 4.0 * shear_modulus / modulus;
        let (elastic_constant, surface) =
            forces.resolved((effective_mass_kg, effective_radius_m), hertz, stiffness_ratio);
        surface.validate()?;
        let alpha = 1.0 / (1.0 + effective_mass_kg * (one.turning + two.turning));
        let pull_off = forces.pull_off_n(effective_radius_m);
        let Friction { dynamic, decay } = forces.law.friction;
        let friction = Friction { dynamic, decay: decay * surface.friction / alpha };
        let pair = Self {
            effective_mass_kg,
            effective_radius_m,
            elastic_constant,
            stiffness_ratio,
            alpha,
            surface,
            law: Law { friction, pull_off, ..forces.law },
            tangential_damping_ratio: forces.tangential_damping_ratio,
        };
        for (name, value) in [
            ("effective_mass_kg", pair.effective_mass_kg),
            ("effective_radius_m", pair.effective_radius_m),
            ("elastic_constant", pair.elastic_constant),
            ("stiffness_ratio", pair.stiffness_ratio),
            ("alpha", pair.alpha),
            // What it is without adhesion is no result.
            ("pull_off_n", if pair.law.normal.is_adhesive() { pull_off } else { 1.0 }),
        ] {
            InvalidValue::check(name, value, POSITIVE, value > 0.0 && value.is_finite())?;
        }
        Ok(pair)
    }

    /// The pair of two equal homogeneous spheres of radius `radius_m`.
    ///
    /// # Errors
    /// [`InvalidValue`] names the first quantity that is out of its range.
    pub fn equal_spheres(
        radius_m: f64,
        material: &Material,
        surface: &Surface,
    ) -> Result<Self, InvalidValue> {
        quantity::DENSITY.check(material.density_kg_per_m3)?;
        let sphere = Sphere::homogeneous(radius_m, material);
        Self::new(&sphere, &Body::Sphere(sphere), surface)
    }

    /// Scaled tangential damping b, the ratio of the dampings over α.
    pub fn tangential_damping(&self) -> f64 {
        self.tangential_damping_ratio / self.alpha
    }

    /// The name and the value of what [`Surface::damping_time_s`] of the pair stands for: a damping
    /// time, or a constant of a hysteretic force.
    ///
    /// [`Surface::damping_time_s`]: super::bodies::Surface::damping_time_s
    pub fn damping_constant(&self) -> (&'static str, f64) {
        let constant = self.surface.damping_time_s;
        match self.law.damping {
            Damping::Hysteretic => (quantity::UNLOADING_RATIO.name, 1.0 + constant),
            Damping::Hardening => (quantity::HARDENING.name, constant),
            Damping::Yielding => (quantity::YIELD_VELOCITY.name, 1.0 / constant),
            _ => (quantity::DAMPING_TIME.name, constant),
        }
    }

    /// The number μ by which tangential velocities are reduced: 1 where there is no friction.
    pub fn friction_unit(&self) -> f64 {
        Reduction { mu: self.surface.friction, alpha: self.alpha }.friction_unit()
    }

    /// Scaled stiffness κ = (3/2)(5/4)^{1/5} (4G*/E*)/α of a spring with Mindlin's tangential
    /// stiffness.
    ///
    /// A contact that does not slip has the stiffness k_t = 8G* √(Rξ). That is 4G*/E* times the
    /// stiffness of the normal motion, dF_n/dξ = 2E* √(Rξ). Both grow with the compression ξ,
    /// but the spring of this model has one stiffness. Here it is k_t at the largest
    /// compression of a contact without damping. Its κ is then the same for every velocity,
    /// size and modulus: 4.52 for equal homogeneous spheres with ν = 0.3.
    ///
    /// Source: R. D. Mindlin, J. Appl. Mech. 16, 259 (1949); K. L. Johnson, Contact Mechanics
    /// (1985), section 7.2.
    pub fn mindlin_kappa(&self) -> f64 {
        1.5 * 1.25_f64.powf(0.2) * self.stiffness_ratio / self.alpha
    }

    /// The impact of this pair. `normal_m_per_s` and `tangential_m_per_s` are the velocities of the
    /// surfaces at the contact.
    ///
    /// # Errors
    /// [`InvalidValue`] if a velocity is not positive and finite, or if the scaled parameters
    /// leave the range of numbers.
    pub fn impact(
        &self,
        normal_m_per_s: f64,
        tangential_m_per_s: f64,
    ) -> Result<Impact, InvalidValue> {
        for (name, value) in
            [("normal_m_per_s", normal_m_per_s), ("tangential_m_per_s", tangential_m_per_s)]
        {
            InvalidValue::check(name, value, POSITIVE, value > 0.0 && value.is_finite())?;
        }
        let Self { mut law, alpha, .. } = *self;
        law.friction.decay *= normal_m_per_s;
        let beta = self.elastic_constant / self.effective_mass_kg;
        let units = Units::new(law, beta, normal_m_per_s);
        let Units { time, length, .. } = units;
        law.pull_off *= time / (self.effective_mass_kg * normal_m_per_s);
        let Surface { friction, tangential_stiffness_kg_per_s2, damping_time_s } = self.surface;
        let stiffness = match law.tangential {
            Tangential::Constant => tangential_stiffness_kg_per_s2,
            Tangential::Mindlin => tangential_stiffness_kg_per_s2 * length.sqrt(),
        };
        let kappa = stiffness * time * time / (alpha * self.effective_mass_kg);
        // A stiffness below the range of numbers is not 0.
        let ok = kappa > 0.0 || stiffness == 0.0;
        InvalidValue::check("kappa", kappa, POSITIVE, ok)?;
        let psi = tangential_m_per_s / normal_m_per_s * alpha / self.friction_unit();
        let damping = units.damping(damping_time_s);
        let contact =
            Contact::new(kappa, psi, damping)?.with_law(law, self.tangential_damping())?;
        Ok(Impact {
            contact: if friction > 0.0 { contact } else { contact.without_friction() },
            pair: *self,
            normal_m_per_s,
            time_unit_s: time,
        })
    }
}

/// One impact of a pair: its scaled parameters and the units that lead back to SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// Parameters of the scaled collision.
    pub contact: Contact,
    /// The two bodies.
    pub pair: BodyPair,
    /// Normal impact velocity g_n in m/s, the unit of velocity.
    pub normal_m_per_s: f64,
    /// β^{−2/5} g_n^{−1/5} in s, the unit of time.
    pub time_unit_s: f64,
}

impl Impact {
    /// Unit of length g_n^{4/5} β^{−2/5} in m.
    pub fn length_unit_m(&self) -> f64 {
        self.normal_m_per_s * self.time_unit_s
    }

    /// Unit of force m g_n/time in N.
    pub fn force_unit_n(&self) -> f64 {
        self.pair.effective_mass_kg * self.normal_m_per_s / self.time_unit_s
    }

    /// Largest compression ξ in m without damping and adhesion: (5/4)^{2/5} length units, and one
    /// where the force is linear. With damping ξ stays below it.
    pub fn largest_compression_m(&self) -> f64 {
        match self.pair.law.normal {
            Normal::Linear => self.length_unit_m(),
            _ => 1.25_f64.powf(0.4) * self.length_unit_m(),
        }
    }

    /// Largest normal force F_n in N without damping and adhesion: (5/4)^{3/5} force units, and one
    /// where it is linear.
    pub fn largest_normal_force_n(&self) -> f64 {
        match self.pair.law.normal {
            Normal::Linear => self.force_unit_n(),
            _ => 1.25_f64.powf(0.6) * self.force_unit_n(),
        }
    }

    /// Mindlin's tangential stiffness k_t = 8G* √(Rξ) in kg/s² of a contact that does not slip, at
    /// [`Self::largest_compression_m`], where it is largest. Its κ is [`BodyPair::mindlin_kappa`].
    /// Both belong to Hertz' normal force.
    pub fn mindlin_stiffness_kg_per_s2(&self) -> f64 {
        let BodyPair { elastic_constant, stiffness_ratio, .. } = self.pair;
        stiffness_ratio * 1.5 * elastic_constant * self.largest_compression_m().sqrt()
    }

    /// Elongation ζ in m of a spring with the reduced elongation y: ζ = (μ/α) y length units.
    pub fn spring_m(&self, spring: f64) -> f64 {
        self.pair.friction_unit() / self.pair.alpha * spring * self.length_unit_m()
    }

    /// Tangential velocity in m/s for the reduced velocity w: (μ/α) w g_n.
    pub fn velocity_m_per_s(&self, velocity: f64) -> f64 {
        self.pair.friction_unit() / self.pair.alpha * velocity * self.normal_m_per_s
    }
}

/// The quantities that are added up over the two bodies; all are 0 for a rigid wall.
#[derive(Clone, Copy, Default)]
struct Reciprocals {
    /// 1/mass in 1/kg.
    mass: f64,
    /// 1/R in 1/m.
    radius: f64,
    /// R²/J in 1/kg.
    turning: f64,
    normal_compliance: f64,
    tangential_compliance: f64,
}

impl Reciprocals {
    fn of_sphere(sphere: &Sphere) -> Self {
        Self {
            mass: 1.0 / sphere.mass_kg,
            radius: 1.0 / sphere.radius_m,
            turning: sphere.radius_m * sphere.radius_m / sphere.moment_of_inertia_kg_m2,
            normal_compliance: sphere.elasticity.normal_compliance(),
            tangential_compliance: sphere.elasticity.tangential_compliance(),
        }
    }
}
