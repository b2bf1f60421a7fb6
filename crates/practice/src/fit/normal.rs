//! The damping, which follows from the normal motion alone.

use stickslip_model::restitution;

use super::FitError;
use super::axis::Axis;
use super::bodies::Units;
use super::free::Free;
use super::intervals::{ConfidenceInterval, interval, threshold};
use super::problem::Problem;
use super::scan::{Line, Lines, candidates};
use super::settings::FitSettings;

/// The fit of the damping to ε_n.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct DampingFit {
    /// Damping a at normal incidence.
    pub damping: f64,
    /// The number of data.
    pub data: usize,
    /// Whether the size of the errors was estimated from the residuals.
    pub estimated_errors: bool,
    /// Sum of the squares of the residuals over their errors.
    pub misfit: f64,
    /// The interval of the damping.
    pub interval: ConfidenceInterval,
}

/// The damping of the settings at normal incidence: fitted, given by ε_n, or taken from the bodies.
pub fn damping(
    settings: &FitSettings,
    units: &Units,
) -> Result<(f64, Option<DampingFit>), FitError> {
    if let Some(eps_n) = settings.eps_n {
        return Ok((restitution::damping(settings.bodies.pair.law, eps_n)?, None));
    }
    if !settings.free.contains(&Free::Damping) {
        return Ok((settings.bodies.values(units).damping, None));
    }
    let data: Vec<_> = settings.data_of(true).map(|(_, datum)| *datum).collect();
    let problem = Problem::new(settings.bodies, *units, data.iter());
    let axis = Axis::new(Free::Damping, settings.ranges.damping, 1.0);
    let fixed = settings.bodies.values(units);
    let lines = Lines { problem: &problem, fixed, outer: &axis, inner: None };
    let found: Result<Vec<Line>, _> = axis.places.iter().map(|at| lines.line(*at)).collect();
    let found = found?;
    let mut bottoms = Vec::new();
    for start in candidates(&found) {
        let bottom = lines.descend(start)?;
        bottoms.push((bottom.values.damping, bottom.misfit));
    }
    let best = bottoms.iter().copied().min_by(|a, b| a.1.total_cmp(&b.1));
    let (damping, misfit) = best.ok_or(FitError::NoPlaces)?;
    let estimated_errors = settings.estimates_errors(true);
    let threshold = threshold(misfit, settings.level, (data.len(), 1), estimated_errors);
    let interval = interval(&lines, &found, bottoms.into_iter(), threshold)?;
    let fit = DampingFit { damping, data: data.len(), estimated_errors, misfit, interval };
    Ok((damping, Some(fit)))
}
