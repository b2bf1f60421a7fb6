//! A study, computed, written into a directory, and summarised on standard output.

use std::fmt::Display;
use std::path::Path;

use stickslip_figure::pictures::studies::Picture;
use stickslip_files::output::directory::prepare;
use stickslip_files::output::study::write_study;
use stickslip_plane::progress::Report;
use stickslip_studies::{Study, StudyError};

use super::threads::ThreadsArguments;
use crate::error::Failure;
use crate::output::console::{print, say};

/// Makes a study with its pictures, writes its files into the directory `out`, and prints its
/// findings.
pub fn run(
    out: &Path,
    threads: ThreadsArguments,
    make: impl FnOnce(Report<'_>) -> Result<(Study, Vec<Picture>), StudyError> + Send,
) -> Result<(), Failure> {
    prepare(out)?;
    let (study, pictures) = threads.with_steps(make)??;
    write_study(&study, &pictures, out)?;
    print(|out| study.findings.iter().try_for_each(|line| writeln!(out, "{line}")))?;
    say(format_args!("wrote {}", out.display()));
    Ok(())
}

/// The failure of settings that are out of range. The settings have the names of the options.
pub fn refused(invalid: impl Display) -> Failure {
    let text = invalid.to_string();
    // What is no option is a thing: the law.
    Failure::Usage(if text.starts_with("the ") { text } else { format!("--{text}") })
}
