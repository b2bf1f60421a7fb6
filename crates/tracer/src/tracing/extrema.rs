//! The places where boundaries are extremal in a coordinate.

use crate::cubic::Cubic;
use crate::curve::{Curve, Node};
use crate::family::Family;
use crate::lengths::angle;
use crate::tracing::corrector::correct;
use crate::tracing::runs::{Runs, Traced};
use crate::tracing::seed::identify;
use crate::window::Point;

/// A place between the ends of a curve where a coordinate has a maximum or minimum along the curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremum {
    /// The index of the curve in the network.
    pub curve: usize,
    /// The coordinate, 0 or 1. The tangent of the curve has no component along its axis.
    pub axis: usize,
    /// The place, which lies on the boundary.
    pub point: Point,
}

/// The extrema of `curves`, in the order of the curves and from start to end.
pub(crate) fn extrema<F: Family>(
    runs: &Runs<'_, F>,
    curves: &[Curve<F::Label, F::Margin>],
) -> Traced<Vec<Extremum>, F> {
    let mut found = Vec::new();
    for (index, curve) in curves.iter().enumerate() {
        let mut on_curve = Vec::new();
        for axis in 0..2 {
            let mut places = Vec::new();
            for bracket in brackets(curve, axis) {
                let component = |node: &Node| node.tangent[axis];
                let is_straight = |component: f64| component.abs() <= angle::STRAIGHT;
                places.extend(solve(runs, curve, &bracket, component, is_straight)?);
            }
            let known = 10.0 * runs.options.interpolation;
            for (place, point) in pronounced(curve, axis, places, known) {
                on_curve.push((place, Extremum { curve: index, axis, point }));
            }
        }
        on_curve.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        found.extend(on_curve.into_iter().map(|(_, extremum)| extremum));
    }
    Ok(found)
}

/// The successive extrema of a curve that differ from their neighbours, or from the ends of the
/// curve, by more than `known` in the coordinate.
fn pronounced<Label, Margin>(
    curve: &Curve<Label, Margin>,
    axis: usize,
    places: Vec<(f64, Point)>,
    known: f64,
) -> Vec<(f64, Point)> {
    let heights: Vec<f64> = places.iter().map(|(_, point)| point[axis]).collect();
    let (first, last) = match curve.ends {
        Some(_) => (curve.nodes.first(), curve.nodes.last()),
        None => (None, None),
    };
    let before = first.map(|node| node.point[axis]).or(heights.last().copied());
    let after = last.map(|node| node.point[axis]).or(heights.first().copied());
    let line: Vec<f64> = before.into_iter().chain(heights.iter().copied()).chain(after).collect();
    let stands_out =
        |around: &[f64]| [0, 2].iter().all(|&side| (around[side] - around[1]).abs() > known);
    places
        .into_iter()
        .zip(line.windows(3))
        .filter(|(_, around)| stands_out(around))
        .map(|(place, _)| place)
        .collect()
}

/// Successive nodes of a curve between which a value changes its sign.
pub(crate) struct Bracket {
    /// The index of the first node.
    pub first: usize,
    pub nodes: Vec<Node>,
}

fn brackets<Label, Margin>(curve: &Curve<Label, Margin>, axis: usize) -> Vec<Bracket> {
    let bends = |node: &Node| node.tangent[axis].abs() > angle::STRAIGHT;
    let Some(start) = curve.nodes.iter().position(bends) else { return Vec::new() };
    let mut nodes = curve.nodes.clone();
    if curve.ends.is_none() {
        // The last node repeats the first one.
        nodes.extend_from_slice(&curve.nodes[1..=start]);
    }
    let mut found = Vec::new();
    let mut first = start;
    for last in start + 1..nodes.len() {
        if !bends(&nodes[last]) {
            continue;
        }
        if (nodes[first].tangent[axis] < 0.0) != (nodes[last].tangent[axis] < 0.0) {
            found.push(Bracket { first, nodes: nodes[first..=last].to_vec() });
        }
        first = last;
    }
    found
}

