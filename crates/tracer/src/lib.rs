//! Curves in a parameter plane on which the switching of a piecewise-smooth ODE changes, and the subdivision of the plane
//! that they make.
//!
//! In reading order: `family` (what is traced), `curve` (what comes out), `trace` (how all curves are found), `branch` (how one is
//! followed), `step` (a step), `special`, `touch` and `ahead` (where it ends), `seed` and `island` (where it starts), `corrector`, `runs`, `network`, `arc`.

mod ahead;
mod arc;
mod branch;
mod corrector;
mod curve;
mod family;
mod island;
mod network;
mod options;
mod runs;
mod seed;
mod special;
mod step;
mod touch;
mod trace;

pub use branch::{Branch, End, Seed, Special, Stop};
pub use curve::{Curve, Node, Vertex, VertexKind};
pub use family::{Family, FreeRun, Point, Window};
pub use network::{Network, NetworkOf, TraceStatistics, Unresolved};
pub use options::{InvalidTraceOption, TraceError, TraceOptions};
pub use runs::Runs;
pub use trace::trace;
