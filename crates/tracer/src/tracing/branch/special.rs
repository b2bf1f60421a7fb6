//! Where a branch must end: the special points that its steps run into.

use crate::cubic::Cubic;
use crate::curve::{Node, VertexKind};
use crate::family::{Family, Point};
use crate::tracing::branch::touch::{graze, narrow};
use crate::tracing::branch::{Branch, FootholdOf, Special};
use crate::tracing::corrector::{correct, crossing, stationary};
use crate::tracing::runs::{Runs, Traced};
use crate::tracing::seed::{bisect, identify};

/// Crossings that are not known better, in parts of the window's shorter extent, are looked at as
/// touches: values tell the place of those to half the digits only.
const TANGENTIAL: f64 = 1e-9;

/// The special point of a branch after `from` within a step `h` that failed; `beyond` is the place
/// reached if its labels are wrong. `None` if it is not found from so far away.
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
                graze(branch, from, beyond, &margin, h)?.map(|point| (point, 0.0))
            }
            met => met,
        };
        if let Some((point, off)) = met {
            let progress = (point - from.node.point).dot(&from.node.tangent);
            found.push((progress, point, off, margin));
        }
    }
    found.sort_by(|(one, ..), (two, ..)| one.total_cmp(two));
    for (_, point, off, margin) in found {
        if is_last(branch, from, &point)? {
            let (mut point, mut off) = (point, off);
            if off > TANGENTIAL * branch.runs.scale
                && let Some(touch) = graze(branch, from, beyond, &margin, h)?
                && (touch - point).norm() <= 10.0 * off
            {
                (point, off) = (touch, 0.3 * off);
            }
            return Ok(Some(Special {
                point,
                kind: VertexKind::Crossing,
                margins: vec![branch.margin.clone(), margin],
                uncertainty: off,
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

/// The end of a branch that no step is short enough for: where its margin stops to exist, within a
/// thousandth of the window, or, unsolved, the place itself.
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
    Ok(degenerate(branch, point, 1e-7 * scale, true))
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
pub(crate) fn rivals<F: Family>(
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

/// Where the boundary meets that of `margin` between `from` and the end of the step: they cross, or
/// touch.
fn meet<F: Family>(
    branch: &Branch<'_, '_, F>,
    from: &FootholdOf<F>,
    beyond: Option<&FootholdOf<F>>,
    margin: &F::Margin,
    h: f64,
) -> Traced<Option<(Point, f64)>, F> {
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
    let Some((point, off)) = crossing(
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
    Ok((progress > -slack && progress < h + slack).then_some((point, off)))
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
    if length > 1e-6 * runs.scale && !branch.is_clear(from, &Cubic::between(&from.node, &node))? {
        return Ok(false);
    }
    let after = point + node.tangent * (0.03 * length).max(1e-6 * runs.scale);
    Ok(!branch.holds_closely(from, &after, 0.3 * length + 1e-6 * runs.scale)?)
}

/// The margins that part a thin region beside a place from the label that the branch has on that
/// side.
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
