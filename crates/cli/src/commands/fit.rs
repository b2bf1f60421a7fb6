//! `fit`: a contact law fitted to measured impacts, printed and drawn.

mod input;
mod table;

use std::path::{Path, PathBuf};

use stickslip_figure::pictures;
use stickslip_files::input::parameter::Parameter;
use stickslip_files::input::source::{is_standard_input, shown};
use stickslip_files::input::{bodies, law, measured, number, range};
use stickslip_files::output::json;
use stickslip_files::output::picture::PictureFile;
use stickslip_model::{Contact, Law, presets};
use stickslip_plane::Range;
use stickslip_practice::fit::{self, FitSettings, FittedBodies, Free, Values};
use stickslip_practice::inputs::Code;

use crate::error::Failure;
use crate::output::console::{deliver, print};
use crate::shared::Format;
use crate::shared::collision::reduction;
use crate::shared::files::{self, plotted, require_different};
use crate::shared::law::LawArguments;
use crate::shared::threads::ThreadsArguments;

/// Fit a contact law to measured impacts
#[derive(Debug, clap::Args)]
#[command(long_about = ABOUT, after_long_help = EXAMPLES)]
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
    #[arg(conflicts_with_all = ["kappa", "mu", "alpha", "damping", "tangential_damping", "dynamic_friction"])]
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

    /// How the result is printed
    #[arg(long, value_enum, default_value_t = Format::Table, help_heading = "Output")]
    pub format: Format,

    /// Input of a particle code with the best fit, printed instead of the tables: lammps, liggghts,
    /// yade, mfix or mercury
    #[arg(long, value_name = "CODE", help_heading = "Output", requires = "bodies")]
    #[arg(conflicts_with = "format", value_parser = code)]
    pub write: Option<Code>,

    /// Picture of data, fit and boundaries, which are printed as well
    #[arg(long, value_name = "FILE.svg|.png|.pdf", help_heading = "Output")]
    #[arg(value_parser = files::picture())]
    pub plot: Option<PictureFile>,

    /// The threads.
    #[command(flatten)]
    pub threads: ThreadsArguments,
}

/// Makes the fit, draws it if that is wanted, and prints it.
pub fn run(arguments: &FitArguments) -> Result<(), Failure> {
    let settings = settings(arguments)?;
    let plot = arguments.plot.as_ref();
    plot.map_or(Ok(()), PictureFile::probe)?;
    let result = arguments.threads.with_steps(|report| fit::run(&settings, report))??;
    if let Some(plot) = plot {
        let picture = pictures::fit::draw(&result).ok_or_else(|| {
            let expected = "expected data at an angle above 0";
            Failure::Usage(format!("--plot has nothing to draw; {expected}"))
        })?;
        deliver([plot.write(Ok(picture))?], "")?;
    }
    if let Some(code) = arguments.write {
        let text = input::of(&result, &settings.bodies, code, arguments.threads)?;
        return print(|out| out.write_all(text.as_bytes()));
    }
    print(|out| match arguments.format {
        Format::Json => json::lines(out, &result),
        Format::Table => table::write(out, &result),
    })
}

/// The data, and what is fitted.
fn settings(arguments: &FitArguments) -> Result<FitSettings, Failure> {
    let FitArguments { data, bodies: file, free, .. } = arguments;
    if is_standard_input(data) && file.as_deref().is_some_and(is_standard_input) {
        let expected = "expected a file for one of them";
        return Err(Failure::Usage(format!(
            "DATA.csv and --bodies are both standard input; {expected}"
        )));
    }
    let inputs = [("DATA.csv", Some(data.as_path())), ("--bodies", file.as_deref())];
    require_different(&[plotted(arguments.plot.as_ref())], &inputs)?;
    let name = arguments.law.law.as_deref();
    if free.contains(&Free::TangentialDamping) {
        permits(name)?;
    }
    let bodies = match file {
        Some(file) => in_file(file, name)?,
        None => scaled(arguments, arguments.law.chosen()?.0)?,
    };
    if let Some(speed) = arguments.speed.filter(|speed| *speed <= 0.0) {
        let expected = "expected a finite number above 0, in m/s";
        return Err(Failure::Usage(format!("--speed = {speed:?} is out of range; {expected}")));
    }
    let scaled = bodies.are_scaled();
    let mut settings = FitSettings::new(bodies, measured::read(data, arguments.speed, scaled)?);
    settings.free.clone_from(free);
    for (index, (free, range)) in arguments.range.iter().enumerate() {
        let name = free.name();
        if !settings.free.contains(free) {
            let expected = "expected what is in --free";
            return Err(Failure::Usage(format!("--range {name} has no effect; {expected}")));
        }
        if arguments.range[..index].iter().any(|(other, _)| other == free) {
            return Err(Failure::Usage(format!(
                "--range {name} is given twice; expected one range"
            )));
        }
        *settings.ranges.of_mut(*free) = *range;
    }
    settings.eps_n = arguments.eps_n;
    settings.level = arguments.level;
    settings.relative_errors = arguments.relative_errors;
    settings.validate().map_err(|invalid| Failure::input(shown(data), invalid))?;
    Ok(settings)
}

