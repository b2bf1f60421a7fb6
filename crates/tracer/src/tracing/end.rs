//! Why branches end, and the vertices at which they do.

use crate::curve::VertexKind;
use crate::window::Point;

/// Why a branch ended.
#[derive(Clone, Debug)]
pub enum End<Margin> {
    /// The branch came back to its start.
    Closed,
    /// The branch came to a known vertex, the stop with this index.
    Known(usize),
    /// The branch found a vertex.
    Vertex(Special<Margin>),
    /// The branch has as many nodes as the options allow.
    Limit,
}

/// A vertex that a branch has found.
#[derive(Clone, Debug)]
pub struct Special<Margin> {
    /// The place of the vertex.
    pub point: Point,
    /// The kind of the vertex.
    pub kind: VertexKind,
    /// The margins that are known to vanish there.
    pub margins: Vec<Margin>,
    /// The largest error of the place.
    pub uncertainty: f64,
    /// Whether the place was solved for. If not, it is where the branch could not go on.
    pub solved: bool,
}

impl<Margin> Special<Margin> {
    /// Whether this place is much more accurate than the place of a known vertex.
    pub(crate) fn improves(&self, stop: &Stop) -> bool {
        self.solved && self.uncertainty < 0.2 * stop.uncertainty
    }
}

/// A known vertex, at which all branches through it end.
#[derive(Clone, Copy, Debug)]
pub struct Stop {
    /// The place of the vertex.
    pub point: Point,
    /// The largest error of the place.
    pub uncertainty: f64,
}
