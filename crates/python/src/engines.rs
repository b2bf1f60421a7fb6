//! What computes collisions.

use pyo3::prelude::*;
use serde_json::{Map, Value, json, to_value};
use stickslip_model::{Engine, Tolerances};
use stickslip_solver::{InvalidOption, Options, Statistics};

use crate::failure::{bad_input, failed};

/// The method and the tolerances, `None` where they are not given.
#[derive(FromPyObject)]
pub struct Choice(String, Option<f64>, Option<f64>);

impl Choice {
    /// The engine that is chosen, by the rules of the program's options.
    pub fn engine(&self) -> PyResult<Engine> {
        let Self(method, rtol, atol) = self;
        let tolerances = |usual: Tolerances| Tolerances {
            rtol: rtol.unwrap_or(usual.rtol),
            atol: atol.unwrap_or(usual.atol),
        };
        let engine = match (method.as_str(), rtol.or(*atol)) {
            ("dop853", _) | ("auto", Some(_)) => Engine::Dop853(tolerances(Tolerances::DOP853)),
            ("dopri5", _) => Engine::Dopri5(tolerances(Tolerances::DOPRI5)),
            ("exact" | "auto", None) => Engine::Exact,
            ("exact", Some(value)) => {
                return Err(bad_input(format!(
                    "a tolerance of {value:?} has no effect with method = \"exact\"; expected with \
                     \"dop853\" and \"dopri5\" only"
                )));
            }
            (other, _) => {
                return Err(bad_input(format!(
                    "method = {other:?}; expected \"auto\", \"exact\", \"dop853\" or \"dopri5\""
                )));
            }
        };
        if let Some(Tolerances { rtol, atol }) = engine.tolerances() {
            let options = Options { rtol, atol, ..Options::default() };
            options.validate().map_err(|InvalidOption { name, value, expected }| {
                bad_input(format!("{name} = {value:?} is out of range; expected {expected}"))
            })?;
        }
        Ok(engine)
    }
}

/// A result with the layout `schema`, as the JSON that the program prints.
pub fn document(
    schema: &str,
    result: &impl serde::Serialize,
    engine: &Engine,
    statistics: Option<&Statistics>,
) -> PyResult<String> {
    let mut object = Map::from_iter([("schema".to_owned(), schema.into())]);
    let method = to_value(engine).map_err(failed)?;
    if let Value::Object(fields) = to_value(result).map_err(failed)? {
        for (name, value) in fields {
            let parameters = name == "parameters";
            object.insert(name, value);
            if parameters {
                object.insert("method".to_owned(), method.clone());
            }
        }
    }
    let statistics = statistics.map_or(Ok(json!({})), to_value).map_err(failed)?;
    object.insert("statistics".to_owned(), statistics);
    Ok(Value::Object(object).to_string())
}

/// The version of the package.
#[pyfunction]
pub fn version() -> &'static str {
    env!("CARGO_PKG_VERSION")
}

/// Whether this build adds products in one instruction.
#[pyfunction]
pub fn has_fused_products() -> bool {
    cfg!(target_feature = "fma")
}

/// Whether the processor has all of x86-64-v3 that the faster build uses.
#[pyfunction]
pub fn processor_has_fused_products() -> bool {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::is_x86_feature_detected as has;
        has!("avx2")
            && has!("bmi1")
            && has!("bmi2")
            && has!("f16c")
            && has!("fma")
            && has!("lzcnt")
            && has!("movbe")
    }
    #[cfg(not(target_arch = "x86_64"))]
    {
        false
    }
}
