//! What `collide` is to do.

use std::path::PathBuf;

use stickslip_model::{Contact, Engine};

use super::collision::contact;
use super::engine::engine;
use super::files::require_different;
use crate::args::{CollideArguments, CollisionArguments, Format, Method};
use crate::error::Failure;
use crate::input::law;
use crate::input::recipe::Given;
use crate::output::picture::PictureFile;

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
    /// Whether the error is estimated.
    pub estimate: bool,
}

/// A file of collisions.
#[derive(Clone, Debug, PartialEq)]
pub struct BatchPlan {
    /// The file of the collisions.
    pub input: PathBuf,
    /// The file for the results.
    pub out: PathBuf,
    /// The file for the switches, if they are wanted.
    pub events: Option<PathBuf>,
    /// Values that all rows have in common.
    pub given: Given,
    /// What computes the collisions.
    pub engine: Engine,
    /// The number of threads; `None` is one for each core.
    pub threads: Option<u16>,
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
        let law = law::chosen(&arguments.law)?;
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
        let (Some(input), Some(out)) = (&arguments.batch, &arguments.out) else {
            let contact = contact(&given)?;
            let (format, plot) = (arguments.format, arguments.plot.clone());
            let estimate = arguments.estimate;
            return Ok(Self::Single(SinglePlan { contact, engine, format, plot, estimate }));
        };
        let events = arguments.events.as_ref();
        require_different(
            &[("--out", Some(out)), ("--events", arguments.events.as_deref())],
            &[("--batch", Some(input))],
        )?;
        Ok(Self::Batch(BatchPlan {
            input: input.clone(),
            out: out.clone(),
            events: events.cloned(),
            given,
            engine,
            threads: arguments.threads,
            estimate: arguments.estimate,
        }))
    }
}
