//! The program `stickslip`: arguments become a plan, a command carries the plan out, and the result
//! becomes an exit code.
//!
//! It is a library only so that tests and fuzz targets can carry out command lines without starting
//! a process for each.
//!
//! Start reading here; then, in this order: `args` (what may be typed), `plan` (what the options
//! mean together), `commands` (what each command does), `output` (what is shown), `page` (the page
//! of `reproduce`), `threads` (on how many threads the work runs), `version` and `schema` (the
//! program about itself), `error` (what can go wrong, and the exit codes). What is read from files
//! and written to them is in the crate `stickslip-files`.

mod args;
mod commands;
mod error;
mod output;
mod page;
mod plan;
mod schema;
mod threads;
mod version;

use std::ffi::OsString;
use std::io;
use std::process::ExitCode;

use clap::Parser;
use stickslip_studies::{convergence, own_system, stiff_springs};

use args::{Arguments, Command};
pub use error::Failure;
use output::console::say;
use plan::{
    CollidePlan, FitPlan, ImpactPlan, JoinPlan, LocatePlan, Mapped, ReproducePlan, RunPlan,
    Stacked, StudyPlan, TablePlan, TimestepPlan, Traced,
};
pub use stickslip_files::FileError;
use version::NAME;

/// Carries out the command line of this process and reports what went wrong.
#[must_use]
pub fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(reply) => return answer(&reply),
    };
    #[cfg(unix)]
    if let Err(error) = stickslip_files::output::partial::remove_on_signals() {
        say(format_args!("warning: signals cannot be watched: {error}"));
    }
    match carry_out(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            say(format_args!("error: {failure}"));
            if failure.is_usage() {
                say("\nFor more information, try '--help'.");
            }
            ExitCode::from(failure.code())
        }
    }
}

/// Shows a help text, the version, or what is wrong with the arguments.
fn answer(reply: &clap::Error) -> ExitCode {
    match reply.print() {
        // If standard error is closed, nobody wants to know.
        _ if reply.use_stderr() => ExitCode::from(u8::try_from(reply.exit_code()).unwrap_or(2)),
        // Nobody may read the help text any more. That is not a failure.
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            let failure = Failure::Stdout(error);
            say(format_args!("error: {failure}"));
            ExitCode::from(failure.code())
        }
        _ => ExitCode::SUCCESS,
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
            CollidePlan::Single(plan) => commands::collide::run(&plan),
            CollidePlan::Batch(plan) => commands::collide::batch::run(&plan),
        },
        Command::Impact(arguments) => match ImpactPlan::new(arguments)? {
            ImpactPlan::Single(plan) => commands::impact::run(&plan),
            ImpactPlan::Batch(plan) => commands::impact::batch::run(*plan),
        },
        Command::Laws(arguments) => commands::laws::run(arguments),
        Command::Map(arguments) => match Mapped::new(arguments)? {
            Mapped::Collisions(plan) => commands::map::run(&plan),
            Mapped::System(plan) => commands::system_map::run(&plan),
        },
        Command::Join(arguments) => commands::join::run(&JoinPlan::new(arguments)?),
        Command::Run(arguments) => commands::run::run(&RunPlan::new(arguments)?),
        Command::System(arguments) => commands::run::describe(arguments),
        Command::Trace(arguments) => match Traced::new(arguments)? {
            Traced::Collisions(plan) => commands::trace::run(&plan),
            Traced::System(plan) => commands::trace::system(&plan),
        },
        Command::Stack(arguments) => match Stacked::new(arguments)? {
            Stacked::Collisions(plan) => commands::stack::run(&plan),
            Stacked::System(plan) => commands::stack::system(&plan),
        },
        Command::Locate(arguments) => commands::locate::run(&LocatePlan::new(arguments)?),
        Command::Reproduce(arguments) => match ReproducePlan::new(arguments) {
            ReproducePlan::Page(plan) => commands::reproduce::run(&plan),
            ReproducePlan::Statements(plan) => commands::statements::run(&plan),
        },
        Command::Asymptote(arguments) => {
            commands::studies::run(&StudyPlan::stiff_springs(arguments)?, stiff_springs::run)
        }
        Command::Converge(arguments) => match StudyPlan::own_system(arguments)? {
            Some(plan) => commands::studies::run(&plan, own_system::run),
            None => commands::studies::run(&StudyPlan::convergence(arguments)?, convergence::run),
        },
        Command::Timestep(arguments) => commands::timestep::run(&TimestepPlan::new(arguments)?),
        Command::Fit(arguments) => commands::fit::run(&FitPlan::new(arguments)?),
        Command::Table(arguments) => commands::table::run(&TablePlan::new(arguments)?),
        Command::Completions(arguments) => commands::completions::run(*arguments),
        Command::Man(arguments) => commands::man::run(arguments),
    }
}
