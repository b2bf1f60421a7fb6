//! What `trace` is to do.

use std::path::PathBuf;

use stickslip_plane::Range;
use stickslip_plane::atlas::{Frame, RatioRange};

use crate::args::TraceArguments;
use crate::error::Failure;
use crate::input::recipe::RecipeError;
use crate::output::picture::PictureFile;
use crate::plan::explain;
use crate::plan::window::Rows;

/// An atlas to be traced.
#[derive(Clone, Debug, PartialEq)]
pub struct TracePlan {
    /// Its window.
    pub frame: Frame,
    /// Accuracy of boundaries in ψ.
    pub tolerance: f64,
    /// Where it goes.
    pub out: PathBuf,
    /// Where it is drawn, if it is.
    pub plot: Option<PictureFile>,
    /// Where it goes as GeoJSON, if it does.
    pub geojson: Option<PathBuf>,
    /// Number of threads; `None` is one for each core.
    pub threads: Option<u16>,
}

impl TracePlan {
    /// The plan that `arguments` make.
    ///
    /// # Errors
    /// [`Failure::Usage`] says which options do not go together.
    pub fn new(arguments: &TraceArguments) -> Result<Self, Failure> {
        let frame = frame(arguments)?;
        let tolerance = arguments.tolerance.unwrap_or_else(|| frame.tolerances().usual);
        if arguments.geojson.as_ref() == Some(&arguments.out) {
            return Err(Failure::Usage(format!(
                "--geojson {} is --out as well; expected two files",
                arguments.out.display()
            )));
        }
        Ok(Self {
            frame,
            tolerance,
            out: arguments.out.clone(),
            plot: arguments.plot.clone(),
            geojson: arguments.geojson.clone(),
            threads: arguments.threads,
        })
    }
}

fn frame(arguments: &TraceArguments) -> Result<Frame, Failure> {
    let TraceArguments { kappa, psi, ratio, collisions, .. } = *arguments;
    let kappa = kappa.ok_or_else(|| Failure::Usage(explain(RecipeError::NoKappa)))?;
    let kappa = positive("--kappa", kappa)?;
    let (psi, ratio) = match Rows::new(psi, ratio, collisions)? {
        Rows::Psi(psi) => (positive("--psi", psi)?, None),
        Rows::Ratio(ratio) => {
            let RatioRange { range, reduction } = ratio;
            let Range { low, high } = positive("--ratio", range)?;
            let [low, high] = [low, high].map(|ratio| reduction.psi(ratio));
            if !(low > 0.0 && low < high && high.is_finite()) {
                return Err(Failure::Usage(format!(
                    "psi = ratio·alpha/mu from {low:?} to {high:?} is out of range; expected \
                     finite numbers 0 < LO < HI"
                )));
            }
            (Range { low, high }, Some(ratio))
        }
    };
    Ok(Frame { kappa, psi, ratio, damping: collisions.damping.unwrap_or(0.0) })
}

/// `range`, unless it begins at 0, where there is no collision.
fn positive(option: &str, range: Range) -> Result<Range, Failure> {
    if range.low > 0.0 {
        return Ok(range);
    }
    Err(Failure::Usage(format!(
        "{option} {:?}:{:?}: there is no collision at 0, and the boundaries near it have no end; \
         expected LO:HI with LO > 0",
        range.low, range.high
    )))
}
