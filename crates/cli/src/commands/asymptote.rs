//! `asymptote`: how the tangential restitution vanishes for stiff springs.

use std::path::PathBuf;

use stickslip_figure::pictures::studies as pictures;
use stickslip_files::input::{number, range};
use stickslip_plane::Range;
use stickslip_studies::stiff_springs::{self, StiffSpringSettings};

use crate::error::Failure;
use crate::shared::study;
use crate::shared::threads::ThreadsArguments;

/// Measure how the tangential restitution vanishes for stiff springs
#[derive(Debug, clap::Args)]
#[command(long_about = ABOUT, after_long_help = EXAMPLES)]
pub struct AsymptoteArguments {
    /// Interval of the scaled stiffness κ = k_t/(α m β^⅘ g_n^⅖), from 3 to 10¹⁰
    #[arg(long, value_name = "LO:HI", help_heading = "Collisions", allow_hyphen_values = true)]
    #[arg(value_parser = range::parse, default_value = "10:1e8")]
    pub kappa: Range,

    /// One to four reduced impact ratios ψ = (g_t/g_n)·α/μ, separated by commas; above 0, below 2
    #[arg(long, value_name = "P,…", help_heading = "Collisions", allow_hyphen_values = true)]
    #[arg(value_parser = number::parse_option)]
    #[arg(value_delimiter = ',', default_value = "0.3,1,1.7")]
    pub psi: Vec<f64>,

    /// Directory for the files of the study; created if it is missing
    #[arg(long, value_name = "DIR", help_heading = "Output")]
    pub out: PathBuf,

    /// The threads.
    #[command(flatten)]
    pub threads: ThreadsArguments,
}

/// Makes the study, writes its files and prints its findings.
pub fn run(arguments: &AsymptoteArguments) -> Result<(), Failure> {
    let AsymptoteArguments { kappa, psi, out, threads } = arguments;
    let settings = StiffSpringSettings { kappa: *kappa, psi: psi.clone() };
    settings.validate().map_err(study::refused)?;
    study::run(out, *threads, |report| {
        let measured = stiff_springs::run(&settings, report)?;
        Ok((measured.study(), pictures::stiff_springs::draw(&measured)))
    })
}

/// What `asymptote --help` says first.
const ABOUT: &str = "\
Measure how ε_t tends to 0 for stiff springs, without damping: the largest |w_final| of the \
oscillation around each ψ at each κ, the exponent and the constant of its decay, the same constant \
and the course of an oscillation from the problem of the last instants alone, the bound \
|ε_t| ≤ 1/(ψ√κ) and its missing factor, the largest |ε_t| above several ψ, and the number of switches.

Exponent and constant are fitted to κ from 1000 on, which must span at least a decade and a half.";

/// What `asymptote --help` says last.
const EXAMPLES: &str = "\
Files in DIR:
  asymptote.json                everything below
  asymptote_envelope.csv        largest |w_final| at each κ, around each ψ, with theory and bounds
  asymptote_restitution.csv     largest |ε_t| above several ψ
  asymptote_counts.csv          number of switches
  asymptote_profile.csv         F(phase) of the inner problem
  asymptote_collisions.csv      collisions over one oscillation at 10⁴, 10⁶ and 10⁸ beside F(phase)
  asymptote_convergence.csv     how F(phase) converges
  asymptote_*.svg               pictures

Each finding is printed on a line.

Examples:
  stickslip asymptote --out asymptote
  stickslip asymptote --kappa 1e3:1e6 --psi 0.1,0.5,1.9 --out asymptote

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
