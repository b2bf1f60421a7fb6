//! Curves in a parameter plane on which the switching of a piecewise-smooth ODE changes, and the
//! regions between them.
//!
//! A [`Family`] says what is traced. At each point of the plane its run has a label, the sequence
//! of its switches, and margins. On a boundary, where the label changes, a margin vanishes. A
//! [`HybridFamily`] is the family of a hybrid system of `stickslip_solver` that depends on two
//! parameters; a [`DynamicFamily`] is the same for a dimension that is known at run time.
//!
//! - [`trace`] finds the boundaries in a [`Window`] and follows them from vertex to vertex.
//! - [`trace_by_margins`] does the same without following labels.
//! - A [`Subdivision`] holds the regions between the curves and answers in which region a point
//!   lies.
//! - [`verify`](fn@regions::verify) compares the labels of the regions with runs at random points.
//! - [`follow`](fn@tracing::follow) follows one boundary from a place on it, and records what the
//!   caller wants to know along it.
//! - An [`Atlas`] has all of this, and knows which regions are in doubt. A [`Surveyor`] makes it,
//!   on the threads of the caller, and looks again where runs disagree.
//! - A [`Stack`] holds atlases over a third parameter, and locates the changes between them.
//!
//! In this example the system is a bouncing ball; its height and its restitution are the
//! parameters. The label of a region lists the guards that fire in its runs:
//!
//! ```
//! use stickslip_solver::{Direction, Dop853, Guard, HybridSystem, Options, Start, State};
//! use stickslip_tracer::{Point, TraceOptions, Window, trace};
//! use stickslip_tracer::hybrid::{HybridFamily, Itinerary};
//! use stickslip_tracer::regions::{Location, Subdivision};
//!
//! /// A ball that keeps a fraction of its velocity at each bounce, in units in which g = 1.
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
//! /// A ball of restitution y that is dropped from the height x.
//! fn drop(point: &Point) -> (Ball, Start<(), 2>) {
//!     let start = Start { mode: (), s: 0.0, state: State::from([point.x, 0.0]) };
//!     (Ball { restitution: point.y }, start)
//! }
//!
//! let options = Options::with_tolerance(1e-14);
//! let family = HybridFamily { problem: drop, method: Dop853, options, end: 2.4 };
//! let window = Window { low: Point::new(0.5, 0.5), high: Point::new(2.0, 0.8) };
//! // A coarse grid is enough for few curves.
//! let network = trace(&family, &window, &TraceOptions { cells: 8, ..TraceOptions::default() })?;
//! assert!(network.unresolved.is_empty());
//!
//! // The second bounce is at the time √(2x)(1 + 2y). On the boundary this is the end of the run.
//! let second = |point: &Point| (2.0 * point.x).sqrt() * (1.0 + 2.0 * point.y);
//! let on_second = |point: &Point| (second(point) - 2.4).abs() < 1e-11;
//! assert!(network.curves[0].nodes.iter().all(|node| on_second(&node.point)));
//!
//! let regions = Subdivision::new(window, network.curves, network.vertices, 1e-9)?;
//! let Location::Region(region) = regions.locate(&Point::new(0.6, 0.55)) else { panic!("a
//! boundary") }; // In this region the guard fires twice before the end, at two bounces.
//! assert_eq!(regions.regions()[region].label, Some(Itinerary::Fires(vec![0, 0])));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Other runs with labels and margins can be traced too: implement [`Family`] for them. The example
//! `examples/belt_atlas` of the repository traces the stick–slip of a shaken mass, with all kinds
//! of boundaries, and compares them with closed forms.
//!
//! [`DynamicFamily`]: hybrid::DynamicFamily
//! [`HybridFamily`]: hybrid::HybridFamily
//! [`Stack`]: stack::Stack
//! [`Subdivision`]: regions::Subdivision
//! [`trace_by_margins`]: tracing::trace_by_margins
//!
//! # The source
//!
//! Start reading in `tracing/tracer/trace.rs`. The modules in reading order:
//!
//! - `window`: points and windows of the parameter plane
//! - `family`: what is traced
//! - `hybrid`: hybrid systems as families
//! - `accumulation`: how many events count where they accumulate
//! - `curve`: what a trace returns
//! - `cubic`: curves between nodes
//! - `options`: options and errors of a trace
//! - `lengths`: what is close, short or accurate
//! - `conditions`: points at which as many conditions hold as there are unknowns
//! - `executor` and `watch`: threads, progress and cancellation, which the caller gives
//! - `tracing`: how boundaries are found and followed
//! - `regions`: the regions between the curves
//! - `effort`: how much is done for an atlas
//! - `draft`: what an atlas has in the places of labels and margins
//! - `survey`: tracing and verifying in turn, until nothing is missing
//! - `atlas` and `doubts`: the result, with all that speaks against it
//! - `names`: what an atlas calls parameters, labels and margins
//! - `document`: atlases of any family, written and read back (feature `serde`)
//! - `stack`: atlases over a third parameter, and where their structure changes

mod accumulation;
mod atlas;
pub mod conditions;
mod cubic;
mod curve;
#[cfg(feature = "serde")]
pub mod document;
mod doubts;
mod draft;
mod effort;
mod executor;
mod family;
pub mod hybrid;
mod inverse;
mod lengths;
mod names;
mod options;
mod polyline;
pub mod regions;
pub mod stack;
mod stopwatch;
mod survey;
pub mod tracing;
mod watch;
mod window;

pub use accumulation::Accumulation;
pub use atlas::{Atlas, AtlasOf, AtlasOptions};
pub use cubic::Cubic;
pub use curve::{Curve, Node, Vertex, VertexKind};
pub use doubts::Doubts;
pub use draft::Draft;
pub use effort::Effort;
pub use executor::{Executor, FreeRunOf, LabelOf, Serial};
pub use family::{Family, FreeRun};
pub use names::{Names, RunNames, Unnamed};
pub use options::{TraceError, TraceOptions};
pub use stickslip_solver::InvalidValue;
pub use survey::{DraftedOf, Surveyor};
pub use tracing::tracer::trace::trace;
pub use watch::{Progress, Report, Watch};
pub use window::{Point, Window};

#[doc = include_str!("../README.md")]
#[cfg(doctest)]
pub struct Readme;
