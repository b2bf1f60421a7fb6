//! A search, and what it has found.
//!
//! In reading order:
//!
//! - `trace`: all boundaries in a window
//! - `count`: how many curves and regions there are, roughly, before anything is traced
//! - `stage` and `stages`: the order of the search, in steps
//! - `state` and `resume`: what a search must remember to go on later
//! - `scan`: the boundaries that cross a segment
//! - `island`: closed boundaries between the places of the grid
//! - `sliver`: boundaries of regions between two places with the same label
//! - `ends`: the ends of curves, when all curves are known

pub mod count;
mod ends;
pub(crate) mod island;
mod resume;
mod scan;
mod sliver;
pub(crate) mod stage;
mod stages;
pub(crate) mod state;
pub mod trace;

use crate::family::Family;
use crate::tracing::builder::Builder;
use crate::tracing::runs::{Runs, Sampled};
use crate::tracing::tracer::stage::Stage;
use crate::tracing::tracer::state::StateOf;
use crate::window::Window;

/// A search for boundaries in a window. It keeps what it has found and can be continued.
///
/// Boundaries are searched for along the window's edges, on circles around every vertex, along the
/// edges of a grid, and near minima of margins between places of the grid. Along edges, margins
/// that fall towards zero are followed, so that narrow strips are found. A curve can be missed if
/// none of these searches crosses it and its margin has no minimum that the grid shows. It may be
/// the edge of a small island. A verification may find a point of such a region, and
/// [`Self::look_between`] then finds the curve.
///
/// Boundaries are followed a little [beyond](crate::TraceOptions::beyond) the window and cut at its
/// edges, so that vertices just outside are found like others. The family is evaluated up to a
/// hundredth of the window's extent, and as far as boundaries are followed, outside the window. The
/// distance of nodes from their boundary is at most `options.tolerance`, or what the noise of
/// margins allows; the distance of the cubics between them is at most `options.interpolation`.
pub struct Tracer<'f, F: Family> {
    pub(crate) runs: Runs<'f, F>,
    pub(crate) builder: Builder<F::Label, F::Margin>,
    /// The window of the caller. The window of the runs and of the builder is larger.
    window: Window,
    /// The number of vertices around which boundaries were searched for.
    probed: usize,
    stage: Stage,
    /// The runs that the stage begins with.
    sampled: Vec<Sampled<F>>,
    /// The state before a second look, while it lasts.
    before_look: Option<Box<StateOf<F>>>,
}
