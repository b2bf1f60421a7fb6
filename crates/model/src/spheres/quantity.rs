//! The quantities that describe bodies and surfaces, with their ranges.

use std::f64::consts::FRAC_PI_2;

use stickslip_contact::InvalidValue;

/// A quantity in SI units: its name, which contains the unit, and its range.
///
/// ```
/// use stickslip_model::spheres::quantity;
///
/// assert_eq!(quantity::RADIUS.check(0.02)?, 0.02);
/// let error = quantity::RADIUS.check(-0.02).unwrap_err().to_string();
/// assert_eq!(error, "radius_m = -0.02 is out of range; expected a finite number above 0, in m");
/// # Ok::<(), stickslip_model::InvalidValue>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct PhysicalQuantity {
    /// The name of the field in structs and files.
    pub name: &'static str,
    /// The range and the unit in words.
    pub expected: &'static str,
    range: Range,
}

/// Radius of a sphere.
pub const RADIUS: PhysicalQuantity = positive("radius_m", "a finite number above 0, in m");
/// Mass of a sphere.
pub const MASS: PhysicalQuantity = positive("mass_kg", "a finite number above 0, in kg");
/// Moment of inertia of a sphere about its centre.
pub const MOMENT_OF_INERTIA: PhysicalQuantity =
    positive("moment_of_inertia_kg_m2", "a finite number above 0, in kg m²");
/// Young's modulus Y.
pub const YOUNG_MODULUS: PhysicalQuantity =
    positive("young_modulus_pa", "a finite number above 0, in Pa");
/// Poisson's ratio ν.
pub const POISSON_RATIO: PhysicalQuantity = PhysicalQuantity {
    name: "poisson_ratio",
    expected: "a number above -1, at most 0.5, without unit",
    range: Range::Poisson,
};
/// Density.
pub const DENSITY: PhysicalQuantity =
    positive("density_kg_per_m3", "a finite number above 0, in kg/m³");
/// Coulomb's coefficient of friction μ.
pub const FRICTION: PhysicalQuantity =
    not_negative("friction", "a finite number, 0 or above, without unit");
/// Dynamic coefficient of friction μ_d, at most the static one.
pub const DYNAMIC_FRICTION: PhysicalQuantity = not_negative(
    "dynamic_friction",
    "a finite number, 0 or above and at most friction, without unit",
);
/// Decay β of friction from μ_s to μ_d, as e^(−β |g|).
pub const FRICTION_DECAY: PhysicalQuantity =
    not_negative("friction_decay_s_per_m", "a finite number, 0 or above, in s/m");
/// Tangential inertia α of two bodies.
pub const INERTIA: PhysicalQuantity = PhysicalQuantity {
    name: "alpha",
    expected: "a number above 0, at most 1",
    range: Range::Share,
};
/// Stiffness k_t of the tangential spring.
pub const TANGENTIAL_STIFFNESS: PhysicalQuantity =
    not_negative("tangential_stiffness_kg_per_s2", "a finite number, 0 or above, in kg/s²");
/// Damping time A of the normal force.
pub const DAMPING_TIME: PhysicalQuantity =
    not_negative("damping_time_s", "a finite number, 0 or above, in s");
/// Stiffness k of a linear normal force.
pub const NORMAL_STIFFNESS: PhysicalQuantity =
    positive("normal_stiffness_kg_per_s2", "a finite number above 0, in kg/s²");
/// Elastic constant ρ of Hertz' force.
pub const HERTZ_STIFFNESS: PhysicalQuantity =
    positive("hertz_stiffness_kg_per_s2_m0_5", "a finite number above 0, in kg/(s² √m)");
/// Constant K of Mindlin's tangential stiffness K √ξ.
pub const MINDLIN_STIFFNESS: PhysicalQuantity =
    not_negative("mindlin_stiffness_kg_per_s2_m0_5", "a finite number, 0 or above, in kg/(s² √m)");
/// Ratio k₂/k₁ of the stiffnesses of a hysteretic normal force.
pub const UNLOADING_RATIO: PhysicalQuantity = PhysicalQuantity {
    name: "unloading_stiffness_ratio",
    expected: "a finite number, 1 or above, without unit",
    range: Range::AtLeastOne,
};
/// Growth of the unloading stiffness with the greatest overlap, k₂/k₁ − 1 over this overlap.
pub const HARDENING: PhysicalQuantity =
    not_negative("hardening_per_m", "a finite number, 0 or above, in 1/m");
