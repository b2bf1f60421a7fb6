//! What computes the collisions, as the options choose it.

use std::path::Path;

use stickslip_model::{Contact, Engine, Tolerances};

use crate::args::{Method, MethodArguments};
use crate::error::Failure;

/// The engine that the options choose for collisions with `--damping`.
///
/// # Errors
/// [`Failure::Usage`]: a tolerance would have no effect, or the exact solution is chosen with
/// damping.
pub fn engine(arguments: &MethodArguments, damping: Option<f64>) -> Result<Engine, Failure> {
    let (engine, damping) = (chosen(arguments)?, damping.unwrap_or(0.0));
    require_computable(engine, damping, &format!("--damping {damping:?}"))
        .map_err(Failure::Usage)?;
    Ok(engine)
}

/// The engine that the options choose for the bodies in `file`, whose damping time is
/// `damping_time_s`.
///
/// # Errors
/// [`Failure::Usage`]: a tolerance would have no effect. [`Failure::Input`]: the exact solution is
/// chosen with damping.
pub fn engine_for_bodies(
    arguments: &MethodArguments,
    file: &Path,
    damping_time_s: f64,
) -> Result<Engine, Failure> {
    let engine = chosen(arguments)?;
    let given = format!("surface.damping_time_s = {damping_time_s:?}");
    require_computable(engine, damping_time_s, &given)
        .map_err(|reason| Failure::input(file, reason))?;
    Ok(engine)
}

fn chosen(arguments: &MethodArguments) -> Result<Engine, Failure> {
    let tolerances = |default: Tolerances| Tolerances {
        rtol: arguments.rtol.unwrap_or(default.rtol),
        atol: arguments.atol.unwrap_or(default.atol),
    };
    match arguments.method {
        Method::Dop853 => return Ok(Engine::Dop853(tolerances(Tolerances::DOP853))),
        Method::Dopri5 => return Ok(Engine::Dopri5(tolerances(Tolerances::DOPRI5))),
        Method::Exact => {}
    }
    let unused = [("--rtol", arguments.rtol), ("--atol", arguments.atol)];
    if let Some((option, Some(value))) = unused.into_iter().find(|(_, value)| value.is_some()) {
        return Err(Failure::Usage(format!(
            "{option} {value:?} has no effect with --method exact, which has no tolerances; \
             expected with dop853 and dopri5 only"
        )));
    }
    Ok(Engine::Exact)
}

/// Refuses the exact solution for a damping with which there is none; the model tells which these
/// are.
fn require_computable(engine: Engine, damping: f64, given: &str) -> Result<(), String> {
    let has_exact_solution = |contact| Engine::Auto.resolved(&contact) == Engine::Exact;
    if engine != Engine::Exact || Contact::new(1.0, 1.0, damping).is_ok_and(has_exact_solution) {
        return Ok(());
    }
    Err(format!(
        "{given} cannot be used with --method exact, which holds without damping; expected 0, or \
         --method dop853 or dopri5"
    ))
}
