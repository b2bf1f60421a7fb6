//! The options of `table`.

use std::path::PathBuf;

use stickslip_files::input::parameter::Parameter;
use stickslip_files::input::{number, range};
use stickslip_plane::Range;

use super::shared;

/// Options of `table`.
#[derive(Debug, clap::Args)]
pub struct TableArguments {
    /// Interval of the scaled stiffness κ = k_t/(α m β^⅘ g_n^⅖), above 0
    #[arg(long, value_name = "LO:HI", help_heading = "Window", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| range::parse_for(Parameter::Kappa, text))]
    #[arg(required_unless_present = "bodies")]
    pub kappa: Option<Range>,

    /// Interval of the reduced impact ratio ψ = (g_t/g_n)·α/μ, above 0
    #[arg(long, value_name = "LO:HI", help_heading = "Window", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| range::parse_for(Parameter::Psi, text))]
    #[arg(required_unless_present = "bodies")]
    pub psi: Option<Range>,

    /// Scaled damping a = A β^⅖ g_n^⅕ of the normal force; 0 or above [default: 0]
    #[arg(long, value_name = "D", help_heading = "Window", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Damping.parse(text))]
    pub damping: Option<f64>,

    /// JSON file of two bodies as `impact` reads it, for a table over velocities; motions in it are
    /// not used
    #[arg(long, value_name = "FILE.json", help_heading = "Window of velocities")]
    #[arg(conflicts_with_all = ["kappa", "psi", "damping"], requires_all = ["normal", "tangential"])]
    pub bodies: Option<PathBuf>,

    /// Interval of the normal velocity g_n of the surfaces in m/s, with --bodies; above 0
    #[arg(long, value_name = "LO:HI", help_heading = "Window of velocities")]
    #[arg(allow_hyphen_values = true, requires = "bodies", value_parser = range::parse_above_0)]
    pub normal: Option<Range>,

    /// Interval of the tangential velocity g_t of the surfaces in m/s, with --bodies; above 0
    #[arg(long, value_name = "LO:HI", help_heading = "Window of velocities")]
    #[arg(allow_hyphen_values = true, requires = "bodies", value_parser = range::parse_above_0)]
    pub tangential: Option<Range>,

    /// Bound of the errors of ε_t and ε_n; 1e-12 to 1e-3
    #[arg(long, value_name = "E", help_heading = "Table", allow_hyphen_values = true)]
    #[arg(value_parser = number::parse_option, default_value = "1e-8")]
    pub bound: f64,

    /// Give the table the number of the atlas' region at each place too, with its switches
    #[arg(long, help_heading = "Table")]
    pub regions: bool,

    /// What names in a C header begin with
    #[arg(long, value_name = "NAME", help_heading = "Table", default_value = "stickslip")]
    pub prefix: String,

    /// File for the table: JSON, NumPy arrays or a C header; may be given more than once
    #[arg(long, value_name = "FILE.json|.npz|.h", help_heading = "Output", required = true)]
    pub out: Vec<PathBuf>,

    /// Threads; 1 to 1024 [default: one for each core]; results do not depend on it
    #[arg(long, value_name = "N", help_heading = "Output", allow_hyphen_values = true)]
    #[arg(value_parser = shared::threads())]
    pub threads: Option<u16>,
}

/// What `table --help` says first.
pub const ABOUT: &str = "\
Make a table of the restitution for programs that look up millions of collisions: over (κ, ψ) at one \
damping, or over the velocities (g_n, g_t) of two bodies in m/s. Its errors are below a bound \
everywhere.

Polynomials follow the boundaries on which the switches of a collision change, so that a kink of \
ε_t stays a kink. The table is compared with collisions in each of its pieces and on both sides of \
all boundaries. Without the bound there is no table, and the exit code is 1.

The contact law is the paper's. At one damping ε_n is one number, which the table has too; over \
velocities it is a function of g_n.";

/// What `table --help` says last.
pub const EXAMPLES: &str = "\
Files:
  FILE.json  everything, for stickslip.load_table in Python and for Rust
  FILE.npz   the same arrays for NumPy
  FILE.h     a header for C99 and C++ with functions NAME_eps_t(kappa, psi) and, with --regions,
             NAME_region(kappa, psi); or NAME_eps_t(g_n, g_t), NAME_eps_n(g_n) and
             NAME_region(g_n, g_t). It needs the standard library only

Examples:
  stickslip table --kappa 0.5:100 --psi 0.01:3 --out table.h --out table.json
  stickslip table --kappa 1:20 --psi 0.05:2.5 --damping 0.3 --bound 1e-6 --regions --out table.npz
  stickslip table --bodies examples/glass_on_wall.json --normal 0.1:10 --tangential 0.01:20 --out t.h

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
