//! The options of `reproduce`.

use crate::audit::{COUNT, Model};

/// Options of `reproduce`.
#[derive(Debug, clap::Args)]
pub struct ReproduceArguments {
    /// Statements of the paper to be tested and printed, by number from 1 to 24
    #[arg(long, value_name = "N", help_heading = "Audit", required = true, num_args = 1..)]
    #[arg(allow_negative_numbers = true)]
    #[arg(value_parser = clap::value_parser!(u8).range(1..=i64::from(COUNT)))]
    pub statement: Vec<u8>,

    /// How the statements are printed
    #[arg(long, value_enum, default_value_t = AuditFormat::Text, help_heading = "Audit")]
    pub format: AuditFormat,

    /// The model of the spring
    #[arg(long, value_enum, default_value_t = Model::Reset, hide = true)]
    pub model: Model,

    /// Threads; 1 to 1024 [default: one for each core]; results do not depend on it
    #[arg(long, value_name = "N", help_heading = "Output", allow_hyphen_values = true)]
    #[arg(value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

/// How statements are printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum AuditFormat {
    /// For a terminal
    Text,
    /// One JSON object
    Json,
    /// Markdown
    Markdown,
}

/// Text of `reproduce --help`.
pub const ABOUT: &str = "\
Test statements of the paper, each by a computation of its own.

A verdict follows from the printed numbers: holds, holds with a condition, does not hold, or cannot be decided.";

/// What follows it.
pub const EXAMPLES: &str = "\
Examples:
  stickslip reproduce --statement 7
  stickslip reproduce --statement 3 4 5 --format json

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
