//! Two observers of one run.

use std::f64::consts::PI;

use stickslip_solver::method::Dense;
use stickslip_solver::{Direction, Dop853, Guard, Observer, Options, Outcome, Recorder};

use super::{Log, fixed, line, reaches_end, start_of_line};
use crate::erased::run;

/// Counts segments that it did not ask for.
struct Segments(usize);
impl Observer<(), 1> for Segments {
    fn on_segment(&mut self, (): (), _dense: &Dense<1>) {
        self.0 += 1;
    }
}

#[test]
fn two_observers_see_the_same_and_either_stops() {
    let system = line([Guard::new(Direction::Either)], |s| [(4.0 * PI * s + 0.1).sin()]);
    for stop_after in [(0, 3), (3, 0)] {
        let mut both = (
            Log { stop_after: stop_after.0, ..Log::default() },
            Log { stop_after: stop_after.1, ..Log::default() },
        );
        let end = run(Dop853, &system, start_of_line(), 1.0, &Options::default(), &mut both);
        assert_eq!(end.unwrap().outcome, Outcome::Stopped);
        assert_eq!(both.0.switches, both.1.switches);
        assert_eq!(both.0.switches.len(), 3);
    }
    // Segments go only to those that want them.
    let mut both = (Segments(0), Recorder::default());
    reaches_end(run(Dop853, &system, start_of_line(), 1.0, &fixed(0.25), &mut both));
    assert_eq!((both.0.0, both.1.trajectory.segments().len()), (0, 4));
}
