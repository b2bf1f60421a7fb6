//! Boundaries that touch: special points that neither labels nor crossings of margins show.
//!
//! Found are other margins that dip to zero between the last three nodes, and boundaries that meet
//! tangentially. Two kinds of margins do not count. The events on both sides of a boundary may each
//! have a margin that vanishes there: such twins do not touch. And the value and the slope of a
//! margin do not show where it vanishes if its slope changes within the shortest differences.

use crate::cubic::Cubic;
use crate::curve::{Node, VertexKind};
use crate::family::Family;
use crate::tracing::branch::track::{Foothold, FootholdOf, Track};
use crate::tracing::corrector::{correct, crossing};
use crate::tracing::end::Special;
use crate::tracing::runs::Traced;
use crate::window::Point;

/// A special point, and whether it lies before the last foothold.
type Touch<Margin> = (Special<Margin>, bool);

/// A special point that the labels do not show: along the last two footholds and `next`, another
/// margin falls to zero and rises again.
pub(crate) fn touch<F: Family>(
    track: &Track<'_, '_, F>,
    next: &FootholdOf<F>,
) -> Traced<Option<Touch<F::Margin>>, F> {
    let [Some(first), Some(middle)] = [track.footholds.front(), track.footholds.get(1)] else {
        return Ok(None);
    };
    let lengths = [
        (middle.node.point - first.node.point).norm(),
        (next.node.point - middle.node.point).norm(),
    ];
    for margin in track.other_margins(middle, None, true) {
        let [Some(a), Some(b), Some(c)] =
            [first, middle, next].map(|foothold| value_beside(foothold, &margin))
        else {
            continue;
        };
        // The parabola through the three values must come close to zero in between.
        if b.abs() > a.abs() || b.abs() >= c.abs() {
            continue;
        }
        let rises = [(b - a) / lengths[0], (c - b) / lengths[1]];
        let bend = (rises[1] - rises[0]) / (lengths[0] + lengths[1]);
        let slope = rises[0] + bend * lengths[0];
        let lowest = b - 0.25 * slope * slope / bend;
        if b.signum() * lowest > 0.3 * a.abs().max(c.abs()) || is_twin(track, &margin)? {
            continue;
        }
        if let Some(found) = dip(track, [first, middle, next], &margin, -0.5 * slope / bend)? {
            return Ok(Some(found));
        }
    }
    Ok(None)
}

/// The value of `margin` in the free runs beside a foothold.
fn value_beside<L, M: PartialEq>(foothold: &Foothold<L, M>, margin: &M) -> Option<f64> {
    foothold
        .sides
        .iter()
        .flat_map(|run| run.margins.iter())
        .find(|(own, _)| own == margin)
        .map(|(_, value)| *value)
}

/// The place where a margin that dips along the boundary touches zero, or first crosses it. `guess`
/// is the length from the middle foothold.
///
/// The margin is lowest where its gradient is parallel to the gradient of the branch. The secant
/// method solves for this, because values near a minimum determine its place only to half the
/// digits.
fn dip<F: Family>(
    track: &Track<'_, '_, F>,
    places: [&FootholdOf<F>; 3],
    margin: &F::Margin,
    guess: f64,
) -> Traced<Option<Touch<F::Margin>>, F> {
    let runs = track.runs;
    let arcs = [
        Cubic::between(&places[0].node, &places[1].node),
        Cubic::between(&places[1].node, &places[2].node),
    ];
    let place = |length: f64| {
        if length < 0.0 {
            arcs[0].at(1.0 + length / arcs[0].chord())
        } else {
            arcs[1].at(length / arcs[1].chord())
        }
    };
    let chords = arcs.map(|arc| arc.chord());
    let start = [guess, guess + 0.1 * chords[0].min(chords[1])];
    let Some((length, last)) =
        parallel(track, place, places[1], margin, start, [-chords[0], chords[1]])?
    else {
        return Ok(None);
    };
    let gap = last.value / last.slope;
    let margins = vec![track.margin.clone(), margin.clone()];
    let special = |point, uncertainty| Special {
        point,
        kind: VertexKind::Crossing,
        margins,
        uncertainty,
        solved: true,
    };
    let floor = runs.options.interpolation.max(10.0 * runs.resolution(last.slope));
    if gap.abs() <= floor && !runs.is_singular(&last.point, margin, &places[1].node.tangent)? {
        return Ok(Some((special(last.point, runs.lengths.touch), length < 0.0)));
    }
    let beside = value_beside(places[1], margin).unwrap_or(last.value);
    if (beside < 0.0) == (gap < 0.0) {
        return Ok(None);
    }
    // The margin crosses zero twice, first between the first foothold and the lowest place.
    let before = value_beside(places[0], margin).unwrap_or(beside);
    // The zero of a parabola with its vertex at the lowest place.
    let part = (last.value.abs() / (before.abs() + last.value.abs())).sqrt();
    let start = place(length - part * (length + chords[0]));
    let tangent = &places[1].node.tangent;
    let reach = 2.0 * (chords[0] + chords[1]);
    let crossed = crossing(runs, [&track.margin, margin], &start, tangent, track.radius, reach)?;
    Ok(crossed.map(|(point, uncertainty)| {
        let along = (point - places[1].node.point).dot(&places[1].node.tangent);
        (special(point, uncertainty), along < 0.0)
    }))
}

/// A place of a branch, with what the search for the lowest value of another margin needs.
struct Probe {
    point: Point,
    /// The sine of the angle between the gradients of the two margins.
    sine: f64,
    /// The value of the other margin.
    value: f64,
    /// The length of its gradient.
    slope: f64,
}

