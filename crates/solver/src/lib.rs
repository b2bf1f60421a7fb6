//! Adaptive integration of piecewise-smooth ODEs that finds every switch.
//!
//! A hybrid system has modes. Each mode has a smooth right-hand side, guards whose zeros end the
//! mode, and transitions to other modes. [`run`] integrates such a system with a Dormand–Prince
//! pair. The time of a switch comes from steps of the method to the switch, not from the dense
//! output.
//!
//! A [`ReadableSystem`] is written once, generic in its numbers. On every step its guards are then
//! *decided*: the solver bounds a guard and its slopes along the step by interval arithmetic, so
//! that no crossing is missed or invented, however steep, fast or kinked the guard is. What
//! rounding hides is reported as a [`Grazing`].
//!
//! ```
//! use stickslip_solver::{
//!     Direction, Dop853, Guard, Number, Options, ReadableSystem, Start, State, run,
//! };
//!
//! /// A room that cools to 5 °C, or is heated towards 30 °C: on below 19, off above 21.
//! struct Room;
//!
//! // One component of the state, one guard in a mode.
//! impl ReadableSystem<1, 1> for Room {
//!     /// Whether it is heated.
//!     type Mode = bool;
//!
//!     fn field<T: Number>(&self, heated: bool, _time: T, y: &[T; 1]) -> [T; 1] {
//!         [-y[0] + if heated { 30.0 } else { 5.0 }]
//!     }
//!     fn guards(&self, _heated: bool) -> [Guard; 1] {
//!         [Guard::new(Direction::Below)]
//!     }
//!     fn guard_values<T: Number>(&self, heated: bool, _time: T, y: &[T; 1]) -> [T; 1] {
//!         [if heated { -y[0] + 21.0 } else { y[0] - 19.0 }]
//!     }
//!     fn transition(&self, heated: bool, _: usize, _time: f64, y: &State<1>) -> (bool, State<1>) {
//!         (!heated, *y)
//!     }
//! }
//!
//! let start = Start { mode: true, s: 0.0, state: State::from([15.0]) };
//! let mut switches = Vec::new();
//! let end = run(Dop853, &Room, start, 5.0, &Options::default(), &mut switches)?.finished()?;
//! // From 21 to 19 without heating.
//! let cooling = switches[1].s - switches[0].s;
//! assert!((cooling - (16.0_f64 / 14.0).ln()).abs() < 1e-11 && end.s == 5.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A [`HybridSystem`] and [`Closures`] are black boxes: their guards are *sampled*. A guard that
//! varies on the scale of the solution is found as surely as one that can be read. One that varies
//! faster needs [`Options::guard_scale`]; without it, what happens between the samples may be
//! missed (`docs/validation.md` has the rates).
//!
//! ```
//! use stickslip_solver::{Closures, Direction, Dop853, Guard, Options, Start, State, run};
//!
//! let ball = Closures::new(|_time, y: &State<2>| State::from([y[1], -9.81]))
//!     .guards([Guard::new(Direction::Below)], |_time, y| [y[0]])
//!     .transition(|_guard, _time, y| State::from([0.0, -0.5 * y[1]]));
//! let start = Start { mode: (), s: 0.0, state: State::from([4.905, 0.0]) };
//! let mut bounces = Vec::new();
//! let end = run(Dop853, &ball, start, 2.5, &Options::default(), &mut bounces)?.finished()?;
//! assert!((bounces[0].s - 1.0).abs() < 1e-14 && (bounces[1].s - 2.0).abs() < 1e-14);
//! # assert_eq!(end.s, 2.5);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | you want | use |
//! |---|---|
//! | several guards in a mode | one value and one guard for each; [`Guard::OFF`] where a mode has fewer |
//! | a guard that ends the run | [`Guard::terminal`], [`Outcome::EndedByGuard`] |
//! | a guard that starts from zero and must not fire there | nothing if it is exactly 0 and rises; else [`Guard::from_zero`] |
//! | a crossing that is reported and changes nothing | [`Direction::Falling`], [`Rising`](Direction::Rising) or [`Either`](Direction::Either), and the provided transition |
//! | switches that accumulate, as when a ball comes to rest | [`Outcome::Zeno`], or [`HybridSystem::rest`] to go on behind them |
//! | events at given times | [`Guard::clock`] and [`HybridSystem::schedule`] |
//! | values that only events change | fields of the mode |
//! | a mode that cannot be copied, as a list | its number in a [`ModeTable`](hybrid::ModeTable) |
//! | a quick problem | [`Closures`] |
//! | the steps one by one | [`Stepper`], an iterator |
//! | derivatives with respect to parameters | [`fn@sensitivity::sensitivities`] |
//! | the state at any time | [`Recorder`] as the observer |
//! | the state at given times | [`Samples`] as the observer |
//! | two observers | a tuple of both |
//! | only the switches | a `Vec` as the observer |
//! | only the end of the run | `()` as the observer |
//! | no guards at all | [`integrate`] with a closure |
//! | a run back in time | [`run_backwards`] |
//! | a tolerance for each component | [`Weighted`] |
//! | a method that is named at run time | [`EmbeddedPair`], [`run_with`] |
//! | a dimension that is known at run time, many components, any number of guards | [`DynamicSystem`], [`run_dynamic`] |
//! | a field that jumps on a surface, as dry friction does | [`sliding::Filippov`] |
//! | how far a run is from another sequence of switches | [`fn@margins`], [`margins_dynamic`], and the crate `stickslip-tracer` |
//!
//! # Defined answers
//!
//! | question | answer |
//! |---|---|
//! | a guard starts on zero | It fires at the start if it leaves zero in its direction, and otherwise not. After [`Guard::from_zero`] it does not fire there, unless it is [`Below`](Direction::Below) and becomes negative. |
//! | a guard touches zero | It does not fire. Where the dense output cannot distinguish a touch from a crossing, a step of the method decides, and [`Observer::on_grazing`] reports it, once and in order. |
//! | a guard has a pole | It does not fire, and [`Observer::on_pole`] reports it. Where a guard is [`Below`](Direction::Below), the domain ends there, and it fires. |
//! | a guard has no value (NaN) | An error, unless the run ends before. |
//! | several guards at one instant | Times are one instant if the errors of their location overlap. All guards act there, each once: guards of higher [priority](Guard::priority) first, and then in the order of the list. |
//! | … and the first one changes the state or the mode | A guard that has crossed zero acts on the state as it is then. If the mode does not have it when its turn comes, it is reported ([`Observer::on_preempted`]). A [`Below`](Direction::Below) guard is evaluated again. |
//! | … and a transition leaves a guard on its own zero | It does not fire again at that instant. |
//! | a transition carries a guard across zero | That is not a crossing, unless the guard [sees jumps](Guard::sees_jumps). |
//! | transitions at one instant without an end | An error that names the cycle ([`RunError::Cycle`]); observers do not keep them. |
//! | a clock and the start of the run | A time that is the start counts. |
//! | a guard crosses zero at the end of the span | It fires. The outcome is [`Outcome::EndedByGuard`] if it is terminal, and else [`Outcome::ReachedEnd`]. |
//! | the state at an event | It always comes with the event: [`SwitchEvent::before`] lies on the guard, and [`SwitchEvent::after`] follows from the transition. |
//! | [`Guard::terminal_after`] k events | The k-th firing ends the run at its place, without a transition, also if several lie on one step. |
//! | an observer that stops | It is called after every switch and every step. The run ends there, at a switch with the state after it. |
//! | output times at switches and at the end | [`Samples`] and [`Recorder`] give the state after the switch. [`Samples`] at the end of the run gives the final state exactly. |
//! | tolerances | Scalars in [`Options`]. [`Weighted`] has a relative and an absolute one for each component. |
//! | the method | A type, compiled into the run. [`run_with`] chooses it at run time, with the same results bit for bit. |
//! | backwards | [`run_backwards`]: s decreases, directions of guards hold in the direction of integration, and every reported s is the original one. |
//! | a [`DynamicSystem`] | The same answers; [`DynamicEvent::simultaneous`] names any number of guards. |
//! | were all guards decided? | [`Run::decided`] |
//!
//! The repository's `examples` have fewer than 80 lines each and check themselves against a closed
//! form or an independent value: `bouncing_ball` (switches that accumulate), `friction_belt`
//! (stick–slip), `relay` (feedback with hysteresis), `impact_oscillator` (near grazing) and
//! `arenstorf` (a smooth problem with dense output).
//!
//! # The source
//!
//! Start reading in [`hybrid`]. The other modules follow in reading order:
//!
//! | module | content |
//! |---|---|
//! | [`hybrid`] | what a user writes (a system with guards), and the results of a run |
//! | `options`, `error` | settings of a run, and why it can fail |
//! | [`runs`] | the loop from switch to switch; smooth problems, trajectories, runs without event location |
//! | `system` | a system as the loop and the events see it, of fixed or of any dimension |
//! | `events` | one step and its guards: which guards fire first, and where |
//! | [`mod@dynamic`] | systems whose dimension is known at run time |
//! | [`method`] | Runge–Kutta pairs, one step, its dense output, step-size control, measured orders |
//! | [`mod@sliding`] | systems whose field jumps on surfaces, along which they may slide |
//! | [`mod@margin`] | how near a run came to other switches |
//! | [`sensitivity`] | derivatives of a run with respect to parameters |
//!
//! [`DynamicEvent::simultaneous`]: dynamic::DynamicEvent::simultaneous
//! [`DynamicSystem`]: dynamic::DynamicSystem
//! [`fn@margins`]: fn@margin::margins
//! [`margins_dynamic`]: margin::margins_dynamic
//! [`run_dynamic`]: dynamic::run_dynamic

pub mod hybrid;

mod options;

mod error;

pub mod runs;

mod lists;

mod system;

mod events;

pub mod dynamic;

pub mod method;

pub mod sliding;

pub mod margin;

pub mod sensitivity;

pub use error::RunError;
pub use hybrid::{
    Direction, Grazing, Guard, HybridSystem, Observer, Outcome, ReadableSystem, Rest, Run,
    Schedule, Start, Statistics, SwitchEvent, Times,
};
pub use method::{Dop853, Dopri5, EmbeddedPair, Method, State};
pub use options::{Options, StepSize};
pub use runs::{
    Closures, Recorder, Samples, Stepper, Weighted, integrate, run, run_backwards, run_with,
};
pub use stickslip_number::{Enclosure, GivenValue, Interval, InvalidValue, Number};
// What appears in signatures: states, and numbers that know their rates.
pub use {nalgebra, num_dual::Dual64};

#[doc = include_str!("../README.md")]
#[cfg(doctest)]
pub struct Readme;
