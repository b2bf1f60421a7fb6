//! `map`: the restitution and the number of switches on a plane, or the runs of a system of one's
//! own.

mod collisions;
mod system;

use std::path::{Path, PathBuf};

use stickslip_files::input::part::MapPart;
use stickslip_files::input::range::{self, Size};
use stickslip_files::output::picture::PictureFile;
use stickslip_plane::Range;

use crate::error::Failure;
use crate::shared::collision::CollisionArguments;
use crate::shared::files;
use crate::shared::law::LawArguments;
use crate::shared::method::MethodArguments;
use crate::shared::system::{PlaneArguments, SystemPlane};
use crate::shared::threads::ThreadsArguments;
pub use collisions::{computed, finish, require_all};

/// Compute the restitution and the number of switches on a plane
#[derive(Debug, clap::Args)]
#[command(long_about = ABOUT, after_long_help = EXAMPLES)]
pub struct MapArguments {
    /// A system of one's own.
    #[command(flatten)]
    pub plane: PlaneArguments,

    /// Columns: interval of the scaled stiffness κ = k_t/(α m β^⅘ g_n^⅖), 0 or above
    #[arg(long, value_name = "LO:HI", help_heading = "Window", allow_hyphen_values = true)]
    #[arg(value_parser = range::parse, conflicts_with = "system")]
    pub kappa: Option<Range>,

    /// Rows: interval of the reduced impact ratio ψ = (g_t/g_n)·α/μ, 0 or above
    #[arg(long, value_name = "LO:HI", help_heading = "Window", allow_hyphen_values = true)]
    #[arg(value_parser = range::parse, conflicts_with = "system")]
    pub psi: Option<Range>,

    /// Rows, instead of --psi: interval of the impact ratio g_t/g_n, 0 or above
    #[arg(long, value_name = "LO:HI", help_heading = "Window", allow_hyphen_values = true)]
    #[arg(value_parser = range::parse, conflicts_with = "system")]
    pub ratio: Option<Range>,

    /// JSON file of two bodies, as for impact; the axes are then --normal and --tangential
    #[arg(long, value_name = "FILE.json", help_heading = "Window in SI units")]
    #[arg(conflicts_with_all = ["system", "kappa", "psi", "ratio", "mu", "alpha", "damping", "e_n", "tangential_damping", "dynamic_friction"])]
    pub bodies: Option<PathBuf>,

    /// Columns: interval of the normal velocity g_n of the surfaces in m/s, 0 or above
    #[arg(long, value_name = "LO:HI", help_heading = "Window in SI units")]
    #[arg(value_parser = range::parse, requires = "bodies", allow_hyphen_values = true)]
    pub normal: Option<Range>,

    /// Rows: interval of the tangential velocity g_t of the surfaces in m/s, 0 or above
    #[arg(long, value_name = "LO:HI", help_heading = "Window in SI units")]
    #[arg(value_parser = range::parse, requires = "bodies", allow_hyphen_values = true)]
    pub tangential: Option<Range>,

    /// Number of columns and rows, at most 10000000000 points
    #[arg(long, value_name = "WxH", help_heading = "Window", allow_hyphen_values = true)]
    #[arg(value_parser = Size::parse)]
    pub size: Size,

    /// The parameters beside κ and ψ.
    #[command(flatten, next_help_heading = "Collisions")]
    pub collisions: CollisionArguments,

    /// The contact law.
    #[command(flatten)]
    pub law: LawArguments,

    /// What computes the collisions.
    #[command(flatten)]
    pub method: MethodArguments,

    /// File for the map: NumPy arrays in FILE.npz, or a table in FILE.csv; --plot is enough
    #[arg(long, value_name = "FILE", help_heading = "Output", required_unless_present = "plot")]
    pub out: Option<PathBuf>,

    /// Compute only part K of N of the map, 1 <= K <= N <= 1000000; FILE is then for the command
    /// join, and may have any name
    #[arg(long, value_name = "K/N", help_heading = "Output", allow_hyphen_values = true)]
    #[arg(value_parser = MapPart::parse, conflicts_with_all = ["plot", "system"], requires = "out")]
    pub part: Option<MapPart>,

    /// Picture of ε_t in colours, and of the regions with equal numbers of switches
    #[arg(long, value_name = "FILE.svg|.png|.pdf", help_heading = "Output")]
    #[arg(value_parser = files::picture())]
    pub plot: Option<PictureFile>,

    /// The threads.
    #[command(flatten)]
    pub threads: ThreadsArguments,
}
/// The format of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapFormat {
    /// NumPy arrays.
    Npz,
    /// A table.
    Csv,
}

