//! Adaptive integration of piecewise-smooth ODEs that finds every switch.
//!
//! A hybrid system has modes, a smooth right-hand side in each, guards whose zeros end a mode, and
//! transitions. [`run`] integrates it with a Dormand–Prince pair. On every step it is *decided*,
//! not sampled, whether a guard crosses zero: the dense output makes the guard an analytic function
//! of the step fraction, whose monotone pieces are isolated. Switch times come from steps of the
//! method to the switch, not from the dense output.
//!
//! Start reading in [`hybrid`]; then, in this order: `runner` (from switch to switch), `phase` and
//! `event` (one step and its guards), `quick`, `isolate` and `chebyshev` (the decision), `locate`
//! (the refinement), [`method`], [`Dopri5`] and [`Dop853`], `control`, `clock`, [`smooth`],
//! [`trajectory`], [`mod@margin`] and `prescribed`, [`sensitivity`], `unlocated` and `order` (what
//! is lost without all this, and how orders are measured).
//!
//! ```
//! use stickslip_solver::{Direction, Dop853, Guard, HybridSystem, Options, Start, State, run};
//!
//! /// A room that cools to 5 °C, or is heated towards 30 °C: on below 19, off above 21.
//! struct Room;
//!
//! // One component of the state, one guard in a mode.
//! impl HybridSystem<1, 1> for Room {
//!     /// Whether it is heated.
//!     type Mode = bool;
//!
//!     fn field(&self, heated: bool, _time: f64, y: &State<1>) -> State<1> {
//!         State::from([if heated { 30.0 - y[0] } else { 5.0 - y[0] }])
//!     }
//!     fn guards(&self, _heated: bool) -> [Guard; 1] {
//!         [Guard::new(Direction::Below)]
//!     }
//!     fn guard_values(&self, heated: bool, _time: f64, y: &State<1>) -> [f64; 1] {
//!         [if heated { 21.0 - y[0] } else { y[0] - 19.0 }]
//!     }
//!     fn transition(&self, heated: bool, _: usize, _time: f64, y: &State<1>) -> (bool, State<1>) {
//!         (!heated, *y)
//!     }
//! }
//!
//! let start = Start { mode: true, s: 0.0, state: State::from([15.0]) };
//! let mut switches = Vec::new();
//! run(Dop853, &Room, start, 5.0, &Options::default(), &mut switches)?;
//! // From 21 to 19 without heating.
//! let cooling = switches[1].s - switches[0].s;
//! assert!((cooling - (16.0_f64 / 14.0).ln()).abs() < 1e-11);
//! # Ok::<(), stickslip_solver::RunError>(())
//! ```
//!
//! | what is wanted | what does it |
//! |---|---|
//! | several guards in a mode | as many values and as many guards; [`Guard::OFF`] where a mode has fewer |
//! | a guard that ends the run | [`Guard::terminal`], [`Outcome::EndedByGuard`] |
//! | a guard that starts from zero, and must not fire there | nothing if it is exactly 0 and rises; else [`Guard::from_zero`] |
//! | a crossing noted, and nothing else | [`Direction::Falling`], [`Rising`](Direction::Rising) or [`Either`](Direction::Either), and the provided transition |
//! | switches that accumulate, as of a ball that comes to rest | [`Outcome::Zeno`] |
//! | the state at any time | [`Recorder`] as the observer |
//! | switches alone; nothing but the end | a `Vec`; `()` |
//! | no guards at all | [`integrate`] with a closure |
//! | how far a run is from another sequence of switches | [`fn@margins`], and the crate `stickslip-tracer` |
//!
//! The repository's `examples`, each held to a closed form or an independent value in less than 80
//! lines: `bouncing_ball` (switches that accumulate), `friction_belt` (stick–slip), `relay`
//! (feedback with hysteresis), `impact_oscillator` (near grazing), `arenstorf` (smooth, with dense
//! output).

pub mod hybrid;

mod error;
mod options;

mod runs;

mod events;

pub mod method;

pub mod margin;
pub mod sensitivity;

pub use error::RunError;
pub use hybrid::{
    Direction, Grazing, Guard, HybridSystem, Observer, Outcome, Run, Start, Statistics, SwitchEvent,
};
pub use margin::{Exit, Hint, Margin, Margins, NearMiss, Place, margin, margins};
pub use method::{Dense, Dop853, Dopri5, Method, Order, State, Step, Tableau, Trial, fit_order};
pub use options::{InvalidOption, Options, StepSize};
pub use runs::{
    Recorder, Segment, Trajectory, integrate, run, run_over_switches, smooth, trajectory,
};
pub use sensitivity::{Change, Differentiable, Sensitivities, SwitchSensitivity, sensitivities};

#[doc = include_str!("../README.md")]
#[cfg(doctest)]
pub struct Readme;
