//! What may be typed: options with their syntax and ranges, and the help text.
//!
//! Start reading here; then, in this order: `shared`, `method`, `law`, `batch` and `course`
//! (options that several commands have), and one file for each command.

mod asymptote;
mod batch;
mod collide;
mod completions;
mod converge;
mod course;
mod fit;
mod impact;
mod join;
mod law;
mod laws;
mod locate;
mod man;
mod map;
mod method;
mod plane;
mod reproduce;
mod run;
mod shared;
mod stack;
mod table;
mod timestep;
mod trace;

use clap::{Parser, Subcommand};

use crate::version;

pub use asymptote::AsymptoteArguments;
pub use batch::BatchArguments;
pub use collide::CollideArguments;
pub use completions::CompletionsArguments;
pub use converge::ConvergeArguments;
pub use course::CourseArguments;
pub use fit::FitArguments;
pub use impact::{ImpactArguments, VelocityArguments};
pub use join::JoinArguments;
pub use law::LawArguments;
pub use laws::LawsArguments;
pub use locate::LocateArguments;
pub use man::ManArguments;
pub use map::MapArguments;
pub use method::{Method, MethodArguments};
pub use plane::{Axis, GivenArguments, PlaneArguments};
pub use reproduce::{AuditFormat, ReproduceArguments};
pub use run::{RunArguments, SystemArguments};
pub use shared::{CollisionArguments, Format};
pub use stack::StackArguments;
pub use table::TableArguments;
pub use timestep::TimestepArguments;
pub use trace::TraceArguments;

/// Collisions of frictional viscoelastic spheres, with every switch between sticking and sliding.
#[derive(Debug, Parser)]
#[command(name = version::NAME, version, long_version = version::long())]
#[command(after_help = EXIT_CODES)]
pub struct Arguments {
    /// The command.
    #[command(subcommand)]
    pub command: Command,
}

/// A command with its options.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Compute one collision, or a file of them
    #[command(long_about = collide::ABOUT, after_long_help = collide::EXAMPLES)]
    Collide(CollideArguments),
    /// Compute the impact of two spheres, or of a sphere and a wall, in SI units, or a file of them
    #[command(long_about = impact::ABOUT, after_long_help = impact::EXAMPLES)]
    Impact(ImpactArguments),
    /// List the contact laws that have names, or print one of them
    #[command(long_about = laws::ABOUT, after_long_help = laws::EXAMPLES)]
    Laws(LawsArguments),
    /// Compute the restitution and the number of switches on a plane
    #[command(long_about = map::ABOUT, after_long_help = map::EXAMPLES)]
    Map(MapArguments),
    /// Join the parts of a map
    #[command(long_about = join::ABOUT, after_long_help = join::EXAMPLES)]
    Join(JoinArguments),
    /// Integrate a system of your own through every event
    #[command(long_about = run::ABOUT, after_long_help = run::EXAMPLES)]
    Run(RunArguments),
    /// Read a system of your own, and print what it consists of
    #[command(long_about = run::SYSTEM_ABOUT, after_long_help = run::SYSTEM_EXAMPLES)]
    System(SystemArguments),
    /// Trace every boundary in a window on which the switches change
    #[command(long_about = trace::ABOUT, after_long_help = trace::EXAMPLES)]
    Trace(TraceArguments),
    /// Trace atlases at several dampings, and find where regions are born and die between them
    #[command(long_about = stack::ABOUT, after_long_help = stack::EXAMPLES)]
    Stack(StackArguments),
    /// Look up the switches of collisions in an atlas
    #[command(long_about = locate::ABOUT, after_long_help = locate::EXAMPLES)]
    Locate(LocateArguments),
    /// Compute the figures of the paper anew, and show everything on one page
    #[command(long_about = reproduce::ABOUT, after_long_help = reproduce::EXAMPLES)]
    Reproduce(ReproduceArguments),
    /// Measure how the tangential restitution vanishes for stiff springs
    #[command(long_about = asymptote::ABOUT, after_long_help = asymptote::EXAMPLES)]
    Asymptote(AsymptoteArguments),
    /// Measure how errors fall with the step and the tolerance, and what they cost
    #[command(long_about = converge::ABOUT, after_long_help = converge::EXAMPLES)]
    Converge(ConvergeArguments),
    /// Measure the errors of the time steps of particle codes
    #[command(long_about = timestep::ABOUT, after_long_help = timestep::EXAMPLES)]
    Timestep(TimestepArguments),
    /// Fit a contact law to measured impacts
    #[command(long_about = fit::ABOUT, after_long_help = fit::EXAMPLES)]
    Fit(FitArguments),
    /// Make a table of the restitution, to be looked up in nanoseconds
    #[command(long_about = table::ABOUT, after_long_help = table::EXAMPLES)]
    Table(TableArguments),
    /// Print a script that completes commands and options in a shell
    #[command(after_long_help = completions::EXAMPLES)]
    Completions(CompletionsArguments),
    /// Print a manual page with all commands, or write one page for each command
    #[command(after_long_help = man::EXAMPLES)]
    Man(ManArguments),
}

const EXIT_CODES: &str = "Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
