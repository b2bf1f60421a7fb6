//! Derivatives of a run with respect to parameters, through every switch.
//!
//! A small change of a parameter changes the state by δy. Between switches, δy obeys the
//! variational equations. At a switch, the change also moves the switch by δs = −δg/g'. Here δg is
//! the change of the guard at a fixed place, and g' is its slope along the solution. After the
//! switch, δy is the change of the transition at the moved place, minus the change that the new
//! right-hand side makes in δs. This is the saltation matrix (Leine and Nijmeijer, *Dynamics and
//! Bifurcations of Non-Smooth Mechanical Systems*, 2004, section 7.3).

use crate::error::RunError;
use crate::hybrid::{
    Guard, HybridSystem, Observer, Outcome, Schedule, Start, Statistics, SwitchEvent,
};
use crate::method::{Dop853, Dopri5, EmbeddedPair, Method, State};
use crate::options::Options;
use crate::runs::run;
use stickslip_number::Enclosure;

/// A small change of the independent variable, of the state and of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change<const N: usize> {
    /// The change of the independent variable.
    pub s: f64,
    /// The change of the state.
    pub y: State<N>,
    /// The parameter that changes by 1, or `None` if no parameter changes.
    pub parameter: Option<usize>,
}

/// A hybrid system with `P` parameters that knows its derivatives.
///
/// Each function belongs to a function of [`HybridSystem`]. It returns the change of that function,
/// to first order, under a [`Change`] of its arguments and of a parameter.
pub trait Differentiable<const N: usize, const G: usize, const P: usize>:
    HybridSystem<N, G>
{
    /// The change of the right-hand side.
    fn field_change(&self, mode: Self::Mode, s: f64, y: &State<N>, change: &Change<N>) -> State<N>;

    /// The changes of the guards' values. All guards may be multiplied by the same positive
    /// function, since this does not move their zeros.
    fn guard_changes(&self, mode: Self::Mode, s: f64, y: &State<N>, change: &Change<N>)
    -> [f64; G];

    /// The change of the state that follows when `guard` fires.
    fn transition_change(
        &self,
        mode: Self::Mode,
        guard: usize,
        s: f64,
        y: &State<N>,
        change: &Change<N>,
    ) -> State<N>;
}

/// A switch, or the end of a run, with its derivatives with respect to the parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SwitchSensitivity<Mode, const N: usize, const P: usize> {
    /// The guard that fired, or `None` if the run reached its end.
    pub guard: Option<usize>,
    /// The mode that ends here.
    pub mode: Mode,
    /// The place of the switch or of the end.
    pub s: f64,
    /// The derivatives of the place.
    pub s_derivatives: [f64; P],
    /// The state at the place, before the transition.
    pub state: State<N>,
    /// The derivatives of the state at the place, which moves too.
    pub state_derivatives: [State<N>; P],
}

/// A run with its derivatives with respect to parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivities<Mode, const N: usize, const P: usize> {
    /// The switches, in order.
    pub switches: Vec<SwitchSensitivity<Mode, N, P>>,
    /// The end of the run.
    pub end: SwitchSensitivity<Mode, N, P>,
    /// Why the run ended.
    pub outcome: Outcome,
    /// The work done. One evaluation of the right-hand side covers state and derivatives together.
    pub statistics: Statistics,
}

