//! Scripts that complete commands and options in a shell.

use std::io::{self, Write};

use clap::CommandFactory;

use crate::args::{Arguments, CompletionsArguments};
use crate::error::Failure;

/// Prints the script for a shell.
///
/// # Errors
/// Standard output cannot be written.
pub fn run(arguments: CompletionsArguments) -> Result<(), Failure> {
    let mut script = Vec::new();
    let name = crate::NAME;
    clap_complete::generate(arguments.shell, &mut Arguments::command(), name, &mut script);
    Failure::unless_written(io::stdout().lock().write_all(&script))
}
