//! The layout of the file: its fields, and what they mean.

mod numbers;

use serde::Deserialize;
use serde_json::Value;
use stickslip_model::Law;
use stickslip_model::spheres::quantity;
use stickslip_model::spheres::quantity::PhysicalQuantity;
use stickslip_model::spheres::{
    Constants, Elasticity, Forces, Motion, Sphere, Surface, Wall, WallMotion,
};

use super::field::{Object, number, required, vector};
use crate::input::json;
pub use numbers::Slot;

/// What a file describes. Motions that are not in the file are `None`.
pub struct Bodies {
    /// The first sphere.
    pub sphere: (Sphere, Option<Motion>),
    /// The second body.
    pub other: Other,
    /// The forces between them.
    pub forces: Forces,
}

/// The body that the first sphere hits.
pub enum Other {
    /// Another sphere.
    Sphere(Sphere, Option<Motion>),
    /// A wall.
    Wall(Wall, Option<WallMotion>),
}

impl Bodies {
    /// Whether the motion of a body is not in the file.
    pub fn lacks_motion(&self) -> bool {
        let other = match self.other {
            Other::Sphere(_, motion) => motion.is_none(),
            Other::Wall(_, motion) => motion.is_none(),
        };
        self.sphere.1.is_none() || other
    }
}

/// The file as it is written. A field that is missing is `None`.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct File {
    #[serde(rename = "$schema")]
    _schema: Option<String>,
    #[serde(rename = "comment")]
    _comment: Option<String>,
    spheres: Option<Vec<Object<SphereFields>>>,
    wall: Option<Object<WallFields>>,
    surface: Option<Object<SurfaceFields>>,
}

#[derive(Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SphereFields {
    #[serde(rename = "comment")]
    _comment: Option<String>,
    radius_m: Option<Value>,
    mass_kg: Option<Value>,
    moment_of_inertia_kg_m2: Option<Value>,
    material: Option<Object<MaterialFields>>,
    motion: Option<Object<MotionFields>>,
}

#[derive(Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WallFields {
    #[serde(rename = "comment")]
    _comment: Option<String>,
    rigid: Option<bool>,
    material: Option<Object<MaterialFields>>,
    motion: Option<Object<WallMotionFields>>,
}

#[derive(Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaterialFields {
    #[serde(rename = "comment")]
    _comment: Option<String>,
    young_modulus_pa: Option<Value>,
    poisson_ratio: Option<Value>,
    density_kg_per_m3: Option<Value>,
}

#[derive(Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MotionFields {
    #[serde(rename = "comment")]
    _comment: Option<String>,
    position_m: Option<Value>,
    velocity_m_per_s: Option<Value>,
    spin_rad_per_s: Option<Value>,
}

#[derive(Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WallMotionFields {
    #[serde(rename = "comment")]
    _comment: Option<String>,
    point_m: Option<Value>,
    normal: Option<Value>,
    velocity_m_per_s: Option<Value>,
}

#[derive(Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SurfaceFields {
    #[serde(rename = "comment")]
    _comment: Option<String>,
    friction: Option<Value>,
    dynamic_friction: Option<Value>,
    friction_decay_s_per_m: Option<Value>,
    normal_stiffness_kg_per_s2: Option<Value>,
    hertz_stiffness_kg_per_s2_m0_5: Option<Value>,
    tangential_stiffness_kg_per_s2: Option<Value>,
    mindlin_stiffness_kg_per_s2_m0_5: Option<Value>,
    damping_coefficient: Option<Value>,
    damping_time_s: Option<Value>,
    damping_ratio: Option<Value>,
    critical_damping_ratio: Option<Value>,
    unloading_stiffness_ratio: Option<Value>,
    hardening_per_m: Option<Value>,
    yield_velocity_m_per_s: Option<Value>,
    yield_pressure_pa: Option<Value>,
    surface_energy_j_per_m2: Option<Value>,
    e_n: Option<Value>,
    e_n_at_m_per_s: Option<Value>,
    tangential_damping_ratio: Option<Value>,
}

/// The places of the spheres; a third one is refused.
const SPHERES: [&str; 2] = ["spheres[0]", "spheres[1]"];

const POSITION: &str = "in m";
const VELOCITY: (&str, &str) = ("velocity_m_per_s", "in m/s");

impl File {
    /// The file that `text` is.
    ///
    /// # Errors
    /// What is wrong with its layout, and where.
    pub fn parse(text: &[u8]) -> Result<Self, String> {
        json::parse(text).map(|Object(file)| file)
    }

