//! What follows a switch: a guard that the next mode has too, equal gaps between switches, and how
//! long the first step may be.

use stickslip_solver::{
    Direction, Dop853, EmbeddedPair, Guard, HybridSystem, Options, Outcome, Start, State, StepSize,
};

use super::at;
use crate::erased::{run, run_with};

/// A mode counts what a guard does that all modes share.
#[derive(Clone, Copy, Debug)]
struct Counts(bool, Direction);

impl HybridSystem<1, 1> for Counts {
    type Mode = usize;

    fn field(&self, _mode: usize, _s: f64, _y: &State<1>) -> State<1> {
        State::from([1.0])
    }

    fn guards(&self, _mode: usize) -> [Guard; 1] {
        [Guard::new(self.1)]
    }

    fn guard_values(&self, _mode: usize, _s: f64, y: &State<1>) -> [f64; 1] {
        [if self.0 { y[0].sin() } else { y[0] - 1.0 }]
    }

    fn transition(&self, mode: usize, _: usize, _s: f64, y: &State<1>) -> (usize, State<1>) {
        (mode + 1, *y)
    }
}

#[test]
fn a_guard_that_all_modes_share_fires_once() {
    for pair in EmbeddedPair::ALL {
        for tolerance in [1e-4, 1e-6, 1e-8, 1e-10, 1e-12] {
            for step_size in [StepSize::Adaptive, StepSize::Fixed(0.37)] {
                let options = Options { step_size, ..Options::with_tolerance(tolerance) };
                for (system, end, count) in [
                    (Counts(true, Direction::Falling), 100.0, 16),
                    (Counts(true, Direction::Either), 100.0, 31),
                    (Counts(false, Direction::Rising), 2.0, 1),
                    (Counts(false, Direction::Either), 2.0, 1),
                ] {
                    let start = Start { mode: 0, s: 0.0, state: State::from([0.5]) };
                    let run = run_with(pair, &system, start, end, &options, &mut ()).unwrap();
                    assert_eq!((run.outcome, run.mode), (Outcome::ReachedEnd, count), "{system:?}");
                }
            }
        }
    }
}

/// A long rest and then a relay, which switches at equal distances.
struct Relay(f64, f64);

impl HybridSystem<1, 1> for Relay {
    type Mode = i8;

    fn field(&self, mode: i8, _s: f64, _y: &State<1>) -> State<1> {
        State::from([f64::from(mode)])
    }

    fn guards(&self, _mode: i8) -> [Guard; 1] {
        [Guard::new(Direction::Below)]
    }

    fn guard_values(&self, mode: i8, s: f64, y: &State<1>) -> [f64; 1] {
        [match mode {
            0 => self.0 - s,
            1 => self.1 - y[0],
            _ => y[0] + self.1,
        }]
    }

    fn transition(&self, mode: i8, _: usize, _s: f64, y: &State<1>) -> (i8, State<1>) {
        (if mode == 1 { -1 } else { 1 }, *y)
    }
}

#[test]
fn equal_gaps_after_a_rest_do_not_accumulate() {
    for (rest, band, end) in
        [(1000.0, 5e-6, 1000.001), (1.0, 5e-9, 1.000_001), (1e5, 5e-4, 1e5 + 0.1)]
    {
        let start = Start { mode: 0, s: 0.0, state: State::from([0.0]) };
        let system = Relay(rest, band);
        let run = run(Dop853, &system, start, end, &Options::default(), &mut ());
        let run = run.unwrap();
        assert_eq!(run.outcome, Outcome::ReachedEnd);
        assert!((95..=105).contains(&run.statistics.switches), "{:?}", run.statistics);
    }
}

/// A step of no length would keep the run where it is.
#[test]
fn a_longest_first_step_that_is_none_is_ignored() {
    /// y' = 1, which starts again from 0 where it reaches 1.
    struct Again(f64);

    impl HybridSystem<1, 1> for Again {
        type Mode = ();

        fn field(&self, (): (), _s: f64, _y: &State<1>) -> State<1> {
            State::from([1.0])
        }

        fn guards(&self, (): ()) -> [Guard; 1] {
            [Guard::new(Direction::Rising)]
        }

        fn guard_values(&self, (): (), _s: f64, y: &State<1>) -> [f64; 1] {
            [y[0] - 1.0]
        }

        fn longest_first_step(&self, (): (), _s: f64, _y: &State<1>) -> f64 {
            self.0
        }

        fn transition(&self, (): (), _: usize, _s: f64, _y: &State<1>) -> ((), State<1>) {
            ((), State::from([0.0]))
        }
    }

    let steps = |longest: f64| {
        let start = at(0.0, [0.0]);
        let run = run(Dop853, &Again(longest), start, 9.5, &Options::default(), &mut ()).unwrap();
        assert_eq!((run.outcome, run.statistics.switches), (Outcome::ReachedEnd, 9));
        run.statistics.accepted
    };
    let free = steps(f64::INFINITY);
    assert!([0.0, -1.0, f64::NAN].iter().all(|none| steps(*none) == free));
    assert!(steps(1e-3) > free);
}

/// Phases that end at these places.
struct Phases([f64; 4]);

impl HybridSystem<1, 1> for Phases {
    type Mode = usize;

    fn field(&self, mode: usize, s: f64, _y: &State<1>) -> State<1> {
        State::from([if mode.is_multiple_of(2) { s.sin() } else { s.cos() }])
    }

    fn guards(&self, mode: usize) -> [Guard; 1] {
        [if mode < 4 { Guard::new(Direction::Below) } else { Guard::OFF }]
    }

    fn guard_values(&self, mode: usize, s: f64, _y: &State<1>) -> [f64; 1] {
        [self.0.get(mode).map_or(1.0, |end| end - s)]
    }

    fn transition(&self, mode: usize, _: usize, _s: f64, y: &State<1>) -> (usize, State<1>) {
        (mode + 1, *y)
    }
}

#[test]
fn a_short_phase_sets_no_step() {
    for pair in EmbeddedPair::ALL {
        let steps = |first: f64| {
            let options =
                Options { first_step: Some(4.0 * first), ..Options::with_tolerance(1e-10) };
            let start = Start { mode: 0, s: 0.0, state: State::zeros() };
            let system = Phases([first, 1.0, 2.0, 3.0]);
            let run = run_with(pair, &system, start, 4.0, &options, &mut ()).unwrap();
            assert_eq!((run.outcome, run.mode), (Outcome::ReachedEnd, 4));
            run.statistics.accepted
        };
        // The second phase has no other step than that of the first one, the third one has.
        let growth = if pair == EmbeddedPair::Dopri5 { 10.0_f64 } else { 6.0 };
        let grown = (1e-2_f64 / 1e-18).log(growth);
        let more = steps(1e-18) as f64 - steps(1e-2) as f64;
        assert!(more < grown + 8.0, "{pair}: {more}");
    }
}
