//! The options of `man`.

use std::path::PathBuf;

/// Options of `man`.
#[derive(Debug, clap::Args)]
pub struct ManArguments {
    /// Directory for one page for each command; created if it is missing
    #[arg(long, value_name = "DIR", help_heading = "Output")]
    pub out: Option<PathBuf>,
}

/// What `man --help` says last.
pub const EXAMPLES: &str = "\
Examples:
  stickslip man | man -l -
  stickslip man --out ~/.local/share/man/man1

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
