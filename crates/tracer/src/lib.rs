//! Curves in a parameter plane on which the switching of a piecewise-smooth ODE changes, and the subdivision of the plane
//! that they make.
//!
//! In reading order: `family` (what is traced), `hybrid` (hybrid systems as families), `curve` (what comes out);
//!
//! - curves: `trace` (how all are found), `branch` (how one is followed), `step` (a step), `special`, `touch` and `ahead` (where it
//!   ends), `seed` and `island` (where it starts), `corrector`, `runs`, `network`, `arc`;
//!   `naming` (what its ends are) and `extrema`;
//! - regions: `hermite` (the cubics between nodes), `subdivision` with `faces`, `crossing`, `finding` and `interior`, `slabs` and
//!   `locate` (where a point lies), `verify` (runs against the subdivision).

mod ahead;
mod arc;
mod bernstein;
mod branch;
mod corrector;
mod crossing;
mod curve;
mod extrema;
mod faces;
mod family;
mod finding;
mod hermite;
mod hybrid;
mod interior;
mod island;
mod locate;
mod naming;
mod network;
mod options;
mod outline;
mod piece;
mod runs;
mod seed;
mod slabs;
mod special;
mod step;
mod subdivision;
mod touch;
mod trace;
mod union;
mod verify;

pub use branch::{Branch, End, Seed, Special, Stop};
pub use curve::{Curve, Node, Vertex, VertexKind};
pub use extrema::Extremum;
pub use family::{Family, FreeRun, Point, Window};
pub use finding::{Euler, Finding, SubdivisionError};
pub use hermite::Cubic;
pub use hybrid::{FamilyError, FamilyErrorKind, HybridFamily, ModeOf, Problem};
pub use locate::Location;
pub use network::{Network, NetworkOf, TraceStatistics, Unresolved};
pub use options::{InvalidTraceOption, TraceError, TraceOptions};
pub use outline::Stretch;
pub use runs::Runs;
pub use subdivision::{Region, Side, Subdivision};
pub use trace::{Tracer, trace};
pub use verify::{
    Checkpoint, Mismatch, Origin, Reason, Unverified, Verification, VerifyError, VerifyOptions,
    verify, verify_with,
};
