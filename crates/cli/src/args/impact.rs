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

    /// Contact law: a name that `stickslip laws` lists, or a JSON file [default: paper]
    #[arg(long, value_name = "NAME|FILE.json", help_heading = "Contact law")]
    pub law: Option<String>,

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

Other laws have other constants in \"surface\", beside \"friction\":
  linear normal force    normal_stiffness_kg_per_s2
  Hertz' normal force    hertz_stiffness_kg_per_s2_m0_5, or that of the materials
  constant k_t           tangential_stiffness_kg_per_s2
  Mindlin's k_t          mindlin_stiffness_kg_per_s2_m0_5, or that of the materials
  damping                damping_coefficient in kg/(s m^e), e = 0, 1/2, 1/4 as the law says; or
                         damping_time_s (viscoelastic with Hertz; both linear), or damping_ratio
                         without unit (Tsuji with Hertz; both linear)
  tangential damping     tangential_damping_ratio, without unit [default: 0]

Examples:
  stickslip impact examples/steel_spheres.json
  stickslip impact examples/glass_on_wall.json --format json
  stickslip impact examples/hooke_spheres.json --law gran/hooke/history

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
