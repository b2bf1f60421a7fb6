//! The options of `fit`.

use std::path::PathBuf;

use stickslip_files::input::parameter::Parameter;
use stickslip_files::input::{number, range};
use stickslip_files::output::picture::PictureFile;
use stickslip_plane::Range;
use stickslip_practice::fit::Free;

use super::law::LawArguments;
use super::shared::{self, Format};

/// Options of `fit`.
#[derive(Debug, clap::Args)]
pub struct FitArguments {
    /// CSV file of measured impacts; - for standard input
    #[arg(value_name = "DATA.csv")]
    pub data: PathBuf,

    /// Names of what is fitted, separated by commas: k_t (or kappa), mu, tangential_damping, at
    /// most two of them, and damping
    #[arg(long, value_name = "NAME,…", help_heading = "Fit", value_delimiter = ',')]
    #[arg(value_parser = free, default_value = "k_t,mu")]
    pub free: Vec<Free>,

    /// Range of a fitted number, such as kappa=1:80; of the stiffness as κ at normal incidence; may
    /// be given for each [default: kappa=0.1:150 mu=0.01:2 tangential_damping=0:4 damping=0:3]
    #[arg(long, value_name = "NAME=LO:HI", help_heading = "Fit", value_parser = named_range)]
    pub range: Vec<(Free, Range)>,

    /// Part of the cases in which the intervals hold the true values; 0.5 to 0.9999
    #[arg(long, value_name = "P", help_heading = "Fit", allow_hyphen_values = true)]
    #[arg(value_parser = number::parse_option, default_value_t = 0.95)]
    pub level: f64,

    /// Use only the ratios of the errors, and estimate their size from the residuals
    #[arg(long, help_heading = "Fit")]
    pub relative_errors: bool,

    /// Coefficient of normal restitution at normal incidence, which decides the damping; above 0,
    /// at most 1
    #[arg(long, value_name = "E", help_heading = "Fit", allow_hyphen_values = true)]
    #[arg(value_parser = number::parse_option)]
    pub eps_n: Option<f64>,

    /// JSON file of the two bodies as `impact` reads it; motions in it are not used
    #[arg(long, value_name = "FILE.json", help_heading = "Bodies")]
    #[arg(conflicts_with_all = ["kappa", "mu", "alpha", "damping", "tangential_damping"])]
    pub bodies: Option<PathBuf>,

    /// Speed of all impacts in m/s, with --bodies, if the data do not have it
    #[arg(long, value_name = "V", help_heading = "Bodies", allow_hyphen_values = true)]
    #[arg(value_parser = number::parse_option, requires = "bodies")]
    pub speed: Option<f64>,

    /// κ at normal incidence, if it is not fitted; above 0
    #[arg(long, value_name = "K", help_heading = "Bodies", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Kappa.parse(text))]
    pub kappa: Option<f64>,

    /// Coefficient of friction μ, if it is not fitted; above 0
    #[arg(long, value_name = "M", help_heading = "Bodies", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Mu.parse(text))]
    pub mu: Option<f64>,

    /// Tangential inertia α; above 0, at most 1 [default: 2/7, homogeneous spheres]
    #[arg(long, value_name = "A", help_heading = "Bodies", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Alpha.parse(text))]
    pub alpha: Option<f64>,

    /// Scaled damping a at normal incidence, if it is not fitted; 0 or above [default: 0]
    #[arg(long, value_name = "D", help_heading = "Bodies", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Damping.parse(text))]
    pub damping: Option<f64>,

    /// The contact law.
    #[command(flatten)]
    pub law: LawArguments,

    /// How the fit is printed
    #[arg(long, value_enum, default_value_t = Format::Table, help_heading = "Output")]
    pub format: Format,

    /// Picture of data, fit and boundaries, which are printed as well
    #[arg(long, value_name = "FILE.svg|.png", help_heading = "Output")]
    #[arg(value_parser = shared::picture())]
    pub plot: Option<PictureFile>,

    /// Threads; 1 to 1024 [default: one for each core]; results do not depend on it
    #[arg(long, value_name = "N", help_heading = "Output", allow_hyphen_values = true)]
    #[arg(value_parser = shared::threads())]
    pub threads: Option<u16>,
}

/// Reads the name of what is fitted.
fn free(text: &str) -> Result<Free, String> {
    Free::find(text.trim()).ok_or_else(|| {
        let names = Free::ALL.map(Free::name).join(", ");
        format!("nothing that can be fitted is named {text:?}; expected k_t, {names}")
    })
}

/// Reads the range of what is fitted.
fn named_range(text: &str) -> Result<(Free, Range), String> {
    let (name, ends) =
        text.split_once('=').ok_or("no name; expected NAME=LO:HI, such as kappa=1:80")?;
    Ok((free(name)?, range::parse(ends).map_err(|problem| problem.to_string())?))
}

/// What `fit --help` says first.
pub const ABOUT: &str = "\
Fit the tangential stiffness and the friction of a contact law, or other numbers, to measured \
restitution, spins or rebound angles of impacts without spin before. Such problems have many \
minima. All of them in a range are found and printed, the best one first, with confidence \
intervals from profiles over the whole range, which may have several pieces.

The normal restitution decides the damping by itself, from data of eps_n or by --eps-n. Without \
--bodies all impacts have the same unknown speed, and the stiffness is told as κ at normal \
incidence.";

/// What `fit --help` says last.
pub const EXAMPLES: &str = "\
Columns of the data; cells may be blank, and a column comment is not read:
  centre_impact_angle_deg or _rad        angle of the impact from the normal, above 0, below 90°
  speed_m_per_s                          speed, if it is not --speed
  normal_m_per_s, tangential_m_per_s     instead of the angle and the speed
  eps_n, eps_t                           restitution of the surfaces; full reversal is -1
  centre_e_t                             tangential restitution of the centre
  spin_rad_per_s                         spin of the first sphere afterwards, as it would roll
  centre_rebound_angle_deg or _rad       angle of the centre afterwards, from the normal
  …_error                                standard error of any of these; all data have it, or none

Without errors their size is estimated from the residuals, which needs more data than free numbers.
The constants of the law are in the file of the bodies, as `impact --help` lists them; there, those
that are fitted have any value.

Examples:
  stickslip fit examples/oblique_impacts.csv --bodies examples/aluminium_oxide_on_glass.json \\
    --speed 3.9 --plot fit.svg
  stickslip fit data.csv --law gran/hertz/history --free kappa,mu --eps-n 0.95
  stickslip fit data.csv --free kappa,mu --range kappa=1:80 --format json

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
