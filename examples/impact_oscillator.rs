//! An oscillator that grazes a stop: its map has a square root.
//!
//! A mass on a spring, x″ = −x, starts at x = 0 with the velocity 1 + δ towards a stop at x = 1. It
//! leaves the stop with the fraction r of its velocity. For δ ≤ 0 the mass is at x = 0 again after
//! the time 2π. For δ > 0 it hits the stop with the velocity √(2δ + δ²), however small, and after
//! the time 2π it is at x = (1 + r) √(2δ + δ²)/(1 + δ). So the map over one turn has an infinite
//! slope at the graze, which is the cause of grazing bifurcations (Nordmark, *J. Sound Vib.* 145,
//! 279, 1991).
//!
//! Run with `cargo run --release --example impact_oscillator`.

use std::error::Error;
use std::f64::consts::TAU;

use stickslip::solver::{
    Direction, Dop853, Guard, Number, Options, ReadableSystem, Start, State, run,
};

struct Oscillator {
    restitution: f64,
}

impl ReadableSystem<2, 1> for Oscillator {
    type Mode = ();

    fn field<T: Number>(&self, (): (), _time: T, y: &[T; 2]) -> [T; 2] {
        [y[1], -y[0]]
    }

    fn guards(&self, (): ()) -> [Guard; 1] {
        [Guard::new(Direction::Below)]
    }

    fn guard_values<T: Number>(&self, (): (), _time: T, y: &[T; 2]) -> [T; 1] {
        [-y[0] + 1.0]
    }

    fn transition(&self, (): (), _guard: usize, _time: f64, y: &State<2>) -> ((), State<2>) {
        ((), State::from([1.0, -self.restitution * y[1]]))
    }
}

/// Computes the map over one turn, from δ = 0.01 to 1e-12, and its exponent.
///
/// # Errors
/// The run failed.
fn main() -> Result<(), Box<dyn Error>> {
    let oscillator = Oscillator { restitution: 0.7 };
    let options = Options::with_tolerance(1e-15);
    let turn = |delta: f64| {
        let start = Start { mode: (), s: 0.0, state: State::from([0.0, 1.0 + delta]) };
        run(Dop853, &oscillator, start, TAU, &options, &mut ())
    };
    let missed = turn(-1e-12)?;
    assert!(missed.statistics.switches == 0 && missed.state[0].abs() < 1e-14);

    let mut last: Option<(f64, f64)> = None;
    for digits in [2, 4, 6, 8, 10, 12] {
        // The same δ as after rounding of the start.
        let delta = 1.0 + 10.0_f64.powi(-digits) - 1.0;
        let end = turn(delta)?;
        let moved = end.state[0];
        let exact = (1.0 + oscillator.restitution) * (delta * (2.0 + delta)).sqrt() / (1.0 + delta);
        let error = (moved / exact - 1.0).abs();
        println!("δ = {delta:.1e}: moved by {moved:.9e}, error {error:.1e}");
        // An error of 1e-16 in the velocity becomes an error of 1e-16/δ. The measured error is at
        // most 2.6e-16/δ.
        assert!(end.statistics.switches == 1 && error * delta < 5e-16);
        if let Some((delta_before, moved_before)) = last {
            let exponent = (moved_before / moved).ln() / (delta_before / delta).ln();
            println!("{:>14} exponent {exponent:.7}", "");
            // (1 + δ/2)/(1 + δ) tends to 1. The measured error is at most 0.16 δ, and 1.1e-6 for
            // small δ, where an error of 5e-16/δ of the place would make one of 1e-4.
            assert!((exponent - 0.5).abs() < 0.2 * delta_before + 3e-6);
        }
        last = Some((delta, moved));
    }
    Ok(())
}

#[test]
fn it_holds() {
    main().expect("what it shows");
}
