//! Studies, each computed, written into a directory, and summed up on standard output.

use std::io::{self, Write};
use std::path::Path;

use stickslip_plane::progress::Report;
use stickslip_studies::{Study, StudyError};

use crate::error::Failure;
use crate::output::progress::{Bar, threads};
use crate::output::study::{prepare, write_study};

/// Makes a study on `count` threads, `None` being one for each core, writes its files into
/// `directory` and prints its findings.
///
/// # Errors
/// Files cannot be written, which is tried first, or `make` fails.
pub fn run(
    directory: &Path,
    count: Option<u16>,
    make: impl FnOnce(Report<'_>) -> Result<Study, StudyError> + Send,
) -> Result<(), Failure> {
    prepare(directory)?;
    let bar = Bar::steps();
    let study = threads(count)?.install(|| make(&|progress| bar.report(progress)));
    bar.finish();
    let study = study.map_err(Failure::of_settings)?;
    write_study(&study, directory)?;
    let mut out = io::stdout().lock();
    Failure::unless_written(study.findings.iter().try_for_each(|line| writeln!(out, "{line}")))
}
