//! Curves in a parameter plane on which the switching of a piecewise-smooth ODE changes, and the subdivision of the plane
//! that they make.
//!
//! In reading order: `family` (what is traced), `curve` (what comes out), `hermite` (the cubics between nodes), `subdivision`
//! (regions) with `faces`, `crossing`, `finding` and `interior`, `slabs` and `locate` (where a point lies), `verify` (runs against
//! the subdivision).

mod bernstein;
mod crossing;
mod curve;
mod faces;
mod family;
mod finding;
mod hermite;
mod interior;
mod locate;
mod outline;
mod piece;
mod slabs;
mod subdivision;
mod union;
mod verify;

pub use curve::{Curve, Node, Vertex, VertexKind};
pub use family::{Family, Point, Window};
pub use finding::{Euler, Finding, SubdivisionError};
pub use hermite::Cubic;
pub use locate::Location;
pub use subdivision::{Region, Side, Subdivision};
pub use verify::{
    Checkpoint, Mismatch, Origin, Reason, Traced, Unverified, Verification, Verified, VerifyError,
    VerifyOptions, until_verified, verify, verify_with,
};
