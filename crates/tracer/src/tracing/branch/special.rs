//! The special points that steps run into, where a branch must end.
//!
//! Margins that cross are searched for before margins that touch, which take many more runs. A
//! branch that stalls without a known cause ends at the vertex to which its margin leads, if one is
//! known within a thousandth of the window, or at the window's edge if the edge is close ahead.

use crate::cubic::Cubic;
use crate::curve::{Node, VertexKind};
use crate::family::Family;
use crate::lengths::Lengths;
use crate::tracing::branch::touch::{graze, narrow};
use crate::tracing::branch::track::{FootholdOf, Track};
use crate::tracing::corrector::{correct, crossing, stationary};
use crate::tracing::end::Special;
use crate::tracing::runs::{Runs, Traced};
use crate::tracing::seed::{bisect, identify};
use crate::window::Point;

/// What a failed step may have run into.
#[derive(Clone, Copy)]
pub(crate) struct Search {
    /// Whether the gradient of the branch's margin may vanish. Near a known cusp it nearly does.
    pub alone: bool,
    /// Whether boundaries may touch within the step. This takes many runs.
    pub touches: bool,
}

/// The special point of a branch after `from`, within a failed step of length `h`; `None` if the
/// step is too long to find it. `beyond` is the place that the step reached, if only its labels
/// were wrong.
pub(crate) fn locate<F: Family>(
    track: &Track<'_, '_, F>,
    from: &FootholdOf<F>,
    beyond: Option<&FootholdOf<F>>,
    h: f64,
    Search { alone, touches }: Search,
) -> Traced<Option<Special<F::Margin>>, F> {
    for sure in [true, false] {
        let mut margins = track.other_margins(from, beyond, sure);
        if sure && let Some(beyond) = beyond {
            margins.extend(wedge(track, beyond)?);
        }
        if let Some(special) = among(track, from, beyond, margins, h, touches)? {
            return Ok(Some(special));
        }
    }
    let guess = from.node.point + from.node.tangent * (0.5 * h);
    if alone
        && let Some(point) = stationary(track.runs, &track.margin, &guess, 0.5 * h, 3.0 * h)?
        && track.runs.margin(&point, &track.margin)?.is_some_and(|value| {
            value.abs() <= (1e-3 * h * from.gradient.norm()).max(track.runs.options.noise)
        })
        && (point - from.node.point).dot(&from.node.tangent) > -track.runs.lengths.same
        && flattens(track, from, &point)?
    {
        return Ok(Some(degenerate(track, point, 0.0, true)));
    }
    Ok(None)
}

/// Whether the gradient of the branch's margin is nearly zero at a place where differences over the
/// length of a step say so. Over a short step these may be differences of errors.
fn flattens<F: Family>(
    track: &Track<'_, '_, F>,
    from: &FootholdOf<F>,
    point: &Point,
) -> Traced<bool, F> {
    let gradient = track.runs.gradient(point, &track.margin, &from.node.tangent, track.radius)?;
    Ok(gradient.is_none_or(|gradient| gradient.norm() <= 0.1 * from.gradient.norm()))
}

/// The first place within a failed step where one of these margins vanishes together with the
/// branch's margin, and behind which the branch does not have its labels. Crossings come first:
/// touches take many runs.
fn among<F: Family>(
    track: &Track<'_, '_, F>,
    from: &FootholdOf<F>,
    beyond: Option<&FootholdOf<F>>,
    margins: Vec<F::Margin>,
    h: f64,
    touches: bool,
) -> Traced<Option<Special<F::Margin>>, F> {
    let (mut crossings, mut others) = (Vec::new(), Vec::new());
    for margin in margins {
        match meet(track, from, beyond, &margin, h)? {
            Some((point, off)) => crossings.push((point, off, margin)),
            None => others.push(margin),
        }
    }
    let special = |point, uncertainty, margin| {
        let margins = vec![track.margin.clone(), margin];
        Special { point, kind: VertexKind::Crossing, margins, uncertainty, solved: true }
    };
    if let Some((mut point, mut off, margin)) = first(track, from, crossings)? {
        // The values of margins determine the place of a touch only to half the digits.
        if off > track.runs.lengths.same
            && let Some(touch) = graze(track, from, beyond, &margin, h)?
            && (touch - point).norm() <= 10.0 * off
        {
            (point, off) = (touch, 0.3 * off);
        }
        return Ok(Some(special(point, off, margin)));
    }
    if !touches {
        return Ok(None);
    }
    let mut touches = Vec::new();
    for margin in others {
        if narrow::<F>(from, beyond, &margin, h)
            && let Some(point) = graze(track, from, beyond, &margin, h)?
        {
            touches.push((point, track.runs.lengths.touch, margin));
        }
    }
    Ok(first(track, from, touches)?.map(|(point, off, margin)| special(point, off, margin)))
}

