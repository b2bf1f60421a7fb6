//! JSON, read so that a message names the field in which something is wrong.

use serde::de::DeserializeOwned;

/// The value that the whole of `text` describes.
///
/// # Errors
/// What is wrong and where. For text that is not JSON there is only a line and a column.
pub fn parse<T: DeserializeOwned>(text: &[u8]) -> Result<T, String> {
    let mut reader = serde_json::Deserializer::from_slice(text);
    let value = serde_path_to_error::deserialize(&mut reader).map_err(located)?;
    reader.end().map_err(|error| error.to_string())?;
    Ok(value)
}

/// As [`parse`], for an object with named fields, in whose place a list of their values is refused.
///
/// # Errors
/// As [`parse`].
pub fn object<T: DeserializeOwned>(text: &[u8]) -> Result<T, String> {
    match text.trim_ascii_start().first() {
        Some(b'[') => Err("is a list; expected an object with named fields".to_owned()),
        _ => parse(text),
    }
}

fn located(error: serde_path_to_error::Error<serde_json::Error>) -> String {
    let path = error.path().to_string();
    let error = error.into_inner();
    if error.is_data() && path != "." { format!("{path}: {error}") } else { error.to_string() }
}
