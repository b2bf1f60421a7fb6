//! A JSON file of two bodies and their surfaces: docs/impact.schema.json.

use std::fmt;
use std::fs;
use std::io::{self, Read};
use std::marker::PhantomData;
use std::path::Path;

use serde::de::value::MapAccessDeserializer;
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::Value;
use stickslip_model::quantity::{self, Quantity};
use stickslip_model::{Body, Elasticity, Pair, Sphere, Surface, Wall};

use crate::error::Failure;

/// The two bodies in the file at `path`, `-` for standard input, as their contact feels them.
///
/// Their motion may be in the file; it does not matter here.
///
/// # Errors
/// [`Failure::Input`]: the file cannot be read, is not JSON, or does not describe two bodies. It
/// names the line or the field, and what is accepted there.
#[allow(dead_code)]
pub fn read_pair(path: &Path) -> Result<Pair, Failure> {
    let shown = if path == Path::new("-") { Path::new("standard input") } else { path };
    let text = read(path).map_err(|e| Failure::input(shown, format!("cannot be read: {e}")))?;
    let Bodies { sphere, other, surface } =
        Bodies::parse(&text).map_err(|reason| Failure::input(shown, reason))?;
    Pair::new(&sphere, &other, &surface).map_err(|invalid| Failure::input(shown, invalid))
}

fn read(path: &Path) -> io::Result<Vec<u8>> {
    if path == Path::new("-") {
        let mut text = Vec::new();
        io::stdin().lock().read_to_end(&mut text)?;
        return Ok(text);
    }
    fs::read(path)
}

/// What a file describes.
struct Bodies {
    sphere: Sphere,
    other: Body,
    surface: Surface,
}

impl Bodies {
    fn parse(text: &[u8]) -> Result<Self, String> {
        let mut reader = serde_json::Deserializer::from_slice(text);
        let Object(file): Object<RawFile> =
            serde_path_to_error::deserialize(&mut reader).map_err(|error| {
                let path = error.path().to_string();
                let error = error.into_inner();
                if error.is_data() && path != "." {
                    format!("{path}: {error}")
                } else {
                    error.to_string()
                }
            })?;
        reader.end().map_err(|error| error.to_string())?;

        let spheres = file.spheres.unwrap_or_default();
        let spheres = spheres.iter().enumerate().map(|(index, Object(s))| s.resolve(index));
        let spheres = spheres.collect::<Result<Vec<_>, _>>()?;
        let wall = file.wall.map(|Object(wall)| wall.resolve()).transpose()?;
        let (sphere, other) = match (&spheres[..], wall) {
            (&[sphere, other], None) => (sphere, Body::Sphere(other)),
            (&[sphere], Some(wall)) => (sphere, Body::Wall(wall)),
            (_, wall) => {
                return Err(format!(
                    "there are {} spheres and {} wall; accepted are two in spheres, or one and a wall",
                    spheres.len(),
                    if wall.is_some() { "a" } else { "no" }
                ));
            }
        };
        let surface = file.surface.ok_or_else(|| missing("surface", AN_OBJECT))?.0.resolve()?;
        Ok(Self { sphere, other, surface })
    }
}

const AN_OBJECT: &str = "an object";

