//! Boundaries that touch: special points that show neither in labels nor as a crossing of two
//! margins.

use crate::cubic::Cubic;
use crate::curve::{Node, VertexKind};
use crate::family::{Family, Point};
use crate::tracing::branch::special::rivals;
use crate::tracing::branch::{Branch, Foothold, FootholdOf, Special};
use crate::tracing::corrector::{correct, crossing};
use crate::tracing::runs::Traced;

/// A special point, and whether it lies before the last foothold.
type Touch<Margin> = (Special<Margin>, bool);

/// A special point that the labels do not show: between the last two footholds and `next` another
/// margin comes down to zero and goes up again.
pub(crate) fn touch<F: Family>(
    branch: &Branch<'_, '_, F>,
    next: &FootholdOf<F>,
) -> Traced<Option<Touch<F::Margin>>, F> {
    let [Some(first), Some(middle)] = [branch.trail().front(), branch.trail().get(1)] else {
        return Ok(None);
    };
    let lengths = [
        (middle.node.point - first.node.point).norm(),
        (next.node.point - middle.node.point).norm(),
    ];
    for margin in rivals(branch, middle, None) {
        let [Some(a), Some(b), Some(c)] =
            [first, middle, next].map(|foothold| value_beside(foothold, &margin))
        else {
            continue;
        };
        // A dip so shallow that its values at the nodes are most of it does not reach zero.
        if b.abs() > a.abs() || b.abs() >= c.abs() {
            continue;
        }
        let rises = [(b - a) / lengths[0], (c - b) / lengths[1]];
        let bend = (rises[1] - rises[0]) / (lengths[0] + lengths[1]);
        let slope = rises[0] + bend * lengths[0];
        let lowest = b - 0.25 * slope * slope / bend;
        if b.signum() * lowest > 0.3 * a.abs().max(c.abs()) {
            continue;
        }
        if let Some(found) = dip(branch, [first, middle, next], &margin, -0.5 * slope / bend)? {
            return Ok(Some(found));
        }
    }
    Ok(None)
}

/// The value of a margin in the free runs beside a place.
fn value_beside<L, M: PartialEq>(foothold: &Foothold<L, M>, margin: &M) -> Option<f64> {
    foothold
        .sides
        .iter()
        .flat_map(|run| run.margins.iter())
        .find(|(own, _)| own == margin)
        .map(|(_, value)| *value)
}

/// Where a margin that dips along the boundary touches zero, or first crosses it. `guess` is the
/// length from the middle place.
///
/// The lowest place is where the gradients of the two margins are parallel, which is solved by the
/// secant method: values near a minimum tell it to half the digits only.
fn dip<F: Family>(
    branch: &Branch<'_, '_, F>,
    places: [&FootholdOf<F>; 3],
    margin: &F::Margin,
    guess: f64,
) -> Traced<Option<Touch<F::Margin>>, F> {
    let runs = branch.runs;
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
        parallel(branch, place, places[1], margin, start, [-chords[0], chords[1]])?
    else {
        return Ok(None);
    };
    let gap = last.value / last.slope;
    let margins = vec![branch.margin.clone(), margin.clone()];
    let special = |point, uncertainty| Special {
        point,
        kind: VertexKind::Crossing,
        margins,
        uncertainty,
        solved: true,
    };
    let floor = runs.options.interpolation.max(10.0 * runs.resolution(last.slope));
    if gap.abs() <= floor {
        return Ok(Some((special(last.point, 1e-8 * runs.scale), length < 0.0)));
    }
    let beside = value_beside(places[1], margin).unwrap_or(last.value);
    if (beside < 0.0) == (gap < 0.0) {
        return Ok(None);
    }
    // Twice through zero: the first time lies between the first place and the lowest one.
    let before = value_beside(places[0], margin).unwrap_or(beside);
    // A parabola has its zero there.
    let part = (last.value.abs() / (before.abs() + last.value.abs())).sqrt();
    let start = place(length - part * (length + chords[0]));
    let tangent = &places[1].node.tangent;
    let reach = 2.0 * (chords[0] + chords[1]);
    let crossed =
        crossing(runs, [&branch.margin, margin], &start, tangent, branch.radius(), reach)?;
    Ok(crossed.map(|(point, uncertainty)| {
        let along = (point - places[1].node.point).dot(&places[1].node.tangent);
        (special(point, uncertainty), along < 0.0)
    }))
}

