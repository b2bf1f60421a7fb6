//! The options of `run`, and of `system`.

use std::path::PathBuf;

use stickslip_files::input::number;
use stickslip_files::output::picture::PictureFile;
use stickslip_solver::EmbeddedPair;

use super::method::{atol, rtol};
use super::shared::{self, Format};

/// Options of `run`.
#[derive(Debug, clap::Args)]
pub struct RunArguments {
    /// The system, a text as docs/systems.md describes it; - is standard input
    #[arg(value_name = "SYSTEM.slip")]
    pub system: PathBuf,

    /// The value of a parameter; may be repeated
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting, help_heading = "System")]
    pub set: Vec<(String, f64)>,

    /// Where the run ends, instead of the end that the system says
    #[arg(long, value_name = "T", value_parser = time, allow_hyphen_values = true)]
    #[arg(help_heading = "System")]
    pub end: Option<f64>,

    /// The method
    #[arg(long, value_name = "NAME", help_heading = "Method", default_value = "dop853")]
    #[arg(value_parser = ["dopri5", "dop853"])]
    pub method: String,

    /// Relative tolerance of a step; 1e-15 to 0.1 [default: 1e-10]
    #[arg(long, value_name = "R", help_heading = "Method", value_parser = rtol)]
    #[arg(allow_hyphen_values = true)]
    pub rtol: Option<f64>,

    /// Absolute tolerance of a step; above 0 [default: 1e-12]
    #[arg(long, value_name = "T", help_heading = "Method", value_parser = atol)]
    #[arg(allow_hyphen_values = true)]
    pub atol: Option<f64>,

    /// How the run is printed
    #[arg(long, value_enum, default_value_t = Format::Table, help_heading = "Output")]
    pub format: Format,

    /// CSV file for the events, with the states before and after them
    #[arg(long, value_name = "FILE.csv", help_heading = "Output")]
    pub events: Option<PathBuf>,

    /// CSV file for the state against time, at even times and on both sides of every event
    #[arg(long, value_name = "FILE.csv", help_heading = "Output")]
    pub course: Option<PathBuf>,

    /// Number of even times of --course, with the start and the end; 2 to 10000000
    #[arg(long, value_name = "N", help_heading = "Output", requires = "course")]
    #[arg(default_value_t = 1000, allow_hyphen_values = true)]
    #[arg(value_parser = clap::value_parser!(u32).range(2..=10_000_000))]
    pub points: u32,

    /// Picture of the state against time, with modes shaded and events marked
    #[arg(long, value_name = "FILE.svg|.png", help_heading = "Output")]
    #[arg(value_parser = shared::picture())]
    pub plot: Option<PictureFile>,
}

/// Options of `system`.
#[derive(Debug, clap::Args)]
pub struct SystemArguments {
    /// The system, a text as docs/systems.md describes it; - is standard input
    #[arg(value_name = "SYSTEM.slip")]
    pub system: PathBuf,

    /// Print the text with usual blanks and indentation; comments stay
    #[arg(long)]
    pub format: bool,
}

impl RunArguments {
    /// The method.
    pub fn pair(&self) -> EmbeddedPair {
        if self.method == "dopri5" { EmbeddedPair::Dopri5 } else { EmbeddedPair::Dop853 }
    }
}

/// Reads `name=value`.
pub fn setting(text: &str) -> Result<(String, f64), String> {
    let (name, value) = text.split_once('=').ok_or("expected NAME=VALUE, such as mu=0.4")?;
    let value = number::parse(value).map_err(|problem| problem.to_string())?;
    Ok((name.trim().to_owned(), value))
}

/// Reads a time.
pub fn time(text: &str) -> Result<f64, String> {
    let value = number::parse(text).map_err(|problem| problem.to_string())?;
    if value.is_finite() { Ok(value) } else { Err("expected a finite number".to_owned()) }
}

/// What `run --help` says first.
pub const ABOUT: &str = "\
Integrate a system of your own, given as a text, through every event: its modes, equations and rules \
are described in docs/systems.md. Guards are decided by bounds, so that no event is missed or invented.";

/// What `run --help` says last.
pub const EXAMPLES: &str = "\
Examples:
  stickslip run examples/systems/ball.slip
  stickslip run examples/systems/belt.slip --set belt=0.25 --plot belt.svg --events events.csv
  stickslip run examples/systems/relay.slip --end 20 --format json

A run that ends at a limit, or at an accumulation of events without a rest, is reported as such.

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";

/// What `system --help` says first.
pub const SYSTEM_ABOUT: &str = "\
Read a system and print what it consists of: its parameters with their ranges, its state, its modes and \
rules, or the same text with usual blanks. What is wrong is reported with line and column.";

/// What `system --help` says last.
pub const SYSTEM_EXAMPLES: &str = "\
Examples:
  stickslip system examples/systems/belt.slip
  stickslip system --format mine.slip > tidy.slip

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
