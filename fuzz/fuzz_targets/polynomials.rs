//! Bytes as a hybrid system: what `tests/checks/hybrid.rs` says of its runs.

#![no_main]
#![allow(dead_code, reason = "each target uses one of the checks")]

#[path = "../../tests/checks/hybrid.rs"]
mod checks;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Err(reason) = checks::polynomials(bytes) {
        panic!("{reason}");
    }
});
