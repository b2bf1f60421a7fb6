//! The study of a system of one's own: how errors fall with the tolerance, and what they cost.

use rayon::prelude::*;
use serde_json::json;
use stickslip_expression::{Recording, Runnable, System, outcome_name};
use stickslip_plane::progress::{Progress, Report};
use stickslip_solver::dynamic::DynamicSwitch;
use stickslip_solver::{EmbeddedPair, Options, Outcome, RunError, Statistics};

use crate::error::StudyError;
use crate::study::{Cell, Study, StudyColumn, StudyTable};

/// The name of the layout of the JSON, with its version.
pub const SCHEMA: &str = "stickslip.system-convergence/1";

/// The tolerances, relative and absolute: 10 to the power of these.
const EXPONENTS: std::ops::RangeInclusive<i32> = -13..=-2;
/// The tolerance of the reference, and the tolerance of the run that measures its error.
const REFERENCE: [f64; 2] = [1e-15, 1e-14];
/// The methods, in the order of lines in pictures.
const METHODS: [EmbeddedPair; 2] = [EmbeddedPair::Dopri5, EmbeddedPair::Dop853];
/// Errors from which on the methods are compared by their work.
const WANTED: [f64; 2] = [1e-6, 1e-9];

/// Which run is studied.
#[derive(Clone, Debug)]
pub struct OwnSystemSettings {
    /// The name of the system in titles.
    pub name: String,
    /// The system.
    pub system: System,
    /// The same system with values for its parameters.
    pub runnable: Runnable,
    /// Where the run ends.
    pub end: f64,
}

/// A run at a tolerance, beside the reference.
#[derive(Clone, Copy, Debug)]
pub struct ComparedRun {
    /// The method.
    pub method: EmbeddedPair,
    /// The tolerance of a step, relative and absolute.
    pub tolerance: f64,
    /// How the run ended.
    pub outcome: &'static str,
    /// The number of events.
    pub events: usize,
    /// Whether the same rules act in the same modes and order.
    pub same: bool,
    /// The largest |Δy|/(1 + |y|) of a component at the end; NaN if the events are others.
    pub state: f64,
    /// The largest |Δt| of an event, and of the end; NaN if the events are others.
    pub time: f64,
    /// The work of the run.
    pub work: Statistics,
}

/// Makes the study on the threads of the current pool.
///
/// # Errors
/// [`StudyError::Run`]: the reference cannot be computed.
pub fn run(
    settings: &OwnSystemSettings,
    progress: Report<'_>,
) -> Result<SystemConvergence, StudyError> {
    let tasks: Vec<(EmbeddedPair, f64)> = METHODS
        .iter()
        .flat_map(|method| EXPONENTS.rev().map(|power| (*method, 10_f64.powi(power))))
        .collect();
    progress(Progress::Begin { steps: REFERENCE.len() + tasks.len() });
    let attempt = |method, tolerance| {
        let options = Options::with_tolerance(tolerance);
        let found = settings.runnable.record(method, settings.end, &options);
        progress(Progress::Advance { steps: 1 });
        found
    };
    let reference = attempt(EmbeddedPair::Dop853, REFERENCE[0])
        .map_err(|error| StudyError::Run(settings.system.explained(&error)))?;
    let beside = attempt(EmbeddedPair::Dop853, REFERENCE[1]);
    let doubt = ComparedRun::new(EmbeddedPair::Dop853, REFERENCE[1], &beside, &reference);
    let row = |&(method, tolerance): &(EmbeddedPair, f64)| {
        ComparedRun::new(method, tolerance, &attempt(method, tolerance), &reference)
    };
    let rows = tasks.par_iter().map(row).collect();
    Ok(SystemConvergence { settings: settings.clone(), reference, doubt, rows })
}

impl ComparedRun {
    fn new(
        method: EmbeddedPair,
        tolerance: f64,
        found: &Result<Recording, RunError>,
        reference: &Recording,
    ) -> Self {
        let (state, time, work) = (f64::NAN, f64::NAN, Statistics::default());
        let none = Self {
            method,
            tolerance,
            outcome: "failed",
            events: 0,
            same: false,
            state,
            time,
            work,
        };
        let Ok(found) = found else { return none };
        let (run, right) = (&found.run, &reference.run);
        let outcome = outcome_name(run.outcome);
        let key = |event: &DynamicSwitch<usize>| (event.from, event.guard, event.to);
        let pairs = || found.events.iter().zip(&reference.events);
        // Where events accumulate, their number is a matter of rounding.
        let accumulates =
            |run: Outcome| matches!(run, Outcome::Zeno { .. }) || !found.rests.is_empty();
        let as_many = found.events.len() == reference.events.len()
            || (accumulates(run.outcome) && outcome == outcome_name(right.outcome));
        let same = as_many
            && outcome == outcome_name(right.outcome)
            && pairs().all(|(one, other)| key(one) == key(other));
        let (events, work) = (found.events.len(), run.statistics);
        if !same {
            return Self { outcome, events, work, ..none };
        }
        let off = |(one, other): (&f64, &f64)| (one - other).abs() / (1.0 + other.abs());
        let state = run.state.iter().zip(&right.state).map(off).fold(0.0, f64::max);
        let times = pairs().map(|(one, other)| (one.s - other.s).abs());
        let time = times.fold((run.s - right.s).abs(), f64::max);
        Self { outcome, events, same, state, time, work, ..none }
    }