/// A place, its largest error, and the margin that vanishes there besides the branch's margin.
type CommonZero<Margin> = (Point, f64, Margin);

/// The first of these places behind which the branch does not have its labels.
fn first<F: Family>(
    track: &Track<'_, '_, F>,
    from: &FootholdOf<F>,
    mut places: Vec<CommonZero<F::Margin>>,
) -> Traced<Option<CommonZero<F::Margin>>, F> {
    let progress = |point: &Point| (point - from.node.point).dot(&from.node.tangent);
    // Where a crossing has a larger error, the two margins are almost multiples of each other.
    places.retain(|(_, off, _)| *off <= track.runs.lengths.close);
    places.sort_by(|(one, ..), (two, ..)| progress(one).total_cmp(&progress(two)));
    for place in places {
        if is_last(track, from, &place.0, 3.0 * place.1)? {
            return Ok(Some(place));
        }
    }
    Ok(None)
}

/// The end of a branch on which even the shortest step fails: the place where a thin region begins
/// beside it, or the place within a thousandth of the window where its margin ceases to exist. If
/// there is none, the result is `from`, unsolved.
///
/// Runs do not distinguish two boundaries that are closer than the offset of the runs. A branch
/// that has the labels beyond both boundaries ends where they separate, and each boundary goes on
/// from there.
pub(crate) fn give_up<F: Family>(
    track: &Track<'_, '_, F>,
    from: &FootholdOf<F>,
    beyond: Option<&FootholdOf<F>>,
    h: f64,
) -> Traced<Special<F::Margin>, F> {
    let Lengths { around, piece, half, .. } = track.runs.lengths;
    if let Some(beyond) = beyond
        && let [other, ..] = &wedge(track, beyond)?[..]
    {
        let margins = vec![track.margin.clone(), other.clone()];
        let (kind, uncertainty) = (VertexKind::Crossing, 4.0 * track.runs.options.offset);
        return Ok(Special { point: from.node.point, kind, margins, uncertainty, solved: true });
    }
    let place = |length: f64| -> Traced<Option<Point>, F> {
        let guess = track.predict(&from.node, length);
        let reach = 0.3 * length + 100.0 * track.runs.options.tolerance;
        Ok(correct(track.runs, &track.margin, &guess, &from.gradient, reach)?
            .map(|found| found.point))
    };
    let (mut exists, mut point) = (0.0, from.node.point);
    let mut length = h;
    while length < around {
        match place(length)? {
            Some(next) => (exists, point) = (length, next),
            None => break,
        }
        length *= 4.0;
    }
    if length >= around {
        return Ok(degenerate(track, from.node.point, piece, false));
    }
    while length - exists > track.runs.options.tolerance {
        let middle = 0.5 * (exists + length);
        if middle <= exists || middle >= length {
            // The tolerance is finer than doubles are.
            break;
        }
        match place(middle)? {
            Some(next) => (exists, point) = (middle, next),
            None => length = middle,
        }
    }
    // Beside a cusp a margin exists in a wedge that is too narrow to follow to its tip.
    Ok(degenerate(track, point, 1.5 * half, true))
}

fn degenerate<F: Family>(
    track: &Track<'_, '_, F>,
    point: Point,
    uncertainty: f64,
    solved: bool,
) -> Special<F::Margin> {
    let margins = vec![track.margin.clone()];
    Special { point, kind: VertexKind::Degenerate, margins, uncertainty, solved }
}

