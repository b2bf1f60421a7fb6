//! Derivatives that come by themselves, of systems that are written badly too.

use stickslip_solver::dynamic::{DynamicStart, ReadableDynamic};
use stickslip_solver::method::Columns;
use stickslip_solver::sensitivity::{
    ReadableReset, ReadableTransition, sensitivities, sensitivities_dynamic,
};
use stickslip_solver::{
    Direction, Dop853, Dopri5, Guard, Number, Options, ReadableSystem, RunError, Start, State, run,
};

/// A ball on a table that shakes: height, velocity, restitution, and the table's amplitude. It
/// grazes nothing here, and each of its parts depends on a parameter.
struct Ball {
    /// What `reset` adds to the velocity, although `transition` does not.
    error: f64,
    guards: [Guard; 1],
}

impl Ball {
    const fn new(error: f64) -> Self {
        Self { error, guards: [Guard::new(Direction::Below)] }
    }
    fn rates<T: Number>(y: &[T]) -> [T; 4] {
        let zero = T::from(0.0);
        [y[1], -(y[1] * y[2] * 0.1) - 9.81, zero, zero]
    }
    fn height<T: Number>(s: T, y: &[T]) -> T {
        y[0] - (s * 20.0).sin() * y[3]
    }
    fn behind<T: Number>(s: T, y: &[T]) -> [T; 4] {
        let table = (s * 20.0).cos() * y[3] * 20.0;
        [(s * 20.0).sin() * y[3], table - (y[1] - table) * y[2], y[2], y[3]]
    }
}

impl ReadableSystem<4, 1> for Ball {
    type Mode = ();
    fn field<T: Number>(&self, (): (), _: T, y: &[T; 4]) -> [T; 4] {
        Self::rates(y)
    }
    fn guards(&self, (): ()) -> [Guard; 1] {
        self.guards
    }
    fn guard_values<T: Number>(&self, (): (), s: T, y: &[T; 4]) -> [T; 1] {
        [Self::height(s, y)]
    }
    fn transition(&self, (): (), _: usize, s: f64, y: &State<4>) -> ((), State<4>) {
        ((), Self::behind(s, y.as_slice()).into())
    }
}

impl ReadableTransition<4, 1> for Ball {
    fn reset<T: Number>(&self, (): (), _: usize, s: T, y: &[T; 4]) -> [T; 4] {
        let [height, velocity, e, amplitude] = Self::behind(s, y);
        [height, velocity + self.error, e, amplitude]
    }
}

/// The same ball, of a dimension that is known at run time.
struct AtRunTime(Ball);

impl ReadableDynamic for AtRunTime {
    type Mode = ();
    fn field<T: Number>(&self, (): (), _: T, y: &[T], slope: &mut [T]) {
        slope.copy_from_slice(&Ball::rates(y));
    }
    fn guards(&self, (): ()) -> &[Guard] {
        &self.0.guards
    }
    fn guard_values<T: Number>(&self, (): (), s: T, y: &[T], values: &mut [T]) {
        values[0] = Ball::height(s, y);
    }
    fn transition(&self, (): (), _: usize, s: f64, y: &mut [f64]) {
        y.copy_from_slice(&Ball::behind(s, y));
    }
}

impl ReadableReset for AtRunTime {
    fn reset<T: Number>(&self, (): (), guard: usize, s: T, y: &mut [T]) {
        let state = [y[0], y[1], y[2], y[3]];
        y.copy_from_slice(&ReadableTransition::reset(&self.0, (), guard, s, &state));
    }
}

const START: [f64; 4] = [1.0, 0.3, 0.7, 0.02];

/// The state at the start, with its derivatives by its components.
fn columns() -> Columns<4, 5> {
    Columns::from_fn(|i, j| if j == 0 { START[i] } else { f64::from(u8::from(i == j - 1)) })
}

