//! Boundaries that begin on another one with its tangent, with a square root.
//!
//! Behind the graze of a guard, everything that depends on when it fires has a square root in the
//! margin r of the graze. Another margin there is m₀ + α √r + β r + …, and its boundary begins on
//! the boundary of the graze where m₀ = 0, as a parabola. The strip between the two boundaries is
//! (m₀/α)² wide. Next to this place runs cannot resolve it. A branch along the graze with the
//! labels of the far side runs past the place, and stalls where the strip becomes as wide as the
//! offset of the runs. A branch with the labels of the strip stalls before the place. But m₀ can be
//! followed along the boundary of the graze, by the polynomial in √r through the margin at four
//! distances, and its zero is simple. Two distances must agree on it.

use nalgebra::Vector1;

use crate::conditions::{Limits, secant, solve};
use crate::curve::VertexKind;
use crate::family::Family;
use crate::lengths::Lengths;
use crate::tracing::branch::track::{FootholdOf, Track};
use crate::tracing::corrector::correct;
use crate::tracing::end::Special;
use crate::tracing::runs::{Runs, Traced};
use crate::window::Point;

/// A place where a boundary begins on another one with its tangent, and whether it lies ahead.
pub(crate) type Tangency<Margin> = (Special<Margin>, bool);

/// The place near the end of a stalled branch where another boundary begins on it with its tangent.
pub(crate) fn begins_on_branch<F: Family>(
    track: &Track<'_, '_, F>,
    from: &FootholdOf<F>,
    beyond: Option<&FootholdOf<F>>,
) -> Traced<Option<Tangency<F::Margin>>, F> {
    nearest(|consider| behind_branch(track, from, beyond, consider))
}

/// The place near the end of a stalled branch where it begins on another boundary with its tangent.
pub(crate) fn branch_begins<F: Family>(
    track: &Track<'_, '_, F>,
    from: &FootholdOf<F>,
) -> Traced<Option<Tangency<F::Margin>>, F> {
    nearest(|consider| behind_others(track, from, consider))
}

/// The nearest of the places that are considered.
fn nearest<F: Family>(
    of: impl FnOnce(&mut Consider<'_, F>) -> Traced<(), F>,
) -> Traced<Option<Tangency<F::Margin>>, F> {
    let mut nearest: Option<(Special<F::Margin>, f64)> = None;
    let mut consider = |root: &Root<'_, F>| {
        let Some((place, uncertainty)) = root.place()? else { return Ok(()) };
        if nearest.as_ref().is_none_or(|(_, other)| place.abs() < other.abs())
            && let Some(point) = root.point(place)?
        {
            let (kind, margins) =
                (VertexKind::Crossing, vec![root.graze.clone(), root.own.clone()]);
            nearest = Some((Special { point, kind, margins, uncertainty, solved: true }, place));
        }
        Ok(())
    };
    of(&mut consider)?;
    Ok(nearest.map(|(special, place)| (special, place > 0.0)))
}

/// What is done with a margin that may have a root.
type Consider<'c, F> = dyn FnMut(&Root<'_, F>) -> Traced<(), F> + 'c;

/// Considers that the branch is the boundary of a graze. Margins behind the graze exist on one side
/// of it. The margin that stalls the branch vanishes at one of the distances of the runs.
fn behind_branch<F: Family>(
    track: &Track<'_, '_, F>,
    from: &FootholdOf<F>,
    beyond: Option<&FootholdOf<F>>,
    consider: &mut Consider<'_, F>,
) -> Traced<(), F> {
    let runs = track.runs;
    let margins = |side: usize| {
        let footholds = [Some(from), beyond].into_iter().flatten();
        footholds.flat_map(move |foothold| &foothold.sides[side].margins).map(|(margin, _)| margin)
    };
    for (side, sign) in [(0, track.orientation), (1, -track.orientation)] {
        let mut tried: Vec<&F::Margin> = Vec::new();
        for own in margins(side) {
            if *own == track.margin || !runs.is_sure(own) || tried.contains(&own) {
                continue;
            }
            tried.push(own);
            let normal = from.gradient.normalize() * sign;
            let values = track.offsets(&from.gradient).map(|offset| {
                let value = runs.margin(&(from.node.point + normal * offset), own)?;
                Ok(value.unwrap_or(f64::NAN))
            });
            if !stalls_with_root(&values.collect::<Traced<Vec<_>, F>>()?) {
                continue;
            }
            consider(&Root {
                runs,
                own,
                graze: &track.margin,
                foot: from.node.point,
                along: from.node.tangent,
                gradient: from.gradient,
                side: sign,
            })?;
        }
    }
    Ok(())
}

/// Whether a margin with these values is nearly zero at one of the distances, and changes with the
/// root of the distance. Each distance is a tenth of the one before.
fn stalls_with_root(values: &[f64]) -> bool {
    let sizes = values.iter().map(|value| value.abs());
    let (least, most) = (sizes.clone().fold(f64::NAN, f64::min), sizes.fold(f64::NAN, f64::max));
    // With a root, differences become smaller by a factor of √10; those of a smooth margin, of 10.
    let is_root = |three: &[f64]| (three[0] - three[1]).abs() < 5.0 * (three[1] - three[2]).abs();
    least <= 0.1 * most && values.len() > 2 && values.windows(3).all(is_root)
}

