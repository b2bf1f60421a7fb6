//! The options of a trace, and its errors.

use stickslip_solver::InvalidValue;

use crate::regions::finding::SubdivisionError;
use crate::window::{Point, Window};

/// The options of a trace. [`TraceOptions::validate`] checks them when the trace starts.
///
/// Lengths are in the coordinates of the window.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TraceOptions {
    /// The largest distance of a node from its boundary, above 0, up to 1e-6.
    pub tolerance: f64,
    /// The largest distance of the cubics between nodes from their boundary, from ten times
    /// `tolerance` to 1e-2.
    pub interpolation: f64,
    /// The distance from a boundary at which the labels on both of its sides are computed, from ten
    /// times `tolerance` to 1e-4.
    pub offset: f64,
    /// The error of a margin, from 0 to 1e-6: smaller values carry no information.
    pub noise: f64,
    /// The longest step, as a fraction of the window's shorter extent, up to 0.25.
    pub max_step: f64,
    /// The largest angle between the tangents of consecutive nodes, in radians, up to 0.5.
    pub max_angle: f64,
    /// How far beyond the window boundaries are followed, as a fraction of its shorter extent, from
    /// 0 to 1e-2. They are cut at the window's edges. With 0, vertices just beyond an edge are not
    /// found, and neither labels nor margins distinguish the boundaries beside them at the edge;
    /// 1e-3 is as far as the search around vertices reaches. The family must be defined there.
    #[cfg_attr(feature = "serde", serde(default))]
    pub beyond: f64,
    /// The number of cells of the grid along each axis, from 2 to 4096. The runs of all cells are
    /// held in memory. Along each side of the window, twice as many segments are searched.
    pub cells: usize,
    /// The greatest number of nodes of a branch, which stops there; at least 2.
    pub max_nodes: usize,
    /// The greatest number of curves, at least 1. A window that shows more of them before it is
    /// traced is refused. Since that count misses some, up to twice as many are traced; further
    /// curves are reported as unresolved.
    pub max_curves: usize,
}

impl Default for TraceOptions {
    fn default() -> Self {
        Self {
            tolerance: 1e-12,
            interpolation: 1e-10,
            offset: 1e-8,
            noise: 1e-13,
            max_step: 0.05,
            max_angle: 0.2,
            beyond: 0.0,
            cells: 32,
            max_nodes: 20_000,
            max_curves: 10_000,
        }
    }
}

impl TraceOptions {
    /// The greatest number of cells along an axis.
    pub(crate) const MOST_CELLS: usize = 4096;

    /// Checks every field.
    ///
    /// # Errors
    /// The first field that is out of its range, with its value and the range.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        let within = |value: f64, low: f64, high: f64| value > low && value <= high;
        InvalidValue::check(
            "tolerance",
            self.tolerance,
            "above 0 to 1e-6",
            within(self.tolerance, 0.0, 1e-6),
        )?;
        InvalidValue::check(
            "interpolation",
            self.interpolation,
            "10 times the tolerance to 1e-2",
            self.interpolation >= 10.0 * self.tolerance && self.interpolation <= 1e-2,
        )?;
        InvalidValue::check(
            "offset",
            self.offset,
            "10 times the tolerance to 1e-4",
            self.offset >= 10.0 * self.tolerance && self.offset <= 1e-4,
        )?;
        InvalidValue::check("noise", self.noise, "0 to 1e-6", (0.0..=1e-6).contains(&self.noise))?;
        InvalidValue::check(
            "max_step",
            self.max_step,
            "above 0 to 0.25",
            within(self.max_step, 0.0, 0.25),
        )?;
        InvalidValue::check(
            "max_angle",
            self.max_angle,
            "above 0 to 0.5",
            within(self.max_angle, 0.0, 0.5),
        )?;
        InvalidValue::check(
            "beyond",
            self.beyond,
            "0 to 1e-2",
            (0.0..=1e-2).contains(&self.beyond),
        )?;
        let cells = (2..=Self::MOST_CELLS).contains(&self.cells);
        InvalidValue::check("cells", self.cells, "2 to 4096", cells)?;
        InvalidValue::check("max_nodes", self.max_nodes, "at least 2", self.max_nodes >= 2)?;
        InvalidValue::check("max_curves", self.max_curves, "at least 1", self.max_curves >= 1)
    }
}

/// Why there is no trace, no atlas or no stack.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TraceError<E: std::error::Error + 'static> {
    /// An option is out of its range.
    #[error(transparent)]
    Option(#[from] InvalidValue),
    /// The window has no area, or its corners are not finite.
    #[error("the window from {:?} to {:?} is not a rectangle", window.low.as_slice(), window.high.as_slice())]
    Window {
        /// The window.
        window: Window,
    },
    /// A run failed.
    #[error("the run at ({}, {}) failed", point.x, point.y)]
    Run {
        /// The point of the run.
        point: Point,
        /// The error of the run.
        source: E,
    },
    /// The window has more curves than the options allow. Nothing was traced.
    #[error(
        "the window has at least about {curves} boundaries and {regions} regions, and at most {most} \
         boundaries are traced; choose a smaller one"
    )]
    TooManyCurves {
        /// The number of regions that were counted, see
        /// [`Tracer::count`](crate::tracing::Tracer::count).
        regions: usize,
        /// The number of curves that were counted.
        curves: usize,
        /// The greatest number of curves, [`TraceOptions::max_curves`].
        most: usize,
    },
    /// The watch of a search has cancelled it. A [`Surveyor`](crate::Surveyor) returns what was
    /// found so far in the place of this.
    #[error("the search was cancelled")]
    Cancelled,
    /// A margin is not a number.
    #[error("a margin at ({}, {}) is not a number", point.x, point.y)]
    NotANumber {
        /// The point of the margin.
        point: Point,
    },
    /// The window, the tolerance or the options of the verification make no regions.
    #[error(transparent)]
    Subdivision(#[from] SubdivisionError),
    /// The values of a stack are fewer than two, not finite, or not in ascending order.
    #[error("expected two values or more, finite and in ascending order")]
    Values,
    /// The width of the brackets of a stack is out of its range.
    #[error("the width is {0}, expected 1e-9 to 0.1")]
    Width(f64),
    /// An atlas of a stack failed.
    #[error("at the value {value}")]
    Layer {
        /// The value of the third parameter.
        value: f64,
        /// The error of the atlas.
        source: Box<Self>,
    },
}