/// The special point at which a boundary leaves the window.
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
    let at_corner = (point - corner).norm() < runs.lengths.same;
    Special {
        point: if at_corner { corner } else { *point },
        kind: if at_corner { VertexKind::WindowCorner } else { VertexKind::WindowEdge },
        margins: vec![margin.clone()],
        uncertainty: 0.0,
        solved: true,
    }
}

/// The place between `from` and the end of the step where the boundary meets the boundary of
/// `margin`, and the largest error of this place. The boundaries cross or touch there.
fn meet<F: Family>(
    track: &Track<'_, '_, F>,
    from: &FootholdOf<F>,
    beyond: Option<&FootholdOf<F>>,
    margin: &F::Margin,
    h: f64,
) -> Traced<Option<(Point, f64)>, F> {
    let runs = track.runs;
    let start = from.node.point;
    let end = beyond.map_or_else(|| track.predict(&from.node, h), |foothold| foothold.node.point);
    let (first, second) = (runs.margin(&start, margin)?, runs.margin(&end, margin)?);
    let guess = match (first, second) {
        (Some(first), Some(second)) if (first < 0.0) != (second < 0.0) => {
            start.lerp(&end, first / (first - second))
        }
        // A step to an edge of the window may end where the two boundaries meet.
        (Some(_), Some(second)) if second.abs() <= runs.options.noise => end,
        (Some(_), None) => start,
        (None, Some(_)) => end,
        _ => return Ok(None),
    };
    let Some((point, off)) =
        crossing(runs, [&track.margin, margin], &guess, &from.node.tangent, track.radius, 2.0 * h)?
    else {
        return Ok(None);
    };
    let progress = (point - start).dot(&from.node.tangent);
    let slack = runs.lengths.same;
    Ok((progress > -slack && progress < h + slack).then_some((point, off)))
}

/// Whether the branch has its labels up to `point` and not beyond it. Runs do not distinguish
/// boundaries that are closer to `point` than `apart`.
fn is_last<F: Family>(
    track: &Track<'_, '_, F>,
    from: &FootholdOf<F>,
    point: &Point,
    apart: f64,
) -> Traced<bool, F> {
    let runs = track.runs;
    let Some(gradient) = runs.gradient(point, &track.margin, &from.node.tangent, track.radius)?
    else {
        return Ok(true);
    };
    let node = Node { point: *point, tangent: track.tangent(&gradient) };
    let length = (point - from.node.point).norm();
    let arc = Cubic::between(&from.node, &node);
    if length > runs.lengths.piece && !track.is_clear(from, &arc, apart)? {
        return Ok(false);
    }
    let after = point + node.tangent * (0.03 * length).max(runs.lengths.piece).max(apart);
    Ok(!track.holds_closely(from, &after, 0.3 * length + runs.lengths.piece)?)
}

/// The margins that separate a thin region beside `place` from the region with the branch's label
/// on that side.
fn wedge<F: Family>(track: &Track<'_, '_, F>, place: &FootholdOf<F>) -> Traced<Vec<F::Margin>, F> {
    let runs = track.runs;
    let left = Point::new(-place.node.tangent.y, place.node.tangent.x);
    let mut margins = Vec::new();
    for (side, normal) in [left, -left].into_iter().enumerate() {
        if place.sides[side].label == track.sides[side] {
            continue;
        }
        let mut offset = 4.0 * runs.options.offset;
        while offset < runs.lengths.around {
            let segment = [0.25 * offset, offset].map(|offset| place.node.point + normal * offset);
            let labels = [runs.label(&segment[0])?, runs.label(&segment[1])?];
            if labels[1] == track.sides[side] && labels[0] != labels[1] {
                let change = bisect(runs, &segment, [0.0, 1.0], labels)?;
                let places = change.places.map(|part| segment[0].lerp(&segment[1], part));
                margins.extend(identify(runs, &places, &change.labels)?.map(|seed| seed.margin));
                break;
            }
            offset *= 4.0;
        }
    }
    margins.retain(|margin| *margin != track.margin);
    Ok(margins)
}