    /// The bodies that the file describes, under a contact law.
    ///
    /// # Errors
    /// What is wrong, where, and what is expected.
    pub fn resolve(&self, law: Law) -> Result<Bodies, String> {
        let mut spheres = Vec::new();
        for (index, Object(sphere)) in self.spheres.iter().flatten().enumerate() {
            spheres.push(sphere.resolve(SPHERES.get(index).unwrap_or(&"spheres[…]"))?);
        }
        let wall = self.wall.as_ref().map(|Object(wall)| wall.resolve()).transpose()?;
        let (sphere, other) = match (&spheres[..], wall) {
            (&[first, (sphere, motion)], None) => (first, Other::Sphere(sphere, motion)),
            (&[first], Some((wall, motion))) => (first, Other::Wall(wall, motion)),
            _ => return Err(self.not_two()),
        };
        let Object(surface) = required("surface", self.surface.as_ref())?;
        Ok(Bodies { sphere, other, forces: surface.resolve(law)? })
    }
}

impl File {
    /// The number of spheres.
    pub fn spheres(&self) -> usize {
        self.spheres.iter().flatten().count()
    }

    /// Refuses other numbers of spheres and walls than two bodies.
    ///
    /// # Errors
    /// What there is, and what is expected.
    pub fn require_two(&self) -> Result<(), String> {
        let two = self.spheres() + usize::from(self.wall.is_some()) == 2 && self.spheres() > 0;
        if two { Ok(()) } else { Err(self.not_two()) }
    }

    fn not_two(&self) -> String {
        format!(
            "spheres has {} entries, and there is {} wall; expected two spheres, or one sphere and a \
             wall",
            self.spheres(),
            if self.wall.is_some() { "a" } else { "no" }
        )
    }
}

impl SphereFields {
    fn resolve(&self, place: &str) -> Result<(Sphere, Option<Motion>), String> {
        let radius_m = number(place, &quantity::RADIUS, self.radius_m.as_ref())?;
        let material_place = format!("{place}.material");
        let Object(material) = required(&material_place, self.material.as_ref())?;
        let elasticity = material.elasticity(&material_place)?;
        let mass_kg = match (&self.mass_kg, &material.density_kg_per_m3) {
            (mass @ Some(_), None) => number(place, &quantity::MASS, mass.as_ref())?,
            (None, density @ Some(_)) => {
                let density = number(&material_place, &quantity::DENSITY, density.as_ref())?;
                Sphere::homogeneous_mass(radius_m, density)
            }
            (mass, _) => {
                return Err(format!(
                    "{place}.mass_kg and {material_place}.density_kg_per_m3 are {}; expected \
                     exactly one of them, a finite number above 0",
                    if mass.is_some() { "both given" } else { "both missing" }
                ));
            }
        };
        let moment_of_inertia_kg_m2 = match &self.moment_of_inertia_kg_m2 {
            None => Sphere::homogeneous_moment(radius_m, mass_kg),
            Some(_) if self.mass_kg.is_none() => {
                return Err(format!(
                    "{place}.moment_of_inertia_kg_m2 contradicts a density, which makes the sphere \
                     homogeneous; expected beside mass_kg only"
                ));
            }
            moment => number(place, &quantity::MOMENT_OF_INERTIA, moment.as_ref())?,
        };
        let sphere = Sphere { radius_m, mass_kg, moment_of_inertia_kg_m2, elasticity };
        let motion_place = format!("{place}.motion");
        let motion = self.motion.as_ref().map(|Object(motion)| motion.resolve(&motion_place));
        Ok((sphere, motion.transpose()?))
    }
}

impl WallFields {
    fn resolve(&self) -> Result<(Wall, Option<WallMotion>), String> {
        let elasticity = match (&self.material, self.rigid.unwrap_or(false)) {
            (None, true) => None,
            (Some(Object(material)), false) if material.density_kg_per_m3.is_none() => {
                Some(material.elasticity("wall.material")?)
            }
            (Some(_), false) => {
                return Err(
                    "wall.material.density_kg_per_m3 has no effect, since the mass of a wall \
                            is infinite; expected in spheres only"
                        .to_owned(),
                );
            }
            (material, _) => {
                return Err(format!(
                    "wall.material and wall.rigid = true are {}; expected exactly one of them",
                    if material.is_some() { "both given" } else { "both missing" }
                ));
            }
        };
        let motion = self.motion.as_ref().map(|Object(motion)| motion.resolve("wall.motion"));
        Ok((Wall { elasticity }, motion.transpose()?))
    }
}

impl MaterialFields {
    fn elasticity(&self, place: &str) -> Result<Elasticity, String> {
        let (young, poisson) = (self.young_modulus_pa.as_ref(), self.poisson_ratio.as_ref());
        Ok(Elasticity {
            young_modulus_pa: number(place, &quantity::YOUNG_MODULUS, young)?,
            poisson_ratio: number(place, &quantity::POISSON_RATIO, poisson)?,
        })
    }
}