/// What the search for the lowest place of a margin along a boundary looks at.
struct Probe {
    point: Point,
    /// Sine of the angle between the gradients.
    sine: f64,
    value: f64,
    slope: f64,
}

/// Where, along a branch, the gradients of its own and of another margin are parallel, by the
/// secant method: the length there, and what is found. Where the other margin stops to exist before
/// that place, as an extremum does that leaves through the end of its phase, the place is
/// approached from the side on which it exists.
fn parallel<F: Family>(
    branch: &Branch<'_, '_, F>,
    place: impl Fn(f64) -> Point,
    near: &FootholdOf<F>,
    margin: &F::Margin,
    start: [f64; 2],
    limits: [f64; 2],
) -> Traced<Option<(f64, Probe)>, F> {
    let runs = branch.runs;
    let width = limits[1] - limits[0];
    let probe = |length: f64| -> Traced<Option<Probe>, F> {
        let reach = 0.3 * width + 100.0 * runs.options.tolerance;
        let guess = place(length);
        let Some(found) = correct(runs, &branch.margin, &guess, &near.gradient, reach)? else {
            return Ok(None);
        };
        let (point, tangent) = (found.point, &near.node.tangent);
        let (Some(own), Some(other), Some(value)) = (
            runs.gradient(&point, &branch.margin, tangent, branch.radius())?,
            runs.gradient(&point, margin, tangent, branch.radius())?,
            runs.margin(&point, margin)?,
        ) else {
            return Ok(None);
        };
        let sine = own.perp(&other) / (own.norm() * other.norm());
        Ok(Some(Probe { point, sine, value, slope: other.norm() }))
    };
    let mut length = start[0];
    let Some(mut last) = probe(length)? else { return Ok(None) };
    let mut shift = start[1] - start[0];
    for _ in 0..40 {
        let Some(now) = probe(length + shift)? else {
            shift *= 0.5;
            if shift.abs() <= 1e-10 * runs.scale {
                return Ok(Some((length, last)));
            }
            continue;
        };
        length += shift;
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
    // Not known beside the step: found across a wedge.
    values.iter().all(Option::is_none)
        || values.iter().flatten().any(|value| value.abs() <= h * from.gradient.norm())
}

/// Where the boundary of `margin` touches the branch within the step.
pub(crate) fn graze<F: Family>(
    branch: &Branch<'_, '_, F>,
    from: &FootholdOf<F>,
    beyond: Option<&FootholdOf<F>>,
    margin: &F::Margin,
    h: f64,
) -> Traced<Option<Point>, F> {
    let end = beyond.map_or_else(
        || Node { point: branch.predict(&from.node, h), tangent: from.node.tangent },
        |foothold| foothold.node,
    );
    if is_twin(branch, margin)? {
        return Ok(None);
    }
    let arc = Cubic::between(&from.node, &end);
    let chord = arc.chord();
    let slack = 1e-8 * branch.runs.scale;
    for start in [[chord, 0.75 * chord], [0.0, 0.25 * chord]] {
        let place = |length: f64| arc.at(length / chord);
        let found = parallel(branch, place, from, margin, start, [-slack, chord + slack])?;
        if let Some((_, probe)) = found
            && (probe.value / probe.slope).abs() <= branch.runs.options.interpolation
        {
            return Ok(Some(probe.point));
        }
    }
    Ok(None)
}

/// Whether another margin vanishes all along the branch, as the two do that a boundary has from its
/// two sides.
fn is_twin<F: Family>(branch: &Branch<'_, '_, F>, margin: &F::Margin) -> Traced<bool, F> {
    let Some(back) = branch.trail().front() else { return Ok(false) };
    let value = branch.runs.margin(&back.node.point, margin)?;
    let floor = branch.runs.options.interpolation * back.gradient.norm();
    Ok(value.is_some_and(|value| value.abs() <= floor))
}
