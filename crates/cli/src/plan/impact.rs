//! What `impact` is to do.

use std::path::Path;

use stickslip_files::input::bodies::{self, ImpactReading, Velocities, VelocitiesError};
use stickslip_files::input::law;
use stickslip_files::input::source::is_standard_input;
use stickslip_model::{Encounter, Engine, Law};

use super::batch::BatchFiles;
use super::course::CoursePlan;
use super::engine::engine;
use crate::args::{Format, ImpactArguments, Method, MethodArguments, VelocityArguments};
use crate::error::Failure;

/// The plan of `impact`.
#[derive(Clone)]
pub enum ImpactPlan {
    /// One impact is printed.
    Single(Box<SingleImpact>),
    /// The impacts of a file are computed.
    Batch(Box<ImpactBatch>),
}

/// An impact to be computed.
#[derive(Clone, Debug, PartialEq)]
pub struct SingleImpact {
    /// The two bodies.
    pub encounter: Encounter,
    /// What computes their collision.
    pub engine: Engine,
    /// How the impact is printed.
    pub format: Format,
    /// The file of its course, if it is wanted.
    pub course: Option<CoursePlan>,
}

/// A file of impacts.
#[derive(Clone)]
pub struct ImpactBatch {
    /// The file of the impacts, and those for the results.
    pub files: BatchFiles,
    /// The bodies, which rows change.
    pub bodies: ImpactReading,
    /// The velocities that all rows have in common.
    pub velocities: [Option<f64>; 4],
    /// What computes the collisions.
    pub engines: Engines,
}

/// What computes impacts under a law, whatever their tangential damping.
#[derive(Clone, Debug, PartialEq)]
pub struct Engines {
    /// The name of the law, or its file, if it is given.
    name: Option<String>,
    /// Without tangential damping, and with it.
    engines: [Engine; 2],
}

impl Engines {
    /// The engines that options choose.
    ///
    /// # Errors
    /// [`Failure::Usage`]: a tolerance would have no effect.
    fn new(name: Option<&str>, law: Law, method: &MethodArguments) -> Result<Self, Failure> {
        let engine = |damping| engine(method, Method::Dop853, (law, damping));
        Ok(Self { name: name.map(str::to_owned), engines: [engine(0.0)?, engine(1.0)?] })
    }

    /// The engine for an encounter.
    ///
    /// # Errors
    /// [`Failure::Usage`]: the law has no tangential damping.
    pub fn of(&self, encounter: &Encounter) -> Result<Engine, Failure> {
        let damping = encounter.contact().tangential_damping();
        law::permits(self.name.as_deref(), "tangential damping", damping)?;
        Ok(self.engines[usize::from(damping != 0.0)])
    }
}

impl ImpactPlan {
    /// The plan that `arguments` make with the files that they name.
    ///
    /// # Errors
    /// [`Failure::File`]: a file cannot be used. [`Failure::Usage`]: options contradict each
    /// other.
    pub fn new(arguments: &ImpactArguments) -> Result<Self, Failure> {
        let ImpactArguments { file, bodies, .. } = arguments;
        let name = arguments.law.as_deref();
        let law_file = ("--law", name.map(Path::new));
        let batch = [("--bodies", bodies.as_deref()), law_file];
        let files = BatchFiles::new(&arguments.batch, &batch)?;
        let inputs = [("FILE.json", file.as_deref()), law_file];
        let course = CoursePlan::new(&arguments.course, &[], &inputs)?;
        let VelocityArguments { normal, tangential, speed, angle } = arguments.velocities;
        let velocities = [normal, tangential, speed, angle];
        let given = Velocities::new(velocities);
        let law = law::by_name_or_file(name)?;
        let engines = Engines::new(name, law, &arguments.method)?;
        if let Some(files) = files {
            let Some(bodies) = bodies else {
                let reason =
                    "--batch is given without --bodies; expected the JSON file of the bodies";
                return Err(Failure::Usage(reason.to_owned()));
            };
            if is_standard_input(bodies) && is_standard_input(&files.input) {
                let both = "--bodies - and --batch - are both standard input; expected one of them";
                return Err(Failure::Usage(both.to_owned()));
            }
            if given == Err(VelocitiesError::Both) {
                return Err(refused(VelocitiesError::Both));
            }
            let bodies = ImpactReading::of_file(bodies, law)?;
            return Ok(Self::Batch(Box::new(ImpactBatch { files, bodies, velocities, engines })));
        }
        let file = file.as_deref().unwrap_or(Path::new("-"));
        let encounter = bodies::read_encounter(file, law, given.map_err(refused)?)?;
        let engine = engines.of(&encounter)?;
        let format = arguments.format;
        Ok(Self::Single(Box::new(SingleImpact { encounter, engine, format, course })))
    }
}

/// The failure of options that are no velocities.
fn refused(error: VelocitiesError) -> Failure {
    const NAMES: [&str; 4] = ["--normal", "--tangential", "--speed", "--angle"];
    Failure::Usage(match error {
        VelocitiesError::Both => {
            "--normal or --tangential and --speed or --angle are both given; expected --normal with \
             --tangential, or --speed with --angle"
                .to_owned()
        }
        VelocitiesError::Half { given, missing } => {
            format!("{} is given without {}; expected both", NAMES[given], NAMES[missing])
        }
    })
}
