//! The numbers of the file, by name, so that columns may give them.

use serde_json::{Value, json};
use stickslip_model::spheres::quantity::{self, PhysicalQuantity};

use super::{
    File, MaterialFields, MotionFields, Object, POSITION, SPHERES, SphereFields, SurfaceFields,
    VELOCITY, WallFields, WallMotionFields,
};

/// A number of the file.
#[derive(Clone, Copy, Debug)]
pub enum Slot {
    /// A number of a sphere with this index.
    Sphere(usize, Scalar<SphereFields>),
    /// A number of the material of a sphere with this index, or of the wall.
    Material(Option<usize>, Scalar<MaterialFields>),
    /// A component of the motion of a sphere with this index.
    Motion(usize, Component<MotionFields>),
    /// A component of the motion of the wall.
    WallMotion(Component<WallMotionFields>),
    /// A number of the surface.
    Surface(Scalar<SurfaceFields>),
}

type Field<T> = fn(&mut T) -> &mut Option<Value>;

/// A quantity, and its field in an object.
pub type Scalar<T> = (&'static PhysicalQuantity, Field<T>);

/// A component of a vector, its unit, and the field of the vector in an object.
pub type Component<T> = (usize, &'static str, Field<T>);

/// A vector: its name, its unit, and its field in an object.
type Vector<T> = (&'static str, &'static str, Field<T>);

const SPHERE: [Scalar<SphereFields>; 3] = [
    (&quantity::RADIUS, |it| &mut it.radius_m),
    (&quantity::MASS, |it| &mut it.mass_kg),
    (&quantity::MOMENT_OF_INERTIA, |it| &mut it.moment_of_inertia_kg_m2),
];
const ELASTICITY: [Scalar<MaterialFields>; 2] = [
    (&quantity::YOUNG_MODULUS, |it| &mut it.young_modulus_pa),
    (&quantity::POISSON_RATIO, |it| &mut it.poisson_ratio),
];
const DENSITY: Scalar<MaterialFields> = (&quantity::DENSITY, |it| &mut it.density_kg_per_m3);
const MOTION: [Vector<MotionFields>; 3] = [
    ("position_m", POSITION, |it| &mut it.position_m),
    (VELOCITY.0, VELOCITY.1, |it| &mut it.velocity_m_per_s),
    ("spin_rad_per_s", "in rad/s", |it| &mut it.spin_rad_per_s),
];
const WALL_MOTION: [Vector<WallMotionFields>; 3] = [
    ("point_m", POSITION, |it| &mut it.point_m),
    ("normal", "without unit", |it| &mut it.normal),
    (VELOCITY.0, VELOCITY.1, |it| &mut it.velocity_m_per_s),
];
const SURFACE: [Scalar<SurfaceFields>; 19] = [
    (&quantity::FRICTION, |it| &mut it.friction),
    (&quantity::DYNAMIC_FRICTION, |it| &mut it.dynamic_friction),
    (&quantity::FRICTION_DECAY, |it| &mut it.friction_decay_s_per_m),
    (&quantity::NORMAL_STIFFNESS, |it| &mut it.normal_stiffness_kg_per_s2),
    (&quantity::HERTZ_STIFFNESS, |it| &mut it.hertz_stiffness_kg_per_s2_m0_5),
    (&quantity::TANGENTIAL_STIFFNESS, |it| &mut it.tangential_stiffness_kg_per_s2),
    (&quantity::MINDLIN_STIFFNESS, |it| &mut it.mindlin_stiffness_kg_per_s2_m0_5),
    (&quantity::DAMPING_COEFFICIENT, |it| &mut it.damping_coefficient),
    (&quantity::DAMPING_TIME, |it| &mut it.damping_time_s),
    (&quantity::DAMPING_RATIO, |it| &mut it.damping_ratio),
    (&quantity::CRITICAL_DAMPING_RATIO, |it| &mut it.critical_damping_ratio),
    (&quantity::UNLOADING_RATIO, |it| &mut it.unloading_stiffness_ratio),
    (&quantity::HARDENING, |it| &mut it.hardening_per_m),
    (&quantity::YIELD_VELOCITY, |it| &mut it.yield_velocity_m_per_s),
    (&quantity::YIELD_PRESSURE, |it| &mut it.yield_pressure_pa),
    (&quantity::SURFACE_ENERGY, |it| &mut it.surface_energy_j_per_m2),
    (&quantity::NORMAL_RESTITUTION, |it| &mut it.e_n),
    (&quantity::RESTITUTION_VELOCITY, |it| &mut it.e_n_at_m_per_s),
    (&quantity::TANGENTIAL_DAMPING_RATIO, |it| &mut it.tangential_damping_ratio),
];

impl Slot {
    /// The quantity of a number that is not a component of a vector.
    pub fn quantity(&self) -> Option<&'static PhysicalQuantity> {
        match self {
            Self::Sphere(_, (quantity, _))
            | Self::Material(_, (quantity, _))
            | Self::Surface((quantity, _)) => Some(quantity),
            Self::Motion(..) | Self::WallMotion(..) => None,
        }
    }

    /// The unit of a component of a vector.
    pub fn unit(&self) -> Option<&'static str> {
        match self {
            Self::Motion(_, (_, unit, _)) | Self::WallMotion((_, unit, _)) => Some(unit),
            _ => None,
        }
    }
}

