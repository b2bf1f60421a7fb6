//! What `trace` is to do.

use std::path::PathBuf;

use stickslip_files::input::recipe::reduced;
use stickslip_files::output::picture::PictureFile;
use stickslip_plane::Range;
use stickslip_plane::atlas::Frame;
use stickslip_tracer::AtlasOptions;

use super::files::require_different;
use super::law::chosen_law;
use super::system::SystemPlane;
use super::window::{ImpactRange, KappaWindow};
use crate::args::TraceArguments;
use crate::error::Failure;

/// What is to be traced.
#[derive(Debug)]
pub enum Traced {
    /// Collisions.
    Collisions(Box<TracePlan>),
    /// A system of one's own.
    System(Box<SystemTracePlan>),
}

/// An atlas of a system of one's own.
#[derive(Debug)]
pub struct SystemTracePlan {
    /// The runs.
    pub plane: SystemPlane,
    /// How they are traced.
    pub options: AtlasOptions,
    /// The file of the atlas.
    pub out: PathBuf,
    /// The file of a picture, if the atlas is drawn.
    pub plot: Option<PictureFile>,
    /// The number of threads; `None` is one for each core.
    pub threads: Option<u16>,
}

impl Traced {
    /// The plan that `arguments` make.
    ///
    /// # Errors
    /// As [`TracePlan::new`]; or the system cannot be read, or options do not fit it.
    pub fn new(arguments: &TraceArguments) -> Result<Self, Failure> {
        let Some(plane) = SystemPlane::new(&arguments.plane)? else {
            return TracePlan::new(arguments).map(|plan| Self::Collisions(Box::new(plan)));
        };
        let TraceArguments { out, plot, threads, .. } = arguments;
        let picture = plot.as_ref().map(PictureFile::path);
        let system = arguments.plane.system.as_deref();
        require_different(&[("--out", Some(out)), ("--plot", picture)], &[("the system", system)])?;
        let options = plane.atlas_options(arguments.tolerance)?;
        let (out, plot, threads) = (out.clone(), plot.clone(), *threads);
        Ok(Self::System(Box::new(SystemTracePlan { plane, options, out, plot, threads })))
    }
}

/// An atlas of collisions to be traced.
#[derive(Clone, Debug, PartialEq)]
pub struct TracePlan {
    /// The window of the atlas.
    pub frame: Frame,
    /// The accuracy of the boundaries in ψ.
    pub tolerance: f64,
    /// The file of the atlas.
    pub out: PathBuf,
    /// The file of a picture, if the atlas is drawn.
    pub plot: Option<PictureFile>,
    /// The file for GeoJSON, if that is wanted.
    pub geojson: Option<PathBuf>,
    /// The file for the lines on which |ε_t| is 1, if they are wanted.
    pub gaining: Option<PathBuf>,
    /// The number of threads; `None` is one for each core.
    pub threads: Option<u16>,
}

impl TracePlan {
    /// The plan that `arguments` make.
    ///
    /// # Errors
    /// [`Failure::Usage`] says which options contradict each other.
    pub fn new(arguments: &TraceArguments) -> Result<Self, Failure> {
        let TraceArguments { out, plot, geojson, gaining, .. } = arguments;
        let frame = frame(arguments)?;
        let tolerance = arguments.tolerance.unwrap_or_else(|| frame.tolerances().usual);
        let picture = plot.as_ref().map(PictureFile::path);
        let outputs = [
            ("--out", Some(&**out)),
            ("--geojson", geojson.as_deref()),
            ("--plot", picture),
            ("--gaining", gaining.as_deref()),
        ];
        require_different(&outputs, &[])?;
        Ok(Self {
            frame,
            tolerance,
            out: out.clone(),
            plot: plot.clone(),
            geojson: geojson.clone(),
            gaining: gaining.clone(),
            threads: arguments.threads,
        })
    }
}

fn frame(arguments: &TraceArguments) -> Result<Frame, Failure> {
    let TraceArguments { kappa, psi, ratio, collisions, .. } = *arguments;
    let KappaWindow { kappa, impact } = KappaWindow::new(kappa, psi, ratio, collisions)?;
    let (psi, ratio) = match impact {
        ImpactRange::Psi(psi) => (psi, None),
        ImpactRange::Ratio(ratio) => {
            let psi = |end| {
                reduced(&ratio.reduction, end).map_err(|error| Failure::Usage(error.to_string()))
            };
            let Range { low, high } = ratio.range;
            (Range { low: psi(low)?, high: psi(high)? }, Some(ratio))
        }
    };
    let law = chosen_law(&arguments.law)?;
    let tangential_damping = arguments.law.tangential_damping.unwrap_or(0.0);
    let damping = collisions.damping.unwrap_or(0.0);
    Ok(Frame { kappa, psi, ratio, damping, law, tangential_damping })
}
