//! The course of a collision as a CSV file.

use stickslip_files::output::csv::{CsvFile, Rows};
use stickslip_files::output::file::StoredFile;
use stickslip_model::{
    Collision, Encounter, ForceSnapshot, History, Moment, Regime, Side, Snapshot,
};

use crate::error::Failure;
use crate::output::console::say;
use crate::plan::CoursePlan;

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

/// Rows are written when they are so many.
const ROWS_AT_ONCE: usize = 10_000;

/// Makes sure that the file can be written, before there is work to lose.
///
/// # Errors
/// [`Failure::File`]: the file cannot be created.
pub fn probe(plan: &CoursePlan) -> Result<(), Failure> {
    Ok(CsvFile::probe(&plan.path)?)
}

/// Writes the course of `collision` in scaled variables, all but the name of the file.
///
/// # Errors
/// [`Failure::File`]: it cannot be written.
pub fn scaled(
    plan: &CoursePlan,
    collision: &Collision,
    history: &History,
) -> Result<StoredFile, Failure> {
    warn(collision, history);
    let number = |snapshot: &Snapshot| {
        let Snapshot { time, compression, normal_velocity, normal_force, .. } = *snapshot;
        let Snapshot { tangential_force, velocity, spring, .. } = *snapshot;
        let others = [compression, normal_velocity, normal_force, tangential_force, velocity];
        (time, others, Some(spring))
    };
    write(plan, &SCALED, history.moments(plan.points - 1), number)
}

/// Writes the course of `collision`, that of `encounter`, in SI units, all but the name of the
/// file.
///
/// # Errors
/// [`Failure::File`]: it cannot be written.
pub fn in_si(
    plan: &CoursePlan,
    encounter: &Encounter,
    (collision, history): (&Collision, &History),
) -> Result<StoredFile, Failure> {
    let central = encounter.is_central();
    if !central {
        warn(collision, history);
    }
    let moments = history.moments(plan.points - 1).filter_map(|moment| match moment.switch {
        // Nothing slides in a central impact, whose contact stands for another one.
        Some(_) if central => None,
        _ if central => Some(Moment { regime: Regime::Stick, side: Side::Positive, ..moment }),
        _ => Some(moment),
    });
    let number = |snapshot: &Snapshot| {
        let moment = encounter.snapshot(snapshot);
        let ForceSnapshot { compression_m, normal_velocity_m_per_s, normal_force_n, .. } = moment;
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
    write(plan, &IN_SI, moments, number)
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

fn write(
    plan: &CoursePlan,
    header: &[&str],
    moments: impl Iterator<Item = Moment>,
    numbers: impl Fn(&Snapshot) -> (f64, [f64; 5], Option<f64>),
) -> Result<StoredFile, Failure> {
    let mut file = CsvFile::create(&plan.path)?;
    let mut rows = Rows::default();
    rows.fields(header);
    rows.end();
    for (index, Moment { snapshot, regime, side, switch }) in moments.enumerate() {
        let (time, others, spring) = numbers(&snapshot);
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
        rows.end();
        if index % ROWS_AT_ONCE == 0 {
            file.write(&rows)?;
            rows.clear();
        }
    }
    file.write(&rows)?;
    Ok(file.store()?)
}

fn side_name(side: Side) -> &'static str {
    match side {
        Side::Positive => "1",
        Side::Negative => "-1",
    }
}
