//! Tests of the crate, in one program.
//!
//! Reference data are in `tests/data` of the workspace, whose README says where they come from.

#[path = "../../../../tests/common/lammps.rs"]
mod lammps;

mod adhesion;
mod c_program;
mod fit;
mod fit_strangers;
mod oblique;
mod reference;
mod strangers;
mod tables;
mod time_steps;
mod velocity_tables;
