//! The `stickslip` program: arguments become a plan, the plan is carried out, the outcome becomes
//! an exit code.
//!
//! A library only so that tests and fuzz targets can carry out command lines without starting a
//! process for each.
//!
//! Start reading here; then, in this order: `args` (what may be typed), `plan` (what it means),
//! `commands` (doing it), `input` (what is read), `output` (what is written), `page` (the page of
//! `reproduce`), `schema` and `version` (the program about itself), `error` (exit codes).

mod args;
mod commands;
mod error;
mod input;
mod output;
mod page;
mod plan;
mod schema;
mod version;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::Parser;
use stickslip_studies::{convergence, stiff_springs};

use args::{Arguments, Command};
pub use error::Failure;
use plan::{CollidePlan, LocatePlan, MapPlan, ReproducePlan, TracePlan};

/// The program's name.
const NAME: &str = "stickslip";

/// Carries out the command line of this process, and reports what went wrong.
#[must_use]
pub fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(reply) => {
            // The reader of a help text may be gone already; that is no failure.
            let _ = reply.print();
            return ExitCode::from(u8::try_from(reply.exit_code()).unwrap_or(2));
        }
    };
    match carry_out(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.report();
            ExitCode::from(failure.code())
        }
    }
}

/// Carries out a command line, which begins with the program's name, and reports nothing.
///
/// # Errors
/// What went wrong.
pub fn run(
    arguments: impl IntoIterator<Item = impl Into<OsString> + Clone>,
) -> Result<(), Failure> {
    let arguments =
        Arguments::try_parse_from(arguments).map_err(|reply| Failure::Usage(reply.to_string()))?;
    carry_out(&arguments)
}

fn carry_out(arguments: &Arguments) -> Result<(), Failure> {
    match &arguments.command {
        Command::Collide(arguments) => match CollidePlan::new(arguments)? {
            CollidePlan::Single(collision) => commands::collide::run(&collision),
            CollidePlan::Batch(batch) => commands::batch::run(&batch),
        },
        Command::Impact(arguments) => commands::impact::run(arguments),
        Command::Map(arguments) => commands::map::run(&MapPlan::new(arguments)?),
        Command::Trace(arguments) => commands::trace::run(&TracePlan::new(arguments)?),
        Command::Locate(arguments) => commands::locate::run(&LocatePlan::new(arguments)?),
        Command::Converge(arguments) => {
            let settings = plan::convergence(arguments)?;
            commands::studies::run(&arguments.out, arguments.threads, |progress| {
                convergence::run(&settings, progress)
            })
        }
        Command::Asymptote(arguments) => {
            let settings = plan::stiff_springs(arguments);
            commands::studies::run(&arguments.out, arguments.threads, |progress| {
                stiff_springs::run(&settings, progress)
            })
        }
        Command::Reproduce(arguments) => match ReproducePlan::new(arguments) {
            ReproducePlan::Page(plan) => commands::reproduce::run(&plan),
            ReproducePlan::Statements(plan) => commands::statements::run(&plan),
        },
        Command::Completions(arguments) => commands::completions::run(*arguments),
        Command::Man(arguments) => commands::man::run(arguments),
    }
}
