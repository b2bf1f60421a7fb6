//! Contact laws in SI units: the constants that belong to a law, and what they mean.

use stickslip_contact::{Damping, Friction, InvalidValue, Law, Normal, Tangential};

use super::bodies::Surface;
use super::quantity::{self, PhysicalQuantity};
use super::units::Units;
use crate::engines::error::CollisionError;
use crate::restitution;

/// The constants of a contact law in SI units. Which of them a law has is said at each.
///
/// With the overlap ξ, its rate ξ̇, the tangential velocity g and the elongation ζ of the spring:
///
/// ```text
/// F_n = k ξ + γ ξ^e ξ̇          (linear)    with e = 0, ½, ¼ where the damping is linear,
/// F_n = ρ ξ^{3/2} + γ ξ^e ξ̇    (hertz)     viscoelastic or tsuji
/// F_t = k_t ζ + r γ ξ^e g      (constant), |F_t| ≤ μ |F_n|
/// F_t = K √ξ ζ + r γ ξ^e g     (mindlin)
/// F_t = r γ ξ^e g              (without history)
/// F_n = k ξ, k₂ (ξ − ξ₀)       (hysteretic) while ξ grows and falls; F_t = k_t ζ
/// F_n = ρ ξ^{3/2}, its tangent from ξ_y on, ρ √r (ξ − ξ₀)^{3/2}   (yielding)
/// F_n = ρ ξ^{3/2} − 4πγ_s R    (dmt)       and |F_t| ≤ μ (ρ ξ^{3/2} + 4πγ_s R)
/// μ = μ_d + (μ_s − μ_d) e^(−β |g|)   where friction decays
/// ```
///
/// In JKR (`jkr`) the square of the contact radius over R takes the place of ξ everywhere but in
/// the elastic force, as [`Normal::Jkr`] has it; F_po is 3πγ_s R.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Constants {
    /// Coulomb's coefficient of friction μ; where it decays with the velocity, μ_s.
    pub friction: f64,
    /// The coefficient μ_d to which friction decays; see [`Friction`].
    pub dynamic_friction: Option<f64>,
    /// The decay β in s/m, which goes with [`dynamic_friction`](Self::dynamic_friction).
    pub friction_decay_s_per_m: Option<f64>,
    /// Stiffness k of a linear normal force in kg/s².
    pub normal_stiffness_kg_per_s2: Option<f64>,
    /// Elastic constant ρ of Hertz' force in kg/(s² √m); `None` takes the constant of the
    /// materials.
    pub hertz_stiffness_kg_per_s2_m0_5: Option<f64>,
    /// Constant tangential stiffness k_t in kg/s².
    pub tangential_stiffness_kg_per_s2: Option<f64>,
    /// Constant K of Mindlin's tangential stiffness K √ξ, in kg/(s² √m); `None` takes 8 G* √R of
    /// the materials.
    pub mindlin_stiffness_kg_per_s2_m0_5: Option<f64>,
    /// Damping γ of the normal force in kg/(s mᵉ).
    pub damping_coefficient: Option<f64>,
    /// Damping time A in s, γ = A ρ or A k: instead of γ where the damping is viscoelastic and the
    /// force Hertz', or both are linear.
    pub damping_time_s: Option<f64>,
    /// Damping c without unit, γ = c √(m ρ) or c √(m k) with the effective mass m: instead of γ
    /// where the damping is Tsuji's and the force Hertz', or both are linear. It is the scaled
    /// damping a, **not** what particle codes call the damping ratio, which is
    /// [`critical_damping_ratio`](Self::critical_damping_ratio).
    pub damping_ratio: Option<f64>,
    /// Damping ratio ζ, the damping over the critical one: c/2 where force and damping are linear,
    /// c/√5 where they are Hertz' and Tsuji's. With a contact that lasts until ξ = 0,
    /// ζ = −ln ε_n/√(π² + ln² ε_n).
    pub critical_damping_ratio: Option<f64>,
    /// Ratio k₂/k₁ of the stiffnesses of a hysteretic normal force, while ξ falls and grows.
    pub unloading_stiffness_ratio: Option<f64>,
    /// What k₂/k₁ − 1 is in 1/m of the greatest overlap, where the damping is `hardening`. Luding's
    /// law has (k₂ᵐᵃˣ/k₁ − 1)/ξ*, and Walton's and Braun's k₂ = k₁ + S F has S.
    pub hardening_per_m: Option<f64>,
    /// Least normal velocity v_y at which the bodies yield, ½ m v_y² = (2/5) ρ ξ_y^{5/2}, where the
    /// damping is `yielding`.
    pub yield_velocity_m_per_s: Option<f64>,
    /// Instead of that, the greatest contact pressure p_y up to which they are elastic:
    /// ξ_y = R (π p_y/2E*)², with E* = 3ρ/(4√R). It is about 1.6 times the yield stress of the
    /// softer body.
    pub yield_pressure_pa: Option<f64>,
    /// Surface energy γ_s of adhesion in J/m²: half the work of adhesion, and what LAMMPS takes as
    /// the fourth number of `dmt` and `jkr`.
    pub surface_energy_j_per_m2: Option<f64>,
    /// Coefficient of normal restitution ε_n, from which γ or k₂/k₁ follows by
    /// [`restitution::damping`].
    pub e_n: Option<f64>,
    /// Normal velocity in m/s at which ε_n is [`e_n`](Self::e_n), in laws where ε_n
    /// [depends on it](crate::restitution::depends_on_velocity).
    pub e_n_at_m_per_s: Option<f64>,
    /// The ratio r of tangential and normal damping, without unit; without it 0.
    pub tangential_damping_ratio: Option<f64>,
}

