//! Results as the JSON documents that the program prints and the Python package gives.

use serde::Serialize;
use serde_json::{Map, Value, json, to_value};
use stickslip_solver::Statistics;

use crate::engines::{Engine, Estimate};

/// The layout of a [`Collision`](crate::Collision). The number at the end of a layout rises when a
/// field disappears or changes its meaning.
pub const COLLISION: &str = "stickslip.collision/1";
/// The layout of an [`ImpactReport`](crate::spheres::ImpactReport).
pub const IMPACT: &str = "stickslip.impact/1";

/// `result` as one object with the layout `schema`. The object also says what computed the result:
/// the engine after the parameters, and at the end the estimate of the error, if there is one, and
/// the integrator's work, which is an empty object for the exact solution.
///
/// # Errors
/// `result` cannot be JSON.
pub fn new(
    schema: &str,
    result: &impl Serialize,
    engine: &Engine,
    (estimate, statistics): (Option<&Estimate>, Option<&Statistics>),
) -> serde_json::Result<Map<String, Value>> {
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
    Ok(object)
}
