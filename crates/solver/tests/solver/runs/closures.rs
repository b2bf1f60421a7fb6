//! Systems from closures.

use std::f64::consts::PI;

use stickslip_solver::{Closures, Direction, Dop853, Guard, Options, Outcome, State};

use super::{Log, at, ball, bounce, close};
use crate::erased::run;

#[test]
fn closures_are_a_system() {
    let mut bounces = Vec::new();
    let end = run(Dop853, &ball(), at(0.0, [1.0, 0.0]), 3.0, &Options::default(), &mut bounces);
    let end = end.unwrap();
    assert_eq!(end.outcome, Outcome::ReachedEnd);
    assert_eq!(bounces.len(), 4);
    for (n, event) in (0..).zip(&bounces) {
        assert!((event.s - bounce(n)).abs() < 1e-12, "{n}");
        // The state comes with the event: on the guard before, and after the transition.
        assert!(event.before[0].abs() < 1e-13 && event.before[1] < 0.0);
        assert_eq!(event.after, State::from([0.0, -0.9 * event.before[1]]));
    }
}

#[test]
fn without_a_transition_events_are_only_noted() {
    let circle = |_s: f64, y: &State<2>| State::from([y[1], -y[0]]);
    let plain = Closures::new(circle);
    let noted = Closures::new(circle).guards([Guard::new(Direction::Either)], |_s, y| [y[0]]);
    let start = at(0.0, [0.5, 1.0]);
    let mut log = Log::default();
    let one = run(Dop853, &plain, start, 10.0, &Options::default(), &mut ()).unwrap();
    let other = run(Dop853, &noted, start, 10.0, &Options::default(), &mut log).unwrap();
    assert_eq!((one.state, one.s), (other.state, other.s));
    let first = PI - 0.5_f64.atan();
    close(&log.places(), &[first, first + PI, first + 2.0 * PI], 1e-9);
    assert!(log.switches.iter().all(|event| event.before == event.after));
}
