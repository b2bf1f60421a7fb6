//! The program `stickslip`: a command checks its options and carries them out, and the result
//! becomes an exit code.
//!
//! It is a library so that the Python package has the program too, and tests and fuzz targets carry
//! out command lines without starting a process for each.
//!
//! Start reading here; then, in this order: `commands` (one file for each), `shared` (options that
//! several commands have, and what they lead to), `output` (what is shown), `page` (the page of
//! `reproduce`), `version` and `schema` (the program about itself), `error` (what can go wrong, and
//! the exit codes). What is read from files and written to them is in the crate `stickslip-files`.

#![allow(clippy::missing_errors_doc, reason = "errors of the program are sentences for its user")]

mod commands;
mod error;
mod output;
mod page;
mod schema;
mod shared;
mod version;

use std::ffi::OsString;
use std::io;
use std::process::ExitCode;

use clap::{CommandFactory, Parser};

use commands::Arguments;
pub use commands::reproduce::write_everything;
pub use error::Failure;
use output::console::say;
pub use stickslip_files::FileError;
pub use stickslip_files::output::file::note_closed_output;
use stickslip_files::output::file::standard_output;
use version::NAME;

/// Carries out the command line of this process and reports what went wrong.
pub fn main() -> ExitCode {
    ExitCode::from(program(std::env::args_os()))
}

/// Carries out a command line, which begins with the program's name, and reports what went wrong:
/// the exit code.
pub fn program(arguments: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> u8 {
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(reply) => return answer(&reply),
    };
    #[cfg(unix)]
    if let Err(error) = stickslip_files::output::partial::remove_on_signals() {
        say(format_args!("warning: signals cannot be watched: {error}"));
    }
    match arguments.command.run() {
        Ok(()) => 0,
        Err(failure) => {
            say(format_args!("error: {failure}"));
            if failure.is_usage() {
                say("\nFor more information, try '--help'.");
            }
            failure.code()
        }
    }
}

/// Shows a help text, the version, or what is wrong with the arguments.
fn answer(reply: &clap::Error) -> u8 {
    if reply.use_stderr() {
        // If standard error is closed, nobody wants to know.
        let _ = reply.print();
        return u8::try_from(reply.exit_code()).unwrap_or(2);
    }
    match standard_output().and_then(|_| reply.print()) {
        // Nobody may read the help text any more. That is not a failure.
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            let failure = Failure::Stdout(error);
            say(format_args!("error: {failure}"));
            failure.code()
        }
        _ => 0,
    }
}

/// Carries out a command line, which begins with the program's name, and reports nothing.
pub fn run(
    arguments: impl IntoIterator<Item = impl Into<OsString> + Clone>,
) -> Result<(), Failure> {
    let arguments =
        Arguments::try_parse_from(arguments).map_err(|reply| Failure::Usage(reply.to_string()))?;
    arguments.command.run()
}

/// All commands with their options and help texts.
pub fn commands() -> clap::Command {
    Arguments::command()
}
