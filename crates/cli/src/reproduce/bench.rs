//! What the parts of the report share.

use std::path::PathBuf;
use std::sync::OnceLock;

use rayon::{ThreadPool, ThreadPoolBuilder};

use super::reading::{ALPHA, MU, Reading};
use crate::atlas::{Frame, Made, make};
use crate::audit::Model;
use crate::error::Failure;
use crate::plan::PagePlan;
use crate::range::Range;

/// The tools of the parts.
#[derive(Debug)]
pub struct Bench {
    /// The directory of the files.
    pub out: PathBuf,
    /// Threads for the work.
    pub pool: ThreadPool,
    /// Columns and rows of a map.
    pub cells: usize,
    /// The model of the spring of which the statements are tested.
    pub model: Model,
    /// The boundaries of Figure 4, once they are traced.
    boundaries: OnceLock<Made>,
}

/// The largest value on the axis of stiffness in Figures 3 and 4.
pub const MOST_STIFFNESS: f64 = 20.0;
/// The largest g_t/g_n in Figure 4.
pub const MOST_RATIO: f64 = 4.0;

impl Bench {
    /// Makes the threads.
    ///
    /// # Errors
    /// They cannot be started.
    pub fn new(plan: &PagePlan) -> Result<Self, Failure> {
        Ok(Self {
            out: plan.out.clone(),
            pool: ThreadPoolBuilder::new().num_threads(plan.threads.unwrap_or(0)).build()?,
            cells: plan.cells,
            model: plan.model,
            boundaries: OnceLock::new(),
        })
    }

    /// The boundaries in the plane of Figure 4, in both readings, verified.
    ///
    /// # Errors
    /// They cannot be traced.
    pub fn boundaries(&self) -> Result<&Made, Failure> {
        if let Some(made) = self.boundaries.get() {
            return Ok(made);
        }
        // The lower ends: boundaries never end at κ = 0 or ψ = 0. Below this ψ no boundary crosses
        // the line of the points.
        let kappa = Range { low: 0.05, high: Reading::Axis.kappa(MOST_STIFFNESS) };
        let psi = Range { low: 0.002, high: MOST_RATIO * ALPHA / MU };
        let frame = Frame { kappa, psi, ratio: None, damping: 0.0 };
        let [_, usual, _] = frame.tolerances();
        let made = make(&self.pool, frame, usual)?;
        Ok(self.boundaries.get_or_init(|| made))
    }
}
