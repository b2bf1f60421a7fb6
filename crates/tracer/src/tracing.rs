//! How boundaries are found and followed.
//!
//! 1. A `tracer` scans segments: the window's edges, the edges of a grid, polygons around vertices.
//!    The known curves explain how the label changes along a segment. Where they do not, `seed`
//!    bisects the change and asks the margins of the free runs on both sides which one vanishes
//!    there. `sliver` follows margins from one place to the next, also where both places have the
//!    same label. `island` searches for minima of margins that dip below zero between the places of
//!    the grid.
//! 2. A `branch` follows a margin both ways, step by step. Free runs on both sides of each node
//!    must have the labels of the branch: the zero set of a margin goes on beyond the place where
//!    its itinerary is the one that happens.
//! 3. Where a step fails, the branch searches for a vertex: two margins vanish together, the
//!    gradient vanishes, or the margin ceases to exist. Grazes, cusps and other vertices are
//!    located in `branch/special`, `branch/cusp`, `branch/touch` and `branch/tangency`.
//! 4. `builder` merges vertices, and divides curves that pass through a new one. A new vertex is
//!    examined on circles around it: the labels there show how many boundaries meet, and which; the
//!    margins show where.
//! 5. `cut` takes the part inside the window, `naming` names the vertices, and `extrema` finds
//!    where curves turn back in a coordinate.
//!
//! A window in which something is in doubt after this is traced again in another way, by `margins`
//! alone: zero sets are followed without labels and divided where they meet, and one run on each
//! side of every part says whether it is a boundary.
//!
//! In reading order:
//!
//! - `tracer`: a search, and what it has found
//! - `seed`: from a change of the label to a place on a boundary
//! - `branch`: one boundary, followed from its seed
//! - `end`: why it ends, and where
//! - `fit`: cubics as close to a boundary as the options ask
//! - `corrector`: from a guess to the zero of a margin
//! - `runs`: the runs of a family, counted
//! - `builder`: the network that grows
//! - `network`: what a trace finds
//! - `cut`: the part of it that lies in the window
//! - `naming`: the kinds of vertices
//! - `special_points`: the names of points at which two conditions hold together
//! - `extrema`: where boundaries are extremal in a coordinate
//! - `margins`: tracing by margins alone
//! - `follow`: one boundary, with monitors

pub(crate) mod branch;
mod builder;
mod corrector;
mod cut;
pub(crate) mod end;
pub(crate) mod extrema;
mod fit;
pub(crate) mod follow;
pub(crate) mod margins;
mod naming;
pub(crate) mod network;
pub(crate) mod runs;
pub(crate) mod seed;
pub(crate) mod special_points;
pub(crate) mod tracer;

pub use branch::BoundaryWalk;
pub use end::{End, Special, Stop};
pub use extrema::Extremum;
pub use follow::{Followed, Monitor, MonitorZero, follow};
pub use margins::trace_by_margins;
pub use network::{Network, NetworkOf, TraceStatistics, Unresolved};
pub use runs::Runs;
pub use seed::Seed;
pub use special_points::SpecialPoint;
pub use tracer::Tracer;
pub use tracer::count::Count;
