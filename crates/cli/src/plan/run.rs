//! What `run` is to do.

use std::path::{Path, PathBuf};

use stickslip_expression::{Runnable, System};
use stickslip_files::input::source;
use stickslip_files::output::picture::PictureFile;
use stickslip_solver::{EmbeddedPair, Options};

use super::files::require_different;
use crate::args::{Format, RunArguments};
use crate::error::Failure;

/// The largest text of a system, in bytes.
const MOST_TEXT: u64 = 100_000_000;

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

/// Reads a system, and its text.
///
/// # Errors
/// [`Failure::File`]: it cannot be read, or is no system.
pub fn read(path: &Path) -> Result<(System, String), Failure> {
    let text = source::read(path, MOST_TEXT)?;
    let shown = source::shown(path);
    let text =
        String::from_utf8(text).map_err(|_| Failure::input(shown, "is not a text in UTF-8"))?;
    let refused = |error| Failure::Text { path: shown.to_owned(), error };
    let system = System::parse(&text).map_err(refused)?;
    Ok((system, text))
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
        let (system, _) = read(&arguments.system)?;
        let mut parameters = system.values();
        for (name, value) in set {
            let place = system.parameters.iter().position(|it| it.name == *name);
            let Some(place) = place else {
                let names: Vec<_> = system.parameters.iter().map(|it| it.name.as_str()).collect();
                let known = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
                let message =
                    format!("--set {name}: the system has no such parameter; it has {known}");
                return Err(Failure::Usage(message));
            };
            parameters[place] = *value;
        }
        let runnable =
            system.with(&parameters).map_err(|error| Failure::Usage(error.to_string()))?;
        let end = arguments.end.unwrap_or(runnable.end());
        if end.is_nan() || end <= runnable.start().s {
            let start = runnable.start().s;
            return Err(Failure::Usage(format!(
                "the run ends at {end}; expected an end after {start}"
            )));
        }
        if end.is_infinite() && !system.ends_itself() {
            let message = "the system says no end; expected --end, `end = …`, or a rule -> end";
            return Err(Failure::Usage(message.to_owned()));
        }
        let defaults = Options::default();
        let options = Options {
            rtol: arguments.rtol.unwrap_or(defaults.rtol),
            atol: arguments.atol.unwrap_or(defaults.atol),
            ..defaults
        };
        let name = source::shown(&arguments.system).file_stem();
        Ok(Self {
            name: name.map_or_else(String::new, |it| it.to_string_lossy().into_owned()),
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
