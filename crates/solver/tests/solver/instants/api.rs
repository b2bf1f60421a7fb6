//! The guards of planted systems.

use stickslip_solver::Guard;

use super::planted::Kind;

pub const PRIORITIES: &[i8] = &[-128, -1, 1, 2, 127];
pub const HAS_JUMPS: bool = true;
pub const HAS_CLOCKS: bool = true;

pub fn guard(kind: &Kind) -> Guard {
    let guard = if kind.clock.is_some() { Guard::clock() } else { Guard::new(kind.direction) };
    let guard = guard.priority(kind.priority);
    let guard = if kind.sees_jumps { guard.sees_jumps() } else { guard };
    if kind.terminal { guard.terminal() } else { guard }
}
