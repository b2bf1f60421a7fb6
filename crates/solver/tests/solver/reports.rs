//! Systems from public reports about the events of other tools, with closed forms.
//!
//! Each system runs as a readable one and as a black box, of fixed and of any dimension, by both
//! methods (`forms`). The number behind a tool's name is that of the report.

mod collisions;
mod forms;
mod order;
mod sides;
mod times;

use stickslip_solver::{Direction, Guard, Outcome};

const FALLING: Guard = Guard::new(Direction::Falling);
const RISING: Guard = Guard::new(Direction::Rising);
const EITHER: Guard = Guard::new(Direction::Either);
const BELOW: Guard = Guard::new(Direction::Below);
const OFF: Guard = Guard::OFF;

/// A guard that acts after the others of its instant.
const fn last(guard: Guard) -> Guard {
    guard.yielding()
}

/// Asserts that a run is refused because its transitions go on for ever at one instant.
fn is_endless(ended: &forms::Ended, s: f64) {
    match ended.outcome {
        Outcome::InstantLimit { s: found } => assert!((found - s).abs() < 1e-12, "{ended:?}"),
        _ => panic!("{ended:?}"),
    }
}
