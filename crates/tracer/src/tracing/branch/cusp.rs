//! Cusps, where the extremum that a branch follows merges with another one on its zero.

use crate::cubic::Cubic;
use crate::curve::VertexKind;
use crate::family::Family;
use crate::tracing::branch::track::{FootholdOf, Track};
use crate::tracing::corrector::crossing;
use crate::tracing::end::{SHORTEST, Special};
use crate::tracing::runs::Traced;
use crate::window::Point;

/// The length of a cubic into a cusp, as a fraction of the window's shorter extent, up to which
/// nothing else is looked for on it: the wedge of a cusp may be too thin for labels there.
const TIP: f64 = 1e-5;

/// The cusps ahead of `from`, within twice a failed step of length `h` or close by, for which the
/// family knows what vanishes there: each place and the largest error of the place, nearest first.
pub(crate) fn ahead<F: Family>(
    track: &Track<'_, '_, F>,
    from: &FootholdOf<F>,
    h: f64,
) -> Traced<Vec<(Point, f64)>, F> {
    let runs = track.runs;
    let (start, along) = (from.node.point, from.node.tangent);
    let reach = (2.0 * h).max(TIP * runs.scale);
    let mut places = Vec::new();
    for [one, two] in runs.cusps(&track.margin) {
        let found = crossing(runs, [&one, &two], &start, &along, runs.scale, reach)?;
        places.extend(found.filter(|(point, _)| (point - start).dot(&along) > 0.0));
    }
    let progress = |point: &Point| (point - start).dot(&along);
    places.sort_by(|(one, _), (two, _)| progress(one).total_cmp(&progress(two)));
    Ok(places)
}

/// The end of a branch in a cusp ahead of `from`; `None` if the cusp is too far away.
///
/// Towards a cusp a boundary bends ever more, and its margin ceases to exist. So the cusp ends the
/// branch only where the cubic that leads into it is as close to the boundary as the options ask,
/// or shorter than [`TIP`] and no farther from it than places that count as one.
pub(crate) fn reached<F: Family>(
    track: &Track<'_, '_, F>,
    from: &FootholdOf<F>,
    (point, uncertainty): (Point, f64),
) -> Traced<Option<Special<F::Margin>>, F> {
    let runs = track.runs;
    let arc = Cubic::between(&from.node, &track.end_node(&from.node, &point)?);
    let tip = arc.chord() <= TIP * runs.scale;
    let error = runs.options.interpolation.max(if tip { SHORTEST * runs.scale } else { 0.0 });
    let floor = error * from.gradient.norm() + runs.options.noise;
    for theta in [0.3, 0.7] {
        let value = runs.margin(&arc.at(theta), &track.margin)?;
        let close = value.is_some_and(|value| value.abs() <= floor);
        if !close {
            return Ok(None);
        }
    }
    for theta in [0.3, 0.5, 0.7] {
        if !tip && !track.holds(from, &arc.at(theta), 0.3 * arc.chord())? {
            return Ok(None);
        }
    }
    let (kind, margins) = (VertexKind::Degenerate, vec![track.margin.clone()]);
    Ok(Some(Special { point, kind, margins, uncertainty, solved: true }))
}
