//! What computes the collisions, as the options choose it.

use clap::ValueEnum;
use stickslip_model::{Engine, InvalidChoice, Law};

use crate::args::{Method, MethodArguments};
use crate::error::Failure;

/// The engine that the options choose for collisions with a law and a tangential damping; `usual`
/// is the method if none is given.
///
/// # Errors
/// [`Failure::Usage`]: a tolerance would have no effect.
pub fn engine(
    arguments: &MethodArguments,
    usual: Method,
    law: (Law, f64),
) -> Result<Engine, Failure> {
    let MethodArguments { method, rtol, atol } = *arguments;
    let method = method.unwrap_or(usual).to_possible_value();
    let name = method.as_ref().map_or("", |value| value.get_name());
    Engine::chosen_for(law, name, rtol, atol).map_err(|invalid| {
        Failure::Usage(match invalid {
            InvalidChoice::Unused { name, value } => format!(
                "--{name} {value:?} has no effect with --method exact, which has no tolerances; \
                 expected with dop853 and dopri5 only"
            ),
            invalid => invalid.to_string(),
        })
    })
}
