//! The options of `impact`.

use std::path::PathBuf;

use stickslip_files::input::parameter;
use stickslip_model::quantity::{self, Quantity};

use super::batch::BatchArguments;
use super::course::CourseArguments;
use super::method::MethodArguments;
use super::shared::Format;

/// Options of `impact`.
#[derive(Debug, clap::Args)]
pub struct ImpactArguments {
    /// JSON file of two spheres, or a sphere and a wall, with their motions; - for standard input
    #[arg(value_name = "FILE.json", required_unless_present = "batch", conflicts_with = "batch")]
    pub file: Option<PathBuf>,

    /// Velocities that are used instead of the motions.
    #[command(flatten)]
    pub velocities: VelocityArguments,

    /// Contact law: a name that `stickslip laws` lists, or a JSON file [default: paper]
    #[arg(long, value_name = "NAME|FILE.json", help_heading = "Contact law")]
    pub law: Option<String>,

    /// What computes the collision.
    #[command(flatten)]
    pub method: MethodArguments,

    /// How the impact is printed
    #[arg(long, value_enum, default_value_t = Format::Table, help_heading = "Output")]
    #[arg(conflicts_with = "batch")]
    pub format: Format,

    /// The course of one impact.
    #[command(flatten)]
    pub course: CourseArguments,

    /// JSON file of the bodies of a batch, of which columns change what they name; - for standard
    /// input
    #[arg(long, value_name = "FILE.json", help_heading = "Batch", requires = "batch")]
    pub bodies: Option<PathBuf>,

    /// A file of impacts.
    #[command(flatten)]
    pub batch: BatchArguments,
}

/// Velocities of the surfaces at the contact, of bodies without spin.
#[derive(Clone, Copy, Debug, Default, clap::Args)]
pub struct VelocityArguments {
    /// Normal velocity g_n of the surfaces in m/s instead of the motions in the file; above 0
    #[arg(long, value_name = "V", help_heading = "Velocities", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| read(&quantity::NORMAL_VELOCITY, text))]
    pub normal: Option<f64>,

    /// Tangential velocity g_t of the surfaces in m/s, with --normal; 0 or above
    #[arg(long, value_name = "V", help_heading = "Velocities", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| read(&quantity::TANGENTIAL_VELOCITY, text))]
    pub tangential: Option<f64>,

    /// Velocity of the surfaces in m/s, instead of --normal and --tangential; above 0
    #[arg(long, value_name = "V", help_heading = "Velocities", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| read(&quantity::SPEED, text))]
    pub speed: Option<f64>,

    /// Angle between velocity and normal in rad, with --speed; 0 or above, below π/2
    #[arg(long, value_name = "A", help_heading = "Velocities", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| read(&quantity::ANGLE, text))]
    pub angle: Option<f64>,
}

fn read(quantity: &Quantity, text: &str) -> Result<f64, parameter::BadValue> {
    parameter::quantity(quantity, text)
}

/// What `impact --help` says first.
pub const ABOUT: &str = "\
Compute the impact of two spheres, or of a sphere and a wall, in three dimensions and SI units: velocities \
and spins after it, the coefficients of restitution, the switches between sticking and sliding in seconds, \
and where the energy went.

The bodies touch and approach each other. In the file every quantity is named with its unit. With \
--batch, a file of impacts: any number of the bodies, their surfaces and motions may be a column.";

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

Velocities: --normal and --tangential, or --speed and --angle, are those of the surfaces of bodies
  without spin. The second body rests, and the first one falls along −z and moves along x. The
  motions in the file are not used.

Batch files:
  The header of IN.csv names normal_m_per_s and tangential_m_per_s, or speed_m_per_s and angle_rad,
  and numbers of the JSON file, such as spheres[0].radius_m, spheres[1].material.young_modulus_pa,
  spheres[0].motion.velocity_m_per_s[2], surface.friction. Columns override the file; velocities may
  be options. Other columns pass through. OUT.csv has the columns of the input followed by results
  and status. A row that cannot be computed has no results; its status says why, and the exit code
  is 1.

Course:
  FILE.csv of --course has the columns time_s, regime, side, switch, compression_m,
  normal_velocity_m_per_s, normal_force_n, tangential_force_n, velocity_m_per_s and spring_m.

Examples:
  stickslip impact examples/steel_spheres.json
  stickslip impact examples/glass_on_wall.json --format json
  stickslip impact examples/hooke_spheres.json --law gran/hooke/history
  stickslip impact examples/steel_pair.json --speed 2 --angle 0.5 --course course.csv
  stickslip impact --batch IN.csv --bodies examples/steel_pair.json --out OUT.csv

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