/// Least normal velocity v_y at which bodies yield.
pub const YIELD_VELOCITY: PhysicalQuantity =
    positive("yield_velocity_m_per_s", "a finite number above 0, in m/s");
/// Greatest contact pressure p_y up to which bodies are elastic.
pub const YIELD_PRESSURE: PhysicalQuantity =
    positive("yield_pressure_pa", "a finite number above 0, in Pa");
/// Surface energy γ of adhesion.
pub const SURFACE_ENERGY: PhysicalQuantity =
    positive("surface_energy_j_per_m2", "a finite number above 0, in J/m²");
/// Damping γ of the normal force.
pub const DAMPING_COEFFICIENT: PhysicalQuantity =
    not_negative("damping_coefficient", "a finite number, 0 or above, in kg/(s mᵉ)");
/// Damping of the normal force without unit.
pub const DAMPING_RATIO: PhysicalQuantity =
    not_negative("damping_ratio", "a finite number, 0 or above, without unit");
/// Damping ratio ζ of the normal force, as particle codes define it.
pub const CRITICAL_DAMPING_RATIO: PhysicalQuantity =
    not_negative("critical_damping_ratio", "a finite number, 0 or above, without unit");
/// Coefficient of normal restitution.
pub const NORMAL_RESTITUTION: PhysicalQuantity =
    PhysicalQuantity { name: "e_n", expected: "a number above 0, at most 1", range: Range::Share };
/// Normal velocity to which a coefficient of normal restitution belongs.
pub const RESTITUTION_VELOCITY: PhysicalQuantity =
    positive("e_n_at_m_per_s", "a finite number above 0, in m/s");
/// Ratio of tangential and normal damping.
pub const TANGENTIAL_DAMPING_RATIO: PhysicalQuantity =
    not_negative("tangential_damping_ratio", "a finite number, 0 or above, without unit");
/// Normal velocity g_n of the surfaces at the contact.
pub const NORMAL_VELOCITY: PhysicalQuantity =
    positive("normal_m_per_s", "a finite number above 0, in m/s");
/// Tangential velocity g_t of the surfaces at the contact; 0 is a central impact.
pub const TANGENTIAL_VELOCITY: PhysicalQuantity =
    not_negative("tangential_m_per_s", "a finite number, 0 or above, in m/s");
/// Velocity of the surfaces at the contact.
pub const SPEED: PhysicalQuantity = positive("speed_m_per_s", "a finite number above 0, in m/s");
/// Angle between the velocity of the surfaces and the normal.
pub const ANGLE: PhysicalQuantity = PhysicalQuantity {
    name: "angle_rad",
    expected: "a number, 0 or above and below π/2, in rad",
    range: Range::Acute,
};

#[derive(Clone, Copy, Debug)]
enum Range {
    Positive,
    NotNegative,
    AtLeastOne,
    Poisson,
    Share,
    Acute,
}

impl PhysicalQuantity {
    /// `value`, if it is in the range.
    ///
    /// # Errors
    /// [`InvalidValue`] with the quantity's name, the value and the range.
    pub fn check(&self, value: f64) -> Result<f64, InvalidValue> {
        let ok = match self.range {
            Range::Positive => value > 0.0,
            Range::NotNegative => value >= 0.0,
            Range::AtLeastOne => value >= 1.0,
            Range::Poisson => value > -1.0 && value <= 0.5,
            Range::Share => value > 0.0 && value <= 1.0,
            Range::Acute => (0.0..FRAC_PI_2).contains(&value),
        };
        InvalidValue::check(self.name, value, self.expected, ok && value.is_finite())?;
        Ok(value)
    }
}

const fn positive(name: &'static str, expected: &'static str) -> PhysicalQuantity {
    PhysicalQuantity { name, expected, range: Range::Positive }
}

const fn not_negative(name: &'static str, expected: &'static str) -> PhysicalQuantity {
    PhysicalQuantity { name, expected, range: Range::NotNegative }
}
