//! The options of `reproduce`.

use std::path::PathBuf;

use stickslip_studies::statements::{COUNT, Spring};

use super::shared;

/// Options of `reproduce`.
#[derive(Debug, clap::Args)]
pub struct ReproduceArguments {
    /// Directory for the page, the pictures and the data; created where it is missing
    #[arg(long, value_name = "DIR", help_heading = "Output")]
    #[arg(required_unless_present = "statement", conflicts_with = "statement")]
    pub out: Option<PathBuf>,

    /// Statements of the paper to be tested and printed instead, by number from 1 to 24
    #[arg(long, value_name = "N", help_heading = "Audit", num_args = 1..)]
    #[arg(allow_negative_numbers = true)]
    #[arg(value_parser = clap::value_parser!(u8).range(1..=i64::from(COUNT)))]
    pub statement: Vec<u8>,

    /// How the statements are printed
    #[arg(long, value_enum, default_value_t = AuditFormat::Text, help_heading = "Audit")]
    #[arg(conflicts_with = "out")]
    pub format: AuditFormat,

    /// The model of the spring
    #[arg(long, value_enum, default_value_t = SpringModel::Reset, hide = true)]
    pub model: SpringModel,

    /// Threads; 1 to 1024 [default: one for each core]; results do not depend on it
    #[arg(long, value_name = "N", help_heading = "Output", allow_hyphen_values = true)]
    #[arg(value_parser = shared::threads())]
    pub threads: Option<u16>,

    /// Columns and rows of a map, for trials in a hurry
    #[arg(long, value_name = "N", hide = true, default_value_t = 400)]
    #[arg(value_parser = clap::value_parser!(u16).range(2..=2000))]
    pub cells: u16,
}

/// The model of the spring of which statements are tested.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum SpringModel {
    /// The paper's: reset to the limit as long as that is active
    Reset,
    /// Never reset
    UnresetSpring,
}

impl SpringModel {
    /// The model that the option names.
    pub fn spring(self) -> Spring {
        match self {
            Self::Reset => Spring::Reset,
            Self::UnresetSpring => Spring::Unreset,
        }
    }
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
Compute the figures of Schwager, Becker and Pöschel, Eur. Phys. J. E 27, 107 (2008), anew, all \
boundaries of the switching, the studies of convergence and of stiff springs, test the statements of \
the paper, and show everything on one page.

DIR/index.html is the page: it holds its pictures, needs no network, and can be printed. \
DIR/report.md and DIR/report.json say the same to other readers. Each picture lies beside them, \
with its data.

With --statement, statements of the paper are tested alone and printed. A verdict follows from the \
printed numbers: holds, holds with a condition, does not hold, or cannot be decided.";

/// What follows it.
pub const EXAMPLES: &str = "\
Examples:
  stickslip reproduce --out out
  stickslip reproduce --statement 7
  stickslip reproduce --statement 3 4 5 --format json

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