impl File {
    /// Names and places of all numbers that a file of such bodies may have.
    pub fn numbers(&self) -> Vec<(String, Slot)> {
        let mut numbers = Vec::new();
        let mut add = |name: String, slot: Slot| numbers.push((name, slot));
        let count = self.spheres();
        for (index, place) in SPHERES.iter().enumerate().take(count) {
            for scalar in SPHERE {
                add(format!("{place}.{}", scalar.0.name), Slot::Sphere(index, scalar));
            }
            for scalar in ELASTICITY.into_iter().chain([DENSITY]) {
                let name = format!("{place}.material.{}", scalar.0.name);
                add(name, Slot::Material(Some(index), scalar));
            }
            for (name, unit, field) in MOTION {
                for axis in 0..3 {
                    let name = format!("{place}.motion.{name}[{axis}]");
                    add(name, Slot::Motion(index, (axis, unit, field)));
                }
            }
        }
        if self.wall.is_some() {
            for scalar in ELASTICITY {
                let name = format!("wall.material.{}", scalar.0.name);
                add(name, Slot::Material(None, scalar));
            }
            for (name, unit, field) in WALL_MOTION {
                for axis in 0..3 {
                    let name = format!("wall.motion.{name}[{axis}]");
                    add(name, Slot::WallMotion((axis, unit, field)));
                }
            }
        }
        for scalar in SURFACE {
            add(format!("surface.{}", scalar.0.name), Slot::Surface(scalar));
        }
        numbers
    }

    /// Sets a number. Objects and vectors around it are made if they are missing.
    pub fn set(&mut self, slot: &Slot, value: f64) {
        let value = Value::from(value);
        match slot {
            Slot::Sphere(index, (_, field)) => {
                if let Some(sphere) = self.sphere(*index) {
                    *field(sphere) = Some(value);
                }
            }
            Slot::Material(owner, (_, field)) => {
                let material = match owner {
                    Some(index) => self.sphere(*index).map(|sphere| &mut sphere.material),
                    None => self.wall().map(|wall| &mut wall.material),
                };
                if let Some(material) = material {
                    *field(inner(material)) = Some(value);
                }
            }
            Slot::Motion(index, (axis, _, field)) => {
                if let Some(sphere) = self.sphere(*index) {
                    set_component(field(inner(&mut sphere.motion)), *axis, value);
                }
            }
            Slot::WallMotion((axis, _, field)) => {
                if let Some(wall) = self.wall() {
                    set_component(field(inner(&mut wall.motion)), *axis, value);
                }
            }
            Slot::Surface((_, field)) => *field(inner(&mut self.surface)) = Some(value),
        }
    }

    fn sphere(&mut self, index: usize) -> Option<&mut SphereFields> {
        self.spheres.as_mut()?.get_mut(index).map(|Object(sphere)| sphere)
    }

    fn wall(&mut self) -> Option<&mut WallFields> {
        self.wall.as_mut().map(|Object(wall)| wall)
    }
}

/// The object, which is made if it is missing.
fn inner<T: Default>(object: &mut Option<Object<T>>) -> &mut T {
    &mut object.get_or_insert_default().0
}

/// Sets a component of a vector. One that never gets a number stays `null`, which is refused later.
fn set_component(vector: &mut Option<Value>, axis: usize, value: Value) {
    let vector = vector.get_or_insert_with(|| json!([null, null, null]));
    if let Some(component) = vector.get_mut(axis) {
        *component = value;
    }
}
