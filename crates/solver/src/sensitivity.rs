//! Derivatives of a run with respect to parameters, through every switch.
//!
//! A small change of a parameter changes the state by δy. Between switches, δy obeys the
//! variational equations. At a switch, the change also moves the switch by δs = −δg/g'. Here δg is
//! the change of the guard at a fixed place, and g' is its slope along the solution. After the
//! switch, δy is the change of the transition at the moved place, minus the change that the new
//! right-hand side makes in δs. This is the saltation matrix (Leine and Nijmeijer, *Dynamics and
//! Bifurcations of Non-Smooth Mechanical Systems*, 2004, section 7.3).

mod dynamic;

use num_dual::Dual64;

use crate::error::RunError;
use crate::events::Note;
use crate::hybrid::{Guard, HybridSystem, Outcome, ReadableSystem, Statistics};
use crate::lists::FixedShape;
use crate::method::{Columns, Dop853, Dopri5, EmbeddedPair, Method, State, StepOf, TrialOf};
use crate::options::Options;
use crate::runs::runner::{Watcher, run_any};
use crate::system::{Fixed, System};
use stickslip_number::{Enclosure, Interval, Number};

pub use dynamic::{
    DynamicSensitivities, DynamicSwitchSensitivity, ReadableReset, sensitivities_dynamic,
};

/// A small change of the independent variable, of the state and of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variation<const N: usize> {
    /// The change of the independent variable.
    pub s: f64,
    /// The change of the state.
    pub y: State<N>,
    /// The parameter that changes by 1, or `None` if no parameter changes.
    pub parameter: Option<usize>,
}

/// A hybrid system that knows its derivatives with respect to the state and to parameters.
///
/// A [`ReadableTransition`] is one by itself, by dual numbers. Otherwise each function belongs to a
/// function of [`HybridSystem`]. It returns the change of that function, to first order, under a
/// [`Variation`] of its arguments and of a parameter.
pub trait Differentiable<const N: usize, const G: usize>: HybridSystem<N, G> {
    /// The change of the right-hand side.
    fn field_change(
        &self,
        mode: Self::Mode,
        s: f64,
        y: &State<N>,
        change: &Variation<N>,
    ) -> State<N>;

    /// The changes of the guards' values. All guards may be multiplied by the same positive
    /// function, since this does not move their zeros.
    fn guard_changes(
        &self,
        mode: Self::Mode,
        s: f64,
        y: &State<N>,
        change: &Variation<N>,
    ) -> [f64; G];

    /// The change of the state that follows when `guard` fires. If it is not a number, the run
    /// fails with [`RunError::State`].
    fn transition_change(
        &self,
        mode: Self::Mode,
        guard: usize,
        s: f64,
        y: &State<N>,
        change: &Variation<N>,
    ) -> State<N>;
}

/// A readable system whose transitions are generic in their numbers, as its right-hand side and its
/// guards are. It is [`Differentiable`] by itself. Its parameters are components of the state whose
/// slope is 0.
///
/// ```
/// use stickslip_solver::method::Columns;
/// use stickslip_solver::sensitivity::{ReadableTransition, sensitivities};
/// use stickslip_solver::{Direction, Dop853, Guard, Number, Options, ReadableSystem, State};
///
/// /// A ball that bounces on the floor: height, velocity and coefficient of restitution.
/// struct Ball;
///
/// impl ReadableSystem<3, 1> for Ball {
///     type Mode = ();
///     fn field<T: Number>(&self, (): (), _time: T, y: &[T; 3]) -> [T; 3] {
///         [y[1], T::from(-9.81), T::from(0.0)]
///     }
///     fn guards(&self, (): ()) -> [Guard; 1] {
///         [Guard::new(Direction::Below).from_zero(1)]
///     }
///     fn guard_values<T: Number>(&self, (): (), _time: T, y: &[T; 3]) -> [T; 1] {
///         [y[0]]
///     }
///     fn transition(&self, (): (), guard: usize, time: f64, y: &State<3>) -> ((), State<3>) {
///         ((), self.reset((), guard, time, y.as_ref()).into())
///     }
/// }
///
/// impl ReadableTransition<3, 1> for Ball {
///     fn reset<T: Number>(&self, (): (), _guard: usize, _time: T, y: &[T; 3]) -> [T; 3] {
///         [T::from(0.0), -(y[2] * y[1]), y[2]]
///     }
/// }
///
/// // Thrown up with velocity v, the ball is back after 2v/g, and again after another 2ev/g.
/// let (e, v) = (0.5, 4.905);
/// // The start, and its derivatives with respect to v and e.
/// let start = Columns::from([[0.0, v, e], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
/// let found = sensitivities(Dop853, &Ball, ((), 0.0), start, 1.6, &Options::default())?;
/// let [time, by_v, by_e] = found.switches[1].s;
/// assert!((time - 2.0 * (1.0 + e) * v / 9.81).abs() < 1e-14);
/// assert!((by_v - 2.0 * (1.0 + e) / 9.81).abs() < 1e-14);
/// assert!((by_e - 2.0 * v / 9.81).abs() < 1e-14);
/// # Ok::<(), stickslip_solver::RunError>(())
/// ```
pub trait ReadableTransition<const N: usize, const G: usize>: ReadableSystem<N, G> {
    /// The state that follows when `guard` fires at the state `y`: that of
    /// [`ReadableSystem::transition`], which best calls this. Where the two differ there are no
    /// derivatives, and the run fails with [`RunError::State`].
    fn reset<T: Number>(&self, mode: Self::Mode, guard: usize, s: T, y: &[T; N]) -> [T; N];
}

