//! Scripts that complete commands and options in a shell.

use clap::CommandFactory;

use crate::args::{Arguments, CompletionsArguments};
use crate::error::Failure;
use crate::output::console::print;
use crate::version::NAME;

/// Prints the script for a shell.
///
/// # Errors
/// Standard output cannot be written.
pub fn run(arguments: CompletionsArguments) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), NAME, &mut script);
    print(|out| out.write_all(&script))
}
