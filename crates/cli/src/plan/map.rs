//! What `map` is to do.

use std::path::{Path, PathBuf};

use crate::args::MapArguments;
use crate::engine::Engine;
use crate::error::Failure;
use crate::figure::Target;
use crate::map::{Axis, Coordinates, Plane};
use crate::plan::explain;
use crate::recipe::{DEFAULT_ALPHA, DEFAULT_MU, RecipeError};

/// A map to be computed.
#[derive(Clone, Debug, PartialEq)]
pub struct MapPlan {
    /// Its window and cells.
    pub plane: Plane,
    /// What computes the collisions.
    pub engine: Engine,
    /// Where it goes.
    pub out: PathBuf,
    /// How it is written.
    pub format: MapFormat,
    /// Where it is drawn, if it is.
    pub plot: Option<Target>,
    /// Number of threads; `None` is one for each core.
    pub threads: Option<usize>,
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
        Ok(Self {
            plane: plane(arguments)?,
            engine: arguments.method.engine(arguments.damping)?,
            out: arguments.out.clone(),
            format: format(&arguments.out)?,
            plot: arguments.plot.clone(),
            threads: arguments.threads.map(usize::from),
        })
    }
}

fn plane(arguments: &MapArguments) -> Result<Plane, Failure> {
    let MapArguments { kappa, psi, ratio, mu, alpha, size, .. } = *arguments;
    let refused = |error| Failure::Usage(explain(error));
    let damping = arguments.damping.unwrap_or(0.0);
    let columns = kappa.ok_or_else(|| refused(RecipeError::NoKappa))?;
    let (rows, coordinates) = match (psi, ratio) {
        (Some(_), Some(_)) => return Err(refused(RecipeError::PsiAndRatio)),
        (None, None) => return Err(refused(RecipeError::NoImpact)),
        (Some(psi), None) => {
            if let Some((name, _)) = [("mu", mu), ("alpha", alpha)].iter().find(|x| x.1.is_some()) {
                return Err(refused(RecipeError::Unused { name }));
            }
            (psi, Coordinates::Psi { damping })
        }
        (None, Some(ratio)) => {
            let (mu, alpha) = (mu.unwrap_or(DEFAULT_MU), alpha.unwrap_or(DEFAULT_ALPHA));
            (ratio, Coordinates::Ratio { mu, alpha, damping })
        }
    };
    Ok(Plane {
        columns: Axis { range: columns, cells: size.columns },
        rows: Axis { range: rows, cells: size.rows },
        coordinates,
    })
}

fn format(out: &Path) -> Result<MapFormat, Failure> {
    match out.extension().and_then(|extension| extension.to_str()) {
        Some("npz") => Ok(MapFormat::Npz),
        Some("csv") => Ok(MapFormat::Csv),
        _ => Err(Failure::Usage(format!(
            "--out {}: the name does not tell the format; accepted are FILE.npz and FILE.csv",
            out.display()
        ))),
    }
}
