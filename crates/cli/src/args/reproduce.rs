//! The options of `reproduce`.

use std::path::PathBuf;

use stickslip_reproduction::statements::{COUNT, Spring};

use super::shared;

/// Options of `reproduce`.
#[derive(Debug, clap::Args)]
pub struct ReproduceArguments {
    /// Directory for the page, the pictures and the data; created if it is missing
    #[arg(long, value_name = "DIR", help_heading = "Output")]
    #[arg(required_unless_present = "statement", conflicts_with = "statement")]
    pub out: Option<PathBuf>,

    /// Numbers of statements of the paper, from 1 to 24, that are tested and printed instead
    #[arg(long, value_name = "N", help_heading = "Audit", num_args = 1..)]
    #[arg(allow_negative_numbers = true)]
    #[arg(value_parser = clap::value_parser!(u8).range(1..=i64::from(COUNT)))]
    pub statement: Vec<u8>,

    /// How the statements are printed
    #[arg(long, value_enum, default_value_t = AuditFormat::Text, help_heading = "Audit")]
    #[arg(conflicts_with = "out")]
    pub format: AuditFormat,

    /// Model of the spring
    #[arg(long, value_enum, default_value_t = SpringModel::Reset, hide = true)]
    pub model: SpringModel,

    /// Threads; 1 to 1024 [default: one for each core]; results do not depend on it
    #[arg(long, value_name = "N", help_heading = "Output", allow_hyphen_values = true)]
    #[arg(value_parser = shared::threads())]
    pub threads: Option<u16>,

    /// Number of columns and rows of each map, fewer for quick trials
    #[arg(long, value_name = "N", hide = true, default_value_t = 400)]
    #[arg(value_parser = clap::value_parser!(u16).range(2..=2000))]
    pub cells: u16,
}

/// The model of the spring for which statements are tested.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum SpringModel {
    /// Reset to its limit as long as the limit is active, as in the paper
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

/// What `reproduce --help` says first.
pub const ABOUT: &str = "\
Compute the figures of Schwager, Becker and Pöschel, Eur. Phys. J. E 27, 107 (2008), anew. Compute \
all boundaries of the switching and the studies of convergence and of stiff springs, test the \
statements of the paper, and show everything on one page.

DIR/index.html is the page. It contains its pictures, needs no network, and can be printed. \
DIR/report.md and DIR/report.json say the same as text and for programs. Each picture is also a \
file, and so are its data.

With --statement, only these statements of the paper are tested, and printed. A verdict follows from \
the printed numbers: holds, holds with a condition, does not hold, or cannot be decided.";

/// What `reproduce --help` says last.
pub const EXAMPLES: &str = "\
Examples:
  stickslip reproduce --out out
  stickslip reproduce --statement 7
  stickslip reproduce --statement 3 4 5 --format json

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
