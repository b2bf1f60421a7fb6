//! Stick–slip of a mass on a moving belt: the period of its limit cycle against the closed form.
//!
//! A mass of 1 on a spring of stiffness 1 lies on a belt of velocity v. Friction holds the mass up
//! to the static force F_s. While the mass slips, the smaller kinetic force F_k drags it:
//!
//! ```text
//! stick:  x′ = v          until x = F_s
//! slip:   x″ = F_k − x    until x′ = v
//! ```
//!
//! With D = F_s − F_k, the slip is x = F_k + D cos t + v sin t. Its velocity is v again after the
//! time 2π − 2 atan(D/v), at x = F_k − D. Then the belt carries the mass over the distance 2D. The
//! period is 2π − 2 atan(D/v) + 2D/v.
//!
//! Run with `cargo run --release --example friction_belt`.

use std::error::Error;
use std::f64::consts::TAU;

use stickslip::solver::{
    Direction, Dop853, Guard, Number, Options, ReadableSystem, Start, State, run,
};

struct Belt {
    velocity: f64,
    static_friction: f64,
    kinetic_friction: f64,
}

impl ReadableSystem<2, 1> for Belt {
    /// Whether the mass sticks.
    type Mode = bool;

    fn field<T: Number>(&self, sticks: bool, _time: T, y: &[T; 2]) -> [T; 2] {
        [y[1], if sticks { T::from(0.0) } else { -y[0] + self.kinetic_friction }]
    }

    fn guards(&self, _sticks: bool) -> [Guard; 1] {
        [Guard::new(Direction::Below)]
    }

    fn guard_values<T: Number>(&self, sticks: bool, _time: T, y: &[T; 2]) -> [T; 1] {
        [if sticks { -y[0] + self.static_friction } else { -y[1] + self.velocity }]
    }

    fn transition(&self, sticks: bool, _: usize, _time: f64, y: &State<2>) -> (bool, State<2>) {
        (!sticks, State::from([y[0], self.velocity]))
    }
}

/// Follows the mass through fifty cycles and compares their periods with the closed form.
///
/// # Errors
/// The run failed.
fn main() -> Result<(), Box<dyn Error>> {
    let belt = Belt { velocity: 0.5, static_friction: 1.0, kinetic_friction: 0.6 };
    let drop = belt.static_friction - belt.kinetic_friction;
    let period = TAU - 2.0 * (drop / belt.velocity).atan() + 2.0 * drop / belt.velocity;

    let start = Start { mode: true, s: 0.0, state: State::from([0.0, belt.velocity]) };
    let options = Options::with_tolerance(1e-13);
    let mut switches = Vec::new();
    let end = run(Dop853, &belt, start, 52.0 * period, &options, &mut switches)?.finished()?;
    assert_eq!(end.s, 52.0 * period);

    let slips: Vec<f64> = switches.iter().filter(|event| event.from).map(|event| event.s).collect();
    let errors = slips.windows(2).map(|pair| (pair[1] - pair[0] - period).abs());
    let largest = errors.fold(0.0, f64::max);
    println!("{} cycles of period {period:.12}, largest error {largest:.1e}", slips.len() - 1);
    // The measured error is 1.5e-13.
    assert!(slips.len() > 50 && largest < 3e-13);
    Ok(())
}

#[test]
fn it_holds() {
    main().expect("what it shows");
}
