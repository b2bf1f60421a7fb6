//! What the options mean together: arguments become a plan that a command can carry out.
//!
//! One file for each command. Rules that several of them need are in `collision` (one collision
//! from options), `system` (systems that are texts), `window` (intervals of κ and ψ), `engine`
//! (what computes collisions), `law`, `batch` and `course` (their files) and `files` (outputs are
//! files of their own).

mod batch;
mod collide;
mod collision;
mod course;
mod engine;
mod files;
mod fit;
mod impact;
mod join;
mod law;
mod locate;
mod map;
mod reproduce;
mod run;
mod stack;
mod studies;
mod system;
mod table;
mod timestep;
mod trace;
mod window;

pub use batch::BatchFiles;
pub use collide::{BatchPlan, CollidePlan, SinglePlan};
pub use course::CoursePlan;
pub use fit::FitPlan;
pub use impact::{Engines, ImpactBatch, ImpactPlan, SingleImpact};
pub use join::JoinPlan;
pub use locate::LocatePlan;
pub use map::{MapFormat, MapOutput, MapPlan, Mapped, SystemMapPlan};
pub use reproduce::{PagePlan, ReproducePlan, StatementsPlan};
pub use run::RunPlan;
pub use stack::{StackPlan, Stacked, SystemStackPlan};
pub use studies::StudyPlan;
pub use system::{SystemPlane, read};
pub use table::{TableFormat, TablePlan};
pub use timestep::TimestepPlan;
pub use trace::{SystemTracePlan, TracePlan, Traced};
