//! Adaptive integration of piecewise-smooth ODEs that finds every switch.
//!
//! A hybrid system has modes, a smooth right-hand side in each, guards whose zeros end a mode, and
//! transitions. [`run`] integrates it with a Dormand–Prince pair. On every step it is *decided*, not
//! sampled, whether a guard crosses zero: the dense output makes the guard an analytic function of
//! the step fraction, whose monotone pieces are isolated. Switch times come from steps of the method to
//! the switch, not from the dense output.
//!
//! Start reading in [`hybrid`]; then, in this order: `event` (one step and its guards), `quick` and `isolate`
//! (the decision), `locate` (the refinement), [`method`], [`Dopri5`] and [`Dop853`], `control`, `clock`, [`smooth`],
//! [`trajectory`], [`mod@margin`], `unlocated` and `order` (what is lost without all this, and how
//! orders are measured).
//!
//! ```
//! use stickslip_solver::{
//!     Direction, Dop853, Guard, HybridSystem, Options, Outcome, Start, State, run,
//! };
//!
//! /// A ball thrown up, which ends its flight on the floor.
//! struct Throw;
//!
//! impl HybridSystem<2, 1> for Throw {
//!     type Mode = ();
//!     fn field(&self, (): (), _time: f64, y: &State<2>) -> State<2> {
//!         State::from([y[1], -9.81])
//!     }
//!     fn guards(&self, (): ()) -> [Guard; 1] {
//!         [Guard::new(Direction::Below).from_zero(1).terminal()]
//!     }
//!     fn guard_values(&self, (): (), _time: f64, y: &State<2>) -> [f64; 1] {
//!         [y[0]]
//!     }
//!     fn transition(&self, (): (), _guard: usize, _time: f64, y: &State<2>) -> ((), State<2>) {
//!         ((), *y)
//!     }
//! }
//!
//! let start = Start { mode: (), s: 0.0, state: State::from([0.0, 10.0]) };
//! let end = run(Dop853, &Throw, start, 100.0, &Options::default(), &mut ())?;
//! assert_eq!(end.outcome, Outcome::EndedByGuard { guard: 0 });
//! assert!((end.s - 2.0 * 10.0 / 9.81).abs() < 1e-14);
//! # Ok::<(), stickslip_solver::RunError>(())
//! ```

mod clock;
mod control;
mod dop853;
mod dopri5;
mod error;
mod event;
mod guard;
pub mod hybrid;
mod isolate;
mod locate;
pub mod margin;
pub mod method;
mod options;
mod order;
mod quick;
pub mod smooth;
pub mod trajectory;
mod unlocated;

pub use dop853::Dop853;
pub use dopri5::Dopri5;
pub use error::RunError;
pub use guard::{Direction, Guard};
pub use hybrid::{
    Grazing, HybridSystem, Observer, Outcome, Run, Start, Statistics, SwitchEvent, run,
};
pub use margin::{Exit, Hint, Margin, Margins, NearMiss, Place, margin, margins};
pub use method::{Dense, Method, State, Step, Tableau, Trial};
pub use options::{InvalidOption, Options, StepSize};
pub use order::{Order, fit_order};
pub use smooth::integrate;
pub use trajectory::{Recorder, Segment, Trajectory};
pub use unlocated::run_over_switches;

#[doc = include_str!("../README.md")]
#[cfg(doctest)]
pub struct Readme;