/// Refuses a free tangential damping in a law that is known to have none.
fn permits(name: Option<&str>) -> Result<(), Failure> {
    match name.and_then(presets::find) {
        Some(preset) if !preset.tangential_damping => Err(Failure::Usage(format!(
            "tangential_damping cannot be fitted in the law {}: {}; expected other free numbers, or \
             a file of the law that is meant",
            preset.name, preset.checked
        ))),
        _ => Ok(()),
    }
}

fn in_file(file: &Path, name: Option<&str>) -> Result<FittedBodies, Failure> {
    let law = law::by_name_or_file(name)?;
    let (sphere, pair) = bodies::read_sphere_and_pair(file, law)?;
    law::permits(name, "tangential damping", pair.tangential_damping())?;
    Ok(FittedBodies::of_sphere(&sphere, pair))
}

/// Bodies of which nothing but α is known.
fn scaled(arguments: &FitArguments, law: Law) -> Result<FittedBodies, Failure> {
    let FitArguments { kappa, mu, damping, free, .. } = arguments;
    let fixed = |name: &str, value: Option<f64>, which: Free| match (value, free.contains(&which)) {
        (Some(value), true) => Err(Failure::Usage(format!(
            "--{name} {value:?} has no effect, since it is fitted; expected it without {name} in --free"
        ))),
        (value, _) => Ok(value),
    };
    let needed = |name: &str, value: Option<f64>, which: Free| {
        let value = fixed(name, value, which)?;
        // What is fitted may have any value.
        let any = free.contains(&which).then_some(1.0);
        value.or(any).ok_or_else(|| {
            Failure::Usage(format!(
                "--{name} is missing; expected it, {name} in --free, or --bodies"
            ))
        })
    };
    let dashpot = arguments.law.tangential_damping;
    let values = Values {
        kappa: needed("kappa", *kappa, Free::Kappa)?,
        mu: needed("mu", *mu, Free::Mu)?,
        tangential_damping: fixed("tangential-damping", dashpot, Free::TangentialDamping)?
            .unwrap_or(0.0),
        damping: fixed("damping", *damping, Free::Damping)?.unwrap_or(0.0),
    };
    if let (Some(damping), Some(eps_n)) = (damping, arguments.eps_n) {
        return Err(Failure::Usage(format!(
            "--damping {damping:?} and --eps-n {eps_n:?} are both given; expected one of them"
        )));
    }
    let alpha = reduction(None, arguments.alpha).alpha;
    Contact::new(values.kappa, 1.0, values.damping)
        .and_then(|contact| contact.with_law(law, values.tangential_damping))
        .and_then(|_| FittedBodies::scaled(law, alpha, &values))
        .map_err(|invalid| Failure::Usage(invalid.to_string()))
}

/// Reads the name of a particle code.
fn code(text: &str) -> Result<Code, String> {
    Code::find(text).ok_or_else(|| {
        let names = Code::ALL.map(Code::name).join(", ");
        format!("no particle code is named {text:?}; expected one of {names}")
    })
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
    Ok((free(name)?, range::parse(ends)?))
}

/// What `fit --help` says first.
const ABOUT: &str = "\
Fit the tangential stiffness and the friction of a contact law, or other numbers, to measured \
restitution, spins or rebound angles of impacts without spin before. Such problems have many \
minima. All of them in a range are found and printed, the best one first, with confidence \
intervals from profiles over the whole range, which may have several pieces.

The normal restitution decides the damping by itself, from data of eps_n or by --eps-n. Without \
--bodies all impacts have the same unknown speed, and the stiffness is told as κ at normal \
incidence.";

/// What `fit --help` says last.
const EXAMPLES: &str = "\
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
  stickslip fit examples/oblique_impacts.csv --bodies examples/aluminium_oxide_on_glass.json \\
    --speed 3.9 --write lammps
  stickslip fit data.csv --free kappa,mu --range kappa=1:80 --format json

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