/// Two ways to write one transition round differently, by less than this part.
const ROUNDING: f64 = 1e-9;

impl<S: ReadableTransition<N, G>, const N: usize, const G: usize> Differentiable<N, G> for S {
    fn field_change(&self, mode: S::Mode, s: f64, y: &State<N>, by: &Variation<N>) -> State<N> {
        let (s, y) = along(s, y, by);
        ReadableSystem::field(self, mode, s, &y).map(|slope| slope.eps).into()
    }

    fn guard_changes(&self, mode: S::Mode, s: f64, y: &State<N>, by: &Variation<N>) -> [f64; G] {
        let (s, y) = along(s, y, by);
        ReadableSystem::guard_values(self, mode, s, &y).map(|value| value.eps)
    }

    fn transition_change(
        &self,
        mode: S::Mode,
        guard: usize,
        s: f64,
        y: &State<N>,
        by: &Variation<N>,
    ) -> State<N> {
        let (_, after) = ReadableSystem::transition(self, mode, guard, s, y);
        let (s, along) = along(s, y, by);
        let reset = self.reset(mode, guard, s, &along);
        let size = after.amax().max(y.amax());
        let same = (0..N).all(|i| (reset[i].re - after[i]).abs() <= ROUNDING * size);
        State::from_fn(|i, _| if same { reset[i].eps } else { f64::NAN })
    }
}

/// Time and state with their changes.
pub(crate) fn along<const N: usize>(
    s: f64,
    y: &State<N>,
    by: &Variation<N>,
) -> (Dual64, [Dual64; N]) {
    (Dual64::new(s, by.s), std::array::from_fn(|i| Dual64::new(y[i], by.y[i])))
}

/// A switch, or the end of a run, with its derivatives: `Q` numbers, or columns, of which the first
/// is the value and the others are its derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SwitchSensitivity<Mode, const N: usize, const Q: usize> {
    /// The guard that fired, or `None` if the run reached its end.
    pub guard: Option<usize>,
    /// The mode that ends here.
    pub mode: Mode,
    /// The place of the switch or of the end, and its derivatives.
    pub s: [f64; Q],
    /// The state at the place, before the transition, and its derivatives at the place, which moves
    /// too.
    pub state: Columns<N, Q>,
}

/// A run with its derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivities<Mode, const N: usize, const Q: usize> {
    /// The switches, in order.
    pub switches: Vec<SwitchSensitivity<Mode, N, Q>>,
    /// The end of the run.
    pub end: SwitchSensitivity<Mode, N, Q>,
    /// Why the run ended.
    pub outcome: Outcome,
    /// The work done. One evaluation of the right-hand side covers state and derivatives together.
    pub statistics: Statistics,
}

