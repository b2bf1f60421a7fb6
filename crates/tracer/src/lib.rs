//! Curves in a parameter plane on which the switching of a piecewise-smooth ODE changes, and the subdivision of the plane
//! that they make.
//!
//! In reading order: `family` (what is traced), `hybrid` (hybrid systems as families), `curve` (what comes out), `trace` (how all curves are found), `branch` (how one is
//! followed), `special` (where it ends), `seed` and `island` (where it starts), `corrector`, `runs`, `network`, `arc`.

mod arc;
mod branch;
mod corrector;
mod curve;
mod family;
mod hybrid;
mod island;
mod network;
mod options;
mod runs;
mod seed;
mod special;
mod trace;

pub use curve::{Curve, Node, Vertex, VertexKind};
pub use family::{Family, FreeRun, Point, Window};
pub use hybrid::{FamilyError, FamilyErrorKind, HybridFamily, ModeOf, Problem};
pub use network::{Network, TraceStatistics, Unresolved};
pub use options::{InvalidTraceOption, TraceError, TraceOptions};
pub use trace::trace;
