//! The program `stickslip`. All of it is in the library of the same crate.

use std::process::ExitCode;

/// Called before Rust's own start, which opens `/dev/null` in the place of streams that are closed.
#[cfg(any(target_os = "linux", target_os = "macos"))]
#[allow(unsafe_code, reason = "a place in the program, for a function that has no conditions")]
#[cfg_attr(target_os = "linux", unsafe(link_section = ".init_array"))]
#[cfg_attr(target_os = "macos", unsafe(link_section = "__DATA,__mod_init_func"))]
#[used]
static AT_START: extern "C" fn() = {
    extern "C" fn look() {
        let exists = |path| std::fs::exists(path).unwrap_or(true);
        if exists("/dev/fd") && std::fs::symlink_metadata("/dev/fd/1").is_err() {
            stickslip_cli::note_closed_output();
        }
    }
    look
};

fn main() -> ExitCode {
    stickslip_cli::main()
}
