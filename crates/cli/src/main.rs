//! The `stickslip` program: see the library of the same crate.

use std::process::ExitCode;

fn main() -> ExitCode {
    stickslip_cli::main()
}
