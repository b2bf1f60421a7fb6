//! An orbit from a draft, by the one search for points at which conditions hold.

use nalgebra::{DMatrix, DVector, Dyn};
use stickslip_tracer::conditions::{Limits, Unsolved, Zero, solve};

use crate::equations::{Equations, Evaluation};
use crate::error::OrbitError;

/// Updates that stagnate below this are errors of the flow.
const STALLED: f64 = 1e-9;

/// The limits of a search over unknowns of size 1.
const LIMITS: Limits = Limits {
    stride: 0.5,
    stalled: STALLED,
    square: 1e-9,
    retreat: 1e-6,
    ..Limits::new(30.0, 1e-14)
};

/// A further condition, which is 0: its value and its derivatives at a place.
pub(crate) type Condition<'a> = &'a dyn Fn(&DVector<f64>) -> (f64, DVector<f64>);

/// The place near `start` where the equations hold, and further conditions, one for each active
/// parameter.
///
/// # Errors
/// [`OrbitError`]: there is none nearby, or a segment cannot be computed.
pub(crate) fn correct(
    equations: &Equations,
    start: &DVector<f64>,
    conditions: &[Condition<'_>],
) -> Result<Zero<Dyn>, OrbitError> {
    search(equations, start, |place, _| Ok(all(equations.at(place)?, place, conditions)))
}

/// Values of conditions, and their derivatives.
type Local = (DVector<f64>, Option<DMatrix<f64>>);

/// As [`correct`], for any conditions near those of an orbit: they are given a place, whose further
/// unknowns follow those of the orbit, and whether derivatives are asked for.
///
/// # Errors
/// As there.
pub(crate) fn search(
    equations: &Equations,
    start: &DVector<f64>,
    mut conditions: impl FnMut(&DVector<f64>, bool) -> Result<Local, OrbitError>,
) -> Result<Zero<Dyn>, OrbitError> {
    let mut failed = None;
    let found = solve(start, &LIMITS, |place, wanted| match conditions(place, wanted) {
        Ok(local) => Ok::<_, OrbitError>(Some(local)),
        // Some places on the way have no flow: half of the way is taken back.
        Err(error @ OrbitError::Run { .. }) => {
            failed = Some(error);
            Ok(None)
        }
        Err(error) => Err(error),
    })?;
    found.map_err(|unsolved| {
        let (reason, at, update) = match unsolved {
            Unsolved::Leaves => ("the search leads far away", None, f64::INFINITY),
            Unsolved::Dependent => (
                "orbits nearby are not isolated, or the equations do not determine one",
                None,
                f64::NAN,
            ),
            Unsolved::Ceases { at, update } => match failed.take() {
                Some(error) => return error,
                None => ("the flow ends", Some(at), update),
            },
            Unsolved::Slow { at, update } => ("updates do not become short", Some(at), update),
        };
        let moved = at.map(|at| (at - start).rows(0, equations.count()).icamax());
        let segment = moved.map_or(0, |unknown| equations.segment_of(unknown));
        OrbitError::NotFound { reason, segment, update }
    })
}

/// The values and derivatives of all conditions.
fn all(
    Evaluation { values, slopes, .. }: Evaluation,
    place: &DVector<f64>,
    conditions: &[Condition<'_>],
) -> Local {
    let (count, more) = (values.len(), conditions.len());
    let mut values = values.insert_rows(count, more, 0.0);
    let mut slopes = slopes.insert_rows(count, more, 0.0);
    for (k, condition) in conditions.iter().enumerate() {
        let (value, by) = condition(place);
        values[count + k] = value;
        slopes.row_mut(count + k).copy_from(&by.transpose());
    }
    (values, Some(slopes))
}
