//! What can go wrong, and its exit code.

use std::fmt::Display;
use std::io;
use std::path::{Path, PathBuf};

use stickslip_files::FileError;
use stickslip_model::CollisionFailure;
use stickslip_orbits::OrbitError;
use stickslip_plane::atlas::AtlasError;
use stickslip_plane::sweep::FailedPoints;
use stickslip_practice::fit::FitError;
use stickslip_practice::tables::TableError;
use stickslip_practice::time_steps::TimeStepsError;
use stickslip_reproduction::ReproductionError;
use stickslip_studies::StudyError;

/// The reason why the program did not do what it was asked.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// An option is out of range, or the options contradict each other.
    #[error("{0}")]
    Usage(String),
    /// A file cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A collision cannot be computed.
    #[error(transparent)]
    Collision(#[from] CollisionFailure),
    /// Some rows of a batch have no result.
    #[error(
        "{failed} of {rows} rows could not be computed; \
         the column status of {} says why", path.display()
    )]
    Rows {
        /// The number of rows without a result.
        failed: u64,
        /// The number of all rows.
        rows: u64,
        /// The output file.
        path: PathBuf,
    },
    /// Some points of a map have no result.
    #[error(
        "{} of {points} points could not be computed and are {shown} in {}; the first, {failed}",
        failed.points, path.display()
    )]
    Points {
        /// The points without a result.
        failed: Box<FailedPoints>,
        /// The number of all points.
        points: usize,
        /// How they are shown.
        shown: &'static str,
        /// The output file.
        path: PathBuf,
    },
    /// Some runs of a map of a system have no result.
    #[error("{failed} of {points} runs failed and are {shown} in {}", path.display())]
    Runs {
        /// The number of runs without a result.
        failed: usize,
        /// The number of all runs.
        points: usize,
        /// How they are shown.
        shown: &'static str,
        /// The output file.
        path: PathBuf,
    },
    /// A page was written, and no browser opens it.
    #[error("no browser opens {}: {error}", path.display())]
    Browser {
        /// The page.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// Boundaries cannot be traced.
    #[error("the boundaries cannot be traced: {0}")]
    Trace(AtlasError),
    /// Boundaries of a system of one's own cannot be traced.
    #[error("the boundaries cannot be traced: {0}")]
    Family(String),
    /// A study has no result.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A text is no system.
    #[error("{}: {error}", path.display())]
    Text {
        /// The file.
        path: PathBuf,
        /// Where it is wrong, and how.
        error: stickslip_expression::TextError,
    },
    /// There is no orbit, or no branch.
    #[error("{0}")]
    Orbit(OrbitError),
    /// A run of a system failed.
    #[error("the run failed: {0}")]
    Run(String),
    /// Errors of time steps cannot be measured.
    #[error(transparent)]
    TimeSteps(#[from] TimeStepsError),
    /// There is no fit.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// There is no table.
    #[error("there is no table: {0}")]
    Table(TableError),
    /// A part of the reproduction has no result.
    #[error(transparent)]
    Reproduction(#[from] ReproductionError),
    /// Something speaks against a result of `reproduce`.
    #[error("{0}")]
    Objection(String),
    /// Something speaks against a result.
    #[error("{}: the {what} complete, but may be wrong: {reason}", path.display())]
    Doubtful {
        /// The output file.
        path: PathBuf,
        /// What the result is called, and its verb: `atlas is`.
        what: &'static str,
        /// What speaks against it.
        reason: String,
    },
    /// Some points could not be located in an atlas.
    #[error(
        "{failed} of {rows} points could not be located and have no switches in {}; \
         the first, {first}", path.display()
    )]
    Unlocated {
        /// The number of points that could not be located.
        failed: u64,
        /// The number of all points.
        rows: u64,
        /// The output file.
        path: PathBuf,
        /// The first of them, and why it could not be located.
        first: String,
    },
    /// A point could not be located in an atlas.
    #[error("{0}")]
    NotLocated(String),
    /// Standard output cannot be written.
    #[error("standard output: cannot be written: {0}")]
    Stdout(io::Error),
    /// The threads cannot be started.
    #[error("--threads: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

impl Failure {
    /// An input file that cannot be used.
    pub fn input(path: &Path, reason: impl Display) -> Self {
        FileError::input(path, reason).into()
    }

    /// An output file that cannot be written.
    pub fn output(path: &Path, source: impl Into<io::Error>) -> Self {
        FileError::output(path, source).into()
    }

    /// The failure of a complete file against which something speaks, if there is an `objection`.
    pub(crate) fn if_doubtful(
        path: &Path,
        what: &'static str,
        objection: Option<String>,
    ) -> Result<(), Self> {
        match objection {
            Some(reason) => Err(Self::Doubtful { path: path.to_owned(), what, reason }),
            None => Ok(()),
        }
    }

    /// Whether the options are wrong.
    pub fn is_usage(&self) -> bool {
        matches!(self, Self::Usage(_) | Self::File(FileError::Option(_)))
    }

    /// The exit code: 2 for bad usage or input, 1 for everything that fails later.
    pub fn code(&self) -> u8 {
        match self {
            Self::Usage(_)
            | Self::Text { .. }
            | Self::File(FileError::Option(_) | FileError::Input { .. }) => 2,
            _ => 1,
        }
    }
}

impl From<TableError> for Failure {
    /// The failure of a table whose window comes from options.
    fn from(error: TableError) -> Self {
        match error {
            TableError::Settings(_) => Self::Usage(error.to_string()),
            TableError::Atlas(error) => error.into(),
            error => Self::Table(error),
        }
    }
}

impl From<AtlasError> for Failure {
    /// The failure of an atlas whose window comes from options.
    fn from(error: AtlasError) -> Self {
        match error {
            AtlasError::Parameter(_) | AtlasError::Unverifiable(_) => {
                Self::Usage(error.to_string())
            }
            AtlasError::Tolerance { .. } => Self::Usage(format!("--tolerance: {error}")),
            error => Self::Trace(error),
        }
    }
}
