//! Seeds: from two places with different labels to a place on a boundary between them.

use crate::family::Family;
use crate::lengths::Lengths;
use crate::tracing::corrector::correct;
use crate::tracing::runs::{Runs, Traced};
use crate::window::Point;

/// A place on a boundary from which the boundary can be followed.
#[derive(Clone, Debug)]
pub struct Seed<Label, Margin> {
    /// The place.
    pub point: Point,
    /// A unit vector along the boundary.
    pub tangent: Point,
    /// The margin that vanishes on the boundary.
    pub margin: Margin,
    /// The labels where the margin is positive and where it is negative.
    pub labels: [Label; 2],
}

/// The seed of a family.
pub(crate) type SeedOf<F> = Seed<<F as Family>::Label, <F as Family>::Margin>;

impl<Label: Clone + Eq, Margin> Seed<Label, Margin> {
    /// A place between two others where the label of the first one ends; `None` if their labels are
    /// the same, or if no margin vanishes where the label changes.
    ///
    /// # Errors
    /// A run fails, or a margin is not a number.
    pub fn between<F: Family<Label = Label, Margin = Margin>>(
        runs: &Runs<'_, F>,
        places: &[Point; 2],
    ) -> Traced<Option<Self>, F> {
        let labels = [runs.label(&places[0])?, runs.label(&places[1])?];
        if labels[0] == labels[1] {
            return Ok(None);
        }
        let change = bisect(runs, places, [0.0, 1.0], labels)?;
        let near = change.places.map(|part| places[0].lerp(&places[1], part));
        identify(runs, &near, &change.labels)
    }
}

/// A place on a segment where the label of its start ends, bracketed.
pub(crate) struct Change<Label> {
    /// A place with the label of the start, and one close behind it with another label, from 0 to
    /// 1.
    pub places: [f64; 2],
    /// The labels at both places.
    pub labels: [Label; 2],
}

/// Bisects a change of the label between two places of the segment from `a` to `b`, down to 1e-9 of
/// the window's shorter extent, or to a thousandth of a segment that is shorter than a thousand of
/// these.
///
/// The result is a place where the label of the first place ends. Beyond it the label may change
/// again.
pub(crate) fn bisect<F: Family>(
    runs: &Runs<'_, F>,
    [a, b]: &[Point; 2],
    places: [f64; 2],
    labels: [F::Label; 2],
) -> Traced<Change<F::Label>, F> {
    let [mut low, mut high] = places;
    let [first, mut second] = labels;
    let width = (runs.lengths.same / (b - a).norm()).min(Lengths::PARTS.around);
    while high - low > width {
        let middle = 0.5 * (low + high);
        if !(middle > low && middle < high) {
            break;
        }
        let label = runs.label(&a.lerp(b, middle))?;
        if label == first {
            low = middle;
        } else {
            (high, second) = (middle, label);
        }
    }
    Ok(Change { places: [low, high], labels: [first, second] })
}

/// The boundary between two places that are close together: a margin of their free runs that
/// vanishes between them and has their labels on its sides.
pub(crate) fn identify<F: Family>(
    runs: &Runs<'_, F>,
    places: &[Point; 2],
    labels: &[F::Label; 2],
) -> Traced<Option<SeedOf<F>>, F> {
    /// The number of margins that are tried, those with the least values first.
    const CANDIDATES: usize = 12;
    /// The greatest slope of a margin that can be expected.
    const STEEPEST: f64 = 1e4;
    let mut margins: Vec<(F::Margin, f64)> = Vec::new();
    for place in places {
        margins.extend(runs.free(place)?.margins);
    }
    margins.sort_by(|(one, x), (two, y)| x.abs().total_cmp(&y.abs()).then_with(|| one.cmp(two)));
    // Of several margins that vanish together, the first one in their order is the simplest. Others
    // may belong to phases that vanish at the boundary, and so cease to exist there.
    let width = (places[1] - places[0]).norm();
    let together = margins.partition_point(|(_, value)| value.abs() <= STEEPEST * width);
    margins[..together].sort_by(|(one, _), (two, _)| one.cmp(two));
    let mut tried: Vec<F::Margin> = Vec::new();
    let middle = places[0].lerp(&places[1], 0.5);
    let along = (places[1] - places[0]) / width;
    for (margin, value) in margins {
        if tried.len() >= CANDIDATES {
            break;
        }
        if tried.contains(&margin) {
            continue;
        }
        tried.push(margin.clone());
        let Some(gradient) = runs.gradient(&middle, &margin, &along, runs.lengths.scale)? else {
            continue;
        };
        let slope = gradient.norm();
        let reach = 10.0 * width + 10.0 * runs.resolution(slope);
        let near = value.abs() <= slope * reach;
        if !near {
            continue;
        }
        let Some(found) = correct(runs, &margin, &middle, &gradient, reach)? else { continue };
        let labels = if gradient.dot(&(places[0] - places[1])) > 0.0 {
            labels.clone()
        } else {
            [labels[1].clone(), labels[0].clone()]
        };
        let tangent = Point::new(gradient.y, -gradient.x) / slope;
        let seed = Seed { point: found.point, tangent, margin, labels };
        if holds(runs, &seed, &gradient)? {
            return Ok(Some(seed));
        }
    }
    Ok(None)
}

/// Whether the free runs on both sides of a seed have its labels.
pub(crate) fn holds<F: Family>(
    runs: &Runs<'_, F>,
    seed: &Seed<F::Label, F::Margin>,
    gradient: &Point,
) -> Traced<bool, F> {
    let resolution = runs.resolution(gradient.norm());
    let mut offset = runs.options.offset.max(10.0 * resolution);
    // The zero of such a flat margin cannot be located.
    if offset.is_nan() || offset > runs.lengths.around {
        return Ok(false);
    }
    let normal = gradient.normalize();
    loop {
        if holds_at(runs, seed, &(normal * offset))? {
            return Ok(true);
        }
        offset *= 0.1;
        if offset < 5.0 * resolution {
            return Ok(false);
        }
    }
}

/// Whether the free runs on both sides of a seed have its labels at the least distance that margins
/// resolve, so that no other boundary beside it has them.
pub(crate) fn holds_closely<F: Family>(
    runs: &Runs<'_, F>,
    seed: &Seed<F::Label, F::Margin>,
    gradient: &Point,
) -> Traced<bool, F> {
    let slope = gradient.norm();
    holds_at(runs, seed, &(gradient * (10.0 * runs.resolution(slope) / slope)))
}

/// Whether the free runs have the labels of a seed at an offset from it and at its opposite.
fn holds_at<F: Family>(
    runs: &Runs<'_, F>,
    seed: &Seed<F::Label, F::Margin>,
    offset: &Point,
) -> Traced<bool, F> {
    Ok(runs.label(&(seed.point + offset))? == seed.labels[0]
        && runs.label(&(seed.point - offset))? == seed.labels[1])
}
