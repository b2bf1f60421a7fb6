//! Systems whose dimension is known at run time only.
//!
//! A [`DynamicSystem`] is to [`run_dynamic`] what a [`HybridSystem`](crate::HybridSystem) is to
//! [`run`](crate::run). States are slices, so a chain of 20 000 oscillators runs in a thread with a
//! small stack, and a mode has as many guards as it says.
//!
//! ```
//! use stickslip_solver::{Direction, Dop853, Guard, Options};
//! use stickslip_solver::dynamic::{DynamicStart, DynamicSystem, run_dynamic};
//!
//! /// Balls that fall on a floor, each with its height and its velocity; all keep half their
//! /// velocity.
//! struct Balls {
//!     guards: Vec<Guard>,
//! }
//!
//! impl DynamicSystem for Balls {
//!     type Mode = ();
//!
//!     fn field(&self, (): (), _time: f64, y: &[f64], slope: &mut [f64]) {
//!         for (ball, slope) in y.chunks_exact(2).zip(slope.chunks_exact_mut(2)) {
//!             slope.copy_from_slice(&[ball[1], -9.81]);
//!         }
//!     }
//!     fn guards(&self, (): ()) -> &[Guard] {
//!         &self.guards
//!     }
//!     fn guard_values(&self, (): (), _time: f64, y: &[f64], values: &mut [f64]) {
//!         for (ball, value) in y.chunks_exact(2).zip(values) {
//!             *value = ball[0];
//!         }
//!     }
//!     fn transition(&self, (): (), guard: usize, _time: f64, y: &mut [f64]) {
//!         (y[2 * guard], y[2 * guard + 1]) = (0.0, -0.5 * y[2 * guard + 1]);
//!     }
//! }
//!
//! // As many as a file says; here 40, the last of which falls for one second.
//! let heights = (1..=40).map(|k| 1.905 + 3.0 * f64::from(k) / 40.0);
//! let state: Vec<f64> = heights.flat_map(|height| [height, 0.0]).collect();
//! let balls = Balls { guards: vec![Guard::new(Direction::Below); state.len() / 2] };
//! let start = DynamicStart { mode: (), s: 0.0, state: &state };
//! let mut bounces = Vec::new();
//! let options = Options::default();
//! let end = run_dynamic(Dop853, &balls, start, 1.1, &options, &mut bounces)?.finished()?;
//! let last = bounces.iter().find(|bounce| bounce.guard == 39).expect("it falls for one second");
//! assert!((last.s - 1.0).abs() < 1e-12 && last.before[78].abs() < 1e-12);
//! assert_eq!((end.s, end.state.len()), (1.1, 80));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # What is the same
//!
//! The engine: a run is that of [`run`](crate::run) on buffers, bit for bit up to 8 components, or
//! on states of fixed dimension ([`DynamicSystem::ON_FIXED_STATES`]). The guards of a
//! [`DynamicSystem`] are black boxes. Those of a [`ReadableDynamic`], whose formulas are generic in
//! their numbers, are decided.
//!
//! # What differs
//!
//! - [`sensitivities_dynamic`](crate::sensitivity::sensitivities_dynamic) are those of a
//!   [`ReadableDynamic`] whose transitions are readable too.
//! - [`DynamicEvent::simultaneous`] is a list, so that it can name any number of guards.
//! - Up to 8 components, the effect of rounding of the state on a guard is measured component by
//!   component; beyond that, by moving all components at once, in eight irregular but fixed
//!   patterns.
//! - A run allocates room for 70 states when it starts, and a little at events. It allocates
//!   nothing on steps without event, and nothing for a right-hand side.
//! - [`Samples`](crate::Samples) exists for fixed dimensions only ([`DynamicRecorder::at`] knows
//!   all times), and so does [`HybridSystem::settle`](crate::HybridSystem::settle). Tolerances of
//!   components are those of [`DynamicSystem::tolerances`].
//!
//! # Cost
//!
//! A step evaluates all guards five times, and three times more unless all are declared to be
//! [smooth](crate::Guard::smooth). On a step on which a guard comes near zero or crosses it in a
//! way that these values do not settle, that guard is isolated by itself: some fifty evaluations of
//! all guards and as many states of the dense output, and more the faster it varies. An event takes
//! a few steps of the method, whatever the number of guards: 27 right-hand sides and two bounds of
//! all guards each with 500 thermostats as with 20.

mod backwards;
mod by_name;
mod dense;
pub(crate) mod few;
mod recorder;
mod results;
mod runner;
mod system;

pub use backwards::run_dynamic_backwards;
pub use by_name::run_dynamic_with;
pub use dense::DynamicDense;
pub use recorder::{DynamicRecorder, DynamicSegment};
pub use results::{DynamicEvent, DynamicObserver, DynamicRun, DynamicSwitch};
pub use runner::run_dynamic;
pub use system::{DynamicStart, DynamicSystem, ReadableDynamic};

/// Some bits that depend on `i` irregularly (the finaliser of splitmix64).
pub(crate) fn scramble(i: usize) -> u64 {
    let mut z = (i as u64).wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
