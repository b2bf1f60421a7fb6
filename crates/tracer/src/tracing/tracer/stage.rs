//! The stages of a search.

use crate::window::Point;

/// What a search does next. New vertices are examined before every step but those along the edges.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub(crate) enum Stage {
    /// Along the segments of the edges up to which boundaries are followed.
    Edges { next: usize },
    /// Along the edges of the grid.
    Grid { next: usize },
    /// For islands beside the places of the grid; `pending` are segments that have to be searched.
    Islands { next: usize, pending: Vec<[Point; 2]> },
    /// Between pairs of places.
    Pairs { next: usize, pairs: Vec<[Point; 2]> },
    /// Between vertices that are close together.
    CloseVertices { next: usize },
    /// Where changes of the label were left open.
    Settle,
    /// For better places of inaccurate vertices.
    Polish,
    /// Nothing.
    Done,
}
