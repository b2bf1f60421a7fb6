//! What a tracer must remember to go on later.

use crate::family::Family;
use crate::tracing::network::Network;
use crate::tracing::tracer::stage::Stage;
use crate::window::Point;

/// A search that was interrupted between two tasks.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct State<Label, Margin> {
    /// The network, up to some way beyond the window.
    pub network: Network<Label, Margin>,
    /// The largest error of each vertex.
    pub uncertainties: Vec<f64>,
    /// The parts of divided curves, whose labels must be checked again.
    pub suspects: Vec<usize>,
    /// The number of vertices around which boundaries were searched for.
    pub probed: usize,
    pub stage: Stage,
    /// Where the tracer has to look again, if it has explored the window and a verification
    /// disagreed.
    pub brackets: Option<Vec<[Point; 2]>>,
    /// Whether the survey has come to its end, with a doubt, and only the margins are left.
    #[cfg_attr(feature = "serde", serde(default))]
    pub surveyed: bool,
}

/// The state of a family's tracer.
pub(crate) type StateOf<F> = State<<F as Family>::Label, <F as Family>::Margin>;
