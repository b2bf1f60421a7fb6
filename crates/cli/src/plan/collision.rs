//! One collision from options, and what is wrong with options that do not make one.

use stickslip_files::input::recipe::{Given, Recipe, RecipeError};
use stickslip_model::Contact;

use crate::error::Failure;

/// The parameters of the collision that options give.
///
/// # Errors
/// [`Failure::Usage`]: the options do not make a collision.
pub fn contact(given: &Given) -> Result<Contact, Failure> {
    let recipe = Recipe::new(given, |_| None).map_err(refused)?;
    recipe.contact(|_| &[]).map_err(|error| Failure::Usage(error.to_string()))
}

/// The failure of options that do not make a collision, or an interval of collisions.
pub fn refused(error: RecipeError) -> Failure {
    Failure::Usage(match error {
        RecipeError::NoKappa => {
            "--kappa is missing; expected --kappa with exactly one of --psi and --ratio".to_owned()
        }
        RecipeError::NoImpact => {
            "neither --psi nor --ratio is given; expected exactly one of them".to_owned()
        }
        RecipeError::PsiAndRatio => {
            "--psi and --ratio are both given; expected exactly one of them".to_owned()
        }
        RecipeError::GivenTwice { name } => format!("--{name} is given twice; expected it once"),
        RecipeError::Unused { name } => {
            format!("--{name} has no effect with --psi; expected with --ratio only")
        }
    })
}
