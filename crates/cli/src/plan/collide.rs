//! What `collide` is to do.

use std::path::Path;

use stickslip_files::input::recipe::Given;
use stickslip_files::output::picture::PictureFile;
use stickslip_model::{Contact, Engine};

use super::batch::BatchFiles;
use super::collision::contact;
use super::course::CoursePlan;
use super::engine::engine;
use super::law::chosen_law;
use crate::args::{CollideArguments, CollisionArguments, Format, Method};
use crate::error::Failure;

/// The plan of `collide`.
#[derive(Clone, Debug, PartialEq)]
pub enum CollidePlan {
    /// One collision is printed.
    Single(SinglePlan),
    /// The collisions of a file are computed.
    Batch(BatchPlan),
}

/// One collision.
#[derive(Clone, Debug, PartialEq)]
pub struct SinglePlan {
    /// The parameters of the collision.
    pub contact: Contact,
    /// What computes it.
    pub engine: Engine,
    /// How it is printed.
    pub format: Format,
    /// The file of its picture, if it is drawn.
    pub plot: Option<PictureFile>,
    /// The file of its course, if it is wanted.
    pub course: Option<CoursePlan>,
    /// Whether the error is estimated.
    pub estimate: bool,
}

/// A file of collisions.
#[derive(Clone, Debug, PartialEq)]
pub struct BatchPlan {
    /// The file of the collisions, and those for the results.
    pub files: BatchFiles,
    /// Values that all rows have in common.
    pub given: Given,
    /// What computes the collisions.
    pub engine: Engine,
    /// Whether errors are estimated.
    pub estimate: bool,
}

impl CollidePlan {
    /// The plan that `arguments` make.
    ///
    /// # Errors
    /// [`Failure::Usage`] says which options contradict each other.
    pub fn new(arguments: &CollideArguments) -> Result<Self, Failure> {
        let CollisionArguments { mu, alpha, damping } = arguments.collision;
        let law = chosen_law(&arguments.law)?;
        let tangential_damping = arguments.law.tangential_damping;
        let chosen = (law, tangential_damping.unwrap_or(0.0));
        let engine = engine(&arguments.method, Method::Dop853, chosen)?;
        let given = Given {
            kappa: arguments.kappa,
            psi: arguments.psi,
            ratio: arguments.ratio,
            mu,
            alpha,
            damping,
            tangential_damping,
            law,
        };
        let law = ("--law", arguments.law.law.as_deref().map(Path::new));
        if let Some(files) = BatchFiles::new(&arguments.batch, &[law])? {
            let estimate = arguments.estimate;
            return Ok(Self::Batch(BatchPlan { files, given, engine, estimate }));
        }
        let plot = arguments.plot.clone();
        let picture = ("--plot", plot.as_ref().map(PictureFile::path));
        Ok(Self::Single(SinglePlan {
            contact: contact(&given)?,
            engine,
            format: arguments.format,
            course: CoursePlan::new(&arguments.course, &[picture], &[law])?,
            plot,
            estimate: arguments.estimate,
        }))
    }
}
