//! Results as JSON.

use std::io::{self, Write};

use serde::Serialize;
use stickslip_model::{Engine, Estimate, document};
use stickslip_plane::sealed;
use stickslip_solver::Statistics;

/// Writes `result` as one [`document`] with the layout `schema`, and ends the line.
///
/// # Errors
/// `out` cannot be written.
pub fn write(
    out: &mut dyn Write,
    schema: &str,
    result: &impl Serialize,
    engine: &Engine,
    work: (Option<&Estimate>, Option<&Statistics>),
) -> io::Result<()> {
    let document = document::new(schema, result, engine, work)?;
    lines(out, &document)
}

/// Writes `value` on several lines, and ends the last one.
///
/// # Errors
/// `out` cannot be written.
pub fn lines(out: &mut dyn Write, value: &impl Serialize) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut *out, value)?;
    writeln!(out)
}

/// `document` as JSON on one line, which is ended. Its fields have digests, see [`sealed`].
///
/// # Errors
/// `document` is not an object of JSON.
pub fn sealed_line(document: &impl Serialize) -> io::Result<Vec<u8>> {
    let mut line = sealed::to_string(document)?.into_bytes();
    line.push(b'\n');
    Ok(line)
}

/// `value` as JSON on one line, which is ended.
///
/// # Errors
/// `value` cannot be JSON.
pub fn line(value: &impl Serialize) -> io::Result<Vec<u8>> {
    let mut line = serde_json::to_vec(value)?;
    line.push(b'\n');
    Ok(line)
}
