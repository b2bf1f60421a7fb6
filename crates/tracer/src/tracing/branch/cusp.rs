//! Cusps, where the extremum that a branch follows merges with another one on its zero.
//!
//! Neither extremum exists beyond a cusp. On one branch the margin ends with the power 3/2 of the
//! distance, on the other branch it is singular: each branch alone locates the cusp to 1e-7 of the
//! window or worse. What makes the extrema merge is smooth, and a family may know it
//! ([`Family::cusps`]). Then the cusp is solved for.

use crate::cubic::Cubic;
use crate::curve::VertexKind;
use crate::family::Family;
use crate::tracing::branch::track::{FootholdOf, Track};
use crate::tracing::corrector::crossing;
use crate::tracing::end::Special;
use crate::tracing::runs::Traced;
use crate::window::Point;

/// The cusps ahead of `from`, within `reach` or close by, for which the family knows what vanishes
/// there: each place and the largest error of the place, nearest first.
pub(crate) fn ahead<F: Family>(
    track: &Track<'_, '_, F>,
    from: &FootholdOf<F>,
    reach: f64,
) -> Traced<Vec<(Point, f64)>, F> {
    let runs = track.runs;
    let (start, along) = (from.node.point, from.node.tangent);
    let reach = reach.max(runs.lengths.close);
    let mut places = Vec::new();
    for [one, two] in runs.cusps(&track.margin) {
        let found = crossing(runs, [&one, &two], &start, &along, runs.lengths.scale, reach)?;
        places.extend(found.filter(|(point, _)| (point - start).dot(&along) > 0.0));
    }
    let progress = |point: &Point| (point - start).dot(&along);
    places.sort_by(|(one, _), (two, _)| progress(one).total_cmp(&progress(two)));
    Ok(places)
}

/// The cusp into which a branch leads beyond `from`, where even the shortest step fails; `None` if
/// there is none. The wedge before the cusp is thinner than runs can resolve, in a window with
/// unequal sides even far from the cusp.
pub(crate) fn beyond<F: Family>(
    track: &Track<'_, '_, F>,
    from: &FootholdOf<F>,
) -> Traced<Option<Special<F::Margin>>, F> {
    for (point, uncertainty) in ahead(track, from, track.runs.lengths.scale)? {
        let arc = Cubic::between(&from.node, &track.end_node(&from.node, &point)?);
        if follows(track, from, &arc, track.runs.options.interpolation)? {
            return Ok(Some(end(track, point, uncertainty)));
        }
    }
    Ok(None)
}

/// Whether the boundary that a branch follows is no farther than `error` from `arc`.
fn follows<F: Family>(
    track: &Track<'_, '_, F>,
    from: &FootholdOf<F>,
    arc: &Cubic,
    error: f64,
) -> Traced<bool, F> {
    let floor = error * from.gradient.norm() + track.runs.options.noise;
    for theta in [0.3, 0.7] {
        let value = track.runs.margin(&arc.at(theta), &track.margin)?;
        if value.is_none_or(|value| value.abs() > floor) {
            return Ok(false);
        }
    }
    Ok(true)
}

/// The end of a branch in a cusp.
fn end<F: Family>(track: &Track<'_, '_, F>, point: Point, uncertainty: f64) -> Special<F::Margin> {
    let (kind, margins) = (VertexKind::Degenerate, vec![track.margin.clone()]);
    Special { point, kind, margins, uncertainty, solved: true }
}

/// The end of a branch in a cusp ahead of `from`; `None` if the cusp is too far away.
///
/// Towards a cusp a boundary bends ever more, and its margin ceases to exist. So the cusp ends the
/// branch only if the cubic that leads into it is as close to the boundary as the options ask, or
/// if its wedge is too thin for labels and it is no farther from the boundary than places that
/// count as one.
pub(crate) fn reached<F: Family>(
    track: &Track<'_, '_, F>,
    from: &FootholdOf<F>,
    (point, uncertainty): (Point, f64),
) -> Traced<Option<Special<F::Margin>>, F> {
    let runs = track.runs;
    let arc = Cubic::between(&from.node, &track.end_node(&from.node, &point)?);
    let tip = arc.chord() <= runs.lengths.close;
    let error = runs.options.interpolation.max(if tip { runs.lengths.same } else { 0.0 });
    if !follows(track, from, &arc, error)? {
        return Ok(None);
    }
    for theta in [0.3, 0.5, 0.7] {
        if !tip && !track.holds(from, &arc.at(theta), 0.3 * arc.chord())? {
            return Ok(None);
        }
    }
    Ok(Some(end(track, point, uncertainty)))
}
