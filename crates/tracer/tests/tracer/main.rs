//! Traces and subdivisions with known answers.

mod any;
mod bent_chessboard;
mod by_margins;
mod conditions;
mod counting;
#[cfg(feature = "serde")]
mod documents;
mod errors;
mod every_change;
mod extrema;
mod following;
mod from_rest;
mod guards;
mod inside;
mod known_curves;
mod leaving_minimum;
mod random_circles;
mod random_guards;
mod roots;
mod slivers;
mod special_points;
mod stack;
mod subdivision;
mod surveys;
mod vertex_kinds;
mod window_edges;

// Where modules of the crate find each other.
use inside::{cubic, curve, lengths, tracing, window};
