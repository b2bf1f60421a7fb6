//! Bytes as the text of a system. `crates/expression/tests/expression/checks.rs` says what must
//! hold.

#![no_main]

#[path = "../../crates/expression/tests/expression/checks.rs"]
mod checks;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Err(reason) = checks::text(bytes) {
        panic!("{reason}");
    }
});
