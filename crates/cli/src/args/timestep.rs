//! The options of `timestep`.

use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use stickslip_files::input::number;
use stickslip_files::input::parameter::Parameter;
use stickslip_files::input::range::{self, OneOrRange};
use stickslip_files::output::picture::PictureFile;
use stickslip_practice::time_steps::Scheme;

use super::law::LawArguments;
use super::shared::{self, Format};

/// Options of `timestep`.
#[derive(Debug, clap::Args)]
pub struct TimestepArguments {
    /// Scaled stiffness κ = k_t/(α m β^⅘ g_n^⅖), or an interval with a grid of them; above 0
    #[arg(long, value_name = "K|LO:HI", help_heading = "Impacts", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| range::parse_one_or_range(Parameter::Kappa, text))]
    pub kappa: Option<OneOrRange>,

    /// Reduced impact ratio ψ = (g_t/g_n)·α/μ, or an interval with a grid of them; above 0
    #[arg(long, value_name = "P|LO:HI", help_heading = "Impacts", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| range::parse_one_or_range(Parameter::Psi, text))]
    pub psi: Option<OneOrRange>,

    /// Values in an interval, in equal ratios from end to end; 2 to 1000 [default: 8]
    #[arg(long, value_name = "N", help_heading = "Impacts", allow_hyphen_values = true)]
    #[arg(value_parser = clap::value_parser!(u16).range(2..=1000))]
    pub grid: Option<u16>,

    /// Scaled damping a of the normal force; 0 or above [default: 0]
    #[arg(long, value_name = "D", help_heading = "Impacts", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Damping.parse(text))]
    pub damping: Option<f64>,

    /// Coefficient of friction μ, of which only the energy knows; above 0 [default: 0.4]
    #[arg(long, value_name = "M", help_heading = "Impacts", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Mu.parse(text))]
    pub mu: Option<f64>,

    /// Tangential inertia α, of which only the energy knows; above 0, at most 1 [default: 2/7]
    #[arg(long, value_name = "A", help_heading = "Impacts", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Alpha.parse(text))]
    pub alpha: Option<f64>,

    /// JSON file of an impact as `impact` reads it, instead of scaled parameters; - for standard
    /// input
    #[arg(long, value_name = "FILE.json", help_heading = "Impacts")]
    #[arg(conflicts_with_all = ["kappa", "psi", "grid", "damping", "mu", "alpha"])]
    #[arg(conflicts_with = "tangential_damping")]
    pub bodies: Option<PathBuf>,

    /// The contact law.
    #[command(flatten)]
    pub law: LawArguments,

    /// Numbers t_c/dt of steps in the undamped contact time, separated by commas; 1 to 1e7
    #[arg(long, value_name = "N,…", help_heading = "Steps", allow_hyphen_values = true)]
    #[arg(value_parser = number::parse_option)]
    #[arg(value_delimiter = ',', default_value = "10,20,50,100,200,500,1000")]
    pub steps: Vec<f64>,

    /// Number of start phases, the parts of a step after which a contact begins; 1 to 4096
    #[arg(long, value_name = "N", help_heading = "Steps", allow_hyphen_values = true)]
    #[arg(value_parser = clap::value_parser!(u16).range(1..=4096), default_value_t = 16)]
    pub phases: u16,

    /// Scheme of a particle code
    #[arg(long, value_name = "NAME", help_heading = "Steps", default_value = Scheme::Lammps.name())]
    #[arg(value_parser = scheme())]
    pub scheme: Scheme,

    /// Wanted error, for which the largest step is told; above 0
    #[arg(long, value_name = "E", help_heading = "Steps", allow_hyphen_values = true)]
    #[arg(value_parser = number::parse_option)]
    pub error: Option<f64>,

    /// How the errors are printed
    #[arg(long, value_enum, default_value_t = Format::Table, help_heading = "Output")]
    pub format: Format,

    /// Picture of the errors over the step, which are printed as well
    #[arg(long, value_name = "FILE.svg|.png", help_heading = "Output")]
    #[arg(value_parser = shared::picture())]
    pub plot: Option<PictureFile>,

    /// Threads; 1 to 1024 [default: one for each core]; results do not depend on it
    #[arg(long, value_name = "N", help_heading = "Output", allow_hyphen_values = true)]
    #[arg(value_parser = shared::threads())]
    pub threads: Option<u16>,
}

/// Reads the name of a scheme.
fn scheme() -> impl TypedValueParser<Value = Scheme> {
    let names = PossibleValuesParser::new(Scheme::ALL.map(Scheme::name));
    names.map(|name| Scheme::find(&name).unwrap_or_default())
}

/// What `timestep --help` says first.
pub const ABOUT: &str = "\
Measure the errors of the time steps of a particle code: the difference in ε_t, in ε_n and in the \
energy after a contact between its steps of fixed length dt and a collision without steps. They \
are told as median, root mean square and largest error over all impacts and over the parts of a \
step after which a contact begins.

Steps are told as numbers t_c/dt in the undamped contact time t_c, which in scaled units is π for \
a linear force and 3.218 for Hertz'. The energy after the contact is a part of that before.

An interval of --kappa or --psi stands for a grid of values in equal ratios; with two intervals \
all pairs are computed.";

/// What `timestep --help` says last.
pub const EXAMPLES: &str = "\
Schemes:
  lammps   velocity Verlet, with forces at the velocities of half steps; the history advances by
           whole steps, in the first step of a contact too; also MercuryDPM's and MFiX'
  elapsed  the same, but in the first step of a contact the history advances by the time since it
           began, as in older versions of MFiX

Status of a step:
  ok          all contacts end, and the steps resolve both springs
  unstable    a spring is not resolved, and its oscillation grows from step to step
  unfinished  some contacts do not end, so that there are no errors

With --error E, the largest dt/t_c is told at which the largest error is at most E, and at all
shorter ones of the given steps too. Nothing is promised of steps that were not given.

With --bodies, steps are told in seconds and in Rayleigh times too. The file has the constants of
the law, as `impact --help` lists them.

Examples:
  stickslip timestep --kappa 3 --psi 0.4 --damping 0.3 --law gran/hertz/history
  stickslip timestep --kappa 1:60 --psi 0.05:2 --error 0.01 --plot errors.svg
  stickslip timestep --bodies examples/steel_spheres.json --steps 20,50,100 --format json
  stickslip timestep --bodies examples/hooke_spheres.json --law gran/hooke/history

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
