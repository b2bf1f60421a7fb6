//! What the options mean together: raw arguments become a plan that can be carried out.

mod locate;
mod map;
mod reproduce;
mod studies;
mod trace;
mod window;

use std::fs;
use std::path::{Path, PathBuf};

use stickslip_model::Contact;

use crate::args::{CollideArguments, CollisionArguments, Format};
use crate::error::Failure;
use crate::input::recipe::{Given, Recipe, RecipeError};
use crate::output::picture::PictureFile;
use stickslip_model::Engine;

pub use locate::LocatePlan;
pub use map::{MapFormat, MapPlan};
pub use reproduce::{PagePlan, ReproducePlan, StatementsPlan};
pub use studies::{convergence, stiff_springs};
pub use trace::TracePlan;

/// What `collide` is to do.
#[derive(Clone, Debug, PartialEq)]
pub enum CollidePlan {
    /// One collision to standard output.
    Single(SingleCollision),
    /// A file of collisions.
    Batch(Batch),
}

/// One collision.
#[derive(Clone, Debug, PartialEq)]
pub struct SingleCollision {
    /// Its parameters.
    pub contact: Contact,
    /// What computes it.
    pub engine: Engine,
    /// How it is printed.
    pub format: Format,
    /// Where it is drawn, if it is.
    pub plot: Option<PictureFile>,
}

/// A file of collisions.
#[derive(Clone, Debug, PartialEq)]
pub struct Batch {
    /// Where they are.
    pub input: PathBuf,
    /// Where the results go.
    pub out: PathBuf,
    /// Where the switches go, if they are wanted.
    pub events: Option<PathBuf>,
    /// Values for all rows.
    pub given: Given,
    /// What computes them.
    pub engine: Engine,
    /// Number of threads; `None` is one for each core.
    pub threads: Option<u16>,
}

impl CollidePlan {
    /// The plan that `arguments` make.
    ///
    /// # Errors
    /// [`Failure::Usage`] says which options do not go together.
    pub fn new(arguments: &CollideArguments) -> Result<Self, Failure> {
        let CollisionArguments { mu, alpha, damping } = arguments.collision;
        let engine = arguments.method.engine(damping)?;
        let given = Given {
            kappa: arguments.kappa,
            psi: arguments.psi,
            ratio: arguments.ratio,
            mu,
            alpha,
            damping,
        };
        let (Some(input), Some(out)) = (&arguments.batch, &arguments.out) else {
            let recipe = Recipe::new(&given, |_| None).map_err(|e| Failure::Usage(explain(e)))?;
            let contact = recipe.contact(|_| &[]).map_err(|e| Failure::Usage(e.to_string()))?;
            let (format, plot) = (arguments.format, arguments.plot.clone());
            return Ok(Self::Single(SingleCollision { contact, engine, format, plot }));
        };
        let events = arguments.events.as_ref();
        require_different(("--out", out), ("--batch", input))?;
        if let Some(events) = events {
            require_different(("--events", events), ("--batch", input))?;
            require_different(("--events", events), ("--out", out))?;
        }
        Ok(Self::Batch(Batch {
            input: input.clone(),
            out: out.clone(),
            events: events.cloned(),
            given,
            engine,
            threads: arguments.threads,
        }))
    }
}

/// What is wrong with the options that give a collision.
fn explain(error: RecipeError) -> String {
    match error {
        RecipeError::NoKappa => "--kappa is missing".to_owned(),
        RecipeError::NoImpact => {
            "neither --psi nor --ratio is given; expected exactly one of them".to_owned()
        }
        RecipeError::PsiAndRatio => {
            "--psi and --ratio are both given; expected exactly one of them".to_owned()
        }
        RecipeError::GivenTwice { name } => format!("--{name} is given twice"),
        RecipeError::Unused { name } => {
            format!("--{name} has no effect with --psi; accepted with --ratio only")
        }
    }
}

fn require_different(output: (&str, &Path), other: (&str, &Path)) -> Result<(), Failure> {
    if identity(output.1) != identity(other.1) {
        return Ok(());
    }
    Err(Failure::Usage(format!(
        "{} {} is the same file as {}; expected a file of its own",
        output.0,
        output.1.display(),
        other.0
    )))
}

/// The file that `path` names, whether it exists or not.
fn identity(path: &Path) -> PathBuf {
    if let Ok(existing) = fs::canonicalize(path) {
        return existing;
    }
    let parent = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    match (fs::canonicalize(parent), path.file_name()) {
        (Ok(parent), Some(name)) => parent.join(name),
        _ => path.to_owned(),
    }
}
