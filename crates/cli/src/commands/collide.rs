//! `collide`: one collision, computed, printed and drawn, or a file of collisions.

use stickslip_figure::pictures;
use stickslip_files::input::parameter::Parameter;
use stickslip_files::input::recipe::Given;
use stickslip_files::input::rows::{Columns, Input};
use stickslip_files::output::csv::Rows;
use stickslip_files::output::json;
use stickslip_files::output::picture::{AnimationFile, PictureFile};
use stickslip_files::output::rows::{self, ESTIMATES, EVENTS, RESULTS};
use stickslip_model::{CollisionFailure, Contact, Engine, document};

use crate::error::Failure;
use crate::output::console::{deliver, print};
use crate::output::text;
use crate::shared::Format;
use crate::shared::batch::{self, BatchArguments, BatchFiles, Work};
use crate::shared::collision::{CollisionArguments, contact};
use crate::shared::course::{Course, CourseArguments};
use crate::shared::files::{self, plotted, require_different};
use crate::shared::law::{self, LawArguments};
use crate::shared::method::MethodArguments;

/// Compute one collision, or a file of them
#[derive(Debug, clap::Args)]
#[command(long_about = ABOUT, after_long_help = EXAMPLES)]
pub struct CollideArguments {
    /// Scaled stiffness κ = k_t/(α m β^⅘ g_n^⅖) of the tangential spring; 0 or above
    #[arg(long, value_name = "K", help_heading = "Collision", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Kappa.parse(text))]
    pub kappa: Option<f64>,

    /// Impact ratio g_t/g_n of tangential and normal velocity; above 0; gives ψ = G·α/μ
    #[arg(long, value_name = "G", help_heading = "Collision", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Ratio.parse(text))]
    pub ratio: Option<f64>,

    /// Reduced impact ratio ψ = (g_t/g_n)·α/μ, instead of --ratio; above 0
    #[arg(long, value_name = "P", help_heading = "Collision", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::Psi.parse(text))]
    pub psi: Option<f64>,

    /// The parameters beside κ and ψ.
    #[command(flatten, next_help_heading = "Collision")]
    pub collision: CollisionArguments,

    /// The contact law.
    #[command(flatten)]
    pub law: LawArguments,

    /// What computes a collision.
    #[command(flatten)]
    pub method: MethodArguments,

    /// How the result is printed
    #[arg(long, value_enum, default_value_t = Format::Table, help_heading = "Output")]
    #[arg(conflicts_with = "batch")]
    pub format: Format,

    /// Add the work of the integrator to the table
    #[arg(long, help_heading = "Output", conflicts_with = "batch")]
    pub verbose: bool,

    /// Add the expected error of ε_t and the distance of the itinerary from changing
    #[arg(long, help_heading = "Output")]
    pub estimate: bool,

    /// Picture of the forces and the velocity of one collision, which is printed as well
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

    /// The course of one collision.
    #[command(flatten, next_help_heading = "Output")]
    pub course: CourseArguments,

    /// A file of collisions.
    #[command(flatten)]
    pub batch: BatchArguments,
}

/// Computes one collision or those of a file.
pub fn run(arguments: &CollideArguments) -> Result<(), Failure> {
    let CollisionArguments { mu, alpha, damping, e_n } = arguments.collision;
    let CollideArguments { kappa, psi, ratio, .. } = *arguments;
    let (law, tangential) = arguments.law.chosen()?;
    let engine = arguments.method.engine((law, tangential))?;
    let tangential_damping = arguments.law.tangential_damping;
    let given = Given { kappa, psi, ratio, mu, alpha, damping, e_n, tangential_damping, law };
    let law_file = law::file(arguments.law.law.as_deref());
    match arguments.batch.files(&[law_file])? {
        Some(files) => many(files, &given, engine, arguments.estimate),
        None => one(&contact(&given)?, &engine, arguments),
    }
}

/// Computes one collision, draws it and writes its course if that is wanted, and prints it.
fn one(contact: &Contact, engine: &Engine, arguments: &CollideArguments) -> Result<(), Failure> {
    let plot = arguments.plot.as_ref();
    let law_file = law::file(arguments.law.law.as_deref());
    let animate = arguments.animate.as_ref();
    let outputs = [plotted(plot), ("--animate", animate.map(AnimationFile::path))];
    require_different(&outputs, &[law_file])?;
    let course = arguments.course.file(&outputs, &[law_file])?;
    let failed = |source| CollisionFailure::new(contact, source);
    plot.map_or(Ok(()), PictureFile::probe)?;
    animate.map_or(Ok(()), AnimationFile::probe)?;
    course.map_or(Ok(()), Course::probe)?;
    let followed = plot.is_some() || animate.is_some() || course.is_some();
    let (collision, statistics, history) = if followed {
        let (collision, statistics, history) = engine.followed(*contact).map_err(failed)?;
        (collision, statistics, Some(history))
    } else {
        let (collision, statistics) = engine.collide(*contact).map_err(failed)?;
        (collision, statistics, None)
    };
    collision.energy.require_finite().map_err(|error| failed(error.into()))?;
    let estimate = arguments.estimate.then(|| engine.estimate(&collision));
    let estimate = estimate.transpose().map_err(failed)?;
    if let Some(history) = &history {
        let draw =
            |plot: &PictureFile| plot.write(Ok(pictures::collision::draw(&collision, history)));
        let picture = plot.map(draw).transpose()?;
        let course = course.map(|course| course.scaled(&collision, history)).transpose()?;
        let film =
            |file: &AnimationFile| file.write(pictures::collision::frames(&collision, history));
        let animation = animate.map(film).transpose()?;
        deliver(picture.into_iter().chain(animation).chain(course), "")?;
    }
    let (estimate, statistics) = (estimate.as_ref(), statistics.as_ref());
    print(|out| match arguments.format {
        Format::Json => {
            let details = (estimate, statistics);
            json::write(out, document::COLLISION, &collision, engine, details)
        }
        Format::Table => {
            let work = statistics.filter(|_| arguments.verbose);
            text::write(out, engine, &collision, (estimate, work))
        }
    })
}

