//! A run as an iterator is the run.

use stickslip_solver::{
    Closures, Direction, Dop853, Dopri5, Guard, HybridSystem, Method, Options, Outcome, Recorder,
    RunError, Start, State, Stepper, run,
};

fn ball() -> impl HybridSystem<2, 1, Mode = ()> {
    Closures::new(|_time, y: &State<2>| State::from([y[1], -9.81]))
        .guards([Guard::new(Direction::Below)], |_time, y| [y[0]])
        .transition(|_guard, _time, y| State::from([0.0, -0.5 * y[1]]))
}

fn check<M: Method + Copy>(method: M, height: f64, end: f64, options: &Options) -> Outcome {
    let system = ball();
    let start = Start { mode: (), s: 0.0, state: State::from([height, 0.0]) };
    let mut recorder = Recorder::default();
    let whole = run(method, &system, start, end, options, &mut recorder).unwrap();
    let mut stepper = Stepper::new(&system);
    // A stepper can be used again.
    for _ in 0..2 {
        let mut steps = stepper.steps(method, start, end, options).unwrap();
        assert_eq!(steps.run(), None);
        let (mut switches, mut segments) = (Vec::new(), Vec::new());
        for step in steps.by_ref() {
            let step = step.unwrap();
            switches.extend(step.switches);
            segments.push(step.segment);
        }
        assert!(steps.next().is_none());
        assert_eq!(steps.run(), Some(whole));
        assert_eq!(switches, recorder.switches);
        let known = recorder.trajectory.segments();
        assert_eq!(segments.len(), known.len());
        for (segment, known) in segments.iter().zip(known) {
            assert_eq!(segment.dense.start().to_bits(), known.dense.start().to_bits());
            assert_eq!(segment.dense.at(0.3), known.dense.at(0.3));
        }
    }
    whole.outcome
}

#[test]
fn steps_are_those_of_a_run() {
    let options = Options::default();
    assert_eq!(check(Dop853, 4.905, 2.7, &options), Outcome::ReachedEnd);
    assert_eq!(check(Dopri5, 4.905, 2.7, &options), Outcome::ReachedEnd);
    assert!(matches!(check(Dop853, 4.905, 9.0, &options), Outcome::Zeno { .. }));
    let few = Options { max_steps: 3, ..options };
    assert_eq!(check(Dopri5, 4.905, 2.7, &few), Outcome::StepLimit);
}

#[test]
fn an_error_is_the_last_item() {
    let system = Closures::new(|s: f64, _: &State<1>| State::from([(1.0 - s).sqrt()]));
    let start = Start { mode: (), s: 0.0, state: State::from([0.0]) };
    let options = Options::default();
    let mut stepper = Stepper::new(&system);
    let mut steps = stepper.steps(Dop853, start, 2.0, &options).unwrap();
    let items: Vec<_> = steps.by_ref().collect();
    let errors = items.iter().filter(|item| item.is_err()).count();
    assert!(errors == 1 && items.last().is_some_and(Result::is_err), "{items:?}");
    assert!(steps.next().is_none() && steps.run().is_none());
    let wrong = stepper.steps(Dop853, start, -1.0, &options);
    assert!(matches!(wrong.err(), Some(RunError::Span { .. })));
}
