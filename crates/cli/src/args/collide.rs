//! The options of `collide`.

use stickslip_files::input::parameter::Parameter;
use stickslip_files::output::picture::PictureFile;

use super::batch::BatchArguments;
use super::course::CourseArguments;
use super::law::LawArguments;
use super::method::MethodArguments;
use super::shared::{self, CollisionArguments, Format};

/// Options of `collide`.
#[derive(Debug, clap::Args)]
pub struct CollideArguments {
    /// Scaled stiffness κ = k_t/(α m β^⅘ g_n^⅖) of the tangential spring; above 0
    #[arg(long, value_name = "K", help_heading = "Collision", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Kappa.parse(text))]
    pub kappa: Option<f64>,

    /// Impact ratio g_t/g_n of tangential and normal velocity; above 0; gives ψ = G·α/μ
    #[arg(long, value_name = "G", help_heading = "Collision", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Ratio.parse(text))]
    pub ratio: Option<f64>,

    /// Reduced impact ratio ψ = (g_t/g_n)·α/μ, instead of --ratio; above 0
    #[arg(long, value_name = "P", help_heading = "Collision", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Psi.parse(text))]
    pub psi: Option<f64>,

    /// The parameters beside κ and ψ.
    #[command(flatten, next_help_heading = "Collision")]
    pub collision: CollisionArguments,

    /// The contact law.
    #[command(flatten)]
    pub law: LawArguments,

    /// What computes a collision.
    #[command(flatten)]
    pub method: MethodArguments,

    /// How one collision is printed
    #[arg(long, value_enum, default_value_t = Format::Table, help_heading = "Output")]
    #[arg(conflicts_with = "batch")]
    pub format: Format,

    /// Add the expected error of ε_t and the distance of the itinerary from changing
    #[arg(long, help_heading = "Output")]
    pub estimate: bool,

    /// Picture of the forces and the velocity of one collision, which is printed as well
    #[arg(long, value_name = "FILE.svg|.png", help_heading = "Output", conflicts_with = "batch")]
    #[arg(value_parser = shared::picture())]
    pub plot: Option<PictureFile>,

    /// The course of one collision.
    #[command(flatten, next_help_heading = "Output")]
    pub course: CourseArguments,

    /// A file of collisions.
    #[command(flatten)]
    pub batch: BatchArguments,
}

/// What `collide --help` says first.
pub const ABOUT: &str = "\
Compute one collision, or a file of them: the coefficients of restitution, the switches between \
sticking and sliding, and where the energy went.

A collision is given by --kappa and exactly one of --psi and --ratio. All quantities are scaled: \
time by β^(−2/5) g_n^(−1/5), length by g_n^(4/5) β^(−2/5), with β = ρ/m; the spring and the \
tangential velocity are also divided by μ/α. Numbers are written like 18, 1.5e3 or 2/7.";

/// What `collide --help` says last.
pub const EXAMPLES: &str = "\
Batch files:
  The header of IN.csv names any of kappa, psi, ratio, mu, alpha, damping, tangential_damping;
  the options of the same names give what the file does not. Other columns pass through. OUT.csv
  has the columns of the input followed by eps_n, eps_t, switch_count, itinerary, contact_time, reversals, status. A row that
  cannot be computed has no results; its status says why, and the exit code is 1.

Course:
  FILE.csv of --course has the columns time, regime, side, switch, compression, normal_velocity,
  normal_force, tangential_force (F_t/μ), velocity (w) and spring (y), at times that are evenly
  spaced and at every switch, whose number, from 0, is in the column switch.

Accuracy at the default tolerances, for kappa 1e-6 to 1e6, psi 1e-10 to 10, damping up to 1e4:
  dop853  2e-11 in eps_t; 4e-12 in contact_time and eps_n, relative
  dopri5  1e-7 in eps_t; 1e-9 in contact_time and eps_n, relative
  exact   1e-15 (1 + sqrt(kappa)) in eps_t, 1e-15 in the others
  Errors are proportional to the tolerance. --estimate tells the error to expect of a collision.

Examples:
  stickslip collide --kappa 63 --psi 0.5
  stickslip collide --kappa 63 --psi 0.5 --plot collision.svg
  stickslip collide --kappa 63 --psi 0.5 --course course.csv
  stickslip collide --kappa 18 --ratio 1.4 --mu 0.4 --alpha 2/7 --method exact
  stickslip collide --kappa 18 --psi 1 --damping 0.05 --format json
  stickslip collide --kappa 18 --psi 1.99 --estimate
  stickslip collide --batch IN.csv --out OUT.csv --events EV.csv --threads 4
  stickslip collide --batch PSI.csv --kappa 18 --method exact --out OUT.csv

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
