//! Tests of the model, in one program.
//!
//! Reference data are in `tests/data` of the workspace, whose README says where they come from.

#[path = "../../../../tests/checks/collision.rs"]
mod checks;
#[path = "../../../../tests/common/mod.rs"]
mod common;
#[path = "../../../../tests/checks/itinerary.rs"]
mod itinerary;
#[path = "../../../../tests/common/lammps.rs"]
mod lammps;
#[path = "../../../../tests/common/plain.rs"]
mod plain;

use stickslip_model as model;

mod adhesive;
mod estimates;
mod exact;
mod forces;
mod friction;
mod history;
mod hysteretic;
mod impacts;
mod inside;
mod largest;
mod law_borders;
mod laws;
mod linear;
mod margins;
mod properties;
mod reference;
mod sensitivities;
#[cfg(feature = "serde")]
mod serialization;
mod short_phases;
mod spheres;
mod torques;
mod whole_range;
