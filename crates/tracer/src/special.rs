//! Where a branch must end: the special points that its steps run into.

use crate::arc::Arc;
use crate::branch::{Branch, FootholdOf, Special};
use crate::corrector::{correct, crossing, stationary};
use crate::curve::{Node, VertexKind};
use crate::family::{Family, Point};
use crate::runs::{Runs, Traced};
use crate::seed::{bisect, identify};

/// The special point of a branch after `from` within a step `h` that failed; `beyond` is the place reached if its labels are
/// wrong. `None` if it is not found from so far away.
pub(crate) fn locate<F: Family>(
    branch: &Branch<'_, '_, F>,
    from: &FootholdOf<F>,
    beyond: Option<&FootholdOf<F>>,
    h: f64,
) -> Traced<Option<Special<F::Margin>>, F> {
    let mut found = Vec::new();
    let mut margins = rivals(branch, from, beyond);
    if let Some(beyond) = beyond {
        margins.extend(wedge(branch, beyond)?);
    }
    for margin in margins {
        let met = match meet(branch, from, beyond, &margin, h)? {
            None if narrow::<F>(from, beyond, &margin, h) => {
                graze(branch, from, beyond, &margin, h)?
            }
            met => met,
        };
        if let Some(point) = met {
            let progress = (point - from.node.point).dot(&from.node.tangent);
            found.push((progress, point, margin));
        }
    }
    found.sort_by(|(one, ..), (two, ..)| one.total_cmp(two));
    for (_, point, margin) in found {
        if is_last(branch, from, &point)? {
            return Ok(Some(Special {
                point,
                kind: VertexKind::Crossing,
                margins: vec![branch.margin.clone(), margin],
                uncertainty: 0.0,
                solved: true,
            }));
        }
    }
    let guess = from.node.point + from.node.tangent * (0.5 * h);
    if let Some(point) = stationary(branch.runs, &branch.margin, &guess, 0.5 * h, 3.0 * h)?
        && branch.runs.margin(&point, &branch.margin)?.is_some_and(|value| {
            value.abs() <= (1e-3 * h * from.gradient.norm()).max(branch.runs.options.noise)
        })
        && (point - from.node.point).dot(&from.node.tangent) > -1e-9 * branch.runs.scale
    {
        return Ok(Some(degenerate(branch, point, 0.0, true)));
    }
    Ok(None)
}

/// The end of a branch that no step is short enough for: where its margin stops to exist, within a thousandth of the window, or,
/// unsolved, the place itself.
pub(crate) fn give_up<F: Family>(
    branch: &Branch<'_, '_, F>,
    from: &FootholdOf<F>,
    h: f64,
) -> Traced<Special<F::Margin>, F> {
    let scale = branch.runs.scale;
    let place = |length: f64| -> Traced<Option<Point>, F> {
        let guess = branch.predict(&from.node, length);
        let reach = 0.3 * length + 100.0 * branch.runs.options.tolerance;
        Ok(correct(branch.runs, &branch.margin, &guess, &from.gradient, reach)?
            .map(|found| found.point))
    };
    let (mut exists, mut point) = (0.0, from.node.point);
    let mut length = h;
    while length < 1e-3 * scale {
        match place(length)? {
            Some(next) => (exists, point) = (length, next),
            None => break,
        }
        length *= 4.0;
    }
    if length >= 1e-3 * scale {
        return Ok(degenerate(branch, from.node.point, 1e-6 * scale, false));
    }
    while length - exists > branch.runs.options.tolerance {
        let middle = 0.5 * (exists + length);
        match place(middle)? {
            Some(next) => (exists, point) = (middle, next),
            None => length = middle,
        }
    }
    Ok(degenerate(branch, point, 1e-8 * scale, true))
}

fn degenerate<F: Family>(
    branch: &Branch<'_, '_, F>,
    point: Point,
    uncertainty: f64,
    solved: bool,
) -> Special<F::Margin> {
    let margins = vec![branch.margin.clone()];
    Special { point, kind: VertexKind::Degenerate, margins, uncertainty, solved }
}

