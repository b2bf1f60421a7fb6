//! The rows of a plane, ψ or the impact ratio, as the options give them.

use stickslip_model::Reduction;
use stickslip_plane::Range;
use stickslip_plane::atlas::RatioRange;

use crate::args::CollisionArguments;
use crate::error::Failure;
use crate::input::recipe::RecipeError;
use crate::plan::explain;

/// What the rows of a plane are.
pub enum Rows {
    /// The reduced impact ratio ψ.
    Psi(Range),
    /// The impact ratio g_t/g_n, with μ and α.
    Ratio(RatioRange),
}

impl Rows {
    /// The rows that the options make.
    ///
    /// # Errors
    /// [`Failure::Usage`]: ψ and the ratio are both given or neither is, or μ or α would have no effect.
    pub fn new(
        psi: Option<Range>,
        ratio: Option<Range>,
        collisions: CollisionArguments,
    ) -> Result<Self, Failure> {
        let CollisionArguments { mu, alpha, .. } = collisions;
        let refused = |error| Err(Failure::Usage(explain(error)));
        match (psi, ratio) {
            (Some(_), Some(_)) => refused(RecipeError::PsiAndRatio),
            (None, None) => refused(RecipeError::NoImpact),
            (Some(psi), None) => {
                match [("mu", mu), ("alpha", alpha)].iter().find(|x| x.1.is_some()) {
                    Some((name, _)) => refused(RecipeError::Unused { name }),
                    None => Ok(Self::Psi(psi)),
                }
            }
            (None, Some(range)) => {
                let usual = Reduction::default();
                let reduction =
                    Reduction { mu: mu.unwrap_or(usual.mu), alpha: alpha.unwrap_or(usual.alpha) };
                Ok(Self::Ratio(RatioRange { range, reduction }))
            }
        }
    }
}