/// The file as it is written; what is missing is `None`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawFile {
    #[serde(rename = "$schema")]
    _schema: Option<String>,
    #[serde(rename = "comment")]
    _comment: Option<String>,
    spheres: Option<Vec<Object<RawSphere>>>,
    wall: Option<Object<RawWall>>,
    surface: Option<Object<RawSurface>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawSphere {
    #[serde(rename = "comment")]
    _comment: Option<String>,
    radius_m: Option<Value>,
    mass_kg: Option<Value>,
    moment_of_inertia_kg_m2: Option<Value>,
    material: Option<Object<RawMaterial>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawWall {
    #[serde(rename = "comment")]
    _comment: Option<String>,
    rigid: Option<bool>,
    material: Option<Object<RawMaterial>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawMaterial {
    #[serde(rename = "comment")]
    _comment: Option<String>,
    young_modulus_pa: Option<Value>,
    poisson_ratio: Option<Value>,
    density_kg_per_m3: Option<Value>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawSurface {
    #[serde(rename = "comment")]
    _comment: Option<String>,
    friction: Option<Value>,
    tangential_stiffness_kg_per_s2: Option<Value>,
    damping_time_s: Option<Value>,
}

impl RawSphere {
    fn resolve(&self, index: usize) -> Result<Sphere, String> {
        let place = format!("spheres[{index}]");
        let number = |quantity, value| number(&place, quantity, value);
        let material_place = format!("{place}.material");
        let radius_m = number(&quantity::RADIUS, &self.radius_m)?;
        let Object(material) =
            self.material.as_ref().ok_or_else(|| missing(&material_place, AN_OBJECT))?;
        let elasticity = material.resolve(&material_place)?;
        let (mass, density) = (&self.mass_kg, &material.density_kg_per_m3);
        let mass_kg = match (mass, density) {
            (Some(_), None) => number(&quantity::MASS, mass)?,
            (None, Some(_)) => {
                let density = crate::bodies::number(&material_place, &quantity::DENSITY, density)?;
                Sphere::homogeneous_mass(radius_m, density)
            }
            _ => {
                return Err(format!(
                    "{place}.mass_kg and {material_place}.density_kg_per_m3 are {}; accepted is exactly one \
                 of them",
                    if mass.is_some() { "both given" } else { "missing" }
                ));
            }
        };
        let moment_of_inertia_kg_m2 = match &self.moment_of_inertia_kg_m2 {
            None => Sphere::homogeneous_moment(radius_m, mass_kg),
            Some(_) if density.is_some() => {
                return Err(format!(
                    "{place}.moment_of_inertia_kg_m2 contradicts the density, which makes a homogeneous \
                 sphere; accepted with mass_kg only"
                ));
            }
            moment => number(&quantity::MOMENT_OF_INERTIA, moment)?,
        };
        Ok(Sphere { radius_m, mass_kg, moment_of_inertia_kg_m2, elasticity })
    }
}

impl RawWall {
    fn resolve(&self) -> Result<Wall, String> {
        match (&self.material, self.rigid.unwrap_or(false)) {
            (None, true) => Ok(Wall { elasticity: None }),
            (Some(Object(material)), false) => {
                if material.density_kg_per_m3.is_some() {
                    return Err("wall.material.density_kg_per_m3 has no effect: a wall's mass is infinite; \
                        accepted in spheres only".to_owned());
                }
                Ok(Wall { elasticity: Some(material.resolve("wall.material")?) })
            }
            (material, _) => Err(format!(
                "wall.material and wall.rigid = true are {}; accepted is \
                exactly one of them",
                if material.is_some() { "both given" } else { "missing" }
            )),
        }
    }
}

impl RawMaterial {
    fn resolve(&self, place: &str) -> Result<Elasticity, String> {
        Ok(Elasticity {
            young_modulus_pa: number(place, &quantity::YOUNG_MODULUS, &self.young_modulus_pa)?,
            poisson_ratio: number(place, &quantity::POISSON_RATIO, &self.poisson_ratio)?,
        })
    }
}

impl RawSurface {
    fn resolve(&self) -> Result<Surface, String> {
        let number = |quantity, value| number("surface", quantity, value);
        Ok(Surface {
            friction: number(&quantity::FRICTION, &self.friction)?,
            tangential_stiffness_kg_per_s2: number(
                &quantity::TANGENTIAL_STIFFNESS,
                &self.tangential_stiffness_kg_per_s2,
            )?,
            damping_time_s: number(&quantity::DAMPING_TIME, &self.damping_time_s)?,
        })
    }
}

/// A struct that is written as an object; serde alone would take an array of its fields too.
struct Object<T>(T);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Object<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(ObjectVisitor(PhantomData))
    }
}

struct ObjectVisitor<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for ObjectVisitor<T> {
    type Value = Object<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(AN_OBJECT)
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
        T::deserialize(MapAccessDeserializer::new(map)).map(Object)
    }
}

/// The number in the field of `quantity` in the object at `place`.
fn number(place: &str, quantity: &Quantity, value: &Option<Value>) -> Result<f64, String> {
    let Quantity { name, accepted, .. } = quantity;
    let value = value.as_ref().ok_or_else(|| missing(&format!("{place}.{name}"), accepted))?;
    let Some(number) = value.as_f64() else {
        return Err(format!("{place}.{name} is {}; accepted is {accepted}", kind(value)));
    };
    quantity.check(number).map_err(|invalid| format!("{place}.{invalid}"))
}

fn missing(field: &str, accepted: &str) -> String {
    format!("{field} is missing; accepted is {accepted}")
}

fn kind(value: &Value) -> &'static str {
    match value {
        Value::Null => "null",
        Value::Bool(_) => "true or false",
        Value::Number(_) => "a number",
        Value::String(_) => "a string",
        Value::Array(_) => "an array",
        Value::Object(_) => "an object",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEEL: &str = r#""material": {"young_modulus_pa": 210e9, "poisson_ratio": 0.3, "density_kg_per_m3": 7850}"#;
    const SURFACE: &str = r#""surface": {"friction": 0.4, "tangential_stiffness_kg_per_s2": 1e12, "damping_time_s": 0}"#;

    #[test]
    fn a_pair_is_the_same_from_a_file() {
        let sphere = format!(r#"{{"radius_m": 0.02, {STEEL}}}"#);
        let text = format!(r#"{{"spheres": [{sphere}, {sphere}], {SURFACE}}}"#);
        let Bodies { sphere, other, surface } = Bodies::parse(text.as_bytes()).unwrap();
        let pair = Pair::new(&sphere, &other, &surface).unwrap();
        let steel = stickslip_model::Material {
            young_modulus_pa: 210e9,
            poisson_ratio: 0.3,
            density_kg_per_m3: 7850.0,
        };
        assert_eq!(pair, Pair::equal_spheres(0.02, &steel, &surface).unwrap());
    }
}