/// Constants that fit a law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forces {
    pub(super) law: Law,
    friction: f64,
    elastic: Option<f64>,
    tangential: Option<f64>,
    dashpot: Dashpot,
    pub(super) tangential_damping_ratio: f64,
    surface_energy: Option<f64>,
}

/// The damping γ of the normal force.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Dashpot {
    Coefficient(f64),
    /// γ over the elastic constant.
    Time(f64),
    /// γ over √(effective mass · elastic constant).
    Ratio(f64),
    /// The scaled damping a at a normal velocity in m/s.
    Scaled(f64, f64),
    /// What [`Units::damping`] takes of a hysteretic force.
    Hysteretic(f64),
    /// The greatest pressure without yield, in Pa.
    Pressure(f64),
}

impl Forces {
    /// The law `law` with `constants`.
    ///
    /// ```
    /// use stickslip_model::presets;
    /// use stickslip_model::spheres::{Body, BodyPair, Constants, Elasticity, Forces, Sphere};
    ///
    /// let law = presets::find("gran/hooke/history").ok_or("no such law")?.law;
    /// let constants = Constants {
    ///     friction: 0.5,
    ///     normal_stiffness_kg_per_s2: Some(1e5),
    ///     tangential_stiffness_kg_per_s2: Some(1e5 * 2.0 / 7.0),
    ///     damping_ratio: Some(0.2),
    ///     ..Constants::default()
    /// };
    /// let elasticity = Elasticity { young_modulus_pa: 1e7, poisson_ratio: 0.3 };
    /// let (radius_m, mass_kg) = (1e-3, 1e-5);
    /// let moment_of_inertia_kg_m2 = Sphere::homogeneous_moment(radius_m, mass_kg);
    /// let sphere = Sphere { radius_m, mass_kg, moment_of_inertia_kg_m2, elasticity };
    /// let forces = Forces::new(law, &constants)?;
    /// let impact = BodyPair::new(&sphere, &Body::Sphere(sphere), forces)?.impact(0.1, 0.2)?;
    /// // κ = k_t/(α k), whatever the size and the velocity.
    /// assert!((impact.contact.kappa() - 1.0).abs() < 1e-14);
    /// assert_eq!(impact.contact.damping(), 0.2);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`CollisionError::Parameter`] names the first constant that is missing, out of its range or
    /// without meaning in the law.
    pub fn new(law: Law, constants: &Constants) -> Result<Self, CollisionError> {
        let c = constants;
        let friction = quantity::FRICTION.check(c.friction)?;
        let law = Law { friction: decaying(law, c)?, ..law };
        let elastic = match law.normal {
            Normal::Linear => {
                unused(&quantity::HERTZ_STIFFNESS, c.hertz_stiffness_kg_per_s2_m0_5)?;
                Some(required(&quantity::NORMAL_STIFFNESS, c.normal_stiffness_kg_per_s2)?)
            }
            Normal::Hertz | Normal::Dmt | Normal::Jkr => {
                unused(&quantity::NORMAL_STIFFNESS, c.normal_stiffness_kg_per_s2)?;
                checked(&quantity::HERTZ_STIFFNESS, c.hertz_stiffness_kg_per_s2_m0_5)?
            }
        };
        let tangential = match law.tangential {
            _ if !law.remembers() => {
                unused(&quantity::MINDLIN_STIFFNESS, c.mindlin_stiffness_kg_per_s2_m0_5)?;
                unused(&quantity::TANGENTIAL_STIFFNESS, c.tangential_stiffness_kg_per_s2)?;
                None
            }
            Tangential::Constant => {
                unused(&quantity::MINDLIN_STIFFNESS, c.mindlin_stiffness_kg_per_s2_m0_5)?;
                Some(required(&quantity::TANGENTIAL_STIFFNESS, c.tangential_stiffness_kg_per_s2)?)
            }
            Tangential::Mindlin => {
                unused(&quantity::TANGENTIAL_STIFFNESS, c.tangential_stiffness_kg_per_s2)?;
                checked(&quantity::MINDLIN_STIFFNESS, c.mindlin_stiffness_kg_per_s2_m0_5)?
            }
        };
        let ratio = checked(&quantity::TANGENTIAL_DAMPING_RATIO, c.tangential_damping_ratio)?;
        let tangential_damping_ratio = ratio.unwrap_or(0.0);
        let surface_energy = adhesion(law, c)?;
        let dashpot = Dashpot::new(law, c)?;
        Ok(Self {
            law,
            friction,
            elastic,
            tangential,
            dashpot,
            tangential_damping_ratio,
            surface_energy,
        })
    }

