//! The `stickslip` program: arguments become a plan, the plan is carried out, the outcome becomes
//! an exit code.
//!
//! A library only so that tests and fuzz targets can carry out command lines without starting a
//! process for each.
//!
//! Start reading here; then, in this order: `args` (what may be typed), `plan` (what it means),
//! `collide`, `batch`, `impact`, `map`, `atlas`, `converge`, `asymptote`, `audit` and `reproduce`
//! (doing it), `completions`, `man` and `version` (the program about itself), `input`, `bodies` and
//! `json_input` (files read), `table`, `json`, `rows`, `figure` and `output` (results written).

mod args;
mod asymptote;
mod atlas;
mod audit;
mod batch;
mod bodies;
mod collide;
mod completions;
mod converge;
mod engine;
mod error;
mod figure;
mod impact;
mod input;
mod json;
mod json_input;
mod man;
mod map;
mod number;
mod output;
mod parameter;
mod plan;
mod range;
mod recipe;
mod reproduce;
mod rows;
mod schema;
mod study;
mod table;
mod version;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::Parser;

use args::{Arguments, Command};
pub use error::Failure;
use plan::{
    AsymptotePlan, CollidePlan, ConvergePlan, LocatePlan, MapPlan, ReproducePlan, TracePlan,
};

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
            CollidePlan::Point(point) => collide::run(&point),
            CollidePlan::Batch(batch) => batch::run(&batch),
        },
        Command::Impact(arguments) => impact::run(arguments),
        Command::Map(arguments) => map::run(&MapPlan::new(arguments)?),
        Command::Trace(arguments) => atlas::trace::run(&TracePlan::new(arguments)?),
        Command::Locate(arguments) => atlas::locate::run(&LocatePlan::new(arguments)?),
        Command::Converge(arguments) => {
            let plan = ConvergePlan::new(arguments)?;
            study::carry_out(&plan.out, plan.threads, |progress| converge::run(&plan, progress))
        }
        Command::Asymptote(arguments) => {
            let plan = AsymptotePlan::new(arguments)?;
            study::carry_out(&plan.out, plan.threads, |progress| asymptote::run(&plan, progress))
        }
        Command::Reproduce(arguments) => match ReproducePlan::new(arguments) {
            ReproducePlan::Page(plan) => reproduce::run(&plan),
            ReproducePlan::Statements(plan) => audit::print(&plan),
        },
        Command::Completions(arguments) => completions::run(*arguments),
        Command::Man(arguments) => man::run(arguments),
    }
}
