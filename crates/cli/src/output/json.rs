//! Results as JSON.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::{Map, Value, json, to_value};
use stickslip_model::{Engine, Estimate};
use stickslip_solver::Statistics;

/// Writes `result` as one JSON object with the layout `schema`, and ends the line. The object also
/// says what computed the result: the engine after the parameters, and at the end the estimate of
/// the error, if there is one, and the integrator's work, which is an empty object for the exact
/// solution.
///
/// # Errors
/// `out` cannot be written.
pub fn write(
    out: &mut dyn Write,
    schema: &str,
    result: &impl Serialize,
    engine: &Engine,
    (estimate, statistics): (Option<&Estimate>, Option<&Statistics>),
) -> io::Result<()> {
    let mut object = Map::from_iter([("schema".to_owned(), schema.into())]);
    let method = to_value(engine)?;
    if let Value::Object(fields) = to_value(result)? {
        for (name, value) in fields {
            let parameters = name == "parameters";
            object.insert(name, value);
            if parameters {
                object.insert("method".to_owned(), method.clone());
            }
        }
    }
    if let Some(estimate) = estimate {
        object.insert("estimate".to_owned(), to_value(estimate)?);
    }
    let statistics = statistics.map_or(Ok(json!({})), to_value)?;
    object.insert("statistics".to_owned(), statistics);
    serde_json::to_writer_pretty(&mut *out, &object)?;
    writeln!(out)
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
