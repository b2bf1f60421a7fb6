//! The commands: what may be typed, and what each command does. There is one file for each command,
//! with its options, their checks, what it does and its help. What several commands have in common
//! is in `shared`.

mod asymptote;
mod basins;
mod branch;
mod collide;
mod completions;
mod converge;
mod curve;
mod explore;
mod fit;
mod impact;
mod join;
mod laws;
mod locate;
mod man;
mod map;
mod orbit;
mod regions;
pub mod reproduce;
mod run;
mod section;
mod stack;
mod system;
mod table;
mod timestep;
mod trace;

use clap::{Parser, Subcommand};

use crate::error::Failure;
use crate::version;

/// Collisions of frictional viscoelastic spheres, with every switch between sticking and sliding.
#[derive(Debug, Parser)]
#[command(name = version::NAME, version, long_version = version::long())]
#[command(after_help = EXIT_CODES)]
pub struct Arguments {
    /// The command.
    #[command(subcommand)]
    pub command: Command,
}

/// A command with its options, in the order of the help text.
#[derive(Debug, Subcommand)]
pub enum Command {
    Collide(collide::CollideArguments),
    Impact(impact::ImpactArguments),
    Laws(laws::LawsArguments),
    Map(map::MapArguments),
    Join(join::JoinArguments),
    Run(run::RunArguments),
    System(system::SystemArguments),
    Orbit(orbit::OrbitArguments),
    Branch(branch::BranchArguments),
    Curve(curve::CurveArguments),
    Regions(regions::RegionsArguments),
    Section(section::SectionArguments),
    Basins(basins::BasinsArguments),
    Trace(trace::TraceArguments),
    Stack(stack::StackArguments),
    Locate(locate::LocateArguments),
    Explore(explore::ExploreArguments),
    Reproduce(reproduce::ReproduceArguments),
    Asymptote(asymptote::AsymptoteArguments),
    Converge(converge::ConvergeArguments),
    Timestep(timestep::TimestepArguments),
    Fit(fit::FitArguments),
    Table(table::TableArguments),
    Completions(completions::CompletionsArguments),
    Man(man::ManArguments),
}

impl Command {
    /// Carries out the command.
    pub fn run(&self) -> Result<(), Failure> {
        match self {
            Self::Collide(arguments) => collide::run(arguments),
            Self::Impact(arguments) => impact::run(arguments),
            Self::Laws(arguments) => laws::run(arguments),
            Self::Map(arguments) => map::run(arguments),
            Self::Join(arguments) => join::run(arguments),
            Self::Run(arguments) => run::run(arguments),
            Self::System(arguments) => system::run(arguments),
            Self::Orbit(arguments) => orbit::run(arguments),
            Self::Branch(arguments) => branch::run(arguments),
            Self::Curve(arguments) => curve::run(arguments),
            Self::Regions(arguments) => regions::run(arguments),
            Self::Section(arguments) => section::run(arguments),
            Self::Basins(arguments) => basins::run(arguments),
            Self::Trace(arguments) => trace::run(arguments),
            Self::Stack(arguments) => stack::run(arguments),
            Self::Locate(arguments) => locate::run(arguments),
            Self::Explore(arguments) => explore::run(arguments),
            Self::Reproduce(arguments) => reproduce::run(arguments),
            Self::Asymptote(arguments) => asymptote::run(arguments),
            Self::Converge(arguments) => converge::run(arguments),
            Self::Timestep(arguments) => timestep::run(arguments),
            Self::Fit(arguments) => fit::run(arguments),
            Self::Table(arguments) => table::run(arguments),
            Self::Completions(arguments) => completions::run(*arguments),
            Self::Man(arguments) => man::run(arguments),
        }
    }
}

const EXIT_CODES: &str = "Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
