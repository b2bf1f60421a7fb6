//! Runs without event location, as a standard of comparison.
//!
//! They are a function of their own, and not an option of `run`: the loop of `run` pays nothing for
//! them, and other functions need not define what the option would mean.

use crate::error::RunError;
use crate::hybrid::{
    Direction, HybridSystem, Observer, Outcome, Run, Start, Statistics, SwitchEvent,
};
use crate::method::{Method, Step, Trial};
use crate::options::{Options, StepSize};
use crate::runs::clock::Clock;
use crate::runs::finite::{check_finite, is_finite};

/// Integrates `system` from `start` to `end` in steps of `step_size`, without locating switches.
///
/// The guards are evaluated only at the ends of steps. The first guard in the list that has fired
/// during a step causes a switch at its end. At most `max_steps` steps are taken.
///
/// A guard that crosses zero and comes back within a step is missed. Switches are late by up to a
/// step, so that the order of the method is lost. [`run`](crate::run) does not have these errors.
/// Every mode is entered as if its first step was done ([`HybridSystem::settle`]), since the state
/// at a late switch does not suit the start of a phase.
///
/// ```
/// use stickslip_solver::{Direction, Dop853, Guard, HybridSystem, Outcome, Start, State};
/// use stickslip_solver::runs::run_over_switches;
///
/// /// A ball thrown up.
/// struct Throw;
///
/// impl HybridSystem<2, 1> for Throw {
///     type Mode = ();
///     fn field(&self, (): (), _time: f64, y: &State<2>) -> State<2> {
///         State::from([y[1], -9.81])
///     }
///     fn guards(&self, (): ()) -> [Guard; 1] {
///         [Guard::new(Direction::Below).from_zero(1).terminal()]
///     }
///     fn guard_values(&self, (): (), _time: f64, y: &State<2>) -> [f64; 1] {
///         [y[0]]
///     }
///     fn transition(&self, (): (), _guard: usize, _time: f64, y: &State<2>) -> ((), State<2>) {
///         ((), *y)
///     }
/// }
///
/// let start = Start { mode: (), s: 0.0, state: State::from([0.0, 10.0]) };
/// let end = run_over_switches(Dop853, &Throw, start, 100.0, 0.01, 1_000_000, &mut ())?;
/// assert_eq!(end.outcome, Outcome::EndedByGuard { guard: 0 });
/// // The ball comes down at 20/9.81 = 2.0387. The guard is evaluated every hundredth.
/// assert!((end.s - 2.04).abs() < 1e-12);
/// # Ok::<(), stickslip_solver::RunError>(())
/// ```
///
/// # Errors
/// A [`RunError`] reports a step size that is not finite and above 0, a span that does not lead
/// forward, a state that is not finite, and a guard that is not a number.
pub fn run_over_switches<M, S, O, const N: usize, const G: usize>(
    _method: M,
    system: &S,
    start: Start<S::Mode, N>,
    end: f64,
    step_size: f64,
    max_steps: usize,
    observer: &mut O,
) -> Result<Run<S::Mode, N>, RunError>
where
    M: Method,
    S: HybridSystem<N, G>,
    O: Observer<S::Mode, N>,
{
    Options { step_size: StepSize::Fixed(step_size), ..Options::default() }.validate()?;
    let Start { mut mode, s, mut state } = start;
    if !(s.is_finite() && end > s) {
        return Err(RunError::Span { from: s, to: end });
    }
    check_finite(s, state.as_slice())?;
    let mut clock = Clock::new(s);
    let mut statistics = Statistics { field: 1, guards: 1, ..Statistics::default() };
    let mut values = system.guard_values(mode, s, &state);
    let mut slope = system.field(mode, s, &state);
    let mut step = Step::blank();
    let outcome = loop {
        if statistics.accepted >= max_steps {
            break Outcome::StepLimit;
        }
        let (h, last) = clock.step_towards(end, step_size);
        let (rest, tolerances) = (Trial::NO_REST, (1.0, 1.0));
        let trial = Trial { s: clock.s, y: &state, rest, slope: &slope, h, tolerances };
        system.step::<M>(mode, &trial, &mut step);
        statistics.accepted += 1;
        statistics.field += M::STAGES - 1 + usize::from(M::ERROR_USES_END);
        if !is_finite(step.y1.as_slice()) {
            return Err(RunError::Field { s: clock.s, step: statistics.accepted });
        }
        clock.advance(h);
        state = step.y1;
        let s = clock.s;
        let ends = system.guard_values(mode, s, &state);
        statistics.guards += 1;
        let guards = system.guards(mode);
        let mut fired = None;
        for guard in (0..G).filter(|&guard| guards[guard].direction().has_values()) {
            if ends[guard].is_nan() {
                return Err(RunError::GuardNotANumber { guard, s: step.s });
            }
            if fired.is_none() && fires(guards[guard].direction(), values[guard], ends[guard]) {
                fired = Some(guard);
            }
        }
        let from = mode;
        mode = system.settle(mode, &state);
        if let Some(guard) = fired {
            let terminal = guards[guard].ends_run();
            let before = state;
            if !terminal {
                let (to, after) = system.transition(from, guard, s, &before);
                (mode, state) = (system.settle(to, &after), after);
                statistics.switches += 1;
            }
            let to = if terminal { from } else { mode };
            observer.on_switch(&SwitchEvent {
                s,
                guard,
                simultaneous: 0,
                flatness: f64::NAN,
                jump: false,
                from,
                to,
                before,
                after: state,
            });
            if terminal {
                break Outcome::EndedByGuard { guard };
            }
        }
        if last {
            break Outcome::ReachedEnd;
        }
        if mode == from && fired.is_none() {
            (values, slope) = (ends, step.finish::<M>(&mut |s, y| system.field(mode, s, y)));
            statistics.field += usize::from(!M::ERROR_USES_END);
        } else {
            values = system.guard_values(mode, s, &state);
            slope = system.field(mode, s, &state);
            statistics.field += 1;
            statistics.guards += 1;
        }
    };
    observer.on_end(mode, clock.s, &state);
    // Guards are looked at only at the ends of steps.
    Ok(Run { outcome, s: clock.s, mode, state, decided: G == 0, statistics })
}

/// Whether a guard has fired that changed from `before` to `now`.
fn fires(direction: Direction, before: f64, now: f64) -> bool {
    let (falls, rises) = (before >= 0.0 && now < 0.0, before <= 0.0 && now > 0.0);
    match direction {
        Direction::Below => now < 0.0,
        Direction::Falling => falls,
        Direction::Rising => rises,
        Direction::Either => falls || rises,
        Direction::Off | Direction::Clock => false,
    }
}