/// Integrates `system` like [`run`], together with the derivatives of its state with respect to `P`
/// parameters.
///
/// The derivatives of the state at the start are `start_derivatives`. State and derivatives
/// together are `A` = N (1 + P) numbers. Error control covers all of them, so derivatives are about
/// as accurate as the state. The derivatives hold for an unchanged itinerary. They grow without
/// bound towards a graze.
///
/// ```
/// use stickslip_solver::{Direction, Dop853, Guard, HybridSystem, Options, Start, State};
/// use stickslip_solver::sensitivity::{Change, Differentiable, sensitivities};
///
/// /// A ball that bounces on the floor. Its coefficient of restitution is the parameter.
/// struct Ball(f64);
///
/// impl HybridSystem<2, 1> for Ball {
///     type Mode = ();
///     fn field(&self, (): (), _time: f64, y: &State<2>) -> State<2> {
///         State::from([y[1], -9.81])
///     }
///     fn guards(&self, (): ()) -> [Guard; 1] {
///         [Guard::new(Direction::Below).from_zero(1)]
///     }
///     fn guard_values(&self, (): (), _time: f64, y: &State<2>) -> [f64; 1] {
///         [y[0]]
///     }
///     fn transition(&self, (): (), _guard: usize, _time: f64, y: &State<2>) -> ((), State<2>) {
///         ((), State::from([0.0, -self.0 * y[1]]))
///     }
/// }
///
/// impl Differentiable<2, 1, 1> for Ball {
///     fn field_change(&self, (): (), _time: f64, _y: &State<2>, by: &Change<2>) -> State<2> {
///         State::from([by.y[1], 0.0])
///     }
///     fn guard_changes(&self, (): (), _time: f64, _y: &State<2>, by: &Change<2>) -> [f64; 1] {
///         [by.y[0]]
///     }
///     fn transition_change(
///         &self, (): (), _guard: usize, _time: f64, y: &State<2>, by: &Change<2>,
///     ) -> State<2> {
///         let restitution = if by.parameter.is_some() { -y[1] } else { 0.0 };
///         State::from([0.0, restitution - self.0 * by.y[1]])
///     }
/// }
///
/// // Thrown up with velocity v, the ball is back after 2v/g, and again after another 2ev/g.
/// let (restitution, velocity) = (0.5, 4.905);
/// let start = Start { mode: (), s: 0.0, state: State::from([0.0, velocity]) };
/// let (ball, options) = (Ball(restitution), Options::default());
/// let found = sensitivities::<_, _, 2, 1, 1, 4>(
///     Dop853, &ball, start, [State::zeros()], 1.6, &options,
/// )?;
/// assert_eq!(found.switches.len(), 2);
/// assert!(found.switches[0].s_derivatives[0].abs() < 1e-14);
/// assert!((found.switches[1].s_derivatives[0] - 2.0 * velocity / 9.81).abs() < 1e-14);
/// # Ok::<(), stickslip_solver::RunError>(())
/// ```
///
/// The caller names A = N (1 + P), since stable Rust cannot compute the length of an array from two
/// others. A wrong A does not compile.
///
/// # Errors
/// Those of [`run`]. [`RunError::State`] is also returned if a switch is a graze, where derivatives
/// do not exist.
pub fn sensitivities<M, S, const N: usize, const G: usize, const P: usize, const A: usize>(
    method: M,
    system: &S,
    start: Start<S::Mode, N>,
    start_derivatives: [State<N>; P],
    end: f64,
    options: &Options,
) -> Result<Sensitivities<S::Mode, N, P>, RunError>
where
    M: Method,
    S: Differentiable<N, G, P>,
{
    let varied = Varied { system };
    let state = join::<N, P, A>(&start.state, &start_derivatives);
    let start = Start { mode: start.mode, s: start.s, state };
    let mut recorded = Recorded::<S, S::Mode, N, G, P> { varied: &varied, switches: Vec::new() };
    let run = run(method, &varied, start, end, options, &mut recorded)?;
    let Recorded { mut switches, .. } = recorded;
    let ended = match run.outcome {
        Outcome::EndedByGuard { .. } => switches.pop(),
        _ => None,
    };
    let end = ended.unwrap_or(SwitchSensitivity {
        guard: None,
        mode: run.mode,
        s: run.s,
        s_derivatives: [0.0; P],
        state: part(&run.state, 0),
        state_derivatives: derivatives(&run.state),
    });
    Ok(Sensitivities { switches, end, outcome: run.outcome, statistics: run.statistics })
}

/// As [`sensitivities`], with a pair that is chosen at run time.
///
/// # Errors
/// Those of [`sensitivities`].
pub fn sensitivities_with<S, const N: usize, const G: usize, const P: usize, const A: usize>(
    pair: EmbeddedPair,
    system: &S,
    start: Start<S::Mode, N>,
    start_derivatives: [State<N>; P],
    end: f64,
    options: &Options,
) -> Result<Sensitivities<S::Mode, N, P>, RunError>
where
    S: Differentiable<N, G, P>,
{
    let by = start_derivatives;
    match pair {
        EmbeddedPair::Dopri5 => {
            sensitivities::<_, _, N, G, P, A>(Dopri5, system, start, by, end, options)
        }
        EmbeddedPair::Dop853 => {
            sensitivities::<_, _, N, G, P, A>(Dop853, system, start, by, end, options)
        }
    }
}

/// A system together with the derivatives of its state.
struct Varied<'a, S, const N: usize, const P: usize> {
    system: &'a S,
}

impl<S, const N: usize, const P: usize> Varied<'_, S, N, P> {
    /// The derivatives of the place where `guard` fires at the state `y`, and of the state at that
    /// moving place.
    fn moved<const G: usize, const A: usize>(
        &self,
        mode: S::Mode,
        guard: usize,
        s: f64,
        y: &State<A>,
    ) -> ([f64; P], [State<N>; P])
    where
        S: Differentiable<N, G, P>,
    {
        let state = part(y, 0);
        let slope = self.system.field(mode, s, &state);
        let change = |change: &Change<N>| self.system.guard_changes(mode, s, &state, change)[guard];
        let along = change(&Change { s: 1.0, y: slope, parameter: None });
        let mut derivatives = derivatives(y);
        let places = std::array::from_fn(|j| {
            let fixed = Change { s: 0.0, y: derivatives[j], parameter: Some(j) };
            let moved = -change(&fixed) / along;
            derivatives[j] += slope * moved;
            moved
        });
        (places, derivatives)
    }
}

