//! Fields of a JSON object: numbers and vectors with their names, units and ranges.

use std::fmt;
use std::marker::PhantomData;

use serde::de::value::MapAccessDeserializer;
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::Value;
use stickslip_model::spheres::Vector3;
use stickslip_model::spheres::quantity::PhysicalQuantity;

/// A struct that is written as an object. serde alone would also accept an array of its fields.
#[derive(Clone, Default)]
pub struct Object<T>(pub T);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Object<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(ObjectVisitor(PhantomData))
    }
}

struct ObjectVisitor<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for ObjectVisitor<T> {
    type Value = Object<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
        T::deserialize(MapAccessDeserializer::new(map)).map(Object)
    }
}

/// The object at `place`.
///
/// # Errors
/// The object is missing.
pub fn required<T>(place: &str, object: Option<T>) -> Result<T, String> {
    object.ok_or_else(|| format!("{place} is missing; expected an object"))
}

/// The number in the field of `quantity` in the object at `place`.
///
/// # Errors
/// The number is missing or out of range, or the field holds something else.
pub fn number(
    place: &str,
    quantity: &PhysicalQuantity,
    value: Option<&Value>,
) -> Result<f64, String> {
    let PhysicalQuantity { name, expected, .. } = quantity;
    let number = match value {
        None => return Err(format!("{place}.{name} is missing; expected {expected}")),
        Some(value) => value
            .as_f64()
            .ok_or_else(|| format!("{place}.{name} is {}; expected {expected}", kind(value)))?,
    };
    quantity.check(number).map_err(|invalid| format!("{place}.{invalid}"))
}

/// The vector in the field `name` of the object at `place`, in `unit`.
///
/// # Errors
/// The vector is missing, or does not consist of three numbers.
pub fn vector(
    place: &str,
    (name, unit): (&str, &str),
    value: Option<&Value>,
) -> Result<Vector3<f64>, String> {
    let found = match value {
        None => "missing".to_owned(),
        Some(Value::Array(items)) => {
            let numbers: Vec<f64> = items.iter().filter_map(Value::as_f64).collect();
            if let ([x, y, z], 3) = (&numbers[..], items.len()) {
                return Ok(Vector3::new(*x, *y, *z));
            }
            format!("an array of {}, {} of them numbers", items.len(), numbers.len())
        }
        Some(value) => kind(value).to_owned(),
    };
    Err(format!("{place}.{name} is {found}; expected three finite numbers, {unit}"))
}

/// What `value` is, for messages.
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
