//! Systems from public reports about the events of other tools, with closed forms.
//!
//! Each system runs as a readable one and as a black box, of fixed and of any dimension, by both
//! methods (`forms`). The number behind a tool's name is that of the report.

#![allow(clippy::maybe_infinite_iter, reason = "bounces are taken while they are early enough")]

mod collisions;
mod forms;
mod order;
mod sides;
mod times;

use stickslip_solver::{Direction, Guard, RunError};

use forms::Ended;

const FALLING: Guard = Guard::new(Direction::Falling);
const RISING: Guard = Guard::new(Direction::Rising);
const EITHER: Guard = Guard::new(Direction::Either);
const BELOW: Guard = Guard::new(Direction::Below);
const OFF: Guard = Guard::OFF;

/// A guard that acts after the others of its instant.
const fn last(guard: Guard) -> Guard {
    guard.priority(-1)
}

/// Asserts that a run does not go on, because its transitions follow each other for ever.
fn is_endless(name: &str, run: &Result<Ended, RunError>, s: f64) {
    match run {
        Err(RunError::Cycle { s: found, .. }) => assert!((found - s).abs() < 1e-12, "{name}"),
        _ => panic!("{name}: {run:?}"),
    }
}
