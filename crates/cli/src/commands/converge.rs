//! `converge`: how errors fall with the step and the tolerance, and what they cost.

use std::path::{Path, PathBuf};

use stickslip_figure::pictures::studies as pictures;
use stickslip_files::input::parameter::Parameter;
use stickslip_files::input::recipe::Given;
use stickslip_model::Law;
use stickslip_studies::convergence::{self, ConvergenceSettings};
use stickslip_studies::own_system;

use crate::error::Failure;
use crate::shared::collision::{CollisionArguments, contact};
use crate::shared::study;
use crate::shared::system::{GivenArguments, SystemRun};
use crate::shared::threads::ThreadsArguments;

/// Measure how errors fall with the step and the tolerance, and what they cost
#[derive(Debug, clap::Args)]
#[command(long_about = ABOUT, after_long_help = EXAMPLES)]
pub struct ConvergeArguments {
    /// A system of your own instead of collisions: a text as docs/systems.md describes it; - is
    /// standard input
    #[arg(value_name = "SYSTEM.slip")]
    #[arg(conflicts_with_all = ["kappa", "ratio", "psi", "mu", "alpha", "damping"])]
    pub system: Option<PathBuf>,

    /// What else differs from the text.
    #[command(flatten)]
    pub given: GivenArguments,

    /// Scaled stiffness κ of one collision, instead of the usual 38; above 0, at most 10⁶
    #[arg(long, value_name = "K", help_heading = "Collision", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Kappa.parse_positive(text))]
    pub kappa: Option<f64>,

    /// Impact ratio g_t/g_n of that collision; above 0; gives ψ = G·α/μ
    #[arg(long, value_name = "G", help_heading = "Collision", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Ratio.parse(text))]
    pub ratio: Option<f64>,

    /// Reduced impact ratio ψ = (g_t/g_n)·α/μ of that collision, instead of --ratio; above 0
    #[arg(long, value_name = "P", help_heading = "Collision", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Psi.parse(text))]
    pub psi: Option<f64>,

    /// The parameters beside κ and ψ. The damping is also that of the usual collisions.
    #[command(flatten, next_help_heading = "Collision")]
    pub collision: CollisionArguments,

    /// Directory for the files of the study; created if it is missing
    #[arg(long, value_name = "DIR", help_heading = "Output")]
    pub out: PathBuf,

    /// The threads.
    #[command(flatten)]
    pub threads: ThreadsArguments,
}

/// Makes the study, writes its files and prints its findings.
pub fn run(arguments: &ConvergeArguments) -> Result<(), Failure> {
    let ConvergeArguments { system, out, threads, .. } = arguments;
    if let Some(path) = system {
        let settings = own_system(path, &arguments.given)?;
        return study::run(out, *threads, |report| {
            let measured = own_system::run(&settings, report)?;
            Ok((measured.study(), pictures::own_system::draw(&measured)))
        });
    }
    let settings = collisions(arguments)?;
    study::run(out, *threads, |report| {
        let measured = convergence::run(&settings, report)?;
        Ok((measured.study(), pictures::convergence::draw(&measured)))
    })
}

/// The collisions of the options, or the usual ones.
fn collisions(arguments: &ConvergeArguments) -> Result<ConvergenceSettings, Failure> {
    let ConvergeArguments { kappa, psi, ratio, collision, .. } = *arguments;
    let CollisionArguments { mu, alpha, damping, e_n } = collision;
    let settings = if [kappa, psi, ratio, mu, alpha].iter().all(Option::is_none) {
        let usual = ConvergenceSettings::usual(collision.damping(Law::PAPER)?);
        usual.map_err(|invalid| Failure::Usage(invalid.to_string()))?
    } else {
        let given = Given { kappa, psi, ratio, mu, alpha, damping, e_n, ..Given::default() };
        ConvergenceSettings { contacts: vec![contact(&given)?] }
    };
    settings.validate().map_err(study::refused)?;
    Ok(settings)
}

/// The run of a system of one's own.
fn own_system(
    path: &Path,
    given: &GivenArguments,
) -> Result<own_system::OwnSystemSettings, Failure> {
    let SystemRun { name, system, runnable, end, .. } =
        SystemRun::new(path, &given.set, given.end)?;
    Ok(own_system::OwnSystemSettings { name, system, runnable, end })
}

/// What `converge --help` says first.
const ABOUT: &str = "\
Measure how accurate the integrators are: the order with which errors fall in fixed steps, the \
errors at a tolerance, and the work that an accuracy takes. This is done for both Dormand–Prince \
pairs, in regularised coordinates and in plain time, with switches located and with steps that run \
over them.

Errors are those of the final tangential velocity and of all switch times. The reference is the \
exact solution or, with damping, dop853 at a tolerance of 1e-15. Without --kappa, errors are root \
mean squares over 38 collisions with κ = 18 and 63 and ψ = 0.1, 0.2, … 1.9, which have two to eight \
switches; --damping is then the damping of all of them.

With SYSTEM.slip, a run of a system of your own at tolerances from 1e-2 to 1e-13, with both methods: \
the errors of its last state and of the times of its events, and where there are other events.";

/// What `converge --help` says last.
const EXAMPLES: &str = "\
Files in DIR:
  convergence.json              everything below except times
  convergence_orders.csv        fitted orders with their standard errors
  convergence_steps.csv         errors and work in fixed steps
  convergence_tolerances.csv    errors and work at tolerances
  convergence_collisions.csv    each collision as `collide` computes it, with its errors
  convergence_time.csv          measured times, the only file that differs from run to run
  convergence_*.svg             pictures

With SYSTEM.slip: convergence.json, convergence_tolerances.csv, convergence_events.csv (the events
of the reference, dop853 at a tolerance of 1e-15), and pictures.

Each finding is printed on a line.

Examples:
  stickslip converge --out convergence
  stickslip converge --damping 0.1 --out damped
  stickslip converge --kappa 1000 --psi 0.5 --out stiff
  stickslip converge examples/systems/belt.slip --set belt=0.3 --out belt

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
