//! JSON files of atlases.

use std::fs;
use std::path::Path;

use serde::Deserialize;
use stickslip_plane::atlas::{Atlas, Document, SCHEMA};

use super::json;
use crate::error::Failure;

/// The field that is read before the others.
#[derive(Deserialize)]
struct Schema {
    schema: String,
}

/// Reads an atlas.
///
/// # Errors
/// [`Failure::Input`]: the file cannot be read, does not hold an atlas, or contradicts itself.
pub fn read(path: &Path) -> Result<Atlas, Failure> {
    let unusable = |reason: String| Failure::input(path, reason);
    let text = fs::read(path).map_err(|error| unusable(format!("cannot be read: {error}")))?;
    let Schema { schema } = json::parse(&text).map_err(unusable)?;
    if schema != SCHEMA {
        return Err(unusable(format!(
            "schema is {schema:?}; expected {SCHEMA:?}, which stickslip trace writes"
        )));
    }
    let document: Document = json::parse(&text).map_err(unusable)?;
    Atlas::try_from(document).map_err(|error| unusable(error.to_string()))
}
