//! JSON Schema, as much of it as the schema of bodies uses. A keyword that is not known here is an
//! error.
//!
//! A library that knows all keywords brings some thirty crates, a seventh of the time in which all
//! dependencies are compiled. It says the same of every file of `impact_files` (jsonschema 0.60).

use serde_json::{Map, Value};

/// A schema of draft 2020-12.
pub struct Schema(Value);

impl Schema {
    /// The schema that a text is.
    pub fn new(text: &str) -> Self {
        let schema: Value = serde_json::from_str(text).expect("JSON");
        assert_eq!(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
        Self(schema)
    }

    pub fn is_valid(&self, value: &Value) -> bool {
        self.allows(&self.0, value)
    }

    /// Whether a part of the schema allows a value.
    fn allows(&self, schema: &Value, value: &Value) -> bool {
        match schema {
            Value::Bool(allows) => *allows,
            Value::Object(keywords) => {
                keywords.iter().all(|(word, says)| self.obeys(keywords, (word, says), value))
            }
            _ => panic!("{schema} is no schema"),
        }
    }

    /// Whether a value obeys one keyword.
    fn obeys(
        &self,
        keywords: &Map<String, Value>,
        (word, says): (&str, &Value),
        value: &Value,
    ) -> bool {
        let allows = |schema: &Value| self.allows(schema, value);
        let number = || says.as_f64().expect("a number");
        let size = || says.as_u64().and_then(|size| usize::try_from(size).ok()).expect("a size");
        let list = || says.as_array().expect("a list");
        match (word, value) {
            ("$ref", _) => {
                let path = says.as_str().and_then(|path| path.strip_prefix('#'));
                allows(path.and_then(|path| self.0.pointer(path)).expect("a part of the schema"))
            }
            ("type", _) => says.as_str() == Some(type_of(value)),
            ("const", _) => says == value,
            ("allOf", _) => list().iter().all(allows),
            ("anyOf", _) => list().iter().any(allows),
            ("not", _) => !allows(says),
            ("if", _) => {
                keywords.get(if allows(says) { "then" } else { "else" }).is_none_or(allows)
            }
            ("minimum", Value::Number(_)) => value.as_f64() >= Some(number()),
            ("exclusiveMinimum", Value::Number(_)) => value.as_f64() > Some(number()),
            ("maximum", Value::Number(_)) => value.as_f64() <= Some(number()),
            ("minItems", Value::Array(items)) => items.len() >= size(),
            ("maxItems", Value::Array(items)) => items.len() <= size(),
            ("items", Value::Array(items)) => items.iter().all(|item| self.allows(says, item)),
            ("contains", Value::Array(items)) => items.iter().any(|item| self.allows(says, item)),
            ("required", Value::Object(fields)) => {
                let has = |name: &Value| fields.contains_key(name.as_str().expect("a name"));
                list().iter().all(has)
            }
            ("properties", Value::Object(fields)) => {
                let properties = says.as_object().expect("properties");
                let fits = |(name, schema): (&String, &Value)| {
                    fields.get(name).is_none_or(|field| self.allows(schema, field))
                };
                properties.iter().all(fits)
            }
            ("additionalProperties", Value::Object(fields)) => {
                let named = keywords.get("properties").and_then(Value::as_object);
                let named = |name: &String| named.is_some_and(|named| named.contains_key(name));
                let mut others = fields.iter().filter(|(name, _)| !named(name));
                others.all(|(_, field)| self.allows(says, field))
            }
            // The rest says nothing of values, or of values of another type.
            ("$schema" | "$defs" | "title" | "description" | "then" | "else", _)
            | ("minimum" | "exclusiveMinimum" | "maximum", _)
            | ("minItems" | "maxItems" | "items" | "contains", _)
            | ("required" | "properties" | "additionalProperties", _) => true,
            _ => panic!("the keyword {word} is not known"),
        }
    }
}

/// The name that a schema has for the type of a value.
fn type_of(value: &Value) -> &'static str {
    match value {
        Value::Null => "null",
        Value::Bool(_) => "boolean",
        Value::Number(_) => "number",
        Value::String(_) => "string",
        Value::Array(_) => "array",
        Value::Object(_) => "object",
    }
}