    /// The force in N that separates two bodies with an effective radius; 0 without adhesion.
    pub(super) fn pull_off_n(&self, effective_radius_m: f64) -> f64 {
        let factor = if self.law.normal == Normal::Dmt { 4.0 } else { 3.0 };
        let energy = self.surface_energy.unwrap_or(0.0);
        factor * std::f64::consts::PI * energy * effective_radius_m
    }

    /// Elastic constant, and the surface with the constants of stiffness and damping, for an
    /// effective mass and radius and materials with the elastic constant `hertz` and this ratio
    /// 4G*/E* of stiffnesses.
    pub(super) fn resolved(
        &self,
        (mass_kg, radius_m): (f64, f64),
        hertz: f64,
        stiffness_ratio: f64,
    ) -> (f64, Surface) {
        let mindlin = 1.5 * stiffness_ratio * hertz;
        let elastic = self.elastic.unwrap_or(hertz);
        let damping_time_s = match self.dashpot {
            Dashpot::Coefficient(gamma) => gamma / elastic,
            Dashpot::Time(time) | Dashpot::Hysteretic(time) => time,
            Dashpot::Ratio(ratio) => ratio * (mass_kg / elastic).sqrt(),
            Dashpot::Pressure(pressure) => {
                // The radius of contact over that of the bodies.
                let modulus = 0.75 * elastic / radius_m.sqrt();
                let share = 0.5 * std::f64::consts::PI * pressure / modulus;
                let overlap = radius_m * share * share;
                1.0 / (0.8 * elastic / mass_kg * overlap * overlap * overlap.sqrt()).sqrt()
            }
            Dashpot::Scaled(damping, normal_m_per_s) => {
                let units = Units::new(self.law, elastic / mass_kg, normal_m_per_s);
                damping / units.damping(1.0)
            }
        };
        // Without a spring any stiffness will do.
        let usual = if self.law.remembers() { mindlin } else { elastic };
        let tangential_stiffness_kg_per_s2 = self.tangential.unwrap_or(usual);
        let friction = self.friction;
        (elastic, Surface { friction, tangential_stiffness_kg_per_s2, damping_time_s })
    }
}