/// Considers that the branch has the root. The graze is a margin of the runs beyond its boundary,
/// and of those on the branch only if the branch's margin ceases there: so it is where a condition
/// of a start ends.
fn behind_others<F: Family>(
    track: &Track<'_, '_, F>,
    from: &FootholdOf<F>,
    consider: &mut Consider<'_, F>,
) -> Traced<(), F> {
    let (runs, own, tangent) = (track.runs, &track.margin, &from.node.tangent);
    let reach = runs.lengths.close;
    let aside = from.gradient.normalize() * reach;
    let is_known = |margin: &F::Margin| {
        let mut known = from.sides.iter().flat_map(|run| &run.margins);
        margin == own || known.any(|(known, _)| known == margin)
    };
    for place in [from.node.point + aside, from.node.point - aside] {
        let ceases = runs.margin(&place, own)?.is_none();
        let is_new = |margin: &F::Margin| !is_known(margin) || ceases && margin != own;
        let margins = runs.free(&place)?.margins.into_iter().map(|(margin, _)| margin);
        for graze in margins.filter(|margin| runs.is_sure(margin) && is_new(margin)) {
            let gradient = |point| runs.gradient(point, &graze, tangent, track.radius);
            let start = &from.node.point;
            let Some(slope) = gradient(start)? else { continue };
            let Some(foot) = correct(runs, &graze, start, &slope, reach)? else { continue };
            let Some(gradient) = gradient(&foot.point)? else { continue };
            let along = Point::new(-gradient.y, gradient.x).normalize();
            let along = along * along.dot(tangent).signum();
            for side in [1.0, -1.0] {
                consider(&Root {
                    runs,
                    own,
                    graze: &graze,
                    foot: foot.point,
                    along,
                    gradient,
                    side,
                })?;
            }
        }
    }
    Ok(())
}

/// A margin beside the boundary of a graze. It has a square root in the margin of the graze.
pub(crate) struct Root<'r, F: Family> {
    pub runs: &'r Runs<'r, F>,
    pub own: &'r F::Margin,
    pub graze: &'r F::Margin,
    /// A place on the boundary of the graze, with a unit vector along it and the gradient there.
    pub foot: Point,
    pub along: Point,
    pub gradient: Point,
    /// 1 or −1: the sign that the margin of the graze has on the side on which this margin exists.
    pub side: f64,
}

impl<F: Family> Root<'_, F> {
    /// The place along the boundary where m₀ vanishes, and its largest error.
    pub fn place(&self) -> Traced<Option<(f64, f64)>, F> {
        let Lengths { piece, half, touch, same, solved, .. } = self.runs.lengths;
        let mut before = None;
        let mut best: Option<(f64, f64)> = None;
        // A larger distance has a larger error of the polynomial, a smaller one of the runs.
        for near in [piece, half, touch, same, solved] {
            let place = self.zero(near)?;
            if let (Some(before), Some(place)) = (before, place) {
                let difference: f64 = place - before;
                let difference = difference.abs();
                if difference <= half && best.is_none_or(|(_, other)| difference < other) {
                    best = Some((place, difference.max(same)));
                }
            }
            before = place;
        }
        Ok(best)
    }

    /// The zero of m₀ by the secant method.
    fn zero(&self, near: f64) -> Traced<Option<f64>, F> {
        let Lengths { scale, piece, touch, same, .. } = self.runs.lengths;
        let mut before = None;
        let limits = Limits { stalled: same, rounds: 20, ..Limits::new(0.1 * scale, 0.01 * same) };
        let zero: Traced<_, F> = solve(&Vector1::zeros(), &limits, |at, _| {
            let Some(value) = self.limit(at.x, near)? else { return Ok(None) };
            let mut slope = secant(&mut before, at.x, value);
            // The margin may exist on one side only.
            let mut steps = [piece, -piece, touch, -touch].into_iter();
            while slope.is_none()
                && let Some(step) = steps.next()
            {
                if let Some(ahead) = self.limit(at.x + step, near)? {
                    slope = Some((ahead - value) / step);
                    before = Some([at.x + step, ahead]);
                }
            }
            Ok(Some((Vector1::new(value), slope.map(Vector1::new))))
        });
        Ok(zero?.ok().map(|zero| zero.at.x))
    }

    /// The point of the boundary of the graze at a place along it.
    pub fn point(&self, place: f64) -> Traced<Option<Point>, F> {
        let guess = self.foot + self.along * place;
        let reach = 0.3 * place.abs() + self.runs.lengths.piece;
        Ok(correct(self.runs, self.graze, &guess, &self.gradient, reach)?.map(|found| found.point))
    }

    /// m₀ at a place along the boundary: the polynomial in √r through the values of the margin at
    /// four distances.
    fn limit(&self, place: f64, near: f64) -> Traced<Option<f64>, F> {
        let Some(point) = self.point(place)? else { return Ok(None) };
        let inwards = self.gradient.normalize() * (self.side * near);
        let mut values = [(0.0, 0.0); 4];
        for (times, value) in [1.0, 4.0, 9.0, 16.0].into_iter().zip(&mut values) {
            let beside = point + inwards * times;
            let (Some(own), Some(graze)) =
                (self.runs.margin(&beside, self.own)?, self.runs.margin(&beside, self.graze)?)
            else {
                return Ok(None);
            };
            *value = ((self.side * graze).sqrt(), own);
        }
        let weight = |root: f64| {
            let others = values.iter().map(|(other, _)| *other).filter(|&other| other != root);
            others.map(|other| other / (other - root)).product::<f64>()
        };
        let limit = values.iter().map(|&(root, own)| own * weight(root)).sum::<f64>();
        Ok(Some(limit).filter(|limit| limit.is_finite()))
    }
}
