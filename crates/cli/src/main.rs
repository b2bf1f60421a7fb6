//! The program `stickslip`. All of it is in the library of the same crate.

use std::process::ExitCode;

fn main() -> ExitCode {
    stickslip_cli::main()
}
