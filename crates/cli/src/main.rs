//! The `stickslip` program: arguments become a plan, the plan is carried out, the outcome becomes
//! an exit code.
//!
//! Start reading here; then, in this order: `args` (what may be typed), `plan` (what it means),
//! `collide`, `batch`, `impact`, `map`, `atlas`, `converge`, `asymptote`, `audit` and `reproduce` (doing it), `completions`, `man` and `version` (the program about itself), `input`, `bodies` and
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

use std::process::ExitCode;

use clap::Parser;

use args::{Arguments, Command};
use error::Failure;
use plan::{
    AsymptotePlan, CollidePlan, ConvergePlan, LocatePlan, MapPlan, ReproducePlan, TracePlan,
};

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(reply) => {
            // The reader of a help text may be gone already; that is no failure.
            let _ = reply.print();
            return ExitCode::from(u8::try_from(reply.exit_code()).unwrap_or(2));
        }
    };
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.report();
            failure.exit_code()
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
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