impl Bracket {
    /// The cubic at a place, and the parameter on it. Places count the pieces of the bracket.
    fn piece(&self, place: f64) -> (Cubic, f64) {
        let pieces = self.nodes.windows(2);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let piece = (place.max(0.0) as usize).min(pieces.len() - 1);
        (Cubic::between(&self.nodes[piece], &self.nodes[piece + 1]), place - piece as f64)
    }
}

/// The zero of a value in a bracket, and its place along the curve, in pieces.
///
/// The value is taken at nodes on the boundary itself; the Illinois method (Dowell and Jarratt,
/// 1971) solves for it, until the place does not move and the value `is_small`. `None` if the value
/// does not vanish but jumps, for instance a tangent at the end of a curve that is not known, or if
/// the boundary cannot be followed.
pub(crate) fn solve<F: Family>(
    runs: &Runs<'_, F>,
    curve: &Curve<F::Label, F::Margin>,
    bracket: &Bracket,
    value: impl Fn(&Node) -> f64,
    is_small: impl Fn(f64) -> bool,
) -> Traced<Option<(f64, Point)>, F> {
    const ROUNDS: usize = 60;
    let margin = margin(runs, curve, bracket)?;
    let (mut low, mut high) = (0.0, (bracket.nodes.len() - 1) as f64);
    let [mut below, mut above] =
        [0, bracket.nodes.len() - 1].map(|node| value(&bracket.nodes[node]));
    let chord = (bracket.nodes[0].point - bracket.nodes[bracket.nodes.len() - 1].point).norm();
    let close = runs.lengths.solved / chord;
    let mut last = f64::INFINITY;
    let mut kept_low = None;
    for _ in 0..ROUNDS {
        let place = (low * above - high * below) / (above - below);
        let (arc, theta) = bracket.piece(place);
        let Some(node) = on_boundary(runs, &margin, &arc, theta)? else { return Ok(None) };
        let here = value(&node);
        if is_small(here) && (place - last).abs() <= close || here == 0.0 {
            return Ok(Some((bracket.first as f64 + place, node.point)));
        }
        last = place;
        if (here < 0.0) == (below < 0.0) {
            (low, below) = (place, here);
            if kept_low == Some(false) {
                above *= 0.5;
            }
            kept_low = Some(false);
        } else {
            (high, above) = (place, here);
            if kept_low == Some(true) {
                below *= 0.5;
            }
            kept_low = Some(true);
        }
    }
    Ok(None)
}

/// The margin of a curve under the name that it has in the middle of a bracket: the name in the
/// free runs beside it, or the name after a move there.
fn margin<F: Family>(
    runs: &Runs<'_, F>,
    curve: &Curve<F::Label, F::Margin>,
    bracket: &Bracket,
) -> Traced<F::Margin, F> {
    let (arc, theta) = bracket.piece(0.5 * (bracket.nodes.len() - 1) as f64);
    let (point, tangent) = (arc.at(theta), arc.tangent(theta));
    let left = Point::new(-tangent.y, tangent.x);
    let offset = runs.options.offset.max(4.0 * runs.options.interpolation);
    let beside = [point + left * offset, point - left * offset];
    match identify(runs, &beside, &curve.sides)? {
        Some(seed) => Ok(seed.margin),
        None => runs.moved(&point, &curve.margin),
    }
}

/// The node on the boundary next to a place of a cubic, with its tangent in the cubic's direction.
fn on_boundary<F: Family>(
    runs: &Runs<'_, F>,
    margin: &F::Margin,
    arc: &Cubic,
    theta: f64,
) -> Traced<Option<Node>, F> {
    let (guess, along) = (arc.at(theta), arc.tangent(theta));
    let radius = arc.chord() / arc.tangent(0.0).angle(&arc.tangent(1.0));
    let Some(gradient) = runs.gradient(&guess, margin, &along, radius)? else { return Ok(None) };
    let reach = 0.3 * arc.chord() + 100.0 * runs.options.tolerance;
    let Some(found) = correct(runs, margin, &guess, &gradient, reach)? else { return Ok(None) };
    let Some(gradient) = runs.gradient(&found.point, margin, &along, radius)? else {
        return Ok(None);
    };
    let tangent = Point::new(gradient.y, -gradient.x).normalize();
    let forward = tangent.dot(&along) > 0.0;
    Ok(Some(Node { point: found.point, tangent: if forward { tangent } else { -tangent } }))
}
