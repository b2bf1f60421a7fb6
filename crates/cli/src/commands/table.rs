//! `table`: the restitution to be looked up.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use stickslip_files::input::bodies::read_pair;
use stickslip_files::input::law::permits;
use stickslip_files::input::parameter::Parameter;
use stickslip_files::input::{number, range};
use stickslip_files::output::file::OutputFile;
use stickslip_files::output::{json, table_npz};
use stickslip_plane::Range;
use stickslip_practice::tables::{
    self, RestitutionTable, TableDocument, TableSettings, TableVerification, TableWindow,
};

use crate::error::Failure;
use crate::output::console::{deliver, print};
use crate::output::text::pairs;
use crate::shared::collision::damping_for;
use crate::shared::files::require_different;
use crate::shared::law::{self, LawArguments};
use crate::shared::study::refused;
use crate::shared::threads::ThreadsArguments;
use crate::version;

/// Make a table of the restitution, to be looked up in nanoseconds
#[derive(Debug, clap::Args)]
#[command(long_about = ABOUT, after_long_help = EXAMPLES)]
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

    /// Coefficient of normal restitution, instead of --damping; above 0, at most 1
    #[arg(long, value_name = "E", help_heading = "Window", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::NormalRestitution.parse(text))]
    #[arg(conflicts_with = "damping")]
    pub e_n: Option<f64>,

    /// JSON file of two bodies as `impact` reads it, for a table over velocities; motions in it are
    /// not used
    #[arg(long, value_name = "FILE.json", help_heading = "Window of velocities")]
    #[arg(conflicts_with_all = ["kappa", "psi", "damping", "e_n", "tangential_damping", "dynamic_friction"])]
    #[arg(requires_all = ["normal", "tangential"])]
    pub bodies: Option<PathBuf>,

    /// Interval of the normal velocity g_n of the surfaces in m/s, with --bodies; above 0
    #[arg(long, value_name = "LO:HI", help_heading = "Window of velocities")]
    #[arg(allow_hyphen_values = true, requires = "bodies", value_parser = range::parse_above_0)]
    pub normal: Option<Range>,

    /// Interval of the tangential velocity g_t of the surfaces in m/s, with --bodies; above 0
    #[arg(long, value_name = "LO:HI", help_heading = "Window of velocities")]
    #[arg(allow_hyphen_values = true, requires = "bodies", value_parser = range::parse_above_0)]
    pub tangential: Option<Range>,

    /// The contact law.
    #[command(flatten)]
    pub law: LawArguments,

    /// Bound of the errors of ε_t and ε_n; 1e-12 to 1e-3, with other laws than the paper's from
    /// 1e-9
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

    /// The threads.
    #[command(flatten)]
    pub threads: ThreadsArguments,
}

/// Makes a table, writes its files and prints what it is.
pub fn run(arguments: &TableArguments) -> Result<(), Failure> {
    let TableArguments { bound, regions, prefix, out, bodies, .. } = arguments;
    let settings = TableSettings { window: window(arguments)?, bound: *bound, regions: *regions };
    settings.validate().map_err(refused)?;
    let outputs: Vec<_> = out.iter().map(|out| ("--out", Some(out.as_path()))).collect();
    require_different(
        &outputs,
        &[("--bodies", bodies.as_deref()), law::file(arguments.law.law.as_deref())],
    )?;
    tables::require_prefix(prefix).map_err(refused)?;
    let formats = out.iter().map(|out| TableFormat::of(out)).collect::<Result<Vec<_>, _>>()?;
    let files = out.iter().map(|out| OutputFile::create(out)).collect::<Result<Vec<_>, _>>()?;
    let table = arguments.threads.with_steps(|report| tables::run(&settings, report))??;
    let stored = files.into_iter().zip(formats).map(|(file, format)| {
        let content = match format {
            TableFormat::Json => json::sealed_line(&TableDocument::from(&table)),
            TableFormat::Npz => table_npz::archive(&table, &version::program()),
            TableFormat::Header => {
                table.c_header(prefix).map(String::into_bytes).map_err(io::Error::other)
            }
        };
        let content = content.map_err(|error| file.failure(error))?;
        file.finish(&content)
    });
    deliver(stored.collect::<Result<Vec<_>, _>>()?, "")?;
    print(|out| summary(out, &table))
}

