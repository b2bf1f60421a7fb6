//! What the solver offers for order. Priorities other than 0 and −1, guards that see jumps and
//! guards with given times are not part of it yet.

use stickslip_solver::Guard;

use super::planted::Kind;

pub const PRIORITIES: &[i8] = &[-1];
pub const HAS_JUMPS: bool = false;
pub const HAS_CLOCKS: bool = false;

pub fn guard(kind: &Kind) -> Guard {
    let guard = Guard::new(kind.direction);
    let guard = if kind.priority < 0 { guard.yielding() } else { guard };
    if kind.terminal { guard.terminal() } else { guard }
}
