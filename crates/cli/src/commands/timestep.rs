//! `timestep`: the errors of time steps, measured, printed and drawn.

mod table;

use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use serde_json::{Value, json, to_value};
use stickslip_figure::pictures;
use stickslip_files::input::parameter::Parameter;
use stickslip_files::input::range::{self, OneOrRange};
use stickslip_files::input::source::shown;
use stickslip_files::input::{bodies, law, number};
use stickslip_files::output::json::lines;
use stickslip_files::output::picture::PictureFile;
use stickslip_model::{Contact, Reduction};
use stickslip_practice::time_steps::{
    self, Scheme, Seconds, SteppedQuantity, Stepping, TimeStepSettings, TimeSteps,
};

use crate::error::Failure;
use crate::output::console::{deliver, print};
use crate::shared::Format;
use crate::shared::collision::{damping_for, reduction};
use crate::shared::files;
use crate::shared::law::LawArguments;
use crate::shared::study::refused;
use crate::shared::threads::ThreadsArguments;

/// Values in an interval.
const GRID: u16 = 8;

/// Measure the errors of the time steps of particle codes
#[derive(Debug, clap::Args)]
#[command(long_about = ABOUT, after_long_help = EXAMPLES)]
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

    /// Coefficient of normal restitution, instead of --damping; above 0, at most 1
    #[arg(long, value_name = "E", help_heading = "Impacts", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::NormalRestitution.parse(text))]
    #[arg(conflicts_with = "damping")]
    pub e_n: Option<f64>,

    /// Coefficient of friction μ, for the energy and with --overlap; above 0 [default: 0.4]
    #[arg(long, value_name = "M", help_heading = "Impacts", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Mu.parse(text))]
    pub mu: Option<f64>,

    /// Tangential inertia α, for the energy and with --overlap; above 0, at most 1 [default: 2/7]
    #[arg(long, value_name = "A", help_heading = "Impacts", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Alpha.parse(text))]
    pub alpha: Option<f64>,

    /// JSON file of an impact as `impact` reads it, instead of scaled parameters; - for standard
    /// input
    #[arg(long, value_name = "FILE.json", help_heading = "Impacts")]
    #[arg(conflicts_with_all = ["kappa", "psi", "grid", "damping", "e_n", "mu", "alpha"])]
    #[arg(conflicts_with_all = ["tangential_damping", "dynamic_friction", "overlap"])]
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

    /// Greatest overlap over the distance of the centres, so that the normal turns during the
    /// contact of two equal spheres without spins; 0 to 0.5
    #[arg(long, value_name = "X", help_heading = "Steps", allow_hyphen_values = true)]
    #[arg(value_parser = number::parse_option, default_value_t = 0.0)]
    pub overlap: f64,

    /// Wanted error, for which the largest step is told; above 0
    #[arg(long, value_name = "E", help_heading = "Steps", allow_hyphen_values = true)]
    #[arg(value_parser = number::parse_option)]
    pub error: Option<f64>,

    /// How the result is printed
    #[arg(long, value_enum, default_value_t = Format::Table, help_heading = "Output")]
    pub format: Format,

    /// Picture of the errors over the step, which are printed as well
    #[arg(long, value_name = "FILE.svg|.png|.pdf", help_heading = "Output")]
    #[arg(value_parser = files::picture())]
    pub plot: Option<PictureFile>,

    /// The threads.
    #[command(flatten)]
    pub threads: ThreadsArguments,
}

/// Measures the errors, draws them if that is wanted, and prints them.
pub fn run(arguments: &TimestepArguments) -> Result<(), Failure> {
    let (contacts, reduction, seconds) = impacts(arguments)?;
    let settings = TimeStepSettings {
        contacts,
        steps_per_contact: arguments.steps.clone(),
        phases: usize::from(arguments.phases),
        stepping: Stepping { scheme: arguments.scheme, overlap: arguments.overlap, reduction },
    };
    settings.validate().map_err(refused)?;
    let wanted = arguments.error;
    if let Some(wanted) = wanted.filter(|wanted| *wanted <= 0.0) {
        let expected = "expected a finite number above 0";
        return Err(Failure::Usage(format!("--error = {wanted:?} is out of range; {expected}")));
    }
    let plot = arguments.plot.as_ref();
    plot.map_or(Ok(()), PictureFile::probe)?;
    let result = arguments.threads.with_steps(|report| time_steps::run(&settings, report))??;
    if let Some(plot) = plot {
        deliver([plot.write(Ok(pictures::time_steps::draw(&result)))?], "")?;
    }
    print(|out| match arguments.format {
        Format::Json => lines(out, &document(&result, seconds, wanted)?),
        Format::Table => table::write(out, &result, seconds.as_ref(), wanted),
    })
}

type Impacts = (Vec<Contact>, Reduction, Option<Seconds>);

/// The impacts of the options or of the file, with what weighs their energy and their times.
fn impacts(arguments: &TimestepArguments) -> Result<Impacts, Failure> {
    let Some(path) = &arguments.bodies else { return scaled(arguments) };
    let name = arguments.law.law.as_deref();
    let encounter = bodies::read_encounter(path, law::by_name_or_file(name)?, None)?;
    law::permits(name, "tangential damping", encounter.contact().tangential_damping())?;
    if encounter.is_central() {
        let reason = "the impact is central; expected a tangential velocity, without which there \
                      is no tangential restitution";
        return Err(Failure::input(shown(path), reason));
    }
    let pair = &encounter.impact.pair;
    let reduction = Reduction { mu: pair.surface.friction, alpha: pair.alpha };
    Ok((vec![encounter.contact()], reduction, Some(Seconds::new(&encounter))))
}

