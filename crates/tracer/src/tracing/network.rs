//! What a trace finds: curves, vertices, and what it could not explain.

use crate::curve::{Curve, Vertex};
use crate::family::Family;
use crate::window::{Point, Window};

/// The curves in a window on which the label changes, with the vertices at which they end.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Network<Label, Margin> {
    /// The window that was traced.
    pub window: Window,
    /// The curves, in the order in which they were found.
    pub curves: Vec<Curve<Label, Margin>>,
    /// The vertices at which the curves end. A corner of the window is a vertex only if a boundary
    /// ends there.
    pub vertices: Vec<Vertex<Margin>>,
    /// The work of the trace.
    pub statistics: TraceStatistics,
    /// What the trace could not explain.
    pub unresolved: Vec<Unresolved<Label>>,
}

/// The network of a family.
pub type NetworkOf<F> = Network<<F as Family>::Label, <F as Family>::Margin>;

/// The work of a trace.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TraceStatistics {
    /// The number of free runs.
    pub free_runs: usize,
    /// The number of runs with a prescribed itinerary, one for each value of a margin.
    pub prescribed_runs: usize,
    /// The number of accepted nodes.
    pub nodes: usize,
    /// The number of rejected steps.
    pub rejected: usize,
    /// The number of places from which a curve was traced.
    pub seeds: usize,
}

/// Something that a trace saw and could not explain;
/// [`Names::unresolved`](crate::Names::unresolved) says it in a sentence.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Unresolved<Label> {
    /// The label changes between two places, but no margin was found that vanishes between them.
    Change {
        /// The places.
        between: [Point; 2],
        /// The labels of the places.
        labels: [Label; 2],
    },
    /// A curve ends at a vertex whose place could not be solved for.
    Stalled {
        /// The index of the vertex.
        vertex: usize,
    },
    /// A curve between two vertices that cannot be distinguished. The curve is left out.
    NoLength {
        /// The place.
        point: Point,
        /// The labels on both sides of the curve.
        labels: [Label; 2],
    },
    /// A curve has as many nodes as the options allow.
    TooManyNodes {
        /// The last node of the curve.
        point: Point,
    },
    /// There are as many curves as the options allow.
    TooManyCurves {
        /// A point of a further curve.
        point: Point,
    },
}

impl<Label, Margin> Network<Label, Margin> {
    /// The same network with other labels and margins.
    #[must_use]
    pub fn map<L, M>(
        self,
        label: impl Fn(&Label) -> L,
        margin: impl Fn(&Margin) -> M,
    ) -> Network<L, M> {
        let Self { window, curves, vertices, statistics, unresolved } = self;
        let both = |labels: [Label; 2]| labels.each_ref().map(&label);
        let curves = curves.into_iter().map(|Curve { margin: own, sides, nodes, ends }| Curve {
            margin: margin(&own),
            sides: both(sides),
            nodes,
            ends,
        });
        let vertices = vertices.into_iter().map(|Vertex { point, kind, margins }| Vertex {
            point,
            kind,
            margins: margins.iter().map(&margin).collect(),
        });
        let unresolved = unresolved.into_iter().map(|what| match what {
            Unresolved::Change { between, labels } => {
                Unresolved::Change { between, labels: both(labels) }
            }
            Unresolved::NoLength { point, labels } => {
                Unresolved::NoLength { point, labels: both(labels) }
            }
            Unresolved::Stalled { vertex } => Unresolved::Stalled { vertex },
            Unresolved::TooManyNodes { point } => Unresolved::TooManyNodes { point },
            Unresolved::TooManyCurves { point } => Unresolved::TooManyCurves { point },
        });
        Network {
            window,
            curves: curves.collect(),
            vertices: vertices.collect(),
            statistics,
            unresolved: unresolved.collect(),
        }
    }
}

impl<Label: Clone> Unresolved<Label> {
    /// A curve that was left out of a subdivision, because it has no length there.
    #[must_use]
    pub fn no_length<Margin>(curve: &Curve<Label, Margin>) -> Self {
        Self::NoLength { point: curve.nodes[0].point, labels: curve.sides.clone() }
    }
}
