//! The options of `stack`.

use std::path::PathBuf;

use stickslip_files::input::parameter::Parameter;
use stickslip_files::input::{number, range};
use stickslip_files::output::picture::PictureFile;
use stickslip_plane::Range;

use super::plane::{Over, PlaneArguments, over};
use super::shared;

/// Options of `stack`.
#[derive(Debug, clap::Args)]
pub struct StackArguments {
    /// A system of one's own.
    #[command(flatten)]
    pub plane: PlaneArguments,

    /// The parameter of the system that differs between the atlases, and its values in ascending
    /// order, two or more
    #[arg(long, value_name = "NAME=V,V,…", value_parser = over, requires = "system")]
    #[arg(help_heading = "System of your own")]
    pub over: Option<Over>,

    /// Interval of the scaled stiffness κ = k_t/(α m β^⅘ g_n^⅖), above 0
    #[arg(long, value_name = "LO:HI", help_heading = "Window", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| range::parse_for(Parameter::Kappa, text))]
    #[arg(required_unless_present = "system", conflicts_with = "system")]
    pub kappa: Option<Range>,

    /// Interval of the reduced impact ratio ψ = (g_t/g_n)·α/μ, above 0
    #[arg(long, value_name = "LO:HI", help_heading = "Window", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| range::parse_for(Parameter::Psi, text))]
    #[arg(required_unless_present = "system", conflicts_with = "system")]
    pub psi: Option<Range>,

    /// Scaled dampings a = A β^⅖ g_n^⅕ of the atlases, in ascending order: two above 0 or more, and
    /// 0 before them or not
    #[arg(long, value_name = "A,B,…", help_heading = "Window", allow_hyphen_values = true)]
    #[arg(value_delimiter = ',', default_value = "0,1e-6,0.1,0.2,0.5,1,1.5,2")]
    #[arg(value_parser = |text: &str| Parameter::Damping.parse(text), conflicts_with = "system")]
    pub damping: Vec<f64>,

    /// Accuracy of boundaries in ψ, also between their points; from 1e-11·(1 + HI) to 1e-9·(1 +
    /// HI) with HI of ψ, and less in narrow windows [default: 1e-10·(1 + HI)]. Of a system, above 0
    /// and below a thousandth of the window [default: 1e-9]
    #[arg(long, value_name = "T", help_heading = "Window", allow_hyphen_values = true)]
    #[arg(value_parser = number::parse_option)]
    pub tolerance: Option<f64>,

    /// JSON file for the atlases' regions and the changes between them
    #[arg(long, value_name = "STACK.json", help_heading = "Output")]
    pub out: PathBuf,

    /// Picture of the atlases, and of the births and deaths of regions over the damping
    #[arg(long, value_name = "FILE.svg|.png", help_heading = "Output")]
    #[arg(value_parser = shared::picture())]
    pub plot: Option<PictureFile>,

    /// Threads for the atlases; 1 to 1024 [default: one for each core]; results do not depend on
    /// it
    #[arg(long, value_name = "N", help_heading = "Output", allow_hyphen_values = true)]
    #[arg(value_parser = shared::threads())]
    pub threads: Option<u16>,
}

/// What `stack --help` says first.
pub const ABOUT: &str = "\
Trace the atlases of a window at several dampings, and find the dampings between them at which \
regions are born, split, merge and die.

Where a special point meets another one or the edge of the window, or where a boundary touches \
another one or the edge, or shrinks to a point, the damping is solved for. A change for which \
nothing can be solved is enclosed between two dampings. Without damping all regions are others, so \
that an atlas at 0 stands beside the others. If something speaks against an atlas, or if changes \
are in doubt, the result is written and says so, and the exit code is 1.

With SYSTEM.slip, the runs of a system of your own over two of its parameters, --x and --y, at \
several values of a third one, --over.";

/// What `stack --help` says last.
pub const EXAMPLES: &str = "\
Examples:
  stickslip stack --kappa 0.5:30 --psi 0.05:2 --out stack.json --plot stack.svg
  stickslip stack --kappa 5:8 --psi 0.5:1.2 --damping 0.05,0.2,0.4 --out stack.json
  stickslip stack examples/systems/ball.slip --x e=0.3:0.7 --y g=5:15 --over height=0.5,1,2 \
    --max-events 6 --end 2 --out stack.json --plot stack.svg

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