/// The window that the options give: of κ and ψ, or of velocities.
fn window(arguments: &TableArguments) -> Result<TableWindow, Failure> {
    let TableArguments { kappa, psi, damping, e_n, bodies, normal, tangential, .. } = arguments;
    let (law, tangential_damping) = arguments.law.chosen()?;
    match (bodies, normal, tangential, kappa, psi) {
        (Some(file), &Some(normal_m_per_s), &Some(tangential_m_per_s), _, _) => {
            let pair = read_pair(file, law)?;
            let name = arguments.law.law.as_deref();
            permits(name, "tangential damping", pair.tangential_damping())?;
            Ok(TableWindow::Velocities { pair, normal_m_per_s, tangential_m_per_s })
        }
        (None, _, _, &Some(kappa), &Some(psi)) => {
            let damping = match *e_n {
                Some(e_n) => damping_for(law, e_n)?,
                None => damping.unwrap_or(0.0),
            };
            Ok(TableWindow::Scaled { kappa, psi, damping, law, tangential_damping })
        }
        // The parser of the options asks for either.
        _ => {
            let expected = "expected --kappa and --psi, or --bodies, --normal and --tangential";
            Err(Failure::Usage(format!("no window; {expected}")))
        }
    }
}

/// The format of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum TableFormat {
    /// JSON.
    Json,
    /// NumPy arrays.
    Npz,
    /// A header for C.
    Header,
}

impl TableFormat {
    /// The format that the name of the file `out` tells.
    fn of(out: &Path) -> Result<Self, Failure> {
        match out.extension().and_then(|extension| extension.to_str()) {
            Some("json") => Ok(Self::Json),
            Some("npz") => Ok(Self::Npz),
            Some("h") => Ok(Self::Header),
            _ => Err(Failure::Usage(format!(
                "--out {}: the name does not tell the format; expected FILE.json, FILE.npz or FILE.h",
                out.display()
            ))),
        }
    }
}

fn summary(out: &mut dyn Write, table: &RestitutionTable) -> io::Result<()> {
    let TableVerification { points, largest_error, x, y, largest_error_of_eps_n } =
        table.verification;
    let [slabs, strips] = table.pieces();
    let (names, units) = match table.window {
        TableWindow::Scaled { .. } => (["κ", "ψ"], ""),
        TableWindow::Velocities { .. } => (["g_n", "g_t"], " m/s"),
    };
    let [first, second] = names;
    let normal = match table.constant_eps_n {
        Some(eps_n) => ("ε_n", format!("{eps_n:?}")),
        None => ("largest error of ε_n", format!("{largest_error_of_eps_n:.2e}")),
    };
    pairs(
        out,
        &[
            ("bound of the errors", format!("{:?}", table.bound)),
            (
                "largest error of ε_t",
                format!("{largest_error:.2e} at {first} = {x:?}{units}, {second} = {y:?}{units}"),
            ),
            normal,
            ("points compared", points.to_string()),
            ("pieces", format!("{strips} in {slabs} intervals of {first}")),
            ("size in memory", format!("{} bytes", table.bytes())),
        ],
    )
}

/// What `table --help` says first.
const ABOUT: &str = "\
Make a table of the restitution for programs that look up millions of collisions: over (κ, ψ) at one \
damping, or over the velocities (g_n, g_t) of two bodies in m/s. Its errors are below a bound \
everywhere.

Polynomials follow the boundaries on which the switches of a collision change, so that a kink of \
ε_t stays a kink. The table is compared with collisions in each of its pieces and on both sides of \
all boundaries. Without the bound there is no table, and the exit code is 1.

The contact law is the paper's, or that of --law. At one damping ε_n is one number, which the table has too; over \
velocities it is a function of g_n.";

/// What `table --help` says last.
const EXAMPLES: &str = "\
Files:
  FILE.json  everything, for stickslip.load_table in Python and for Rust
  FILE.npz   the same arrays for NumPy
  FILE.h     a header for C99 and C++ with functions NAME_eps_t(kappa, psi) and, with --regions,
             NAME_region(kappa, psi); or NAME_eps_t(g_n, g_t), NAME_eps_n(g_n) and
             NAME_region(g_n, g_t). It needs the standard library only

Examples:
  stickslip table --kappa 0.5:100 --psi 0.01:3 --out table.h --out table.json
  stickslip table --kappa 1:20 --psi 0.05:2.5 --damping 0.3 --bound 1e-6 --regions --out table.npz
  stickslip table --kappa 1:20 --psi 0.1:3 --damping 0.2 --law gran/hertz/history --bound 1e-6 --out t.h
  stickslip table --bodies examples/glass_on_wall.json --normal 0.1:10 --tangential 0.01:20 --out t.h

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
