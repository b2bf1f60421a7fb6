//! A file that the program reads: what `crates/cli/tests/readers/checks.rs` says of it.

#![no_main]
#![allow(dead_code, reason = "each target uses one of the checks")]

#[path = "../../crates/cli/tests/readers/checks.rs"]
mod checks;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Err(reason) = checks::batch(bytes) {
        panic!("{reason}");
    }
});
