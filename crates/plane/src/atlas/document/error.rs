//! What a reader of documents refuses.

use stickslip_model::InvalidValue;
use stickslip_tracer::regions::{Finding, SubdivisionError};

use super::layout::SCHEMA;
use crate::chart::Chart;

/// The reason why a document is not an atlas.
///
/// Places are named as in the document, as `boundaries[3].points[0]`.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AtlasDocumentError {
    /// The document has another layout.
    #[error("schema = {found:?}: expected {SCHEMA:?}")]
    Schema {
        /// The name of its layout.
        found: String,
    },
    /// The verification found something that speaks against the atlas.
    #[error("verification: {objection}; expected an atlas against which nothing speaks")]
    Doubtful {
        /// What the verification found, in a line.
        objection: String,
    },
    /// An interval of the window is empty or not above 0.
    #[error("window.{name} = [{low:?}, {high:?}]: expected [LO, HI] with 0 < LO < HI")]
    Window {
        /// The field with the interval.
        name: &'static str,
        /// Lower end of the interval.
        low: f64,
        /// Upper end of the interval.
        high: f64,
    },
    /// The chart does not map the window onto an area.
    #[error("{0:?} does not map the window onto an area")]
    Chart(Chart),
    /// No collision has the dampings and the law of the window, or the window is too narrow.
    #[error("window: {0}")]
    Values(#[from] InvalidValue),
    /// The damping is negative.
    #[error("window.damping = {damping:?}: expected 0 or above")]
    Damping {
        /// The damping of the document.
        damping: f64,
    },
    /// The accuracy is out of its range.
    #[error("tolerance = {tolerance:?}: expected above 0 to 1e-6")]
    Tolerance {
        /// The accuracy of the document.
        tolerance: f64,
    },
    /// An entry of a list has another place than its `id` says.
    #[error("{list}[{index}].id = {id}; expected {index}, its place in the list")]
    Id {
        /// The list.
        list: &'static str,
        /// The place of the entry.
        index: usize,
        /// The `id` of the entry.
        id: usize,
    },
    /// A point has a coordinate that is not above 0.
    #[error("{place}: kappa = {kappa:?}, psi = {psi:?}; expected numbers above 0")]
    Point {
        /// The place in the document.
        place: String,
        /// κ of the point.
        kappa: f64,
        /// ψ of the point.
        psi: f64,
    },
    /// A boundary has fewer than two points, or not as many tangents as points.
    #[error(
        "boundaries[{boundary}] has {points} points and {tangents} tangents; expected at least two, \
         and as many of both"
    )]
    Tangents {
        /// The index of the boundary.
        boundary: usize,
        /// The number of its points.
        points: usize,
        /// The number of its tangents.
        tangents: usize,
    },
    /// A number of switches and an itinerary contradict each other.
    #[error(
        "{place}: switch_count {switch_count} and itinerary {itinerary:?} do not fit; expected o in \
         turns with + or -, one for each phase, one more than there are switches"
    )]
    Switching {
        /// The place in the document.
        place: String,
        /// The number of switches.
        switch_count: usize,
        /// The itinerary.
        itinerary: String,
    },
    /// The boundaries do not divide the window.
    #[error("the boundaries make no regions: {0}")]
    Subdivision(#[from] SubdivisionError),
    /// The boundaries contradict each other.
    #[error("the boundaries do not fit together: {0}")]
    Finding(Finding<String>),
    /// The document lists more or fewer regions than the boundaries make.
    #[error(
        "regions has {listed} entries, and the boundaries make {made} regions; expected one for each"
    )]
    Regions {
        /// The number of entries.
        listed: usize,
        /// The number of regions.
        made: usize,
    },
    /// A region contradicts the boundaries around it.
    #[error("regions[{region}] is not what the boundaries around it say")]
    Region {
        /// The index of the region.
        region: usize,
    },
}