impl MapFormat {
    /// The format that the name of the file `out` tells.
    pub fn of(out: &Path) -> Result<Self, Failure> {
        match out.extension().and_then(|extension| extension.to_str()) {
            Some("npz") => Ok(Self::Npz),
            Some("csv") => Ok(Self::Csv),
            _ => Err(Failure::Usage(format!(
                "--out {}: the name does not tell the format; expected FILE.npz or FILE.csv",
                out.display()
            ))),
        }
    }
}

/// How points without a result are shown.
pub const IN_ARRAYS: &str = "NaN and -1";
const IN_PICTURES: &str = "grey";

impl MapArguments {
    /// The file of the map, or of its picture if there is no other, and how points without a
    /// result are shown in it.
    fn main_file(&self) -> Result<(&Path, &'static str), Failure> {
        match (&self.out, &self.plot) {
            (Some(out), _) => Ok((out, IN_ARRAYS)),
            (None, Some(plot)) => Ok((plot.path(), IN_PICTURES)),
            // The parser of the options asks for one.
            (None, None) => Err(Failure::Usage("--out is missing; expected it or --plot".into())),
        }
    }
}

/// Computes the map and writes it.
///
/// # Errors
/// Options contradict each other, files cannot be used, or some points have no result. In the last
/// case the map is complete.
pub fn run(arguments: &MapArguments) -> Result<(), Failure> {
    match SystemPlane::new(&arguments.plane)? {
        Some(plane) => system::run(&plane, arguments),
        None => collisions::run(arguments),
    }
}

/// What `map --help` says first.
const ABOUT: &str = "\
Compute the tangential restitution ε_t and the number of switches on a plane, with all cores.

The interval LO:HI of each axis is divided into equal cells, W along κ and H along ψ, and the \
collision at the centre of each cell is computed: κ_i = LO + (HI − LO)·((i + ½)/W) for i = 0 … W − 1, \
and the same for ψ with H. An interval may therefore begin at 0, where there is no collision.

The axes are --kappa and one of --psi and --ratio. For two bodies in SI units they are --normal and \
--tangential, the velocities of the surfaces at the contact.

With SYSTEM.slip, the runs of a system of your own over two of its parameters, --x and --y: the number \
of events, and the time and the state at the end.";

/// What `map --help` says last.
const EXAMPLES: &str = "\
Results:
  FILE.npz has the arrays kappa (W), psi (H), with --ratio also ratio (H), and eps_t and
  switch_count (H x W: one row for each psi). With --bodies they are normal_m_per_s (W),
  tangential_m_per_s (H), kappa (W), psi (H x W), damping (W), eps_t and switch_count. Arrays
  without dimensions say what made the map: damping, with --ratio mu and alpha, or the quantities
  of the bodies; rtol and atol; method and version. FILE.csv has the same names as columns and one
  row per point. A point that cannot be computed is NaN and -1, and the exit code is 1.

  With SYSTEM.slip, FILE.npz has the two parameters (W and H) by their names, event_count (H x W,
  of events before the end), outcome (end, rule, accumulation, event_limit, step_limit or failed),
  end_time, end_mode, and the components of the state, end_NAME. The picture shows the number of events, the time, and the first components.

  Finished tiles are kept in FILE.npz.tiles until the map is complete. After an interruption the
  same command continues where it stopped, and the result is the same, bit for bit.

Examples:
  stickslip map --kappa 0:70 --psi 0:2.9 --size 1000x1000 --out map.npz --plot map.svg
  stickslip map --kappa 0:20 --ratio 0:3.5 --mu 0.4 --alpha 2/7 --size 600x400 --out map.csv
  stickslip map --kappa 17:19 --psi 0:2 --size 500x500 --plot map.png
  stickslip map --kappa 0:70 --psi 0:2.9 --damping 0.05 --size 500x500 --out damped.npz
  stickslip map --bodies pair.json --normal 0:200 --tangential 0:200 --size 500x500 --out si.npz
  stickslip map examples/systems/belt.slip --x belt=0.1:1.5 --y kinetic=0.2:0.9 --size 300x300 \\
    --out belt.npz --plot belt.svg

A map in parts, as a job array of Slurm:
  #!/bin/sh
  #SBATCH --array=1-64
  #SBATCH --cpus-per-task=8
  #SBATCH --requeue
  stickslip map --kappa 0:70 --psi 0:2.9 --size 20000x20000 --part $SLURM_ARRAY_TASK_ID/64 \\
    --threads $SLURM_CPUS_PER_TASK --out map-$SLURM_ARRAY_TASK_ID.part

  When all parts are there, the whole map is made by
  stickslip join map-*.part --out map.npz

  Each part needs its own FILE. A job that was stopped goes on when it is started again, and one
  whose part is there has nothing to do.

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
