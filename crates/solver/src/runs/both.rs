//! Two observers of one run.

use crate::hybrid::{Grazing, Observer, Pole, Preempted, Rest, SwitchEvent};
use crate::method::{Dense, State};

/// What two observers are told in the same way, whatever the dimension of the run.
macro_rules! tell_both {
    () => {
        fn on_grazing(&mut self, grazing: &Grazing<Mode>) {
            self.0.on_grazing(grazing);
            self.1.on_grazing(grazing);
        }

        fn on_pole(&mut self, pole: &Pole<Mode>) {
            self.0.on_pole(pole);
            self.1.on_pole(pole);
        }

        fn on_preempted(&mut self, preempted: &Preempted<Mode>) {
            self.0.on_preempted(preempted);
            self.1.on_preempted(preempted);
        }

        fn on_rest(&mut self, rest: &Rest<Mode>) {
            self.0.on_rest(rest);
            self.1.on_rest(rest);
        }

        fn forget(&mut self, switches: usize) {
            self.0.forget(switches);
            self.1.forget(switches);
        }

        fn stops(&self, s: f64) -> bool {
            self.0.stops(s) || self.1.stops(s)
        }
    };
}
pub(crate) use tell_both;

/// Two observers of one run. The first one is called first, and the run stops if either of them
/// stops it. Segments go only to observers that want them.
///
/// ```
/// use stickslip_solver::{Dop853, Options, Recorder, Samples, State, integrate};
///
/// let mut both = (Samples::at(&[0.25])?, Recorder::default());
/// let field = |s: f64, _: &State<1>| State::from([2.0 * s]);
/// integrate(Dop853, field, 0.0, State::from([0.0]), 1.0, &Options::default(), &mut both)?;
/// let (samples, recorder) = both;
/// assert!((samples.samples[0].state[0] - 0.0625).abs() < 1e-15);
/// assert_eq!(recorder.trajectory.at(0.25), Some(((), samples.samples[0].state)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
impl<A, B, Mode: Copy, const N: usize> Observer<Mode, N> for (A, B)
where
    A: Observer<Mode, N>,
    B: Observer<Mode, N>,
{
    const WANTS_SEGMENTS: bool = A::WANTS_SEGMENTS || B::WANTS_SEGMENTS;

    fn on_switch(&mut self, event: &SwitchEvent<Mode, N>) {
        self.0.on_switch(event);
        self.1.on_switch(event);
    }

    tell_both!();

    fn on_segment(&mut self, mode: Mode, dense: &Dense<N>) {
        if A::WANTS_SEGMENTS {
            self.0.on_segment(mode, dense);
        }
        if B::WANTS_SEGMENTS {
            self.1.on_segment(mode, dense);
        }
    }

    fn on_end(&mut self, mode: Mode, s: f64, state: &State<N>) {
        self.0.on_end(mode, s, state);
        self.1.on_end(mode, s, state);
    }
}
