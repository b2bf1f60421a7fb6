//! What `map` is to do.

use std::path::{Path, PathBuf};

use stickslip_files::input::part::MapPart;
use stickslip_files::input::range::Size;
use stickslip_files::input::source::is_standard_input;
use stickslip_files::input::{bodies, law};
use stickslip_files::output::picture::PictureFile;
use stickslip_model::{Engine, Law};
use stickslip_plane::atlas::RatioRange;
use stickslip_plane::{Coordinates, Grid, GridAxis, Range};

use super::engine::engine;
use super::files::require_different;
use super::law::chosen_law;
use super::system::SystemPlane;
use super::window::{ImpactRange, KappaWindow};
use crate::args::{MapArguments, Method};
use crate::error::Failure;

/// What is to be mapped.
#[derive(Debug)]
pub enum Mapped {
    /// Collisions.
    Collisions(Box<MapPlan>),
    /// A system of one's own.
    System(Box<SystemMapPlan>),
}

/// A map of a system of one's own.
#[derive(Debug)]
pub struct SystemMapPlan {
    /// The runs.
    pub plane: SystemPlane,
    /// The number of columns and rows.
    pub size: Size,
    /// The file of the map.
    pub out: PathBuf,
    /// The format of that file.
    pub format: MapFormat,
    /// The file of a picture, if the map is drawn.
    pub plot: Option<PictureFile>,
    /// The number of threads; `None` is one for each core.
    pub threads: Option<u16>,
}

/// The largest number of points of a map of a system, which is in memory.
const MOST_POINTS: usize = 100_000_000;

impl Mapped {
    /// The plan that `arguments` make.
    ///
    /// # Errors
    /// As [`MapPlan::new`]; or the system cannot be read, or options do not fit it.
    pub fn new(arguments: &MapArguments) -> Result<Self, Failure> {
        let Some(plane) = SystemPlane::new(&arguments.plane)? else {
            return MapPlan::new(arguments).map(|plan| Self::Collisions(Box::new(plan)));
        };
        let &MapArguments { size, ref out, ref plot, threads, .. } = arguments;
        let picture = plot.as_ref().map(PictureFile::path);
        let system = arguments.plane.system.as_deref();
        require_different(&[("--out", Some(out)), ("--plot", picture)], &[("the system", system)])?;
        if size.columns.saturating_mul(size.rows) > MOST_POINTS {
            return Err(Failure::Usage(format!(
                "--size: {}x{} points; expected at most {MOST_POINTS} of a system",
                size.columns, size.rows
            )));
        }
        let (format, out, plot) = (MapFormat::of(out)?, out.clone(), plot.clone());
        Ok(Self::System(Box::new(SystemMapPlan { plane, size, out, format, plot, threads })))
    }
}

/// A map of collisions to be computed.
#[derive(Clone, Debug, PartialEq)]
pub struct MapPlan {
    /// The cells of the map.
    pub grid: Grid,
    /// What computes the collisions.
    pub engine: Engine,
    /// The file of the map.
    pub out: PathBuf,
    /// What that file holds.
    pub output: MapOutput,
    /// The file of a picture, if the map is drawn.
    pub plot: Option<PictureFile>,
    /// The number of threads; `None` is one for each core.
    pub threads: Option<u16>,
}

/// What a map is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapOutput {
    /// The whole map.
    Whole(MapFormat),
    /// One of its parts, which are to be joined.
    Part(MapPart),
}

/// The format of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapFormat {
    /// NumPy arrays.
    Npz,
    /// A table.
    Csv,
}

impl MapPlan {
    /// The plan that `arguments` make.
    ///
    /// # Errors
    /// [`Failure::Usage`] says which options contradict each other. [`Failure::File`]: the file of
    /// the bodies cannot be used.
    pub fn new(arguments: &MapArguments) -> Result<Self, Failure> {
        let MapArguments { size, out, plot, bodies, .. } = arguments;
        let picture = plot.as_ref().map(PictureFile::path);
        require_different(
            &[("--out", Some(out)), ("--plot", picture)],
            &[("--bodies", bodies.as_deref())],
        )?;
        let output = MapOutput::new(arguments)?;
        let law = chosen_law(&arguments.law)?;
        let mut tangential_damping = arguments.law.tangential_damping.unwrap_or(0.0);
        let MapAxes { columns, rows, coordinates, engine } = match bodies {
            Some(file) => MapAxes::of_bodies(arguments, file, law)?,
            None => MapAxes::scaled(arguments, (law, tangential_damping))?,
        };
        if let Coordinates::Velocities { pair } = coordinates {
            tangential_damping = pair.tangential_damping();
            law::permits(arguments.law.law.as_deref(), "tangential damping", tangential_damping)?;
        }
        Ok(Self {
            grid: Grid {
                columns: GridAxis { range: columns, cells: size.columns },
                rows: GridAxis { range: rows, cells: size.rows },
                coordinates,
                law,
                tangential_damping,
            },
            engine,
            out: out.clone(),
            output,
            plot: plot.clone(),
            threads: arguments.threads,
        })
    }
}

impl MapOutput {
    fn new(arguments: &MapArguments) -> Result<Self, Failure> {
        let MapArguments { part, out, .. } = arguments;
        match part {
            None => MapFormat::of(out).map(Self::Whole),
            Some(_) if is_standard_input(out) => {
                let message = "--out -: a part is not written to standard output; expected a file";
                Err(Failure::Usage(message.to_owned()))
            }
            Some(part) => Ok(Self::Part(*part)),
        }
    }
}

impl MapFormat {
    /// The format that the name of the file `out` tells.
    ///
    /// # Errors
    /// [`Failure::Usage`]: the name tells none.
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

/// The axes of a map, what they mean, and what computes the collisions.
struct MapAxes {
    columns: Range,
    rows: Range,
    coordinates: Coordinates,
    engine: Engine,
}

impl MapAxes {
    /// The axes κ and ψ, or κ and g_t/g_n.
    fn scaled(arguments: &MapArguments, law: (Law, f64)) -> Result<Self, Failure> {
        let MapArguments { kappa, psi, ratio, collisions, ref method, .. } = *arguments;
        let window = KappaWindow::new(kappa, psi, ratio, collisions)?;
        let engine = engine(method, Method::Auto, law)?;
        let damping = collisions.damping.unwrap_or(0.0);
        let (rows, coordinates) = match window.impact {
            ImpactRange::Psi(psi) => (psi, Coordinates::Psi { damping }),
            ImpactRange::Ratio(RatioRange { range, reduction }) => {
                (range, Coordinates::Ratio { reduction, damping })
            }
        };
        Ok(Self { columns: window.kappa, rows, coordinates, engine })
    }

    /// The axes g_n and g_t of the bodies in `file`.
    fn of_bodies(arguments: &MapArguments, file: &Path, law: Law) -> Result<Self, Failure> {
        let (Some(columns), Some(rows)) = (arguments.normal, arguments.tangential) else {
            let message = "--normal or --tangential is missing; expected --bodies with both";
            return Err(Failure::Usage(message.to_owned()));
        };
        let pair = bodies::read_pair(file, law)?;
        let law = (law, pair.tangential_damping());
        let engine = engine(&arguments.method, Method::Auto, law)?;
        Ok(Self { columns, rows, coordinates: Coordinates::Velocities { pair }, engine })
    }
}