impl MotionFields {
    fn resolve(&self, place: &str) -> Result<Motion, String> {
        let (position, spin) = (("position_m", POSITION), ("spin_rad_per_s", "in rad/s"));
        Ok(Motion {
            position_m: vector(place, position, self.position_m.as_ref())?,
            velocity_m_per_s: vector(place, VELOCITY, self.velocity_m_per_s.as_ref())?,
            spin_rad_per_s: vector(place, spin, self.spin_rad_per_s.as_ref())?,
        })
    }
}

impl WallMotionFields {
    fn resolve(&self, place: &str) -> Result<WallMotion, String> {
        let (point, normal) = (("point_m", POSITION), ("normal", "not all 0, without unit"));
        Ok(WallMotion {
            point_m: vector(place, point, self.point_m.as_ref())?,
            normal: vector(place, normal, self.normal.as_ref())?,
            velocity_m_per_s: vector(place, VELOCITY, self.velocity_m_per_s.as_ref())?,
        })
    }
}

impl SurfaceFields {
    fn resolve(&self, law: Law) -> Result<Forces, String> {
        let number = |quantity: &PhysicalQuantity, value: &Option<Value>| {
            number("surface", quantity, value.as_ref())
        };
        let friction = number(&quantity::FRICTION, &self.friction)?;
        let given = |quantity: &PhysicalQuantity, value: &Option<Value>| {
            value.as_ref().map(|_| number(quantity, value)).transpose()
        };
        let constants = Constants {
            friction,
            dynamic_friction: given(&quantity::DYNAMIC_FRICTION, &self.dynamic_friction)?,
            friction_decay_s_per_m: given(&quantity::FRICTION_DECAY, &self.friction_decay_s_per_m)?,
            normal_stiffness_kg_per_s2: given(
                &quantity::NORMAL_STIFFNESS,
                &self.normal_stiffness_kg_per_s2,
            )?,
            hertz_stiffness_kg_per_s2_m0_5: given(
                &quantity::HERTZ_STIFFNESS,
                &self.hertz_stiffness_kg_per_s2_m0_5,
            )?,
            tangential_stiffness_kg_per_s2: given(
                &quantity::TANGENTIAL_STIFFNESS,
                &self.tangential_stiffness_kg_per_s2,
            )?,
            mindlin_stiffness_kg_per_s2_m0_5: given(
                &quantity::MINDLIN_STIFFNESS,
                &self.mindlin_stiffness_kg_per_s2_m0_5,
            )?,
            damping_coefficient: given(&quantity::DAMPING_COEFFICIENT, &self.damping_coefficient)?,
            damping_time_s: given(&quantity::DAMPING_TIME, &self.damping_time_s)?,
            damping_ratio: given(&quantity::DAMPING_RATIO, &self.damping_ratio)?,
            critical_damping_ratio: given(
                &quantity::CRITICAL_DAMPING_RATIO,
                &self.critical_damping_ratio,
            )?,
            unloading_stiffness_ratio: given(
                &quantity::UNLOADING_RATIO,
                &self.unloading_stiffness_ratio,
            )?,
            hardening_per_m: given(&quantity::HARDENING, &self.hardening_per_m)?,
            yield_velocity_m_per_s: given(&quantity::YIELD_VELOCITY, &self.yield_velocity_m_per_s)?,
            yield_pressure_pa: given(&quantity::YIELD_PRESSURE, &self.yield_pressure_pa)?,
            surface_energy_j_per_m2: given(
                &quantity::SURFACE_ENERGY,
                &self.surface_energy_j_per_m2,
            )?,
            e_n: given(&quantity::NORMAL_RESTITUTION, &self.e_n)?,
            e_n_at_m_per_s: given(&quantity::RESTITUTION_VELOCITY, &self.e_n_at_m_per_s)?,
            tangential_damping_ratio: given(
                &quantity::TANGENTIAL_DAMPING_RATIO,
                &self.tangential_damping_ratio,
            )?,
        };
        let only_of_paper = Constants {
            friction,
            tangential_stiffness_kg_per_s2: constants.tangential_stiffness_kg_per_s2,
            damping_time_s: constants.damping_time_s,
            ..Constants::default()
        };
        if law == Law::PAPER && constants == only_of_paper {
            let stiffness = &self.tangential_stiffness_kg_per_s2;
            return Ok(Forces::from(&Surface {
                friction,
                tangential_stiffness_kg_per_s2: number(&quantity::TANGENTIAL_STIFFNESS, stiffness)?,
                damping_time_s: number(&quantity::DAMPING_TIME, &self.damping_time_s)?,
            }));
        }
        Forces::new(law, &constants).map_err(|invalid| {
            let text = invalid.to_string();
            // What is wrong with the law is no field.
            if text.starts_with("the law") { text } else { format!("surface.{text}") }
        })
    }
}
