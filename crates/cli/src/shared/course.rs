//! The course of a collision in time, as a CSV file.

use std::path::{Path, PathBuf};

use clap::builder::TypedValueParser;
use stickslip_files::output::csv::CsvFile;
use stickslip_files::output::file::StoredFile;
use stickslip_model::history::{History, Moment, Snapshot};
use stickslip_model::spheres::{Encounter, ForceSnapshot};
use stickslip_model::{Collision, Regime, Side};

use super::files::{Named, require_different};
use crate::error::Failure;
use crate::output::console::say;

/// The columns of a course in scaled variables.
const SCALED: [&str; 10] = [
    "time",
    "regime",
    "side",
    "switch",
    "compression",
    "normal_velocity",
    "normal_force",
    "tangential_force",
    "velocity",
    "spring",
];
/// The columns of a course in SI units.
const IN_SI: [&str; 10] = [
    "time_s",
    "regime",
    "side",
    "switch",
    "compression_m",
    "normal_velocity_m_per_s",
    "normal_force_n",
    "tangential_force_n",
    "velocity_m_per_s",
    "spring_m",
];

/// Where the course is written, and how dense it is.
#[derive(Clone, Debug, clap::Args)]
pub struct CourseArguments {
    /// CSV file for forces, overlap and velocities against time, at even times and every switch
    #[arg(long, value_name = "FILE.csv", help_heading = "Output", conflicts_with = "batch")]
    pub course: Option<PathBuf>,

    /// Number of even times of --course, with the start and the end; 2 to 10000000
    #[arg(long, value_name = "N", help_heading = "Output", requires = "course")]
    #[arg(default_value_t = 1000, allow_hyphen_values = true)]
    #[arg(value_parser = points())]
    pub points: usize,
}

impl CourseArguments {
    /// Where the course is written, beside other outputs and inputs; `None` if it is not wanted.
    pub fn file(&self, others: &[Named], inputs: &[Named]) -> Result<Option<Course<'_>>, Failure> {
        let Some(path) = &self.course else { return Ok(None) };
        require_different(&[others, &[("--course", Some(&**path))]].concat(), inputs)?;
        Ok(Some(Course { path, points: self.points }))
    }
}

/// Reads a number of times.
pub fn points() -> impl TypedValueParser<Value = usize> {
    clap::value_parser!(u32).range(2..=10_000_000).map(|points| points as usize)
}

/// The file of a course.
#[derive(Clone, Copy, Debug)]
pub struct Course<'a> {
    path: &'a Path,
    /// Number of even times, at least two.
    points: usize,
}

impl Course<'_> {
    /// Makes sure that the file can be written, before there is work to lose.
    pub fn probe(self) -> Result<(), Failure> {
        Ok(CsvFile::probe(self.path)?)
    }

    /// Writes the course of `collision` in scaled variables, all but the name of the file.
    pub fn scaled(self, collision: &Collision, history: &History) -> Result<StoredFile, Failure> {
        warn(collision, history);
        let number = |snapshot: &Snapshot| {
            let Snapshot { time, compression, normal_velocity, normal_force, .. } = *snapshot;
            let Snapshot { tangential_force, velocity, spring, .. } = *snapshot;
            let others = [compression, normal_velocity, normal_force, tangential_force, velocity];
            (time, others, Some(spring))
        };
        self.write(&SCALED, history.moments(self.points - 1), number)
    }

    /// Writes the course of `collision`, that of `encounter`, in SI units, all but the name of the
    /// file.
    pub fn in_si(
        self,
        encounter: &Encounter,
        (collision, history): (&Collision, &History),
    ) -> Result<StoredFile, Failure> {
        let central = encounter.is_central();
        if !central {
            warn(collision, history);
        }
        let moments = history.moments(self.points - 1).filter_map(|moment| match moment.switch {
            // Nothing slides in a central impact, whose contact stands for another one.
            Some(_) if central => None,
            _ if central => Some(Moment { regime: Regime::Stick, side: Side::Positive, ..moment }),
            _ => Some(moment),
        });
        let number = |snapshot: &Snapshot| {
            let moment = encounter.snapshot(snapshot);
            let ForceSnapshot { compression_m, normal_velocity_m_per_s, normal_force_n, .. } =
                moment;
            let ForceSnapshot { tangential_force_n, velocity_m_per_s, spring_m, .. } = moment;
            let others = [
                compression_m,
                normal_velocity_m_per_s,
                normal_force_n,
                tangential_force_n,
                velocity_m_per_s,
            ];
            (moment.time_s, others, spring_m)
        };
        self.write(&IN_SI, moments, number)
    }

    fn write(
        self,
        header: &[&str],
        moments: impl Iterator<Item = Moment>,
        numbers: impl Fn(&Snapshot) -> (f64, [f64; 5], Option<f64>),
    ) -> Result<StoredFile, Failure> {
        let mut file = CsvFile::create(self.path)?;
        file.rows.fields(header);
        file.end()?;
        for Moment { snapshot, regime, side, switch } in moments {
            let (time, others, spring) = numbers(&snapshot);
            let rows = &mut file.rows;
            rows.number(time);
            rows.field(regime.name());
            rows.field(side_name(side));
            match switch {
                Some(switch) => rows.count(switch),
                None => rows.field(""),
            }
            for value in others {
                rows.number(value);
            }
            match spring {
                Some(spring) => rows.number(spring),
                None => rows.field(""),
            }
            file.end()?;
        }
        Ok(file.store()?)
    }
}

/// Says so if the course has other switches than the collision.
fn warn(collision: &Collision, history: &History) {
    let switches = history.phases().len() - 1;
    if switches != collision.switches.len() {
        say(format_args!(
            "warning: the course has {switches} switches, the collision {}: it nearly grazes",
            collision.switches.len()
        ));
    }
}

fn side_name(side: Side) -> &'static str {
    match side {
        Side::Positive => "1",
        Side::Negative => "-1",
    }
}
