//! `system`: a system of one's own, read and printed.

use std::path::PathBuf;

use crate::error::Failure;
use crate::output::console::print;
use crate::shared::system::read;

/// Read a system of your own, and print what it consists of
#[derive(Debug, clap::Args)]
#[command(long_about = ABOUT, after_long_help = EXAMPLES)]
pub struct SystemArguments {
    /// The system, a text as docs/systems.md describes it; - is standard input
    #[arg(value_name = "SYSTEM.slip")]
    pub system: PathBuf,

    /// Print the text with usual blanks and indentation; comments stay
    #[arg(long)]
    pub format: bool,
}

/// Prints what a system consists of, or its text in the usual form.
pub fn run(arguments: &SystemArguments) -> Result<(), Failure> {
    let (system, text) = read(&arguments.system)?;
    // A text that reads as a system consists of words and signs.
    let formatted = stickslip_expression::format(&text);
    print(|out| {
        let text = if arguments.format { formatted.ok() } else { None };
        write!(out, "{}", text.unwrap_or_else(|| system.text()))
    })
}

/// What `system --help` says first.
const ABOUT: &str = "\
Read a system and print what it consists of: its parameters with their ranges, its state, its modes and \
rules, or the same text with usual blanks. What is wrong is reported with line and column.";

/// What `system --help` says last.
const EXAMPLES: &str = "\
Examples:
  stickslip system examples/systems/belt.slip
  stickslip system --format mine.slip > tidy.slip

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
