//! What computes collisions.

use std::ffi::OsString;
use std::fmt::Display;

use pyo3::prelude::*;
use serde_json::Value;
use stickslip_model::{Engine, Law, presets};
use stickslip_solver::Statistics;

use crate::failure::{bad_input, failed};

/// The method and the tolerances, `None` where they are not given.
#[derive(FromPyObject)]
pub struct Choice(String, Option<f64>, Option<f64>);

impl Choice {
    /// The engine that is chosen for collisions with a law and a tangential damping, by the rules
    /// of the program's options.
    pub fn engine(&self, law: (Law, f64)) -> PyResult<Engine> {
        let Self(method, rtol, atol) = self;
        Engine::chosen_for(law, method, *rtol, *atol).map_err(bad_input)
    }
}

/// A contact law, by its name or as JSON, and the tangential damping.
#[derive(FromPyObject)]
pub struct LawChoice(pub String, pub f64);

impl LawChoice {
    /// The law that is chosen, and the tangential damping.
    pub fn law(&self) -> PyResult<(Law, f64)> {
        let Self(text, tangential_damping) = self;
        let Some(preset) = presets::find(text) else {
            let refused = |error: &dyn Display| {
                bad_input(format!("law = {text}: {error}; expected a name of stickslip.laws()"))
            };
            if let Some(why) = presets::refusal(text).filter(|_| !text.contains('{')) {
                return Err(bad_input(format!("law = {text:?}: {why}")));
            }
            if text.trim_start().starts_with('[') {
                return Err(refused(&"is a list"));
            }
            let law = serde_json::from_str(text).map_err(|error| refused(&error))?;
            return Ok((law, *tangential_damping));
        };
        if *tangential_damping != 0.0 && !preset.tangential_damping {
            return Err(bad_input(format!(
                "tangential_damping = {tangential_damping:?} has no meaning in the law {}: {}; \
                 expected 0, or the terms of the law that is meant",
                preset.name, preset.checked
            )));
        }
        Ok((preset.law, *tangential_damping))
    }
}

/// The contact laws that have names, as JSON, with their equations.
#[pyfunction]
pub fn laws() -> PyResult<String> {
    let entry = |preset: &presets::Preset| {
        let mut entry = serde_json::to_value(preset)?;
        entry["equations"] = preset.law.equations().into();
        Ok(entry)
    };
    let entries: serde_json::Result<Vec<Value>> =
        presets::ALL.iter().chain(presets::ADHESIVE).map(entry).collect();
    Ok(Value::from(entries.map_err(failed)?).to_string())
}

/// Which damping has a coefficient of normal restitution, for a law with a name or as JSON, and
/// what its code makes of the coefficient, as JSON.
#[pyfunction]
pub fn restitution(law: LawChoice, e_n: f64) -> PyResult<String> {
    let found = match stickslip_model::restitution::of(&law.0, e_n).map_err(bad_input)? {
        Some(found) => found,
        None => stickslip_model::restitution::of_law(law.law()?.0, e_n).map_err(bad_input)?,
    };
    serde_json::to_string(&found).map_err(failed)
}

/// A result with the layout `schema`, as the JSON that the program prints.
pub fn document(
    schema: &str,
    result: &impl serde::Serialize,
    engine: &Engine,
    statistics: Option<&Statistics>,
) -> PyResult<String> {
    stickslip_model::document::new(schema, result, engine, (None, statistics))
        .map(|document| Value::Object(document).to_string())
        .map_err(failed)
}

/// Carries out a command line of the program, which begins with its name: the exit code.
#[pyfunction]
pub fn program(py: Python<'_>, arguments: Vec<OsString>, output_is_closed: bool) -> u8 {
    if output_is_closed {
        stickslip_cli::note_closed_output();
    }
    py.detach(|| stickslip_cli::program(arguments))
}

/// The version of the package.
#[pyfunction]
pub fn version() -> &'static str {
    env!("CARGO_PKG_VERSION")
}

/// The explorer, a page of HTML, opened with a view.
#[pyfunction]
pub fn explorer(view: &str) -> String {
    stickslip_page::showing(view)
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