/// The paper's law, with the elastic constant of the materials. [`BodyPair::new`] checks it.
///
/// [`BodyPair::new`]: super::scaling::BodyPair::new
impl From<&Surface> for Forces {
    fn from(surface: &Surface) -> Self {
        Self {
            law: Law::PAPER,
            friction: surface.friction,
            elastic: None,
            tangential: Some(surface.tangential_stiffness_kg_per_s2),
            dashpot: Dashpot::Time(surface.damping_time_s),
            tangential_damping_ratio: 0.0,
            surface_energy: None,
        }
    }
}

impl Dashpot {
    fn new(law: Law, constants: &Constants) -> Result<Self, CollisionError> {
        let c = constants;
        let critical = restitution::critical_damping(law);
        let has_time = matches!(
            (law.normal, law.damping),
            (Normal::Linear, Damping::Linear)
                | (Normal::Hertz | Normal::Dmt | Normal::Jkr, Damping::Viscoelastic)
        );
        let [has_ratio, damped] = [critical.is_some(), law.damping != Damping::None];
        let viscous = law.damping.is_viscous();
        let yields = law.damping == Damping::Yielding;
        // What may be given, and whether the law has it.
        let all = [
            (&quantity::DAMPING_COEFFICIENT, c.damping_coefficient, viscous),
            (&quantity::DAMPING_TIME, c.damping_time_s, has_time),
            (&quantity::DAMPING_RATIO, c.damping_ratio, has_ratio),
            (&quantity::CRITICAL_DAMPING_RATIO, c.critical_damping_ratio, has_ratio),
            (
                &quantity::UNLOADING_RATIO,
                c.unloading_stiffness_ratio,
                law.damping == Damping::Hysteretic,
            ),
            (&quantity::HARDENING, c.hardening_per_m, law.damping == Damping::Hardening),
            (&quantity::YIELD_VELOCITY, c.yield_velocity_m_per_s, yields),
            (&quantity::YIELD_PRESSURE, c.yield_pressure_pa, yields),
            (&quantity::NORMAL_RESTITUTION, c.e_n, damped),
        ];
        let mut given: Option<(&PhysicalQuantity, f64)> = None;
        for (quantity, value, has) in all {
            let Some(value) = value else { continue };
            let of_one = [quantity::NORMAL_RESTITUTION.name, quantity::UNLOADING_RATIO.name];
            let none = if of_one.contains(&quantity.name) { 1.0 } else { 0.0 };
            if !has && (damped || value != none) {
                unused(quantity, Some(value))?;
            }
            let value = quantity.check(value)?;
            if let (Some((first, _)), true) = (given, damped) {
                let phrase = format!("and {} are both given", quantity.name);
                let expected = "one constant of damping";
                return Err(InvalidValue::phrase(first.name, phrase, expected).into());
            }
            given = Some((quantity, value));
        }
        if c.e_n.is_some() {
            law.require_no_adhesion("the damping of an e_n is")?;
        }
        let velocity = (&quantity::RESTITUTION_VELOCITY, c.e_n_at_m_per_s);
        if c.e_n.is_none() || !restitution::depends_on_velocity(law) {
            unused(velocity.0, velocity.1)?;
        }
        let Some((quantity, value)) = given.filter(|_| damped) else {
            return if damped {
                Err(without_damping(law, has_time, has_ratio).into())
            } else {
                Ok(Self::Coefficient(0.0))
            };
        };
        Ok(match quantity.name {
            name if name == quantity::DAMPING_COEFFICIENT.name => Self::Coefficient(value),
            name if name == quantity::DAMPING_TIME.name => Self::Time(value),
            name if name == quantity::DAMPING_RATIO.name => Self::Ratio(value),
            name if name == quantity::CRITICAL_DAMPING_RATIO.name => {
                Self::Ratio(value * critical.unwrap_or(f64::NAN))
            }
            name if name == quantity::UNLOADING_RATIO.name => Self::Hysteretic(value - 1.0),
            name if name == quantity::HARDENING.name => Self::Hysteretic(value),
            name if name == quantity::YIELD_VELOCITY.name => Self::Hysteretic(1.0 / value),
            name if name == quantity::YIELD_PRESSURE.name => Self::Pressure(value),
            name if yields && value == 1.0 => {
                let expected = "below 1 where bodies yield: without, take Hertz' law";
                return Err(InvalidValue::new(name, value, expected).into());
            }
            _ if law.damping == Damping::Hysteretic => {
                Self::Hysteretic(restitution::damping(law, value)?)
            }
            _ if has_ratio => Self::Ratio(restitution::damping(law, value)?),
            _ => {
                let at = required(velocity.0, velocity.1)?;
                Self::Scaled(restitution::damping(law, value)?, at)
            }
        })
    }
}

