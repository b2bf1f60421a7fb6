//! Runs that go backwards.
//!
//! The substitution τ = −s turns them into runs forwards. Whatever an observer or a caller sees has
//! the original s.

use crate::error::RunError;
use crate::hybrid::{
    Grazing, Guard, HybridSystem, Observer, Outcome, Pole, Preempted, Rest, Run, Schedule, Start,
    SwitchEvent,
};
use crate::method::{Dense, Method, State, Step, Trial};
use crate::options::Options;
use crate::runs::runner::run;
use stickslip_number::Enclosure;

/// Integrates `system` from `start` down to `end` < `start.s`, through every switch on the way.
///
/// It does what [`run`](crate::run) does, with the same options, observers and accuracy. Directions
/// of guards hold in the direction of integration: a guard that is `Falling` fires where its value
/// becomes negative while s decreases. A transition is not inverted. `end` may be −∞ if a terminal
/// guard ends the run.
///
/// Every s that is reported is the original one, so the places of switches decrease. Segments have
/// a negative size ([`Dense::size`]) and start where s is largest.
///
/// ```
/// use stickslip_solver::{
///     Closures, Direction, Dop853, Guard, Options, Start, State, run_backwards,
/// };
///
/// // A stone hits the ground at 9.81 m/s. When was it 1 m high?
/// let stone = Closures::new(|_time, y: &State<2>| State::from([y[1], -9.81]))
///     .guards([Guard::new(Direction::Rising).terminal()], |_time, y| [y[0] - 1.0]);
/// let impact = Start { mode: (), s: 0.0, state: State::from([0.0, -9.81]) };
/// let earlier = run_backwards(Dop853, &stone, impact, -10.0, &Options::default(), &mut ())?;
/// assert!((earlier.s - (-1.0 + (1.0 - 2.0 / 9.81_f64).sqrt())).abs() < 1e-12);
/// # Ok::<(), stickslip_solver::RunError>(())
/// ```
///
/// # Errors
/// Those of [`run`](crate::run), and [`RunError::Span`] unless `end` < `start.s`.
pub fn run_backwards<M, S, O, const N: usize, const G: usize>(
    method: M,
    system: &S,
    start: Start<S::Mode, N>,
    end: f64,
    options: &Options,
    observer: &mut O,
) -> Result<Run<S::Mode, N>, RunError>
where
    M: Method,
    S: HybridSystem<N, G>,
    O: Observer<S::Mode, N>,
{
    let reversed = Start { s: reverse(start.s), ..start };
    let mut observer = Reversed(observer);
    match run(method, &Reversed(system), reversed, reverse(end), options, &mut observer) {
        Ok(run) => Ok(Run { s: reverse(run.s), outcome: original(run.outcome), ..run }),
        Err(error) => Err(error.reversed()),
    }
}

/// −s. The place 0 keeps its sign.
pub(crate) fn reverse(s: f64) -> f64 {
    0.0 - s
}

/// The outcome of a run in s that ended so as a run in −s.
pub(crate) fn original(outcome: Outcome) -> Outcome {
    match outcome {
        Outcome::Zeno { accumulation } => Outcome::Zeno { accumulation: reverse(accumulation) },
        Outcome::EndedByGuard { .. }
        | Outcome::ReachedEnd
        | Outcome::StepLimit
        | Outcome::SwitchLimit
        | Outcome::Stopped => outcome,
    }
}

/// A system as a function of τ = −s, or the observer of a run in τ that passes s on.
struct Reversed<T>(T);

impl<S, const N: usize, const G: usize> HybridSystem<N, G> for Reversed<&S>
where
    S: HybridSystem<N, G>,
{
    type Mode = S::Mode;

    const READABLE: bool = S::READABLE;

    #[inline]
    fn field(&self, mode: S::Mode, tau: f64, y: &State<N>) -> State<N> {
        -self.0.field(mode, reverse(tau), y)
    }

    #[inline]
    fn guards(&self, mode: S::Mode) -> [Guard; G] {
        self.0.guards(mode)
    }

    #[inline]
    fn guard_values(&self, mode: S::Mode, tau: f64, y: &State<N>) -> [f64; G] {
        self.0.guard_values(mode, reverse(tau), y)
    }

    fn guard_rates(&self, mode: S::Mode, tau: f64, y: &State<N>) -> [f64; G] {
        self.0.guard_rates(mode, reverse(tau), y).map(|rate| -rate)
    }

    fn enclose_guards(&self, mode: S::Mode, tau: Enclosure, y: &[Enclosure; N]) -> [Enclosure; G] {
        self.0.enclose_guards(mode, -tau, y)
    }

    fn longest_first_step(&self, mode: S::Mode, tau: f64, y: &State<N>) -> f64 {
        self.0.longest_first_step(mode, reverse(tau), y)
    }

    fn settle(&self, mode: S::Mode, y: &State<N>) -> S::Mode {
        self.0.settle(mode, y)
    }

    /// The system's own step, of negative size.
    fn step<M: Method>(&self, mode: S::Mode, trial: &Trial<'_, N>, step: &mut Step<N>) {
        let slope = -trial.slope;
        let backwards = Trial { s: reverse(trial.s), slope: &slope, h: -trial.h, ..*trial };
        self.0.step::<M>(mode, &backwards, step);
        step.reverse();
    }

    fn counter(&self, mode: S::Mode, guard: usize) -> usize {
        self.0.counter(mode, guard)
    }

    fn schedule(&self, mode: S::Mode, guard: usize) -> Schedule<'_> {
        self.0.schedule(mode, guard).reversed()
    }

    fn rest(
        &self,
        mode: S::Mode,
        guard: usize,
        tau: f64,
        y: &State<N>,
    ) -> Option<(S::Mode, State<N>)> {
        self.0.rest(mode, guard, reverse(tau), y)
    }

    fn transition(
        &self,
        mode: S::Mode,
        guard: usize,
        tau: f64,
        y: &State<N>,
    ) -> (S::Mode, State<N>) {
        self.0.transition(mode, guard, reverse(tau), y)
    }
}

impl<O, Mode: Copy, const N: usize> Observer<Mode, N> for Reversed<&mut O>
where
    O: Observer<Mode, N>,
{
    const WANTS_SEGMENTS: bool = O::WANTS_SEGMENTS;

    fn on_switch(&mut self, event: &SwitchEvent<Mode, N>) {
        self.0.on_switch(&SwitchEvent { s: reverse(event.s), ..*event });
    }

    fn on_grazing(&mut self, grazing: &Grazing<Mode>) {
        self.0.on_grazing(&Grazing { s: reverse(grazing.s), ..*grazing });
    }

    fn on_pole(&mut self, pole: &Pole<Mode>) {
        self.0.on_pole(&Pole { s: reverse(pole.s), ..*pole });
    }

    fn on_preempted(&mut self, preempted: &Preempted<Mode>) {
        self.0.on_preempted(&Preempted { s: reverse(preempted.s), ..*preempted });
    }

    fn on_rest(&mut self, rest: &Rest<Mode>) {
        self.0.on_rest(&Rest { s: reverse(rest.s), ..*rest });
    }

    fn forget(&mut self, switches: usize) {
        self.0.forget(switches);
    }

    fn stops(&self, tau: f64) -> bool {
        self.0.stops(reverse(tau))
    }

    fn on_segment(&mut self, mode: Mode, dense: &Dense<N>) {
        self.0.on_segment(mode, &dense.reversed());
    }

    fn on_end(&mut self, mode: Mode, tau: f64, state: &State<N>) {
        self.0.on_end(mode, reverse(tau), state);
    }
}
