//! What `stack` is to do.

use std::path::PathBuf;

use stickslip_files::output::picture::PictureFile;
use stickslip_plane::atlas::Frame;
use stickslip_plane::stack::damped;
use stickslip_tracer::{AtlasOptions, StackOptions};

use super::files::require_different;
use super::system::{SystemPlane, place};
use crate::args::StackArguments;
use crate::error::Failure;

/// What is to be stacked.
#[derive(Debug)]
pub enum Stacked {
    /// Atlases of collisions.
    Collisions(Box<StackPlan>),
    /// Atlases of a system of one's own.
    System(Box<SystemStackPlan>),
}

/// Atlases of a system of one's own over a third parameter.
#[derive(Debug)]
pub struct SystemStackPlan {
    /// The runs.
    pub plane: SystemPlane,
    /// The place and the name of the third parameter.
    pub over: (usize, String),
    /// Its values.
    pub values: Vec<f64>,
    /// How the atlases are traced.
    pub options: StackOptions,
    /// The file of the stack.
    pub out: PathBuf,
    /// The file of a picture, if the stack is drawn.
    pub plot: Option<PictureFile>,
    /// The number of threads; `None` is one for each core.
    pub threads: Option<u16>,
}

impl Stacked {
    /// The plan that `arguments` make.
    ///
    /// # Errors
    /// As [`StackPlan::new`]; or the system cannot be read, or options do not fit it.
    pub fn new(arguments: &StackArguments) -> Result<Self, Failure> {
        let Some(plane) = SystemPlane::new(&arguments.plane)? else {
            return StackPlan::new(arguments).map(|plan| Self::Collisions(Box::new(plan)));
        };
        let StackArguments { over, tolerance, out, plot, threads, .. } = arguments;
        let Some(over) = over else {
            let message = "--over is missing; expected NAME=V,V,… for a third parameter";
            return Err(Failure::Usage(message.to_owned()));
        };
        let third = place(&plane.system, "--over", &over.name)?;
        if plane.axes.contains(&over.name) {
            let name = &over.name;
            let message = format!("--over {name}: expected another parameter than --x and --y");
            return Err(Failure::Usage(message));
        }
        let one = plane.system.require_one_first_mode(third);
        one.map_err(|error| Failure::Usage(format!("--over: {error}")))?;
        let picture = plot.as_ref().map(PictureFile::path);
        let system = arguments.plane.system.as_deref();
        require_different(&[("--out", Some(out)), ("--plot", picture)], &[("the system", system)])?;
        let atlas: AtlasOptions = plane.atlas_options(*tolerance)?;
        Ok(Self::System(Box::new(SystemStackPlan {
            plane,
            over: (third, over.name.clone()),
            values: over.values.clone(),
            options: StackOptions { atlas, ..StackOptions::default() },
            out: out.clone(),
            plot: plot.clone(),
            threads: *threads,
        })))
    }
}

/// A stack of atlases to be traced.
#[derive(Clone, Debug, PartialEq)]
pub struct StackPlan {
    /// The window of the atlases.
    pub frame: Frame,
    /// The dampings of the atlases.
    pub dampings: Vec<f64>,
    /// The accuracy of the boundaries in ψ.
    pub tolerance: f64,
    /// The file of the stack.
    pub out: PathBuf,
    /// The file of a picture, if the stack is drawn.
    pub plot: Option<PictureFile>,
    /// The number of threads; `None` is one for each core.
    pub threads: Option<u16>,
}

impl StackPlan {
    /// The plan that `arguments` make.
    ///
    /// # Errors
    /// [`Failure::Usage`]: the dampings do not ascend, or two files are the same.
    pub fn new(arguments: &StackArguments) -> Result<Self, Failure> {
        let StackArguments { kappa, psi, damping, tolerance, out, plot, threads, .. } = arguments;
        let (Some(kappa), Some(psi)) = (kappa, psi) else {
            return Err(Failure::Usage("--kappa and --psi are missing".to_owned()));
        };
        damped(damping).map_err(|error| Failure::Usage(format!("--damping: {error}")))?;
        let picture = plot.as_ref().map(PictureFile::path);
        require_different(&[("--out", Some(&**out)), ("--plot", picture)], &[])?;
        let frame = Frame::new(*kappa, *psi, 0.0);
        Ok(Self {
            frame,
            dampings: damping.clone(),
            tolerance: tolerance.unwrap_or_else(|| frame.tolerances().usual),
            out: out.clone(),
            plot: plot.clone(),
            threads: *threads,
        })
    }
}
