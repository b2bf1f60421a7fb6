//! What `stack` is to do.

use std::path::PathBuf;

use stickslip_files::output::picture::PictureFile;
use stickslip_plane::atlas::Frame;
use stickslip_plane::stack::damped;

use super::files::require_different;
use crate::args::StackArguments;
use crate::error::Failure;

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
        let StackArguments { kappa, psi, damping, tolerance, out, plot, threads } = arguments;
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
