//! What `impact` is to do.

use stickslip_model::{Encounter, Engine};

use super::engine::engine;
use crate::args::{Format, ImpactArguments, Method};
use crate::error::Failure;
use crate::input::{bodies, law};

/// An impact to be computed.
#[derive(Clone, Debug, PartialEq)]
pub struct ImpactPlan {
    /// The two bodies.
    pub encounter: Encounter,
    /// What computes their collision.
    pub engine: Engine,
    /// How the impact is printed.
    pub format: Format,
}

impl ImpactPlan {
    /// The plan that `arguments` make with the file that they name.
    ///
    /// # Errors
    /// [`Failure::Input`]: the file cannot be used. [`Failure::Usage`]: options contradict each
    /// other.
    pub fn new(arguments: &ImpactArguments) -> Result<Self, Failure> {
        let ImpactArguments { file, law, method, format } = arguments;
        let name = law.as_deref();
        let law = law::by_name_or_file(name)?;
        let encounter = bodies::read_encounter(file, law)?;
        let tangential_damping = encounter.contact().tangential_damping();
        law::permits(name, "tangential damping", tangential_damping)?;
        let engine = engine(method, Method::Dop853, (law, tangential_damping))?;
        Ok(Self { encounter, engine, format: *format })
    }
}
