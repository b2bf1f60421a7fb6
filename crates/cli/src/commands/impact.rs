//! `impact`: the impact of two bodies in SI units, computed and printed, or a file of impacts.

mod table;

use std::path::{Path, PathBuf};

use stickslip_figure::pictures;
use stickslip_files::input::bodies::{self, ImpactReading, Velocities, VelocitiesError};
use stickslip_files::input::rows::Input;
use stickslip_files::input::{law, parameter};
use stickslip_files::output::csv::Rows;
use stickslip_files::output::impact_rows::{self, EVENTS};
use stickslip_files::output::json;
use stickslip_files::output::picture::{AnimationFile, PictureFile};
use stickslip_model::spheres::quantity::{self, PhysicalQuantity};
use stickslip_model::spheres::{Encounter, ImpactReport};
use stickslip_model::{CollisionFailure, Engine, Law, document};

use crate::error::Failure;
use crate::output::console::{deliver, print};
use crate::shared::Format;
use crate::shared::batch::{self, BatchArguments, BatchFiles, Work};
use crate::shared::course::{Course, CourseArguments};
use crate::shared::files::{self, plotted, require_different, require_one_standard_input};
use crate::shared::law::file as law_file;
use crate::shared::method::MethodArguments;

/// Compute the impact of two spheres, or of a sphere and a wall, in SI units, or a file of them
#[derive(Debug, clap::Args)]
#[command(long_about = ABOUT, after_long_help = EXAMPLES)]
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

    /// How the result is printed
    #[arg(long, value_enum, default_value_t = Format::Table, help_heading = "Output")]
    #[arg(conflicts_with = "batch")]
    pub format: Format,

    /// Add the work of the integrator to the table
    #[arg(long, help_heading = "Output", conflicts_with = "batch")]
    pub verbose: bool,

    /// Picture of the forces and the velocity of one impact, which is printed as well
    #[arg(
        long,
        value_name = "FILE.svg|.png|.pdf",
        help_heading = "Output",
        conflicts_with = "batch"
    )]
    #[arg(value_parser = files::picture())]
    pub plot: Option<PictureFile>,

    /// Animation of the same picture
    #[arg(long, value_name = "FILE.gif|.mp4", help_heading = "Output", conflicts_with = "batch")]
    #[arg(value_parser = files::animation())]
    pub animate: Option<AnimationFile>,

    /// The course of one impact.
    #[command(flatten)]
    pub course: CourseArguments,

    /// JSON file of the bodies of a batch, of which columns change what they name; - for standard
    /// input
    #[arg(long, value_name = "FILE.json", help_heading = "Batch", requires = "batch")]
    #[arg(conflicts_with = "file")]
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

impl VelocityArguments {
    /// All of them, in the order in which files have them.
    fn all(self) -> [Option<f64>; 4] {
        let Self { normal, tangential, speed, angle } = self;
        [normal, tangential, speed, angle]
    }
}

fn read(quantity: &PhysicalQuantity, text: &str) -> Result<f64, String> {
    parameter::quantity(quantity, text)
}

/// Computes one impact or those of a file.
pub fn run(arguments: &ImpactArguments) -> Result<(), Failure> {
    let ImpactArguments { file, bodies, .. } = arguments;
    let name = arguments.law.as_deref();
    let files = arguments.batch.files(&[("--bodies", bodies.as_deref()), law_file(name)])?;
    let inputs = [("FILE.json", file.as_deref()), law_file(name)];
    let animated = ("--animate", arguments.animate.as_ref().map(AnimationFile::path));
    let outputs = [plotted(arguments.plot.as_ref()), animated];
    require_different(&outputs, &inputs)?;
    let course = arguments.course.file(&outputs, &inputs)?;
    let law = law::by_name_or_file(name)?;
    let engines = Engines::new(name, law, &arguments.method)?;
    if let Some(files) = files {
        return many(files, arguments, law, engines);
    }
    let velocities = Velocities::new(arguments.velocities.all()).map_err(refused)?;
    let file = file.as_deref().unwrap_or(Path::new("-"));
    let encounter = bodies::read_encounter(file, law, velocities)?;
    one(&encounter, &engines.of(&encounter)?, course, arguments)
}

