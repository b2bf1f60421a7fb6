//! How a run changes with parameters: derivatives of switches and of the state, through every
//! switch.
//!
//! Between switches a small change δy of the state, made by a change of a parameter, obeys the
//! variational equations. At a switch it also moves the switch: by δs = −δg/g', with δg the change
//! of the guard at its place and g' its slope along the solution. The change that goes on beyond is
//! that of the transition at the place that has moved, less what the new right-hand side does in δs
//! (the saltation matrix; Leine and Nijmeijer, *Dynamics and Bifurcations of Non-Smooth Mechanical
//! Systems*, 2004, section 7.3).

use crate::error::RunError;
use crate::hybrid::{Guard, HybridSystem, Observer, Outcome, Start, Statistics, SwitchEvent};
use crate::method::{Method, State};
use crate::options::Options;
use crate::runs::run;

/// A small change: of the independent variable, of the state, and of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change<const N: usize> {
    /// Of the independent variable.
    pub s: f64,
    /// Of the state.
    pub y: State<N>,
    /// The parameter that changes, by 1; `None` if none does.
    pub parameter: Option<usize>,
}

/// A hybrid system with `P` parameters that knows its derivatives.
///
/// Each function returns how one of [`HybridSystem`] changes, to first order, under a [`Change`] of
/// what it depends on.
pub trait Differentiable<const N: usize, const G: usize, const P: usize>:
    HybridSystem<N, G>
{
    /// The change of the right-hand side.
    fn field_change(&self, mode: Self::Mode, s: f64, y: &State<N>, change: &Change<N>) -> State<N>;

    /// The changes of the guards' values; all guards may be multiplied by the same positive
    /// function, since their zeros stay.
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

/// A switch, or the end of a run, and its derivatives with respect to the parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SwitchSensitivity<Mode, const N: usize, const P: usize> {
    /// The guard that fired; `None` where the run came to its end.
    pub guard: Option<usize>,
    /// The mode that ends here.
    pub mode: Mode,
    /// Where.
    pub s: f64,
    /// Its derivatives.
    pub s_derivatives: [f64; P],
    /// The state there, before the transition.
    pub state: State<N>,
    /// Its derivatives, with the place moving along.
    pub state_derivatives: [State<N>; P],
}

/// A run with its derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivities<Mode, const N: usize, const P: usize> {
    /// Every switch, in order.
    pub switches: Vec<SwitchSensitivity<Mode, N, P>>,
    /// The end of the run.
    pub end: SwitchSensitivity<Mode, N, P>,
    /// Why it ended.
    pub outcome: Outcome,
    /// The work done; a right-hand side is that of state and derivatives together.
    pub statistics: Statistics,
}

/// Integrates `system` as [`run`] does, together with the derivatives of its state with respect to
/// `P` parameters, which are `start_derivatives` at the start.
///
/// State and derivatives together are `A` = N (1 + P) numbers, which the caller has to name; error
/// control covers all of them, so derivatives are about as accurate as the state. They are those of
/// the run as it is: the itinerary stays the same. Towards a graze they grow without bound.
///
/// ```
/// use stickslip_solver::{
///     Change, Differentiable, Direction, Dop853, Guard, HybridSystem, Options, Start, State,
///     sensitivities,
/// };
///
/// /// A ball falls on the floor and bounces with a coefficient of restitution, which is the parameter, until time 2.
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
/// // Thrown up with velocity v, it is back after 2v/g, and after another 2ev/g.
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
/// # Errors
/// Those of [`run`]; [`RunError::State`] also where a switch is a graze, at which derivatives do
/// not exist.
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
    let mut noted = Noted::<S, S::Mode, N, G, P> { varied: &varied, switches: Vec::new() };
    let run = run(method, &varied, start, end, options, &mut noted)?;
    let Noted { mut switches, .. } = noted;
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

/// A system together with the derivatives of its state.
struct Varied<'a, S, const N: usize, const P: usize> {
    system: &'a S,
}

impl<S, const N: usize, const P: usize> Varied<'_, S, N, P> {
    /// Where `guard` fires at the state `y`: the derivatives of the place, and of the state at the
    /// place that moves.
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

    fn settle(&self, mode: S::Mode) -> S::Mode {
        self.system.settle(mode)
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

/// Notes the switches with their derivatives.
struct Noted<'a, S, Mode, const N: usize, const G: usize, const P: usize> {
    varied: &'a Varied<'a, S, N, P>,
    switches: Vec<SwitchSensitivity<Mode, N, P>>,
}

impl<S, const N: usize, const G: usize, const P: usize, const A: usize> Observer<S::Mode, A>
    for Noted<'_, S, S::Mode, N, G, P>
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

/// State and derivatives in one vector.
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

/// The state, which is part 0, or a derivative.
fn part<const N: usize, const A: usize>(joined: &State<A>, index: usize) -> State<N> {
    joined.fixed_rows::<N>(N * index).into_owned()
}

fn derivatives<const N: usize, const P: usize, const A: usize>(joined: &State<A>) -> [State<N>; P] {
    std::array::from_fn(|j| part(joined, 1 + j))
}