impl<S, const N: usize, const G: usize, const P: usize, const A: usize> HybridSystem<A, G>
    for Varied<'_, S, N, P>
where
    S: Differentiable<N, G, P>,
{
    type Mode = S::Mode;

    fn field(&self, mode: S::Mode, s: f64, y: &State<A>) -> State<A> {
        let state = part(y, 0);
        let derivatives: [State<N>; P] = derivatives(y);
        let changes = std::array::from_fn(|j| {
            let change = Change { s: 0.0, y: derivatives[j], parameter: Some(j) };
            self.system.field_change(mode, s, &state, &change)
        });
        join::<N, P, A>(&self.system.field(mode, s, &state), &changes)
    }

    fn guards(&self, mode: S::Mode) -> [Guard; G] {
        self.system.guards(mode)
    }

    fn guard_values(&self, mode: S::Mode, s: f64, y: &State<A>) -> [f64; G] {
        self.system.guard_values(mode, s, &part(y, 0))
    }

    const READABLE: bool = S::READABLE;

    fn enclose_guards(&self, mode: S::Mode, s: Enclosure, y: &[Enclosure; A]) -> [Enclosure; G] {
        self.system.enclose_guards(mode, s, &std::array::from_fn(|i| y[i]))
    }

    fn longest_first_step(&self, mode: S::Mode, s: f64, y: &State<A>) -> f64 {
        self.system.longest_first_step(mode, s, &part(y, 0))
    }

    fn schedule(&self, mode: S::Mode, guard: usize) -> Schedule<'_> {
        self.system.schedule(mode, guard)
    }

    fn settle(&self, mode: S::Mode, y: &State<A>) -> S::Mode {
        self.system.settle(mode, &part(y, 0))
    }

    fn transition(&self, mode: S::Mode, guard: usize, s: f64, y: &State<A>) -> (S::Mode, State<A>) {
        let before = part(y, 0);
        let (places, derivatives) = self.moved(mode, guard, s, y);
        let (next, after) = self.system.transition(mode, guard, s, &before);
        let slope = self.system.field(next, s, &after);
        let derivatives = std::array::from_fn(|j| {
            let change = Change { s: places[j], y: derivatives[j], parameter: Some(j) };
            self.system.transition_change(mode, guard, s, &before, &change) - slope * places[j]
        });
        (next, join::<N, P, A>(&after, &derivatives))
    }
}

/// Records the switches with their derivatives.
struct Recorded<'a, S, Mode, const N: usize, const G: usize, const P: usize> {
    varied: &'a Varied<'a, S, N, P>,
    switches: Vec<SwitchSensitivity<Mode, N, P>>,
}

impl<S, const N: usize, const G: usize, const P: usize, const A: usize> Observer<S::Mode, A>
    for Recorded<'_, S, S::Mode, N, G, P>
where
    S: Differentiable<N, G, P>,
{
    fn on_switch(&mut self, event: &SwitchEvent<S::Mode, A>) {
        let (mode, guard, s) = (event.from, event.guard, event.s);
        let (s_derivatives, state_derivatives) = self.varied.moved(mode, guard, s, &event.before);
        let state = part(&event.before, 0);
        self.switches.push(SwitchSensitivity {
            guard: Some(guard),
            mode,
            s,
            s_derivatives,
            state,
            state_derivatives,
        });
    }
}

/// Joins state and derivatives in one vector.
fn join<const N: usize, const P: usize, const A: usize>(
    state: &State<N>,
    derivatives: &[State<N>; P],
) -> State<A> {
    const { assert!(A == N * (1 + P), "A must be N (1 + P)") };
    let mut joined: State<A> = State::zeros();
    joined.fixed_rows_mut::<N>(0).copy_from(state);
    for (j, derivative) in derivatives.iter().enumerate() {
        joined.fixed_rows_mut::<N>(N * (1 + j)).copy_from(derivative);
    }
    joined
}

/// The state, which is part 0, or one of the derivatives, which are the other parts.
fn part<const N: usize, const A: usize>(joined: &State<A>, index: usize) -> State<N> {
    joined.fixed_rows::<N>(N * index).into_owned()
}

fn derivatives<const N: usize, const P: usize, const A: usize>(joined: &State<A>) -> [State<N>; P] {
    std::array::from_fn(|j| part(joined, 1 + j))
}
