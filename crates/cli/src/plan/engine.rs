//! What computes the collisions, as the options choose it.

use stickslip_model::{Engine, Tolerances};

use crate::args::{Method, MethodArguments};
use crate::error::Failure;

/// The engine that the options choose; `usual` is the method if none is given.
///
/// `auto` is the exact solution, whose range contains that of the integrators, unless a tolerance
/// asks for an integration.
///
/// # Errors
/// [`Failure::Usage`]: a tolerance would have no effect.
pub fn engine(arguments: &MethodArguments, usual: Method) -> Result<Engine, Failure> {
    let tolerances = |default: Tolerances| Tolerances {
        rtol: arguments.rtol.unwrap_or(default.rtol),
        atol: arguments.atol.unwrap_or(default.atol),
    };
    let given = [("--rtol", arguments.rtol), ("--atol", arguments.atol)];
    let given = given.into_iter().find_map(|(option, value)| Some((option, value?)));
    match (arguments.method.unwrap_or(usual), given) {
        (Method::Dop853, _) | (Method::Auto, Some(_)) => {
            Ok(Engine::Dop853(tolerances(Tolerances::DOP853)))
        }
        (Method::Dopri5, _) => Ok(Engine::Dopri5(tolerances(Tolerances::DOPRI5))),
        (Method::Exact | Method::Auto, None) => Ok(Engine::Exact),
        (Method::Exact, Some((option, value))) => Err(Failure::Usage(format!(
            "{option} {value:?} has no effect with --method exact, which has no tolerances; \
             expected with dop853 and dopri5 only"
        ))),
    }
}