    /// The larger one of the two errors.
    fn error(&self) -> f64 {
        if self.same { self.state.max(self.time) } else { f64::NAN }
    }
}

/// How the errors of a run fall with the tolerance.
#[derive(Clone, Debug)]
pub struct SystemConvergence {
    /// The run.
    pub settings: OwnSystemSettings,
    /// The run that others are compared with.
    pub reference: Recording,
    /// The run that measures the error of the reference.
    pub doubt: ComparedRun,
    /// The runs at all tolerances, by method, from coarse to fine.
    pub rows: Vec<ComparedRun>,
}

impl SystemConvergence {
    /// The study: findings, numbers and tables.
    pub fn study(&self) -> Study {
        let tables = vec![self.tolerances(), self.events()];
        let json = json!({
            "schema": SCHEMA,
            "system": self.settings.name,
            "reference": {
                "method": "dop853", "tolerance": REFERENCE[0],
                "outcome": outcome_name(self.reference.run.outcome),
                "end_time": self.reference.run.s, "end_state": self.reference.run.state,
                "state_error": finite(self.doubt.state), "time_error": finite(self.doubt.time),
            },
            "tolerances": tables[0].json(),
            "events": tables[1].json(),
        });
        Study {
            name: "convergence",
            title: "Convergence of a system",
            headlines: Vec::new(),
            findings: self.findings(),
            json,
            tables,
        }
    }

    /// The runs of a method, from coarse to fine.
    pub fn of(&self, method: EmbeddedPair) -> impl Iterator<Item = &ComparedRun> {
        self.rows.iter().filter(move |row| row.method == method)
    }

    fn findings(&self) -> Vec<String> {
        let name = &self.settings.name;
        let count = match self.reference.events.len() {
            1 => "1 event".to_owned(),
            count => format!("{count} events"),
        };
        let mut findings = vec![if self.doubt.same {
            format!(
                "The reference of `{name}` is dop853 at a tolerance of {:.0e}: {count}. At \
                 {:.0e} the state is {:.1e} and an event {:.1e} beside it.",
                REFERENCE[0], REFERENCE[1], self.doubt.state, self.doubt.time
            )
        } else {
            format!(
                "The reference of `{name}` is in doubt: dop853 finds {count} at a tolerance \
                 of {:.0e}, and others at {:.0e}.",
                REFERENCE[0], REFERENCE[1]
            )
        }];
        for method in METHODS {
            let others: Vec<&ComparedRun> = self.of(method).filter(|row| !row.same).collect();
            let name = method.name();
            findings.push(match others.last() {
                None => format!("{name} finds the same events at every tolerance."),
                Some(last) => format!(
                    "{name} finds other events at {} of {} tolerances, the smallest of them {:.0e}.",
                    others.len(),
                    EXPONENTS.count(),
                    last.tolerance
                ),
            });
            for wanted in WANTED {
                let enough = self.of(method).find(|row| row.error() <= wanted);
                findings.extend(enough.map(|row| {
                    format!(
                        "{name} has errors below {wanted:.0e} at a tolerance of {:.0e}, with {} \
                         right-hand sides.",
                        row.tolerance, row.work.field
                    )
                }));
            }
        }
        findings
    }

    fn tolerances(&self) -> StudyTable {
        let columns = vec![
            StudyColumn::new("method", "dop853 or dopri5"),
            StudyColumn::new("tolerance", "relative and absolute tolerance of a step"),
            StudyColumn::new("outcome", "how the run ended, as of the command run"),
            StudyColumn::new("events", "number of events"),
            StudyColumn::new("same_events", "1 if the same rules act in the same order, else 0"),
            StudyColumn::new("state_error", "largest |Δy|/(1 + |y|) of a component at the end"),
            StudyColumn::new("time_error", "largest error of the time of an event, and of the end"),
            StudyColumn::new("steps", "accepted steps"),
            StudyColumn::new("rejected", "rejected steps"),
            StudyColumn::new("right_hand_sides", "evaluations of the right-hand side"),
        ];
        let row = |row: &ComparedRun| -> Vec<Cell> {
            vec![
                row.method.name().into(),
                row.tolerance.into(),
                row.outcome.into(),
                row.events.into(),
                usize::from(row.same).into(),
                row.state.into(),
                row.time.into(),
                row.work.accepted.into(),
                (row.work.rejected + row.work.too_coarse).into(),
                row.work.field.into(),
            ]
        };
        let title = "Errors and work at tolerances".to_owned();
        let rows = self.rows.iter().map(row).collect();
        StudyTable { name: "convergence_tolerances", title, columns, rows }
    }

    fn events(&self) -> StudyTable {
        let columns = vec![
            StudyColumn::new("event", "name of the rule"),
            StudyColumn::new("time", "when it acts, in the reference"),
            StudyColumn::new("mode_before", "mode before the event"),
            StudyColumn::new("mode_after", "mode after the event"),
        ];
        let modes = &self.settings.system.modes;
        let row = |event: &DynamicSwitch<usize>| -> Vec<Cell> {
            vec![
                modes[event.from].rules[event.guard].name(event.guard).into(),
                event.s.into(),
                modes[event.from].name.as_str().into(),
                modes[event.to].name.as_str().into(),
            ]
        };
        let title = "Events of the reference".to_owned();
        let rows = self.reference.events.iter().map(row).collect();
        StudyTable { name: "convergence_events", title, columns, rows }
    }
}

/// A number, or null.
fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