/// Computes one impact, draws it and writes its course if that is wanted, and prints it.
fn one(
    encounter: &Encounter,
    engine: &Engine,
    course: Option<Course<'_>>,
    arguments: &ImpactArguments,
) -> Result<(), Failure> {
    let contact = encounter.contact();
    let failed = |source| CollisionFailure::new(&contact, source);
    let (plot, animate) = (arguments.plot.as_ref(), arguments.animate.as_ref());
    let drawn = plot.map(|_| "--plot").or(animate.map(|_| "--animate"));
    if let Some(option) = drawn.filter(|_| encounter.is_central()) {
        let reason = "nothing is tangential in a central impact; expected another impact, \
                      or --course, which has the normal force";
        return Err(Failure::Usage(format!("{option}: {reason}")));
    }
    plot.map_or(Ok(()), PictureFile::probe)?;
    animate.map_or(Ok(()), AnimationFile::probe)?;
    course.map_or(Ok(()), Course::probe)?;
    let (collision, statistics, history) = if drawn.is_some() || course.is_some() {
        let (collision, statistics, history) = engine.followed(contact).map_err(failed)?;
        (collision, statistics, Some(history))
    } else {
        let (collision, statistics) = engine.collide(contact).map_err(failed)?;
        (collision, statistics, None)
    };
    let impact = ImpactReport::new(encounter, collision);
    impact.require_finite().map_err(|error| failed(error.into()))?;
    if let Some(history) = &history {
        let course = course.map(|course| course.in_si(encounter, (&impact.collision, history)));
        let draw =
            |plot: &PictureFile| plot.write(Ok(pictures::collision::draw_impact(&impact, history)));
        let picture = plot.map(draw).transpose()?;
        let film = |file: &AnimationFile| {
            file.write(pictures::collision::frames_of_impact(&impact, history))
        };
        let animation = animate.map(film).transpose()?;
        deliver(picture.into_iter().chain(animation).chain(course.transpose()?), "")?;
    }
    let statistics = statistics.as_ref();
    print(|out| match arguments.format {
        Format::Json => json::write(out, document::IMPACT, &impact, engine, (None, statistics)),
        Format::Table => {
            table::write(out, engine, &impact, statistics.filter(|_| arguments.verbose))
        }
    })
}

/// Computes the impacts of a file.
fn many(
    files: BatchFiles<'_>,
    arguments: &ImpactArguments,
    law: Law,
    engines: Engines<'_>,
) -> Result<(), Failure> {
    let Some(bodies) = &arguments.bodies else {
        let reason = "--batch is given without --bodies; expected the JSON file of the bodies";
        return Err(Failure::Usage(reason.to_owned()));
    };
    require_one_standard_input(("--bodies", Some(bodies)), ("--batch", Some(files.input)))?;
    let velocities = arguments.velocities.all();
    if Velocities::new(velocities) == Err(VelocitiesError::Both) {
        return Err(refused(VelocitiesError::Both));
    }
    let bodies = ImpactReading::of_file(bodies, law)?;
    let work = Impacts { engines, names: impact_rows::names(bodies.spheres()) };
    let columns = |header: &_| bodies.with_columns(header, velocities, &work.names);
    let input = Input::open(files.input, columns)?;
    batch::run(files, input, &work, "")
}

/// What computes impacts under a law, whatever their tangential damping and friction.
struct Engines<'a> {
    /// The name of the law, or its file, if it is given.
    name: Option<&'a str>,
    /// With the law as it is, and with tangential damping or a friction that decays.
    engines: [Engine; 2],
}

impl<'a> Engines<'a> {
    /// The engines that options choose.
    fn new(name: Option<&'a str>, law: Law, method: &MethodArguments) -> Result<Self, Failure> {
        let engine = |damping| method.engine((law, damping));
        Ok(Self { name, engines: [engine(0.0)?, engine(1.0)?] })
    }

