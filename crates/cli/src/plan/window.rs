//! Intervals of κ and of ψ or the impact ratio, as options give them.

use stickslip_files::input::recipe::{ImpactParameter, RecipeError};
use stickslip_model::Reduction;
use stickslip_plane::Range;
use stickslip_plane::atlas::RatioRange;

use super::collision::refused;
use crate::args::CollisionArguments;
use crate::error::Failure;

/// Both intervals.
pub struct KappaWindow {
    /// The interval of κ.
    pub kappa: Range,
    /// The interval of ψ or of the impact ratio.
    pub impact: ImpactRange,
}

/// The interval of ψ or of the impact ratio.
pub enum ImpactRange {
    /// The reduced impact ratio ψ.
    Psi(Range),
    /// The impact ratio g_t/g_n, with μ and α.
    Ratio(RatioRange),
}

impl KappaWindow {
    /// The window that the options make.
    ///
    /// # Errors
    /// [`Failure::Usage`]: κ is missing, exactly one of ψ and the ratio is not given, or μ or α
    /// would have no effect.
    pub fn new(
        kappa: Option<Range>,
        psi: Option<Range>,
        ratio: Option<Range>,
        collisions: CollisionArguments,
    ) -> Result<Self, Failure> {
        let CollisionArguments { mu, alpha, .. } = collisions;
        let kappa = kappa.ok_or(RecipeError::NoKappa).map_err(refused)?;
        let impact = match ImpactParameter::new((psi, ratio), (mu, alpha)).map_err(refused)? {
            ImpactParameter::Psi(psi) => ImpactRange::Psi(psi),
            ImpactParameter::Ratio(range) => {
                let usual = Reduction::default();
                let reduction =
                    Reduction { mu: mu.unwrap_or(usual.mu), alpha: alpha.unwrap_or(usual.alpha) };
                ImpactRange::Ratio(RatioRange { range, reduction })
            }
        };
        Ok(Self { kappa, impact })
    }
}
