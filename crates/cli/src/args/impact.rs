//! The options of `impact`.

use std::path::PathBuf;

use super::method::MethodArguments;
use super::shared::Format;

/// Options of `impact`.
#[derive(Debug, clap::Args)]
pub struct ImpactArguments {
    /// JSON file of two spheres, or a sphere and a wall, with their motions; - for standard input
    #[arg(value_name = "FILE.json")]
    pub file: PathBuf,

    /// What computes the collision.
    #[command(flatten)]
    pub method: MethodArguments,

    /// How the impact is printed
    #[arg(long, value_enum, default_value_t = Format::Table, help_heading = "Output")]
    pub format: Format,
}

/// What `impact --help` says first.
pub const ABOUT: &str = "\
Compute the impact of two spheres, or of a sphere and a wall, in three dimensions and SI units: velocities \
and spins after it, the coefficients of restitution, the switches between sticking and sliding in seconds, \
and where the energy went.

The bodies touch and approach each other. In the file every quantity is named with its unit.";

/// What `impact --help` says last.
pub const EXAMPLES: &str = "\
File, for two spheres (a wall instead of the second: {\"spheres\": [one], \"wall\": {…}, \"surface\": {…}}):
  {
    \"comment\": \"any text; every object may have one\",
    \"spheres\": [
      {
        \"radius_m\": 0.02,
        \"material\": {\"young_modulus_pa\": 210e9, \"poisson_ratio\": 0.3, \"density_kg_per_m3\": 7850},
        \"motion\": {
          \"position_m\": [0, 0, 0.04], \"velocity_m_per_s\": [4, 0, -20], \"spin_rad_per_s\": [0, 0, 0]
        }
      },
      { the second sphere }
    ],
    \"surface\": {\"friction\": 0.4, \"tangential_stiffness_kg_per_s2\": 1e12, \"damping_time_s\": 0}
  }

Examples:
  stickslip impact examples/steel_spheres.json
  stickslip impact examples/glass_on_wall.json --format json

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
