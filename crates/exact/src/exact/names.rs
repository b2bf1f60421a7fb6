//! Names of margins and of exits: half swings and guards as numbers, and back.

use stickslip_contact::phase::{OTHER_SIDE, SAME_SIDE};
use stickslip_solver::margin::{Exit, Hint, Place};

/// The number in the name of the margin of a slip phase at its first turn.
pub const TURN: usize = 0;

/// The distance of what different numbers are counted from: more than there are half swings with
/// two tops.
pub const NAMES: usize = 1 << 20;

/// The place of what is called `what` on half swing `k`.
pub fn numbered(k: u32, what: usize) -> Place {
    Place::Minimum { near: Hint(f64::from(k)), number: what + (k / 2) as usize }
}

/// The guard that fires on half swing `k`.
pub fn guard(k: u32) -> usize {
    if k.is_multiple_of(2) { SAME_SIDE } else { OTHER_SIDE }
}

/// The exit at the end of a stick phase; its hint is the number of the half swing, and 1/2 more
/// after the top of R.
pub fn stick_exit(k: u32, after_top: bool) -> Exit {
    let after = f64::from(k) + if after_top { 0.5 } else { 0.0 };
    Exit::falling(guard(k), after)
}

/// The half swing of the exit of a stick phase, and whether the exit is after the top of R.
pub fn flank_of(exit: &Exit) -> (u32, bool) {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number")]
    let k = exit.after.0 as u32;
    (k, exit.after.0 - f64::from(k) > 0.25)
}