/// Integrates `system` like [`run`](crate::run), together with derivatives of its state.
///
/// The first column of `start` is the state at the place `s`. Each other column is the derivative
/// of that state with respect to a parameter: column 1 + j belongs to [`Variation::parameter`] j.
/// Error control covers all columns, so derivatives are about as accurate as the state. The
/// derivatives hold for an unchanged itinerary. They grow without bound towards a graze. A run does
/// not [go on](HybridSystem::rest) behind switches that accumulate.
///
/// [`ReadableTransition`] has an example.
///
/// # Errors
/// Those of [`run`](crate::run). [`RunError::State`] is also returned if a switch is a graze, where
/// derivatives do not exist.
pub fn sensitivities<M, S, const N: usize, const G: usize, const Q: usize>(
    _method: M,
    system: &S,
    (mode, s): (S::Mode, f64),
    start: Columns<N, Q>,
    end: f64,
    options: &Options,
) -> Result<Sensitivities<S::Mode, N, Q>, RunError>
where
    M: Method,
    S: Differentiable<N, G>,
{
    const { assert!(Q > 0, "the first column of the start is the state") };
    let varied = Varied { system };
    let mut recorded = Recorded { varied: &varied, switches: Vec::new() };
    let run = run_any::<M, _, _>(&varied, (mode, s, &start), end, options, &mut recorded)?;
    let Recorded { mut switches, .. } = recorded;
    let ended = match run.outcome {
        Outcome::EndedByGuard { .. } => switches.pop(),
        _ => None,
    };
    let mut place = [0.0; Q];
    place[0] = run.s;
    let at_end = SwitchSensitivity { guard: None, mode: run.mode, s: place, state: run.state };
    let end = ended.unwrap_or(at_end);
    Ok(Sensitivities { switches, end, outcome: run.outcome, statistics: run.statistics })
}

/// As [`sensitivities`], with a pair that is chosen at run time.
///
/// # Errors
/// Those of [`sensitivities`].
pub fn sensitivities_with<S, const N: usize, const G: usize, const Q: usize>(
    pair: EmbeddedPair,
    system: &S,
    from: (S::Mode, f64),
    start: Columns<N, Q>,
    end: f64,
    options: &Options,
) -> Result<Sensitivities<S::Mode, N, Q>, RunError>
where
    S: Differentiable<N, G>,
{
    match pair {
        EmbeddedPair::Dopri5 => sensitivities(Dopri5, system, from, start, end, options),
        EmbeddedPair::Dop853 => sensitivities(Dop853, system, from, start, end, options),
    }
}

/// A system together with the derivatives of its state.
struct Varied<'a, S, const N: usize, const G: usize, const Q: usize> {
    system: &'a S,
}

impl<S, const N: usize, const G: usize, const Q: usize> Varied<'_, S, N, G, Q>
where
    S: Differentiable<N, G>,
{
    /// The place where `guard` fires at the state `y`, and the state there, with their derivatives.
    fn moved(
        &self,
        mode: S::Mode,
        guard: usize,
        s: f64,
        y: &Columns<N, Q>,
    ) -> ([f64; Q], Columns<N, Q>) {
        let state = column(y, 0);
        let slope = self.system.field(mode, s, &state);
        let change =
            |change: &Variation<N>| self.system.guard_changes(mode, s, &state, change)[guard];
        let rate = change(&Variation { s: 1.0, y: slope, parameter: None });
        let (mut place, mut moved) = ([s; Q], *y);
        for (j, later) in place.iter_mut().enumerate().skip(1) {
            let fixed = Variation { s: 0.0, y: column(y, j), parameter: Some(j - 1) };
            *later = -change(&fixed) / rate;
            moved.set_column(j, &(fixed.y + slope * *later));
        }
        (place, moved)
    }
}

fn column<const N: usize, const Q: usize>(columns: &Columns<N, Q>, j: usize) -> State<N> {
    columns.column(j).into_owned()
}

