//! How runs end, and who may end them.

use std::f64::consts::PI;

use stickslip_solver::method::Dense;
use stickslip_solver::{
    Closures, Direction, Dop853, EmbeddedPair, Guard, Observer, Options, Outcome, RunError, State,
};

use super::{Log, at, ball, bounce, fixed, line, start_of_line, thrown};
use crate::erased::{run, run_backwards, run_with};

#[test]
fn a_terminal_guard_ends_the_run_when_it_fires_often_enough() {
    for count in [1, 2, 5, 9] {
        // Several firings within one step, which change nothing.
        for h in [1.0, 0.125, 0.01] {
            for (direction, first, every) in
                [(Direction::Either, 1.0, 1.0), (Direction::Falling, 1.0, 2.0)]
            {
                let guard = Guard::new(direction).terminal_after(count);
                let system = line([guard], |s| [(20.0 * PI * (s + 0.003)).sin()]);
                let options = Options { guard_scale: Some(0.02), ..fixed(h) };
                let mut log = Log::default();
                let end = run(Dop853, &system, start_of_line(), 2.0, &options, &mut log).unwrap();
                let place = (first + every * f64::from(count - 1)) / 20.0 - 0.003;
                assert_eq!(end.outcome, Outcome::EndedByGuard { guard: 0 });
                assert!((end.s - place).abs() < 1e-14, "{count} {h}: {} {place}", end.s);
                assert_eq!(log.switches.len(), count as usize);
                assert_eq!(end.statistics.switches, count as usize - 1);
                assert_eq!((log.switches[count as usize - 1].s, log.ends[0]), (end.s, end.s));
            }
        }
    }
    // Firings that change the state.
    let system = Closures::new(|_s, y: &State<2>| State::from([y[1], -9.81]))
        .guards([Guard::new(Direction::Below).terminal_after(4)], |_s, y| [y[0]])
        .transition(|_guard, _s, y| State::from([0.0, -0.9 * y[1]]));
    let end = run(Dop853, &system, at(0.0, [1.0, 0.0]), 9.0, &Options::default(), &mut ()).unwrap();
    assert!((end.s - bounce(3)).abs() < 1e-12 && end.finished().is_ok());
    // Never.
    let never =
        line([Guard::new(Direction::Either).terminal_after(0)], |s| [(9.0 * s + 0.1).sin()]);
    let end = run(Dop853, &never, start_of_line(), 2.0, &Options::default(), &mut ()).unwrap();
    assert_eq!((end.outcome, end.statistics.switches), (Outcome::ReachedEnd, 5));
}

#[test]
fn firings_together_with_another_guard_are_counted() {
    for h in [1.0, 0.5, 0.125, 0.01] {
        for count in [2, 3, 4] {
            let guards = [
                Guard::new(Direction::Either),
                Guard::new(Direction::Either).terminal_after(count),
            ];
            let system = line(guards, |s| [(10.0 * PI * (s + 0.01)).sin(); 2]);
            let options = Options { guard_scale: Some(0.05), ..fixed(h) };
            let end = run(Dop853, &system, start_of_line(), 2.0, &options, &mut ()).unwrap();
            let place = f64::from(count) / 10.0 - 0.01;
            assert_eq!(end.outcome, Outcome::EndedByGuard { guard: 1 }, "{h} {count}");
            assert!((end.s - place).abs() < 1e-14, "{h} {count}: {} {place}", end.s);
        }
    }
}

/// Counts steps, and stops after the third.
struct Steps(usize);
impl Observer<(), 1> for Steps {
    const WANTS_SEGMENTS: bool = true;
    fn on_segment(&mut self, (): (), _dense: &Dense<1>) {
        self.0 += 1;
    }
    fn stops(&self, _: f64) -> bool {
        self.0 == 3
    }
}

