//! Options that several commands have.

use clap::ValueEnum;
use clap::builder::{PathBufValueParser, RangedI64ValueParser, TypedValueParser};
use stickslip_files::input::parameter::Parameter;
use stickslip_files::output::picture::PictureFile;

/// The parameters of collisions beside κ and ψ. Each command shows them under a heading of its own.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct CollisionArguments {
    /// Coefficient of friction μ, with --ratio; above 0 [default: 0.4]
    #[arg(long, value_name = "M", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Mu.parse(text))]
    pub mu: Option<f64>,

    /// Tangential inertia α, with --ratio; above 0, at most 1 [default: 2/7, homogeneous spheres]
    #[arg(long, value_name = "A", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Alpha.parse(text))]
    pub alpha: Option<f64>,

    /// Scaled damping a = A β^⅖ g_n^⅕ of the normal force; 0 or above [default: 0]
    #[arg(long, value_name = "D", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Damping.parse(text))]
    pub damping: Option<f64>,
}

/// How one result is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// A readable table
    Table,
    /// One JSON object
    Json,
}

/// Reads the file of a picture, whose name tells its format.
pub fn picture() -> impl TypedValueParser<Value = PictureFile> {
    PathBufValueParser::new().try_map(PictureFile::new)
}

/// Reads a number of threads.
pub fn threads() -> RangedI64ValueParser<u16> {
    clap::value_parser!(u16).range(1..=1024)
}