/// Computes the collisions of a file.
fn many(
    files: BatchFiles<'_>,
    given: &Given,
    engine: Engine,
    estimate: bool,
) -> Result<(), Failure> {
    let work = Collisions { engine, estimate };
    let columns = Columns::of_collisions(work.names());
    let input = Input::open(files.input, |header| columns.recipe(header, given))?;
    batch::run(files, input, &work, &format!(" by {}", text::describe(&engine)))
}

/// Collisions in scaled parameters.
struct Collisions {
    engine: Engine,
    /// Whether errors are estimated.
    estimate: bool,
}

/// The columns of results with estimates.
const ESTIMATED: [&str; RESULTS.len() + ESTIMATES.len()] = {
    let mut names = [""; RESULTS.len() + ESTIMATES.len()];
    names.split_at_mut(RESULTS.len()).0.copy_from_slice(&RESULTS);
    names.split_at_mut(RESULTS.len()).1.copy_from_slice(&ESTIMATES);
    names
};

impl Collisions {
    fn names(&self) -> &'static [&'static str] {
        if self.estimate { &ESTIMATED } else { &RESULTS }
    }
}

impl Work for Collisions {
    type Case = Contact;

    fn results(&self) -> &[&'static str] {
        self.names()
    }

    fn events(&self) -> &'static [&'static str] {
        &EVENTS
    }

    fn switches(&self, contact: &Contact) -> f64 {
        // Without damping their number grows as √κ t_c/π.
        contact.kappa().sqrt()
    }

    fn write(
        &self,
        contact: &Contact,
        results: &mut Rows,
        wanted: Option<(&mut Rows, u64)>,
    ) -> Result<bool, String> {
        let (collision, _) = self.engine.collide(*contact).map_err(|error| error.to_string())?;
        let estimate = self.estimate.then(|| self.engine.estimate(&collision));
        let complete = !matches!(estimate, Some(Err(_)));
        match estimate {
            None => rows::write_collision(results, &collision, "ok"),
            Some(Ok(estimate)) => {
                rows::write_collision(results, &collision, "ok");
                rows::write_estimate(results, &estimate);
            }
            Some(Err(error)) => {
                let status = format!("no estimate: {error}");
                rows::write_collision(results, &collision, &status);
                results.fields([""; ESTIMATES.len()]);
            }
        }
        if let Some((events, number)) = wanted {
            rows::write_switches(events, number, &collision);
        }
        Ok(complete)
    }
}

/// What `collide --help` says first.
const ABOUT: &str = "\
Compute one collision, or a file of them: the coefficients of restitution, the switches between \
sticking and sliding, and where the energy went.

A collision is given by --kappa and exactly one of --psi and --ratio. All quantities are scaled: \
time by β^(−2/5) g_n^(−1/5), length by g_n^(4/5) β^(−2/5), with β = ρ/m; the spring and the \
tangential velocity are also divided by μ/α. Numbers are written like 18, 1.5e3 or 2/7.";

/// What `collide --help` says last.
const EXAMPLES: &str = "\
Batch files:
  The header of IN.csv names any of kappa, psi, ratio, mu, alpha, damping, e_n,
  tangential_damping; the options of the same names give what the file does not. Other columns pass through. OUT.csv
  has the columns of the input followed by eps_n, eps_t, switch_count, itinerary, contact_time, reversals, status. A row that
  cannot be computed has no results; its status says why, and the exit code is 1. Bodies that stay together by
  adhesion have no restitution, and the status adheres.

Course:
  FILE.csv of --course has the columns time, regime, side, switch, compression, normal_velocity,
  normal_force, tangential_force (F_t/μ), velocity (w) and spring (y), at times that are evenly
  spaced and at every switch, whose number, from 0, is in the column switch.

Accuracy at the default tolerances, for kappa 1e-6 to 1e6, psi 1e-10 to 10, damping up to 1e4:
  exact   1e-15 (1 + sqrt(kappa)) in eps_t, 1e-15 in the others
  dop853  2e-11 in eps_t; 4e-12 in contact_time and eps_n, relative
  dopri5  1e-7 in eps_t; 1e-9 in contact_time and eps_n, relative
  Errors of both are proportional to the tolerance. --estimate tells the error to expect of a collision.

Examples:
  stickslip collide --kappa 63 --psi 0.5
  stickslip collide --kappa 63 --psi 0.5 --plot collision.svg
  stickslip collide --kappa 63 --psi 0.5 --course course.csv --animate collision.gif
  stickslip collide --kappa 18 --ratio 1.4 --mu 0.4 --alpha 2/7 --method dop853 --verbose
  stickslip collide --kappa 18 --psi 1 --damping 0.05 --format json
  stickslip collide --kappa 18 --psi 1 --e-n 0.9 --law gran/hertz/history
  stickslip collide --kappa 18 --psi 1 --law granular/jkr/viscoelastic/mindlin --pull-off 0.2
  stickslip collide --kappa 18 --psi 1.99 --estimate
  stickslip collide --batch IN.csv --out OUT.csv --events EV.csv --threads 4
  stickslip collide --batch PSI.csv --kappa 18 > OUT.csv

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
