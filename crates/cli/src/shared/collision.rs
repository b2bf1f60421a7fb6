//! The parameters of collisions as options, and what is wrong with options that make none.

use stickslip_files::input::parameter::Parameter;
use stickslip_files::input::recipe::{Given, ImpactParameter, Recipe, RecipeError};
use stickslip_model::{Contact, Law, Reduction, restitution};
use stickslip_plane::Range;
use stickslip_plane::atlas::RatioRange;

use crate::error::Failure;

/// The parameters of collisions beside κ and ψ. Each command shows them under a heading of its own.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct CollisionArguments {
    /// Coefficient of friction μ, with --ratio; 0 or above [default: 0.4]
    #[arg(long, value_name = "M", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Mu.parse(text))]
    pub mu: Option<f64>,

    /// Tangential inertia α, with --ratio; above 0, at most 1 [default: 2/7, homogeneous spheres]
    #[arg(long, value_name = "A", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Alpha.parse(text))]
    pub alpha: Option<f64>,

    /// Scaled damping a = A β^⅖ g_n^⅕ of the normal force; 0 or above [default: 0]
    #[arg(long, value_name = "D", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Damping.parse(text))]
    pub damping: Option<f64>,

    /// Coefficient of normal restitution, instead of --damping; above 0, at most 1
    #[arg(long, value_name = "E", allow_hyphen_values = true, conflicts_with = "damping")]
    #[arg(value_parser = |text: &str| Parameter::NormalRestitution.parse(text))]
    pub e_n: Option<f64>,
}

impl CollisionArguments {
    /// The scaled damping that the options give; without them 0.
    pub fn damping(&self, law: Law) -> Result<f64, Failure> {
        match self.e_n {
            Some(e_n) => damping_for(law, e_n),
            None => Ok(self.damping.unwrap_or(0.0)),
        }
    }
}

/// The scaled damping with which a law has a coefficient of normal restitution.
pub fn damping_for(law: Law, e_n: f64) -> Result<f64, Failure> {
    restitution::damping(law, e_n).map_err(|error| Failure::Usage(format!("--e-n: {error}")))
}

/// The parameters of the collision that options give.
pub fn contact(given: &Given) -> Result<Contact, Failure> {
    let recipe = Recipe::new(given, |_| None).map_err(refused)?;
    recipe.contact(|_| &[]).map_err(Failure::Usage)
}

/// An interval of ψ or of the impact ratio.
pub enum ImpactRange {
    /// The reduced impact ratio ψ.
    Psi(Range),
    /// The impact ratio g_t/g_n, with μ and α.
    Ratio(RatioRange),
}

/// The intervals of κ and of ψ or the impact ratio that options give.
pub fn window(
    kappa: Option<Range>,
    psi_or_ratio: (Option<Range>, Option<Range>),
    collisions: CollisionArguments,
) -> Result<(Range, ImpactRange), Failure> {
    let CollisionArguments { mu, alpha, .. } = collisions;
    let kappa = kappa.ok_or(RecipeError::NoKappa).map_err(refused)?;
    let impact = match ImpactParameter::new(psi_or_ratio, (mu, alpha)).map_err(refused)? {
        ImpactParameter::Psi(psi) => ImpactRange::Psi(psi),
        ImpactParameter::Ratio(range) => {
            let reduction = reduction(mu, alpha);
            if reduction.mu == 0.0 {
                let expected = "expected --mu above 0: without friction ε_t is 1 everywhere";
                return Err(Failure::Usage(format!("--mu 0 with an interval; {expected}")));
            }
            ImpactRange::Ratio(RatioRange { range, reduction })
        }
    };
    Ok((kappa, impact))
}

/// μ and α, as given or as usual.
pub fn reduction(mu: Option<f64>, alpha: Option<f64>) -> Reduction {
    let usual = Reduction::default();
    Reduction { mu: mu.unwrap_or(usual.mu), alpha: alpha.unwrap_or(usual.alpha) }
}

/// The failure of options that do not make a collision, or an interval of collisions.
fn refused(error: RecipeError) -> Failure {
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
        RecipeError::DampingTwice => {
            "--damping and --e-n are both given; expected one of them".to_owned()
        }
        RecipeError::Unused { name } => {
            format!("--{name} has no effect with --psi; expected with --ratio only")
        }
    })
}
