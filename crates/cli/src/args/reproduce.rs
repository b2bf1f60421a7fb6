//! The options of `reproduce`.

use std::path::PathBuf;

use super::shared;

/// Options of `reproduce`.
#[derive(Debug, clap::Args)]
pub struct ReproduceArguments {
    /// Directory for the page, the pictures and the data; created where it is missing
    #[arg(long, value_name = "DIR", help_heading = "Output")]
    pub out: PathBuf,

    /// Threads; 1 to 1024 [default: one for each core]; results do not depend on it
    #[arg(long, value_name = "N", help_heading = "Output", allow_hyphen_values = true)]
    #[arg(value_parser = shared::threads())]
    pub threads: Option<u16>,

    /// Columns and rows of a map, for trials in a hurry
    #[arg(long, value_name = "N", hide = true, default_value_t = 400)]
    #[arg(value_parser = clap::value_parser!(u16).range(2..=2000))]
    pub cells: u16,
}

/// Text of `reproduce --help`.
pub const ABOUT: &str = "\
Compute the figures of Schwager, Becker and Pöschel, Eur. Phys. J. E 27, 107 (2008), anew, and all \
boundaries of the switching, and show everything on one page.

DIR/index.html is the page: it holds its pictures, needs no network, and can be printed. \
DIR/report.md and DIR/report.json say the same to other readers. Each picture lies beside them, \
with its data.";

/// What follows it.
pub const EXAMPLES: &str = "\
Examples:
  stickslip reproduce --out out

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
