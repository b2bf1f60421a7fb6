//! Curves in a parameter plane on which the switching of a piecewise-smooth ODE changes, and the subdivision of the plane
//! that they make.
//!
//! What is traced is a [`Family`]: at each point of the plane a run has a label, its itinerary, and leaves margins, one of which vanishes where the
//! label changes. A [`HybridFamily`] makes one of a hybrid system of `stickslip_solver` that depends on two parameters. [`trace`] finds
//! the boundaries in a [`Window`] and follows them between their vertices; a [`Subdivision`] answers what lies between them, and
//! [`verify`] asks runs at random places whether it is true.
//!
//! ```
//! use std::convert::Infallible;
//!
//! use stickslip_tracer::{Family, FreeRun, Point, TraceOptions, Window, trace};
//!
//! /// A switch that happens below the parabola y = x².
//! struct Parabola;
//!
//! impl Family for Parabola {
//!     type Label = bool;
//!     type Margin = ();
//!     type Error = Infallible;
//!
//!     fn label(&self, point: &Point) -> Result<bool, Infallible> {
//!         Ok(point.y < point.x * point.x)
//!     }
//!     fn margin(&self, point: &Point, (): &()) -> Result<Option<f64>, Infallible> {
//!         Ok(Some(point.y - point.x * point.x))
//!     }
//!     fn free_run(&self, point: &Point) -> Result<FreeRun<bool, ()>, Infallible> {
//!         let margin = point.y - point.x * point.x;
//!         Ok(FreeRun { label: margin < 0.0, margins: vec![((), margin)] })
//!     }
//! }
//!
//! let window = Window { low: Point::new(-1.0, -0.5), high: Point::new(1.0, 0.5) };
//! let network = trace(&Parabola, &window, &TraceOptions::default())?;
//! // One curve, from the window's edge to its edge.
//! assert_eq!((network.curves.len(), network.vertices.len()), (1, 2));
//! let off = |point: &Point| (point.y - point.x * point.x).abs();
//! assert!(network.curves[0].nodes.iter().all(|node| off(&node.point) < 1e-11));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
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

#[doc = include_str!("../README.md")]
#[cfg(doctest)]
pub struct Readme;
