//! What `run` is to do.

use std::path::PathBuf;

use stickslip_expression::{Runnable, System};
use stickslip_files::output::picture::PictureFile;
use stickslip_solver::{EmbeddedPair, Options};

use super::files::require_different;
use super::system::SystemRun;
use crate::args::{Format, RunArguments};
use crate::error::Failure;

/// A run of a system.
#[derive(Debug)]
pub struct RunPlan {
    /// The system.
    pub system: System,
    /// Its name in titles.
    pub name: String,
    /// The values of its parameters.
    pub parameters: Vec<f64>,
    /// The system with these values.
    pub runnable: Runnable,
    /// Where the run ends.
    pub end: f64,
    /// The method.
    pub method: EmbeddedPair,
    /// The options of the run.
    pub options: Options,
    /// How it is printed.
    pub format: Format,
    /// The file of its events.
    pub events: Option<PathBuf>,
    /// The file of its course, and the number of even times.
    pub course: Option<(PathBuf, usize)>,
    /// The file of its picture.
    pub plot: Option<PictureFile>,
}

impl RunPlan {
    /// The plan that `arguments` make.
    ///
    /// # Errors
    /// [`Failure`]: the system cannot be read, or options do not fit it.
    pub fn new(arguments: &RunArguments) -> Result<Self, Failure> {
        let RunArguments { set, events, course, plot, .. } = arguments;
        let outputs = [
            ("--events", events.as_deref()),
            ("--course", course.as_deref()),
            ("--plot", plot.as_ref().map(PictureFile::path)),
        ];
        require_different(&outputs, &[("the system", Some(&*arguments.system))])?;
        let SystemRun { name, system, parameters, runnable, end } =
            SystemRun::new(&arguments.system, set, arguments.end)?;
        let defaults = Options::default();
        let options = Options {
            rtol: arguments.rtol.unwrap_or(defaults.rtol),
            atol: arguments.atol.unwrap_or(defaults.atol),
            ..defaults
        };
        Ok(Self {
            name,
            parameters,
            runnable,
            end,
            method: arguments.pair(),
            options,
            format: arguments.format,
            events: events.clone(),
            course: course.clone().map(|path| (path, arguments.points as usize)),
            plot: plot.clone(),
            system,
        })
    }
}