/// Where a boundary leaves the window.
pub(crate) fn edge<F: Family>(
    runs: &Runs<'_, F>,
    point: &Point,
    margin: &F::Margin,
) -> Special<F::Margin> {
    let window = &runs.window;
    let nearest = |axis: usize| {
        let (low, high) = (window.low[axis], window.high[axis]);
        if point[axis] - low < high - point[axis] { low } else { high }
    };
    let corner = Point::new(nearest(0), nearest(1));
    let at_corner = (point - corner).norm() < 1e-9 * runs.scale;
    Special {
        point: if at_corner { corner } else { *point },
        kind: if at_corner { VertexKind::WindowCorner } else { VertexKind::WindowEdge },
        margins: vec![margin.clone()],
        uncertainty: 0.0,
        solved: true,
    }
}

/// The margins that the free runs around know, but for the one that is followed, in order.
fn rivals<F: Family>(
    branch: &Branch<'_, '_, F>,
    from: &FootholdOf<F>,
    beyond: Option<&FootholdOf<F>>,
) -> Vec<F::Margin> {
    let mut margins: Vec<F::Margin> = [Some(from), beyond]
        .into_iter()
        .flatten()
        .flat_map(|foothold| foothold.sides.iter())
        .flat_map(|run| run.margins.iter())
        .map(|(margin, _)| margin)
        .filter(|margin| **margin != branch.margin)
        .cloned()
        .collect();
    margins.sort();
    margins.dedup();
    margins
}

/// Where the boundary meets that of `margin` between `from` and the end of the step: they cross, or touch.
fn meet<F: Family>(
    branch: &Branch<'_, '_, F>,
    from: &FootholdOf<F>,
    beyond: Option<&FootholdOf<F>>,
    margin: &F::Margin,
    h: f64,
) -> Traced<Option<Point>, F> {
    let runs = branch.runs;
    let start = from.node.point;
    let end = beyond.map_or_else(|| branch.predict(&from.node, h), |foothold| foothold.node.point);
    let (first, second) = (runs.margin(&start, margin)?, runs.margin(&end, margin)?);
    let guess = match (first, second) {
        (Some(first), Some(second)) if (first < 0.0) != (second < 0.0) => {
            start.lerp(&end, first / (first - second))
        }
        (Some(_), None) => start,
        (None, Some(_)) => end,
        _ => return Ok(None),
    };
    let Some(point) = crossing(
        runs,
        [&branch.margin, margin],
        &guess,
        &from.node.tangent,
        branch.radius(),
        2.0 * h,
    )?
    else {
        return Ok(None);
    };
    let progress = (point - start).dot(&from.node.tangent);
    let slack = 1e-9 * runs.scale;
    Ok((progress > -slack && progress < h + slack).then_some(point))
}

/// Whether the branch holds up to `point` and not beyond it.
fn is_last<F: Family>(
    branch: &Branch<'_, '_, F>,
    from: &FootholdOf<F>,
    point: &Point,
) -> Traced<bool, F> {
    let runs = branch.runs;
    let Some(gradient) =
        runs.gradient(point, &branch.margin, &from.node.tangent, branch.radius())?
    else {
        return Ok(true);
    };
    let node = Node { point: *point, tangent: branch.tangent(&gradient) };
    let length = (point - from.node.point).norm();
    if length > 1e-6 * runs.scale {
        let before = Arc::between(&from.node, &node).point(0.97);
        if !branch.holds(from, &before, 0.3 * length)? {
            return Ok(false);
        }
    }
    let after = point + node.tangent * (0.03 * length).max(1e-6 * runs.scale);
    Ok(!branch.holds(from, &after, 0.3 * length)?)
}

