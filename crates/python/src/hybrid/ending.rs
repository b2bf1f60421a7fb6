//! How a run ended.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyDictMethods};
use stickslip_solver::dynamic::DynamicRun;
use stickslip_solver::sliding::Refusal;
use stickslip_solver::{Outcome, RunError};

use crate::hybrid::Regime;
use crate::hybrid::system::System;

/// How a run ended, in words.
pub struct Ending {
    /// The outcome's name.
    outcome: &'static str,
    /// 0 at the end of the span, 1 at a terminal guard, and else −1.
    status: i32,
    /// The place where switches accumulate.
    accumulation: Option<f64>,
    pub message: String,
}

impl Ending {
    /// The ending of a run, which may have led to where the solution does not go on.
    pub fn new(
        system: &System,
        run: &Result<DynamicRun<Regime>, RunError>,
        refusal: Option<(f64, Refusal)>,
    ) -> Self {
        let ending = |outcome, status, message: String| Self {
            outcome,
            status,
            accumulation: None,
            message,
        };
        let run = match run {
            Ok(run) => run,
            Err(error @ RunError::Cycle { .. }) => {
                return ending("instant_limit", -1, reason(system, error));
            }
            Err(RunError::Field { .. }) if let Some((s, refusal)) = refusal => {
                return ending("failed", -1, format!("At t = {s:?}, {refusal}."));
            }
            Err(error) => return ending("failed", -1, reason(system, error)),
        };
        let s = run.s;
        match run.outcome {
            Outcome::ReachedEnd => ending("reached_end", 0, "The end was reached.".into()),
            Outcome::EndedByGuard { guard } => {
                let (mode, _) = system.regime(run.mode.own);
                let guard = system.guard_label(mode, guard);
                ending("ended_by_guard", 1, format!("At t = {s:?}, {guard} ended the run."))
            }
            Outcome::StepLimit => {
                ending("step_limit", -1, format!("Stopped at t = {s:?}: too many steps."))
            }
            Outcome::SwitchLimit => ending(
                "switch_limit",
                -1,
                format!("Stopped at t = {s:?}: max_switches was reached."),
            ),
            Outcome::Zeno { accumulation } => Self {
                accumulation: Some(accumulation),
                ..ending(
                    "zeno",
                    -1,
                    format!("Stopped at t = {s:?}: the switches accumulate at {accumulation:?}."),
                )
            },
            Outcome::Stopped => ending("stopped", -1, format!("Stopped at t = {s:?}.")),
        }
    }

    /// Adds the ending and the work to `columns`.
    pub fn describe(
        self,
        columns: &Bound<'_, PyDict>,
        run: &Result<DynamicRun<Regime>, RunError>,
    ) -> PyResult<()> {
        columns.set_item("outcome", self.outcome)?;
        columns.set_item("status", self.status)?;
        columns.set_item("message", self.message)?;
        columns.set_item("accumulation", self.accumulation)?;
        columns.set_item("decided", run.as_ref().is_ok_and(|run| run.decided))?;
        let statistics = PyDict::new(columns.py());
        if let Ok(run) = run {
            let work = run.statistics;
            statistics.set_item("accepted", work.accepted)?;
            statistics.set_item("rejected", work.rejected)?;
            statistics.set_item("too_coarse", work.too_coarse)?;
            statistics.set_item("field", work.field)?;
            statistics.set_item("guards", work.guards)?;
            statistics.set_item("resteps", work.resteps)?;
            statistics.set_item("isolations", work.isolations)?;
            statistics.set_item("switches", work.switches)?;
        }
        columns.set_item("statistics", statistics)
    }
}

/// Why a run failed, with the names of its functions.
fn reason(system: &System, error: &RunError) -> String {
    let mode = system.last_mode();
    let field = system.field_label(mode);
    match *error {
        RunError::Cycle { s, count, ref cycle } => {
            // Regimes are numbers here, before the sides of surfaces.
            let label = |(guard, regime): &(usize, String)| {
                let number = regime.split(' ').next().and_then(|number| number.parse().ok());
                number.map_or_else(
                    || regime.clone(),
                    |regime| system.guard_label(system.regime(regime).0, *guard).to_owned(),
                )
            };
            format!(
                "At t = {s:?}, {count} transitions follow each other and no time passes: {}, again \
                 and again. Guards may contradict each other, or the state has to slide.",
                cycle.iter().map(label).collect::<Vec<_>>().join(", ")
            )
        }
        RunError::Schedule { s } => format!("After t = {s:?}, a clock has no valid next time."),
        RunError::Span { from, to } => format!("no run leads from t = {from:?} to t = {to:?}"),
        RunError::State { s, component } => {
            format!("At t = {s:?}, component {component} of the state is not finite.")
        }
        RunError::Field { s, .. } => format!("Near t = {s:?}, {field} is not finite."),
        RunError::Tolerance { s, h, .. } => {
            format!("Near t = {s:?}, {field} does not meet the tolerance, even on a step of {h:e}.")
        }
        RunError::GuardNotANumber { guard, s } => {
            format!("Near t = {s:?}, {} is not a number.", system.guard_label(mode, guard))
        }
        RunError::GuardIdenticallyZero { guard, s } => format!(
            "From t = {s:?}, {} is zero throughout a step, or its rounding hides that it is not, so \
             that no crossing has a meaning.",
            system.guard_label(mode, guard)
        ),
        RunError::GuardUnresolved { guard, s, h } => format!(
            "Near t = {s:?}, {} is not resolved by a step of {h:e}: it is not smooth, or starts \
             from a zero of another order than from_zero says.",
            system.guard_label(mode, guard)
        ),
        _ => error.to_string(),
    }
}