impl<S, const N: usize, const G: usize, const Q: usize> System for Varied<'_, S, N, G, Q>
where
    S: Differentiable<N, G>,
{
    type Mode = S::Mode;
    type State = Columns<N, Q>;
    /// Guards read the state alone.
    type Components = FixedShape<N>;
    type Guards = FixedShape<G>;
    const READABLE: bool = S::READABLE;

    fn field(&self, mode: S::Mode, s: f64, y: &Columns<N, Q>, slope: &mut Columns<N, Q>) {
        let state = column(y, 0);
        slope.set_column(0, &self.system.field(mode, s, &state));
        for j in 1..Q {
            let change = Variation { s: 0.0, y: column(y, j), parameter: Some(j - 1) };
            slope.set_column(j, &self.system.field_change(mode, s, &state, &change));
        }
    }
    fn guards(&self, mode: S::Mode, guards: &mut [Guard; G]) {
        *guards = self.system.guards(mode);
    }
    fn guard_values(&self, mode: S::Mode, s: f64, y: &Columns<N, Q>, values: &mut [f64; G]) {
        *values = self.system.guard_values(mode, s, &column(y, 0));
    }
    fn enclose(&self, mode: S::Mode, s: Enclosure, y: &[Enclosure; N]) -> [Enclosure; G] {
        self.system.enclose_guards(mode, s, y)
    }
    fn reads(&self, _: S::Mode) {}
    fn guard_rates(&self, mode: S::Mode, s: f64, y: &Columns<N, Q>, rates: &mut [f64; G]) {
        *rates = self.system.guard_rates(mode, s, &column(y, 0));
    }
    fn enclose_rate(&self, mode: S::Mode, s: f64, y: &Columns<N, Q>, guard: usize) -> Interval {
        Fixed(self.system).enclose_rate(mode, s, &column(y, 0), guard)
    }
    fn transition_condition(&self, mode: S::Mode, guard: usize, s: f64, y: &Columns<N, Q>) -> f64 {
        self.system.transition_condition(mode, guard, s, &column(y, 0))
    }
    fn settle(&self, mode: S::Mode, y: &Columns<N, Q>) -> S::Mode {
        self.system.settle(mode, &column(y, 0))
    }
    fn longest_first_step(&self, mode: S::Mode, s: f64, y: &Columns<N, Q>) -> f64 {
        self.system.longest_first_step(mode, s, &column(y, 0))
    }
    fn rest(&self, _: S::Mode, _: usize, _: f64, _: &mut Columns<N, Q>) -> Option<S::Mode> {
        None
    }
    fn counter(&self, mode: S::Mode, guard: usize) -> usize {
        self.system.counter(mode, guard)
    }
    fn next_time(&self, mode: S::Mode, guard: usize, s: f64) -> f64 {
        self.system.schedule(mode, guard).next_after(s)
    }
    fn step<M: Method>(
        &self,
        mode: S::Mode,
        trial: &TrialOf<'_, Columns<N, Q>>,
        step: &mut StepOf<Columns<N, Q>>,
    ) {
        let mut field = |s: f64, y: &_, slope: &mut _| self.field(mode, s, y, slope);
        step.take_in_place::<M>(&mut field, trial, |_| trial.tolerances);
    }
    fn transition(&self, mode: S::Mode, guard: usize, s: f64, y: &mut Columns<N, Q>) -> S::Mode {
        let before = column(y, 0);
        let (place, moved) = self.moved(mode, guard, s, y);
        let (next, after) = self.system.transition(mode, guard, s, &before);
        let slope = self.system.field(next, s, &after);
        y.set_column(0, &after);
        for (j, &later) in place.iter().enumerate().skip(1) {
            let by = Variation { s: later, y: column(&moved, j), parameter: Some(j - 1) };
            let change = self.system.transition_change(mode, guard, s, &before, &by);
            y.set_column(j, &(change - slope * later));
        }
        next
    }
}

/// Records the switches with their derivatives.
struct Recorded<'a, S: Differentiable<N, G>, const N: usize, const G: usize, const Q: usize> {
    varied: &'a Varied<'a, S, N, G, Q>,
    switches: Vec<SwitchSensitivity<S::Mode, N, Q>>,
}

impl<'a, S, const N: usize, const G: usize, const Q: usize> Watcher<Varied<'a, S, N, G, Q>>
    for Recorded<'a, S, N, G, Q>
where
    S: Differentiable<N, G>,
{
    const WANTS_SEGMENTS: bool = false;

    fn on_switch(&mut self, note: &Note<Varied<'a, S, N, G, Q>>) {
        let (s, state) = self.varied.moved(note.from, note.guard, note.s, &note.before);
        let (guard, mode) = (Some(note.guard), note.from);
        self.switches.push(SwitchSensitivity { guard, mode, s, state });
    }
    fn forget(&mut self, switches: usize) {
        self.switches.truncate(self.switches.len().saturating_sub(switches));
    }
    fn stops(&self, _: f64) -> bool {
        false
    }
}