/// A boundary that is more than this many step lengths away does not touch the branch within the
/// step.
const FAR: f64 = 10.0;

/// After this many updates the angle between boundaries that touch is at most half of the first
/// angle.
const UPDATES: usize = 5;

/// The place along a branch where the gradients of its own and of another margin are parallel, by
/// the secant method: the length up to it, and the place.
///
/// The other margin may cease to exist before that place, for instance if its extremum leaves
/// through the end of its phase. Then the result is the last place at which it exists.
fn parallel<F: Family>(
    track: &Track<'_, '_, F>,
    place: impl Fn(f64) -> Point,
    near: &FootholdOf<F>,
    margin: &F::Margin,
    start: [f64; 2],
    limits: [f64; 2],
) -> Traced<Option<(f64, Probe)>, F> {
    let runs = track.runs;
    let width = limits[1] - limits[0];
    let probe = |length: f64| -> Traced<Option<Probe>, F> {
        let reach = 0.3 * width + 100.0 * runs.options.tolerance;
        let guess = place(length);
        let Some(found) = correct(runs, &track.margin, &guess, &near.gradient, reach)? else {
            return Ok(None);
        };
        let (point, tangent) = (found.point, &near.node.tangent);
        let (Some(own), Some(other), Some(value)) = (
            runs.gradient(&point, &track.margin, tangent, track.radius)?,
            runs.gradient(&point, margin, tangent, track.radius)?,
            runs.margin(&point, margin)?,
        ) else {
            return Ok(None);
        };
        let sine = own.perp(&other) / (own.norm() * other.norm());
        Ok(Some(Probe { point, sine, value, slope: other.norm() }))
    };
    let mut length = start[0];
    let Some(mut last) = probe(length)? else { return Ok(None) };
    if last.value.abs() > FAR * width * last.slope {
        return Ok(None);
    }
    let (mut shift, first) = (start[1] - start[0], last.sine.abs());
    let mut updates = 0;
    for _ in 0..40 {
        if updates >= UPDATES && last.sine.abs() > 0.5 * first {
            return Ok(None);
        }
        let Some(now) = probe(length + shift)? else {
            shift *= 0.5;
            if shift.abs() <= runs.lengths.solved {
                return Ok(Some((length, last)));
            }
            continue;
        };
        length += shift;
        updates += 1;
        let turn = (now.sine - last.sine) / shift;
        last = now;
        shift = (length - last.sine / turn).clamp(limits[0], limits[1]) - length;
        if shift == 0.0 && (length == limits[0] || length == limits[1]) || shift.is_nan() {
            return Ok(None);
        }
        if shift.abs() <= 10.0 * runs.options.tolerance {
            return Ok(Some((length, last)));
        }
    }
    Ok(None)
}

/// Whether another margin is so close to zero beside the step that its boundary may touch the
/// branch there.
pub(crate) fn narrow<F: Family>(
    from: &FootholdOf<F>,
    beyond: Option<&FootholdOf<F>>,
    margin: &F::Margin,
    h: f64,
) -> bool {
    let values =
        [Some(from), beyond].map(|foothold| foothold.and_then(|f| value_beside(f, margin)));
    // A margin without a value beside the step was found on the other side of a wedge.
    values.iter().all(Option::is_none)
        || values.iter().flatten().any(|value| value.abs() <= h * from.gradient.norm())
}

/// The place within the step where the boundary of `margin` touches the branch.
pub(crate) fn graze<F: Family>(
    track: &Track<'_, '_, F>,
    from: &FootholdOf<F>,
    beyond: Option<&FootholdOf<F>>,
    margin: &F::Margin,
    h: f64,
) -> Traced<Option<Point>, F> {
    let end = beyond.map_or_else(
        || Node { point: track.predict(&from.node, h), tangent: from.node.tangent },
        |foothold| foothold.node,
    );
    if is_twin(track, margin)? {
        return Ok(None);
    }
    let arc = Cubic::between(&from.node, &end);
    let chord = arc.chord();
    let slack = track.runs.lengths.touch;
    for start in [[chord, 0.75 * chord], [0.0, 0.25 * chord]] {
        let place = |length: f64| arc.at(length / chord);
        let found = parallel(track, place, from, margin, start, [-slack, chord + slack])?;
        if let Some((_, probe)) = found
            && (probe.value / probe.slope).abs() <= track.runs.options.interpolation
            && !track.runs.is_singular(&probe.point, margin, &from.node.tangent)?
        {
            return Ok(Some(probe.point));
        }
    }
    Ok(None)
}

/// Whether another margin vanishes all along the branch. A boundary may have two such margins, one
/// in the free runs on each side, and each may exist on its own side only.
fn is_twin<F: Family>(track: &Track<'_, '_, F>, margin: &F::Margin) -> Traced<bool, F> {
    let Some(Foothold { node, gradient, .. }) = track.footholds.front() else { return Ok(false) };
    let runs = track.runs;
    let nearest = track.offsets(gradient).last().unwrap_or_default();
    let (normal, floor) = (gradient.normalize(), runs.options.interpolation * gradient.norm());
    for offset in [0.0, nearest, -nearest] {
        let place = node.point + normal * offset;
        let Some(value) = runs.margin(&place, margin)? else { continue };
        if value.abs() > floor {
            return Ok(false);
        }
        let other = runs.gradient(&place, margin, &node.tangent, track.radius)?;
        // Boundaries that touch ahead are farther apart here than the error of the zeros of
        // margins.
        return Ok(other.is_none_or(|other| {
            let apart = (offset - value / other.dot(&normal)).abs();
            apart <= 0.5 * nearest
        }));
    }
    Ok(false)
}
