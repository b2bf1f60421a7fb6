//! Curves in a parameter plane on which the switching of a piecewise-smooth ODE changes, and the
//! subdivision of the plane that they make.
//!
//! What is traced is a [`Family`]: at each point of the plane a run has a label, its itinerary, and
//! leaves margins, one of which vanishes where the label changes. A [`HybridFamily`] makes one of a
//! hybrid system of `stickslip_solver` that depends on two parameters. [`trace`] finds
//! the boundaries in a [`Window`] and follows them between their vertices; a [`Subdivision`]
//! answers what lies between them, and [`verify`] asks runs at random places whether it is true.
//!
//! A system of the solver, given as a function of two parameters, is traced; regions are labelled
//! by the guards that fire in them:
//!
//! ```
//! use stickslip_solver::{Direction, Dop853, Guard, HybridSystem, Options, Start, State};
//! use stickslip_tracer::{
//!     HybridFamily, Location, Point, Subdivision, TraceOptions, Window, trace,
//! };
//!
//! /// A ball that keeps a part of its velocity at each bounce; lengths and times are such that g = 1.
//! struct Ball {
//!     restitution: f64,
//! }
//!
//! impl HybridSystem<2, 1> for Ball {
//!     type Mode = ();
//!
//!     fn field(&self, (): (), _time: f64, y: &State<2>) -> State<2> {
//!         State::from([y[1], -1.0])
//!     }
//!     fn guards(&self, (): ()) -> [Guard; 1] {
//!         [Guard::new(Direction::Below)]
//!     }
//!     fn guard_values(&self, (): (), _time: f64, y: &State<2>) -> [f64; 1] {
//!         [y[0]]
//!     }
//!     fn transition(&self, (): (), _: usize, _time: f64, y: &State<2>) -> ((), State<2>) {
//!         ((), State::from([0.0, -self.restitution * y[1]]))
//!     }
//! }
//!
//! /// A ball of restitution y, dropped from height x.
//! fn drop(point: &Point) -> (Ball, Start<(), 2>) {
//!     let start = Start { mode: (), s: 0.0, state: State::from([point.x, 0.0]) };
//!     (Ball { restitution: point.y }, start)
//! }
//!
//! let options = Options::with_tolerance(1e-14);
//! let family = HybridFamily { problem: drop, method: Dop853, options, end: 2.4 };
//! let window = Window { low: Point::new(0.5, 0.5), high: Point::new(2.0, 0.8) };
//! let network = trace(&family, &window, &TraceOptions::default())?;
//! assert!(network.unresolved.is_empty());
//!
//! // The second bounce is at √(2x)(1 + 2y): where that is 2.4, a boundary passes.
//! let second = |point: &Point| (2.0 * point.x).sqrt() * (1.0 + 2.0 * point.y);
//! let on_second = |point: &Point| (second(point) - 2.4).abs() < 1e-11;
//! assert!(network.curves[0].nodes.iter().all(|node| on_second(&node.point)));
//!
//! let regions = Subdivision::new(window, network.curves, network.vertices, 1e-9)?;
//! let Location::Region(region) = regions.locate(&Point::new(0.6, 0.55)) else { panic!("a boundary") };
//! // The guards that fire in this region before the end: those of two bounces.
//! assert_eq!(regions.regions()[region].label, Some(vec![0, 0]));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Anything else whose runs have labels and margins implements [`Family`]. The repository's
//! `examples/belt_atlas` traces stick–slip of a shaken mass, with all kinds of boundaries, and
//! holds them to closed forms.
//!
//! In reading order: `family` (what is traced), `hybrid` (hybrid systems as families), `curve`
//! (what comes out), `cubic` (curves between nodes), `options`; then `tracing` (how boundaries are
//! found and followed) and `regions` (what they make of the window).

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