#[test]
fn they_agree_with_differences_and_in_any_dimension() {
    let (ball, options, end) = (Ball::new(0.0), Options::with_tolerance(1e-12), 1.7);
    let found = sensitivities(Dop853, &ball, ((), 0.0), columns(), end, &options).unwrap();
    assert!(found.switches.len() >= 3, "{found:?}");
    let moved = |j: usize, by: f64| {
        let mut state = State::from(START);
        state[j] += by;
        let mut bounces = Vec::new();
        let start = Start { mode: (), s: 0.0, state };
        let run = run(Dop853, &ball, start, end, &options, &mut bounces).unwrap();
        (run.state, bounces.iter().map(|bounce| bounce.s).collect::<Vec<_>>())
    };
    let by = 2e-6;
    for j in 0..4 {
        let ((more, late), (less, early)) = (moved(j, by), moved(j, -by));
        let difference = (more - less) / (2.0 * by);
        let error = (difference - found.end.state.column(1 + j)).amax();
        assert!(error < 1e-6 * difference.amax(), "{j}: {difference} {}", found.end.state);
        for (k, switch) in found.switches.iter().enumerate() {
            let difference = (late[k] - early[k]) / (2.0 * by);
            assert!((difference - switch.s[1 + j]).abs() < 1e-6 * difference.abs().max(1.0));
        }
    }

    let directions: Vec<_> =
        (0..4).map(|j| columns().column(1 + j).iter().copied().collect()).collect();
    let start = DynamicStart { mode: (), s: 0.0, state: &START };
    let system = AtRunTime(ball);
    let dynamic =
        sensitivities_dynamic(Dop853, &system, start, &directions, end, &options).unwrap();
    assert_eq!(dynamic.switches.len(), found.switches.len());
    for (dynamic, found) in dynamic.switches.iter().zip(&found.switches) {
        for j in 0..5 {
            assert!((dynamic.s[j] - found.s[j]).abs() < 1e-9 * found.s[j].abs().max(1.0));
            let column = State::<4>::from_column_slice(&dynamic.states[j]);
            assert!((column - found.state.column(j)).amax() < 1e-9 * column.amax().max(1.0));
        }
    }
}

#[test]
fn two_versions_of_a_transition_have_no_derivatives() {
    let (ball, options) = (Ball::new(1e-6), Options::default());
    let found = sensitivities(Dopri5, &ball, ((), 0.0), columns(), 1.0, &options);
    assert!(matches!(found, Err(RunError::State { component: 4, .. })), "{found:?}");
    let start = DynamicStart { mode: (), s: 0.0, state: &START };
    let directions = [vec![0.0, 0.0, 1.0, 0.0]];
    let system = AtRunTime(ball);
    let found = sensitivities_dynamic(Dopri5, &system, start, &directions, 1.0, &options);
    assert!(matches!(found, Err(RunError::State { component: 4, .. })), "{found:?}");
    // Without a direction there is nothing that could differ.
    let found = sensitivities_dynamic(Dopri5, &system, start, &[], 1.0, &options).unwrap();
    assert!(found.switches[0].s.len() == 1 && found.switches[0].states.len() == 1);
    let wrong = sensitivities_dynamic(Dopri5, &system, start, &[vec![1.0]], 1.0, &options);
    let words = wrong.unwrap_err().to_string();
    assert!(words.contains("direction 0") && words.contains("expected 4"), "{words}");
}

#[test]
fn the_value_alone_is_a_run() {
    let (ball, options) = (Ball::new(0.0), Options::default());
    let state = State::from(START);
    let alone = sensitivities(Dop853, &ball, ((), 0.0), state, 1.0, &options).unwrap();
    let mut bounces = Vec::new();
    let start = Start { mode: (), s: 0.0, state };
    let run = run(Dop853, &ball, start, 1.0, &options, &mut bounces).unwrap();
    assert_eq!((alone.end.state, alone.switches.len()), (run.state, bounces.len()));
    assert_eq!(alone.switches[0].s, [bounces[0].s]);
}
