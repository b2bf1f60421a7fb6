//! Bytes as a system of expressions. `crates/solver/tests/solver/checks.rs` says what must hold.

#![no_main]
#![allow(dead_code, reason = "each target uses one of the checks")]

#[path = "../../crates/solver/tests/solver/checks.rs"]
mod checks;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Err(reason) = checks::expressions(bytes) {
        panic!("{reason}");
    }
});