    /// The engine for an encounter.
    fn of(&self, encounter: &Encounter) -> Result<Engine, Failure> {
        let damping = encounter.contact().tangential_damping();
        law::permits(self.name, "tangential damping", damping)?;
        let decays = !encounter.contact().law().friction.is_constant();
        Ok(self.engines[usize::from(damping != 0.0 || decays)])
    }
}

/// The failure of options that are no velocities.
fn refused(error: VelocitiesError) -> Failure {
    const NAMES: [&str; 4] = ["--normal", "--tangential", "--speed", "--angle"];
    Failure::Usage(match error {
        VelocitiesError::Both => {
            "--normal or --tangential and --speed or --angle are both given; expected --normal with \
             --tangential, or --speed with --angle"
                .to_owned()
        }
        VelocitiesError::Half { given, missing } => {
            format!("{} is given without {}; expected both", NAMES[given], NAMES[missing])
        }
    })
}

/// Impacts in SI units.
struct Impacts<'a> {
    engines: Engines<'a>,
    /// The columns of results.
    names: Vec<&'static str>,
}

impl Work for Impacts<'_> {
    type Case = Encounter;

    fn results(&self) -> &[&'static str] {
        &self.names
    }

    fn events(&self) -> &'static [&'static str] {
        &EVENTS
    }

    fn switches(&self, encounter: &Encounter) -> f64 {
        // Without damping their number grows as √κ t_c/π.
        encounter.contact().kappa().sqrt()
    }

    fn write(
        &self,
        encounter: &Encounter,
        results: &mut Rows,
        wanted: Option<(&mut Rows, u64)>,
    ) -> Result<bool, String> {
        let engine = self.engines.of(encounter).map_err(|failure| failure.to_string())?;
        let (collision, _) =
            engine.collide(encounter.contact()).map_err(|error| error.to_string())?;
        let impact = ImpactReport::new(encounter, collision);
        impact.require_finite().map_err(|error| error.to_string())?;
        impact_rows::write(results, &impact, "ok");
        if let Some((events, number)) = wanted {
            impact_rows::write_switches(events, number, &impact.outcome.switches);
        }
        Ok(true)
    }
}

/// What `impact --help` says first.
const ABOUT: &str = "\
Compute the impact of two spheres, or of a sphere and a wall, in three dimensions and SI units: velocities \
and spins after it, the coefficients of restitution, the switches between sticking and sliding in seconds, \
and where the energy went.

The bodies touch and approach each other. In the file every quantity is named with its unit. With \
--batch, a file of impacts: any number of the bodies, their surfaces and motions may be a column.";

/// What `impact --help` says last.
const EXAMPLES: &str = "\
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
                         without unit (Tsuji with Hertz; both linear), or critical_damping_ratio;
                         or e_n, with e_n_at_m_per_s where it depends on the velocity
  hysteretic force       unloading_stiffness_ratio, k2/k1, 1 or above
  hardening              hardening_per_m, (k2/k1 - 1)/(greatest overlap)
  yielding               yield_velocity_m_per_s, or yield_pressure_pa of the contact
  tangential damping     tangential_damping_ratio, without unit [default: 0]
  decaying friction      dynamic_friction, at most friction, and friction_decay_s_per_m
  adhesion (dmt, jkr)    surface_energy_j_per_m2, half the work of adhesion

Bodies with adhesion may stay together: then there is no restitution, nothing is known of their motion
  afterwards, and their status in a batch is \"adheres\".

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
  stickslip impact examples/steel_spheres.json --plot impact.svg
  stickslip impact examples/glass_on_wall.json --format json
  stickslip impact examples/hooke_spheres.json --law gran/hooke/history
  stickslip impact examples/steel_pair.json --speed 2 --angle 0.5 --course course.csv
  stickslip impact --batch IN.csv --bodies examples/steel_pair.json --out OUT.csv

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
