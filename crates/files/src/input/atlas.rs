//! JSON files of atlases.

use std::path::Path;

use serde::Deserialize;
use stickslip_plane::atlas::{Atlas, Document, SCHEMA};

use super::{json, source};
use crate::error::FileError;

/// Largest number of bytes of a file. Atlases of large windows have some ten million.
const MOST_BYTES: u64 = 1 << 30;

/// The field that is read before the others.
#[derive(Deserialize)]
struct Schema {
    schema: String,
}

/// Reads an atlas; `-` is standard input.
///
/// # Errors
/// [`FileError::Input`]: the file cannot be read, does not hold an atlas, or contradicts itself.
pub fn read(path: &Path) -> Result<Atlas, FileError> {
    let unusable = |reason: String| FileError::input(source::shown(path), reason);
    let text = source::read(path, MOST_BYTES)?;
    let Schema { schema } = json::parse(&text).map_err(unusable)?;
    if schema != SCHEMA {
        return Err(unusable(format!(
            "schema is {schema:?}; expected {SCHEMA:?}, which stickslip trace writes"
        )));
    }
    let document: Document = json::parse(&text).map_err(unusable)?;
    Atlas::try_from(document).map_err(|error| unusable(error.to_string()))
}
