//! JSON documents that a reader knows to be as they were written: each field has a digest.
//!
//! A file that was edited, cut or damaged may still be a document, with other numbers. Its digests
//! no longer fit then, and say which field is another one. Spaces, line breaks and the spelling of
//! numbers do not matter. A document without digests is not checked: older files have none.

use std::collections::BTreeMap;

use serde::Serialize;
use serde_json::{Map, Value};
use stickslip_model::InvalidValue;
use twox_hash::XxHash3_128;

/// The field with the digests of the others.
const DIGESTS: &str = "digests";

/// A document with the digests of its fields behind them.
#[derive(Serialize)]
struct Sealed<'a, D> {
    #[serde(flatten)]
    document: &'a D,
    digests: BTreeMap<String, String>,
}

/// A document as JSON on one line, with digests.
///
/// ```
/// use std::collections::BTreeMap;
/// use stickslip_plane::sealed;
///
/// let text = sealed::to_string(&BTreeMap::from([("psi", 0.5), ("kappa", 18.0)]))?;
/// assert_eq!(sealed::check(text.as_bytes()), Ok(()));
/// assert_eq!(sealed::check(text.replace("0.5", "0.50 ").as_bytes()), Ok(()));
/// let damaged = sealed::check(text.replace("0.5", "0.6").as_bytes()).unwrap_err();
/// assert_eq!(damaged.name, "psi");
/// # Ok::<(), serde_json::Error>(())
/// ```
///
/// # Errors
/// The document is not an object of JSON.
pub fn to_string(document: &impl Serialize) -> serde_json::Result<String> {
    let fields: Map<String, Value> = serde_json::from_value(serde_json::to_value(document)?)?;
    serde_json::to_string(&Sealed { document, digests: digests_of(&fields) })
}

/// Compares the fields of a document with its digests. A text that is not a document is left to its
/// reader, who says where it is wrong.
///
/// # Errors
/// [`InvalidValue`] names the first field that does not fit.
pub fn check(text: &[u8]) -> Result<(), InvalidValue> {
    let Ok(mut fields) = serde_json::from_slice::<Map<String, Value>>(text) else { return Ok(()) };
    let Some(digests) = fields.remove(DIGESTS) else {
        // Digests under another name: it is their name that was changed.
        let renamed = fields.into_iter().find(|(_, value)| has_digests(value));
        return renamed.map_or(Ok(()), |(field, _)| Err(damaged(field)));
    };
    let (written, found) = (serde_json::from_value(digests), digests_of(&fields));
    let written: BTreeMap<String, String> = written.map_err(|_| damaged(DIGESTS.to_owned()))?;
    let mut names = found.keys().chain(written.keys());
    match names.find(|name| found.get(*name) != written.get(*name)) {
        Some(field) => Err(damaged(field.clone())),
        None => Ok(()),
    }
}

fn damaged(field: String) -> InvalidValue {
    let expected =
        "the file as it was, or, if it was changed on purpose, without the field digests";
    InvalidValue::phrase(field, "has changed since the file was written", expected)
}

/// Whether a value is an object with a digest.
fn has_digests(value: &Value) -> bool {
    let is_digest = |text: &str| text.len() == 32 && text.bytes().all(|it| it.is_ascii_hexdigit());
    value.as_object().is_some_and(|it| it.values().filter_map(Value::as_str).any(is_digest))
}

fn digests_of(fields: &Map<String, Value>) -> BTreeMap<String, String> {
    fields.iter().map(|(name, value)| (name.clone(), digest(value))).collect()
}

/// A digest of a value, in hexadecimal digits.
fn digest(value: &Value) -> String {
    let mut bytes = Vec::new();
    write(value, &mut bytes);
    format!("{:032x}", XxHash3_128::oneshot(&bytes))
}

/// Writes a value so that equal values, and only these, have equal bytes: names in order, each text
/// with its length.
fn write(value: &Value, bytes: &mut Vec<u8>) {
    let text = |text: &str, bytes: &mut Vec<u8>| {
        bytes.extend(text.len().to_le_bytes());
        bytes.extend(text.as_bytes());
    };
    match value {
        Value::Object(fields) => {
            bytes.push(b'{');
            for (name, value) in fields.iter().collect::<BTreeMap<_, _>>() {
                text(name, bytes);
                write(value, bytes);
            }
            bytes.push(b'}');
        }
        Value::Array(values) => {
            bytes.push(b'[');
            for value in values {
                write(value, bytes);
            }
            bytes.push(b']');
        }
        Value::String(own) => {
            bytes.push(b'"');
            text(own, bytes);
        }
        Value::Number(_) | Value::Bool(_) | Value::Null => text(&value.to_string(), bytes),
    }
}
