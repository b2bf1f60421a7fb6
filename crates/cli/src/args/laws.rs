//! The options of `laws`.

use std::path::PathBuf;

use stickslip_files::input::parameter::Parameter;

use super::shared::{self, Format};

/// Options of `laws`.
#[derive(Debug, clap::Args)]
pub struct LawsArguments {
    /// The law that is printed; +limit_damping may be added to its name [default: a list of all]
    #[arg(value_name = "NAME")]
    pub name: Option<String>,

    /// How it is printed; the JSON of one law is a file for --law
    #[arg(long, value_enum, default_value_t = Format::Table)]
    pub format: Format,

    /// Directory for a page that shows what the laws do, DIR/laws.html, and its data; created if it
    /// is missing
    #[arg(long, value_name = "DIR", help_heading = "Page", conflicts_with_all = ["name", "format"])]
    pub out: Option<PathBuf>,

    /// Scaled damping of the maps; 0 or above [default: 0.2]
    #[arg(long, value_name = "A", help_heading = "Page", requires = "out")]
    #[arg(value_parser = |text: &str| Parameter::Damping.parse(text), allow_hyphen_values = true)]
    pub damping: Option<f64>,

    /// Tangential damping (γ_t/γ_n)/α of the maps; 0 or above [default: 0]
    #[arg(long, value_name = "B", help_heading = "Page", requires = "out")]
    #[arg(value_parser = |text: &str| Parameter::TangentialDamping.parse(text))]
    #[arg(allow_hyphen_values = true)]
    pub tangential_damping: Option<f64>,

    /// Columns and rows of each map; 1 to 1000 [default: 60]
    #[arg(long, value_name = "N", help_heading = "Page", requires = "out")]
    #[arg(value_parser = clap::value_parser!(u16).range(1..=1000), allow_hyphen_values = true)]
    pub cells: Option<u16>,

    /// Threads; 1 to 1024 [default: one for each core]; results do not depend on it
    #[arg(long, value_name = "N", help_heading = "Page", requires = "out")]
    #[arg(value_parser = shared::threads(), allow_hyphen_values = true)]
    pub threads: Option<u16>,
}

/// What `laws --help` says first.
pub const ABOUT: &str = "\
List the contact laws that have names, or print one of them: those of particle codes, by the codes' \
own keywords, with their equations, where these were read, and what was compared.

A law consists of seven terms, in JSON and here: normal (linear, hertz), damping (none, linear, \
viscoelastic, tsuji), tangential (constant, mindlin), history (displacement, force), rescaled, \
limit_damping (true, false), end (force, overlap). Every combination is a law.

Quantities are scaled: x overlap, v its rate, w tangential velocity, F normal and Q tangential force, \
y or q history; κ stiffness, a damping, b tangential damping. Hysteretic and adhesive laws have other \
terms and are not computed.

With --out, maps of ε_t and the number of switches, the difference from the paper's law, the forces of a \
standard impact, and where a law creates energy, for all of them on one page.";

/// What `laws --help` says last.
pub const EXAMPLES: &str = "\
Examples:
  stickslip laws
  stickslip laws gran/hertz/history
  stickslip laws granular/hertz/tsuji/mindlin+limit_damping --format json > law.json
  stickslip collide --kappa 3 --psi 0.4 --damping 0.3 --law law.json --tangential-damping 3.5
  stickslip laws --out laws --damping 0.1

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
