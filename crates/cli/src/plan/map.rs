//! What `map` is to do.

use std::path::{Path, PathBuf};

use stickslip_model::Engine;
use stickslip_plane::atlas::RatioRange;
use stickslip_plane::{Coordinates, Grid, GridAxis, Range};

use crate::args::{MapArguments, Method};
use crate::error::Failure;
use crate::input::bodies::read_pair;
use crate::input::recipe::RecipeError;
use crate::output::picture::PictureFile;
use crate::plan::explain;
use crate::plan::window::Rows;

/// A map to be computed.
#[derive(Clone, Debug, PartialEq)]
pub struct MapPlan {
    /// Its window and cells.
    pub grid: Grid,
    /// What computes the collisions.
    pub engine: Engine,
    /// Where it goes.
    pub out: PathBuf,
    /// How it is written.
    pub format: MapFormat,
    /// Where it is drawn, if it is.
    pub plot: Option<PictureFile>,
    /// Number of threads; `None` is one for each core.
    pub threads: Option<u16>,
}

/// How a map is written.
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
    /// [`Failure::Usage`] says which options do not go together.
    pub fn new(arguments: &MapArguments) -> Result<Self, Failure> {
        let MapArguments { size, .. } = *arguments;
        let (columns, rows, coordinates) = match &arguments.bodies {
            Some(bodies) => velocities(arguments, bodies)?,
            None => scaled(arguments)?,
        };
        Ok(Self {
            grid: Grid {
                columns: GridAxis { range: columns, cells: size.columns },
                rows: GridAxis { range: rows, cells: size.rows },
                coordinates,
            },
            engine: arguments.method.engine(arguments.collisions.damping)?,
            out: arguments.out.clone(),
            format: format(&arguments.out)?,
            plot: arguments.plot.clone(),
            threads: arguments.threads,
        })
    }
}

/// The axes κ and ψ, or κ and g_t/g_n.
fn scaled(arguments: &MapArguments) -> Result<(Range, Range, Coordinates), Failure> {
    let MapArguments { kappa, psi, ratio, collisions, .. } = *arguments;
    let kappa = kappa.ok_or_else(|| Failure::Usage(explain(RecipeError::NoKappa)))?;
    let damping = collisions.damping.unwrap_or(0.0);
    Ok(match Rows::new(psi, ratio, collisions)? {
        Rows::Psi(psi) => (kappa, psi, Coordinates::Psi { damping }),
        Rows::Ratio(RatioRange { range, reduction }) => {
            (kappa, range, Coordinates::Ratio { reduction, damping })
        }
    })
}

/// The axes g_n and g_t of the bodies in a file.
fn velocities(
    arguments: &MapArguments,
    bodies: &Path,
) -> Result<(Range, Range, Coordinates), Failure> {
    let (Some(normal), Some(tangential)) = (arguments.normal, arguments.tangential) else {
        let message = "--normal or --tangential is missing; expected --bodies with both";
        return Err(Failure::Usage(message.to_owned()));
    };
    let pair = read_pair(bodies)?;
    let damping_time_s = pair.surface.damping_time_s;
    if arguments.method.method == Method::Exact && damping_time_s != 0.0 {
        return Err(Failure::input(
            bodies,
            format!(
                "surface.damping_time_s is {damping_time_s:?}, and --method exact holds without \
                 damping; expected 0, or --method dop853 or dopri5"
            ),
        ));
    }
    Ok((normal, tangential, Coordinates::Velocities { pair }))
}

fn format(out: &Path) -> Result<MapFormat, Failure> {
    match out.extension().and_then(|extension| extension.to_str()) {
        Some("npz") => Ok(MapFormat::Npz),
        Some("csv") => Ok(MapFormat::Csv),
        _ => Err(Failure::Usage(format!(
            "--out {}: the name does not tell the format; expected FILE.npz and FILE.csv",
            out.display()
        ))),
    }
}