fn scaled(arguments: &TimestepArguments) -> Result<Impacts, Failure> {
    let missing = |name: &str| {
        Failure::Usage(format!("--{name} is missing; expected --kappa and --psi, or --bodies"))
    };
    let kappa = arguments.kappa.ok_or_else(|| missing("kappa"))?;
    let psi = arguments.psi.ok_or_else(|| missing("psi"))?;
    let ranged = |value| matches!(value, OneOrRange::Range(_));
    if arguments.grid.is_some() && !ranged(kappa) && !ranged(psi) {
        let expected = "expected with an interval LO:HI of --kappa or --psi only";
        return Err(Failure::Usage(format!("--grid has no effect; {expected}")));
    }
    let (law, tangential_damping) = arguments.law.chosen()?;
    let damping = match arguments.e_n {
        Some(e_n) => damping_for(law, e_n)?,
        None => arguments.damping.unwrap_or(0.0),
    };
    let count = usize::from(arguments.grid.unwrap_or(GRID));
    let mut contacts = Vec::new();
    for kappa in kappa.values(count) {
        for psi in psi.values(count) {
            let contact = Contact::new(kappa, psi, damping)
                .and_then(|contact| contact.with_law(law, tangential_damping))
                .map_err(|invalid| Failure::Usage(invalid.to_string()))?;
            contacts.push(contact);
        }
    }
    Ok((contacts, reduction(arguments.mu, arguments.alpha), None))
}

/// The errors as `--format json` prints them: with the times of the impact and the step of each
/// row, and the largest dt/t_c for a wanted error.
fn document(
    result: &TimeSteps,
    seconds: Option<Seconds>,
    wanted: Option<f64>,
) -> serde_json::Result<Value> {
    let mut document = to_value(result)?;
    if let Some(times) = seconds {
        let steps = result.rows.iter().map(|row| times.step_s(row.steps_per_contact));
        document["seconds"] = to_value(times)?;
        document["seconds"]["steps_s"] = steps.collect();
    }
    if let Some(wanted) = wanted {
        let [eps_t, eps_n, energy] =
            SteppedQuantity::ALL.map(|quantity| result.largest_step(quantity, wanted));
        document["largest_step"] =
            json!({ "wanted": wanted, "eps_t": eps_t, "eps_n": eps_n, "energy": energy });
    }
    Ok(document)
}

/// Reads the name of a scheme.
fn scheme() -> impl TypedValueParser<Value = Scheme> {
    let names = PossibleValuesParser::new(Scheme::ALL.map(Scheme::name));
    names.map(|name| Scheme::find(&name).unwrap_or_default())
}

/// What `timestep --help` says first.
const ABOUT: &str = "\
Measure the errors of the time steps of a particle code: the difference in ε_t, in ε_n and in the \
energy after a contact between its steps of fixed length dt and a collision without steps. They \
are told as median, root mean square and largest error over all impacts and over the parts of a \
step after which a contact begins.

Steps are told as numbers t_c/dt in the undamped contact time t_c, which in scaled units is π for \
a linear force and 3.218 for Hertz'. The energy after the contact is a part of that before.

An interval of --kappa or --psi stands for a grid of values in equal ratios; with two intervals \
all pairs are computed.";

/// What `timestep --help` says last.
const EXAMPLES: &str = "\
Schemes:
  lammps   velocity Verlet, with forces at the velocities of half steps; the history advances by
           whole steps, in the first step of a contact too; also MercuryDPM's and MFiX'
  elapsed  the same, but in the first step of a contact the history advances by the time since it
           began, as in older versions of MFiX
  synchronized_verlet
           velocities are taken along the normal in the middle of a step, as that keyword of LAMMPS
           does; the same as lammps without --overlap

Status of a step:
  ok          all contacts end, and the steps resolve both springs
  unstable    a spring is not resolved, and its oscillation grows from step to step
  unfinished  some contacts do not end, so that there are no errors

With --error E, the largest dt/t_c is told at which the largest error is at most E, and at all
shorter ones of the given steps too. Nothing is promised of steps that were not given.

With --overlap, what a turning normal changes is in the errors too, and does not vanish with the
step: ε_n and ε_t are those of the normal with which the contact begins.

With --bodies, steps are told in seconds and in Rayleigh times too. The file has the constants of
the law, as `impact --help` lists them.

Examples:
  stickslip timestep --kappa 3 --psi 0.4 --damping 0.3 --law gran/hertz/history
  stickslip timestep --kappa 1:60 --psi 0.05:2 --error 0.01 --plot errors.svg
  stickslip timestep --bodies examples/steel_spheres.json --steps 20,50,100 --format json
  stickslip timestep --bodies examples/hooke_spheres.json --law gran/hooke/history
  stickslip timestep --kappa 3 --psi 2 --law gran/hooke/history --overlap 0.01

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
