//! What may be typed: options with their syntax and ranges, and the help text.

mod asymptote;
mod completions;
mod converge;
mod impact;
mod locate;
mod man;
mod map;
mod method;
mod reproduce;
mod shared;
mod trace;

use std::path::PathBuf;

use clap::{Parser, Subcommand, ValueEnum};

use crate::input::parameter::Parameter;
use crate::output::picture::PictureFile;
use crate::version;

pub use asymptote::AsymptoteArguments;
pub use completions::CompletionsArguments;
pub use converge::ConvergeArguments;
pub use impact::ImpactArguments;
pub use locate::LocateArguments;
pub use man::ManArguments;
pub use map::MapArguments;
pub use method::{Method, MethodArguments};
pub use reproduce::{AuditFormat, ReproduceArguments};
pub use shared::CollisionArguments;
pub use trace::TraceArguments;

/// Collisions of frictional viscoelastic spheres, with every switch between sticking and sliding.
#[derive(Debug, Parser)]
#[command(name = "stickslip", version, long_version = version::long(), after_help = EXIT_CODES)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Compute one collision, or a file of them
    #[command(long_about = COLLIDE, after_long_help = COLLIDE_EXAMPLES)]
    Collide(CollideArguments),
    /// Compute the impact of two spheres, or a sphere and a wall, in SI units
    #[command(long_about = impact::ABOUT, after_long_help = impact::EXAMPLES)]
    Impact(ImpactArguments),
    /// Compute the restitution and the number of switches on a plane
    #[command(long_about = map::ABOUT, after_long_help = map::EXAMPLES)]
    Map(MapArguments),
    /// Trace every boundary in a window on which the switches change
    #[command(long_about = trace::ABOUT, after_long_help = trace::EXAMPLES)]
    Trace(TraceArguments),
    /// Look up the switches of collisions in an atlas
    #[command(long_about = locate::ABOUT, after_long_help = locate::EXAMPLES)]
    Locate(LocateArguments),
    /// Compute the figures of the paper anew, and show everything on one page
    #[command(long_about = reproduce::ABOUT, after_long_help = reproduce::EXAMPLES)]
    Reproduce(ReproduceArguments),
    /// Measure how the tangential restitution vanishes for stiff springs
    #[command(long_about = asymptote::ABOUT, after_long_help = asymptote::EXAMPLES)]
    Asymptote(AsymptoteArguments),
    /// Measure how errors fall with the step and the tolerance, and what they cost
    #[command(long_about = converge::ABOUT, after_long_help = converge::EXAMPLES)]
    Converge(ConvergeArguments),
    /// Print a script that completes commands and options in a shell
    #[command(after_long_help = completions::EXAMPLES)]
    Completions(CompletionsArguments),
    /// Print a manual page with all commands, or write a page for each
    #[command(after_long_help = man::EXAMPLES)]
    Man(ManArguments),
}

/// Options of `collide`.
#[derive(Debug, clap::Args)]
pub struct CollideArguments {
    /// Scaled stiffness κ = k_t/(α m β^⅘ g_n^⅖) of the tangential spring; above 0
    #[arg(long, value_name = "K", help_heading = "Collision", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Kappa.parse(text))]
    #[arg(required_unless_present = "batch")]
    pub kappa: Option<f64>,

    /// Impact ratio g_t/g_n of tangential and normal velocity; above 0; gives ψ = G·α/μ
    #[arg(long, value_name = "G", help_heading = "Collision", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Ratio.parse(text))]
    pub ratio: Option<f64>,

    /// Reduced impact ratio ψ = (g_t/g_n)·α/μ, instead of --ratio; above 0
    #[arg(long, value_name = "P", help_heading = "Collision", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Psi.parse(text))]
    pub psi: Option<f64>,

    /// What the collision has beside κ and ψ.
    #[command(flatten, next_help_heading = "Collision")]
    pub collision: CollisionArguments,

    /// What computes a collision.
    #[command(flatten)]
    pub method: MethodArguments,

    /// How one collision is printed
    #[arg(long, value_enum, default_value_t = Format::Table, help_heading = "Output")]
    #[arg(conflicts_with = "batch")]
    pub format: Format,

    /// Picture of the forces and the velocity of one collision, beside what is printed
    #[arg(long, value_name = "FILE.svg|.png", help_heading = "Output", conflicts_with = "batch")]
    #[arg(value_parser = shared::picture())]
    pub plot: Option<PictureFile>,

    /// CSV file with a header row and one collision a row
    #[arg(long, value_name = "IN.csv", help_heading = "Batch", requires = "out")]
    pub batch: Option<PathBuf>,

    /// CSV file for the results, one row a collision in the order of the input
    #[arg(long, value_name = "OUT.csv", help_heading = "Batch", requires = "batch")]
    pub out: Option<PathBuf>,

    /// CSV file for every switch of every collision
    #[arg(long, value_name = "EV.csv", help_heading = "Batch", requires = "batch")]
    pub events: Option<PathBuf>,

    /// Threads for a batch; 1 to 1024 [default: one for each core]; results do not depend on it
    #[arg(long, value_name = "N", help_heading = "Batch", allow_hyphen_values = true)]
    #[arg(value_parser = shared::threads())]
    pub threads: Option<u16>,
}

/// How one collision is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// A readable table
    Table,
    /// One JSON object
    Json,
}

const EXIT_CODES: &str = "Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";

const COLLIDE: &str = "\
Compute one collision, or a file of them: the coefficients of restitution, the switches between \
sticking and sliding, and where the energy went.

A collision is given by --kappa and exactly one of --psi and --ratio. All quantities are scaled: \
time by β^(−2/5) g_n^(−1/5), length by g_n^(4/5) β^(−2/5), with β = ρ/m; spring and tangential \
velocity are reduced by μ/α besides. Numbers are written like 18, 1.5e3 or 2/7.";

const COLLIDE_EXAMPLES: &str = "\
Batch files:
  The header of IN.csv names any of kappa, psi, ratio, mu, alpha, damping; the options of the same
  names give what the file does not. Other columns pass through. OUT.csv has the input's columns
  followed by eps_n, eps_t, switch_count, itinerary, contact_time, reversals, status. A row that
  cannot be computed has empty results and its reason in status, and the exit code is 1.

Examples:
  stickslip collide --kappa 63 --psi 0.5
  stickslip collide --kappa 63 --psi 0.5 --plot collision.svg
  stickslip collide --kappa 18 --ratio 1.4 --mu 0.4 --alpha 2/7 --method exact
  stickslip collide --kappa 18 --psi 1 --damping 0.05 --format json
  stickslip collide --batch IN.csv --out OUT.csv --events EV.csv --threads 4
  stickslip collide --batch PSI.csv --kappa 18 --method exact --out OUT.csv

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