#[test]
fn an_observer_stops_the_run() {
    let wave = line([Guard::new(Direction::Either)], |s| [(20.0 * PI * (s + 0.003)).sin()]);
    for (h, stop_after) in [(1.0, 1), (1.0, 3), (0.1, 3), (0.01, 7)] {
        let options = Options { guard_scale: Some(0.02), ..fixed(h) };
        let mut log = Log { stop_after, ..Log::default() };
        let end = run(Dop853, &wave, start_of_line(), 2.0, &options, &mut log).unwrap();
        // It stops at the switch, though the step went further.
        assert_eq!((end.outcome, log.switches.len()), (Outcome::Stopped, stop_after));
        let place = stop_after as f64 / 20.0 - 0.003;
        assert!((end.s - place).abs() < 1e-14 && (end.state[0] - place).abs() < 1e-14);
        assert_eq!(
            end.finished(),
            Err(RunError::Unfinished { outcome: Outcome::Stopped, s: end.s })
        );
    }
    // At a switch that changes something, with the state after it.
    let mut log = Log { stop_after: 2, ..Log::default() };
    let end =
        run(Dop853, &ball(), at(0.0, [1.0, 0.0]), 9.0, &Options::default(), &mut log).unwrap();
    assert_eq!(
        (end.outcome, end.s, end.state),
        (Outcome::Stopped, log.switches[1].s, log.switches[1].after)
    );
    // Without a switch, after a step.
    let end = run(Dop853, &line([], |_| []), start_of_line(), 2.0, &fixed(0.25), &mut Steps(0));
    let end = end.unwrap();
    assert_eq!((end.outcome, end.s), (Outcome::Stopped, 0.75));
}

#[test]
fn a_chain_of_transitions_at_one_instant_is_an_error_that_names_it() {
    // At s = 0.5 the guard stays negative, whatever the transition does.
    let system = Closures::new(|_s, _y: &State<1>| State::from([1.0]))
        .guards([Guard::new(Direction::Below)], |s, _y| [0.5 - s])
        .transition(|_guard, _s, y| State::from([y[0] + 1.0]));
    let options = Options { max_at_one_instant: 7, ..Options::default() };
    let (mut log, mut back) = (Log::default(), Log::default());
    let chain = (&system, start_of_line(), &options);
    let error = run(Dop853, chain.0, chain.1, 1.0, chain.2, &mut log).unwrap_err();
    let RunError::Cycle { s, count: 7, cycle } = error else { panic!("{error:?}") };
    assert!((s - 0.5).abs() < 1e-15);
    assert!(cycle.len() == 1 && cycle[0].0 == 0, "{cycle:?}");
    assert_eq!(log.switches, []);
    let mirrored = Closures::new(|_s, _y: &State<1>| State::from([1.0]))
        .guards([Guard::new(Direction::Below)], |s, _y| [0.5 + s])
        .transition(|_guard, _s, y| State::from([y[0] + 1.0]));
    let back = run_backwards(Dop853, &mirrored, start_of_line(), -1.0, &options, &mut back);
    assert!(matches!(back, Err(RunError::Cycle { s: at, .. }) if at == -s));
}

#[test]
fn only_regular_ends_are_finished() {
    let start = at(0.0, [1.0, 0.0]);
    let go =
        |options: Options, end: f64| run(Dop853, &ball(), start, end, &options, &mut ()).unwrap();
    let regular = go(Options::default(), 1.0);
    assert_eq!(regular.finished(), Ok(regular));
    for (options, expected) in [
        (Options { max_steps: 3, ..Options::default() }, Outcome::StepLimit),
        (Options { max_switches: 2, ..Options::default() }, Outcome::SwitchLimit),
    ] {
        let early = go(options, 5.0);
        assert_eq!(early.outcome, expected);
        assert_eq!(early.finished(), Err(RunError::Unfinished { outcome: expected, s: early.s }));
    }
    let start = at(0.0, [0.0, 1.0]);
    let zeno = run(Dop853, &thrown(), start, 100.0, &Options::default(), &mut ()).unwrap();
    assert!(matches!(zeno.outcome, Outcome::Zeno { .. }));
    let error = zeno.finished().unwrap_err();
    assert_eq!(error, RunError::Unfinished { outcome: zeno.outcome, s: zeno.s });
    assert!(error.to_string().contains("ended early"));
}

/// Steps whose sum is the span only to within rounding end exactly at its end.
#[test]
fn a_guard_fires_at_the_end_of_a_span_that_steps_divide() {
    for n in 1..=100 {
        let steps = f64::from(n);
        for (h, end) in [(0.1, 0.1 * steps), (1.0 / steps, 1.0)] {
            let along = Options { max_step: h, first_step: Some(h), ..Options::default() };
            for options in [fixed(h), along] {
                for pair in EmbeddedPair::ALL {
                    let system = Closures::new(|_s, _y: &State<1>| State::from([1.0]))
                        .guards([Guard::new(Direction::Rising).terminal()], move |s, _y| [s - end]);
                    let found = run_with(pair, &system, at(0.0, [0.0]), end, &options, &mut ());
                    let outcome = found.unwrap().outcome;
                    assert_eq!(outcome, Outcome::EndedByGuard { guard: 0 }, "{n} {options:?}");
                }
            }
        }
    }
}