/// A damped law without damping.
fn without_damping(law: Law, has_time: bool, has_ratio: bool) -> InvalidValue {
    match law.damping {
        Damping::Hysteretic => return missing(quantity::UNLOADING_RATIO.name, "it or e_n"),
        Damping::Hardening => return missing(quantity::HARDENING.name, "it or e_n"),
        Damping::Yielding => {
            return missing(quantity::YIELD_VELOCITY.name, "it, yield_pressure_pa or e_n");
        }
        _ => {}
    }
    let expected = match (has_time, has_ratio) {
        (true, true) => "it, damping_time_s, damping_ratio, critical_damping_ratio or e_n",
        (true, false) => "it, damping_time_s or e_n",
        (false, true) => "it, damping_ratio, critical_damping_ratio or e_n",
        (false, false) => "it or e_n",
    };
    missing(quantity::DAMPING_COEFFICIENT.name, expected)
}

/// The friction of the constants, with the decay β in s/m.
fn decaying(law: Law, constants: &Constants) -> Result<Friction, InvalidValue> {
    let (rest, decay) = (&quantity::DYNAMIC_FRICTION, &quantity::FRICTION_DECAY);
    if law.friction != Friction::COULOMB {
        let phrase = "has a friction of scaled numbers";
        let expected = format!("{} and {} of the bodies instead", rest.name, decay.name);
        return Err(InvalidValue::phrase("the law", phrase, expected));
    }
    let dynamic = match (constants.dynamic_friction, constants.friction_decay_s_per_m) {
        (None, None) => return Ok(Friction::COULOMB),
        (None, Some(_)) => return Err(missing(rest.name, decay.name)),
        (Some(_), None) => return Err(missing(decay.name, rest.name)),
        (Some(dynamic), Some(_)) => rest.check(dynamic)?,
    };
    let decay = required(decay, constants.friction_decay_s_per_m)?;
    let ok = dynamic <= constants.friction;
    InvalidValue::check(rest.name, dynamic, rest.expected, ok)?;
    // Without friction nothing decays.
    let dynamic = if constants.friction > 0.0 { dynamic / constants.friction } else { 1.0 };
    Ok(Friction { dynamic, decay })
}

/// The surface energy, which belongs to a law with adhesion.
fn adhesion(law: Law, constants: &Constants) -> Result<Option<f64>, InvalidValue> {
    let (quantity, value) = (&quantity::SURFACE_ENERGY, constants.surface_energy_j_per_m2);
    if law.pull_off != 0.0 {
        let expected = format!("{} of the bodies instead", quantity.name);
        return Err(InvalidValue::phrase("the law", "has a pull-off of scaled numbers", expected));
    }
    if law.normal.is_adhesive() {
        return required(quantity, value).map(Some);
    }
    unused(quantity, value)?;
    Ok(None)
}

fn missing(name: &'static str, expected: &str) -> InvalidValue {
    InvalidValue::phrase(name, "is missing", format!("in this law: {expected}"))
}

fn checked(quantity: &PhysicalQuantity, value: Option<f64>) -> Result<Option<f64>, InvalidValue> {
    value.map(|value| quantity.check(value)).transpose()
}

fn required(quantity: &PhysicalQuantity, value: Option<f64>) -> Result<f64, InvalidValue> {
    let PhysicalQuantity { name, expected, .. } = *quantity;
    checked(quantity, value)?.ok_or_else(|| missing(name, expected))
}

/// Refuses a constant that the law does not have.
fn unused(quantity: &PhysicalQuantity, value: Option<f64>) -> Result<(), InvalidValue> {
    match value {
        Some(value) => {
            let phrase = format!("= {value} has no meaning in this law");
            Err(InvalidValue::phrase(quantity.name, phrase, "without it"))
        }
        None => Ok(()),
    }
}
