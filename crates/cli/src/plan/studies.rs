//! What the studies are to do.

use stickslip_studies::{convergence, stiff_springs};

use crate::args::{AsymptoteArguments, CollisionArguments, ConvergeArguments};
use crate::error::Failure;
use crate::input::recipe::{Given, Recipe};
use crate::plan::explain;

/// The study of convergence that `arguments` make.
///
/// # Errors
/// [`Failure::Usage`] says which options do not go together.
pub fn convergence(arguments: &ConvergeArguments) -> Result<convergence::Settings, Failure> {
    let ConvergeArguments { kappa, psi, ratio, collision, .. } = *arguments;
    let CollisionArguments { mu, alpha, damping } = collision;
    if [kappa, psi, ratio, mu, alpha].iter().all(Option::is_none) {
        let usual = convergence::Settings::usual(damping.unwrap_or(0.0));
        return usual.map_err(|invalid| Failure::Usage(invalid.to_string()));
    }
    let given = Given { kappa, psi, ratio, mu, alpha, damping };
    let recipe = Recipe::new(&given, |_| None).map_err(|e| Failure::Usage(explain(e)))?;
    let contact = recipe.contact(|_| &[]).map_err(|e| Failure::Usage(e.to_string()))?;
    Ok(convergence::Settings { contacts: vec![contact] })
}

/// The study of stiff springs that `arguments` make.
pub fn stiff_springs(arguments: &AsymptoteArguments) -> stiff_springs::Settings {
    stiff_springs::Settings { kappa: arguments.kappa, psi: arguments.psi.clone() }
}
