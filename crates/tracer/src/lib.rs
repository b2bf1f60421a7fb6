//! Curves in a parameter plane on which the switching of a piecewise-smooth ODE changes, and the subdivision of the plane
//! that they make.
//!
//! In reading order: `family` (what is traced), `hybrid` (hybrid systems as families), `curve` (what comes out), `cubic` (curves
//! between nodes), `options`; then `tracing` (how boundaries are found and followed) and `regions` (what they make of the window).

mod cubic;
mod curve;
mod family;
mod hybrid;
mod options;
mod regions;
mod tracing;

pub use cubic::Cubic;
pub use curve::{Curve, Node, Vertex, VertexKind};
pub use family::{Family, FreeRun, Point, Window};
pub use hybrid::{FamilyError, FamilyErrorKind, HybridFamily, ModeOf, Problem};
pub use options::{InvalidTraceOption, TraceError, TraceOptions};
pub use regions::finding::{Euler, Finding, SubdivisionError};
pub use regions::locate::Location;
pub use regions::outline::Stretch;
pub use regions::subdivision::{Region, Side, Subdivision};
pub use regions::verify::{
    Checkpoint, Mismatch, Origin, Reason, Unverified, Verification, VerifyError, VerifyOptions,
    verify, verify_with,
};
pub use tracing::branch::{Branch, End, Seed, Special, Stop};
pub use tracing::extrema::Extremum;
pub use tracing::network::{Network, NetworkOf, TraceStatistics, Unresolved};
pub use tracing::runs::Runs;
pub use tracing::trace::{Tracer, trace};