/// A special point that the labels do not show: between the last two footholds and `next` another margin comes down to zero and
/// goes up again. With it whether it lies before the last foothold.
pub(crate) fn touch<F: Family>(
    branch: &Branch<'_, '_, F>,
    next: &FootholdOf<F>,
) -> Traced<Option<(Special<F::Margin>, bool)>, F> {
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
fn value_beside<L, M: PartialEq>(
    foothold: &crate::branch::Foothold<L, M>,
    margin: &M,
) -> Option<f64> {
    foothold
        .sides
        .iter()
        .flat_map(|run| run.margins.iter())
        .find(|(own, _)| own == margin)
        .map(|(_, value)| *value)
}

/// Where a margin that dips along the boundary touches zero, or first crosses it. `guess` is the length from the middle place.
///
/// The lowest place is where the gradients of the two margins are parallel, which is solved by the secant method: values near a
/// minimum tell it to half the digits only.
fn dip<F: Family>(
    branch: &Branch<'_, '_, F>,
    places: [&FootholdOf<F>; 3],
    margin: &F::Margin,
    guess: f64,
) -> Traced<Option<(Special<F::Margin>, bool)>, F> {
    let runs = branch.runs;
    let arcs = [
        Arc::between(&places[0].node, &places[1].node),
        Arc::between(&places[1].node, &places[2].node),
    ];
    let place = |length: f64| {
        if length < 0.0 {
            arcs[0].point(1.0 + length / arcs[0].chord())
        } else {
            arcs[1].point(length / arcs[1].chord())
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
    let start = places[0].node.point.lerp(&last.point, before / (before - last.value));
    let tangent = &places[1].node.tangent;
    let reach = 2.0 * (chords[0] + chords[1]);
    let crossed =
        crossing(runs, [&branch.margin, margin], &start, tangent, branch.radius(), reach)?;
    Ok(crossed.map(|point| {
        let along = (point - places[1].node.point).dot(&places[1].node.tangent);
        (special(point, 0.0), along < 0.0)
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

/// Where, along a branch, the gradients of its own and of another margin are parallel, by the secant method: the length there, and
/// what is found. Where the other margin stops to exist before that place, as an extremum does that leaves through the end of its
/// phase, the place is approached from the side on which it exists.
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
        shift = -last.sine / turn;
        if !(length + shift >= limits[0] && length + shift <= limits[1]) {
            return Ok(None);
        }
        if shift.abs() <= 10.0 * runs.options.tolerance {
            return Ok(Some((length, last)));
        }
    }
    Ok(None)
}

/// Whether another margin is so close to zero beside the step that its boundary may touch the branch there.
fn narrow<F: Family>(
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
fn graze<F: Family>(
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
    let arc = Arc::between(&from.node, &end);
    let chord = arc.chord();
    let slack = 1e-8 * branch.runs.scale;
    for start in [[chord, 0.75 * chord], [0.0, 0.25 * chord]] {
        let place = |length: f64| arc.point(length / chord);
        let found = parallel(branch, place, from, margin, start, [-slack, chord + slack])?;
        if let Some((_, probe)) = found
            && (probe.value / probe.slope).abs() <= branch.runs.options.interpolation
        {
            return Ok(Some(probe.point));
        }
    }
    Ok(None)
}

/// Whether another margin vanishes all along the branch, as the two do that a boundary has from its two sides.
fn is_twin<F: Family>(branch: &Branch<'_, '_, F>, margin: &F::Margin) -> Traced<bool, F> {
    let Some(back) = branch.trail().front() else { return Ok(false) };
    let value = branch.runs.margin(&back.node.point, margin)?;
    let floor = branch.runs.options.interpolation * back.gradient.norm();
    Ok(value.is_some_and(|value| value.abs() <= floor))
}

/// The margins that part a thin region beside a place from the label that the branch has on that side.
fn wedge<F: Family>(
    branch: &Branch<'_, '_, F>,
    place: &FootholdOf<F>,
) -> Traced<Vec<F::Margin>, F> {
    let runs = branch.runs;
    let left = Point::new(-place.node.tangent.y, place.node.tangent.x);
    let mut margins = Vec::new();
    for (side, normal) in [left, -left].into_iter().enumerate() {
        if place.sides[side].label == branch.sides[side] {
            continue;
        }
        let mut offset = 4.0 * runs.options.offset;
        while offset < 1e-3 * runs.scale {
            let segment = [0.25 * offset, offset].map(|offset| place.node.point + normal * offset);
            let labels = [runs.label(&segment[0])?, runs.label(&segment[1])?];
            if labels[1] == branch.sides[side] && labels[0] != labels[1] {
                let change = bisect(runs, &segment, [0.0, 1.0], labels)?;
                let places = change.places.map(|part| segment[0].lerp(&segment[1], part));
                margins.extend(identify(runs, &places, &change.labels)?.map(|seed| seed.margin));
                break;
            }
            offset *= 4.0;
        }
    }
    margins.retain(|margin| *margin != branch.margin);
    Ok(margins)
}
