//! Which codimension-2 points may have met between two atlases of different structure.

use crate::curve::Curve;
use crate::family::Family;
use crate::regions::outline::OutlinePart;
use crate::stack::conditions::{Condition, Conditions};
use crate::stack::structure::{Sample, side_of};
use crate::window::Point;

/// Conditions for points to meet, with a guess of the place.
pub(super) struct Candidate<Margin> {
    pub conditions: Conditions<Margin>,
    pub guess: Point,
    /// The distance of the points in the atlas.
    pub distance: f64,
}

/// The candidates of an atlas, by distance: the ends of each curve and of each part of the window's
/// boundary around the given regions and their neighbours, each closed curve, and where two curves
/// on which the same margin vanishes are closest.
pub(super) fn candidates<F: Family>(
    family: &F,
    sample: &Sample<F>,
    regions: &[usize],
) -> Vec<Candidate<F::Margin>> {
    let plane = &sample.atlas.plane;
    let mut regions = regions.to_vec();
    for index in 0..regions.len() {
        let around = plane.regions()[regions[index]].boundary.iter();
        regions.extend(around.flat_map(|&(curve, _)| plane.regions_beside(curve)).flatten());
    }
    regions.sort_unstable();
    regions.dedup();
    let mut found = Vec::new();
    let mut done = vec![false; plane.curves().len()];
    for stretch in regions.iter().flat_map(|&region| plane.outlines(region)).flatten() {
        match stretch {
            OutlinePart::Curve(curve, _) => {
                if !std::mem::replace(&mut done[curve], true) {
                    of_curve(family, sample, curve, &mut found);
                }
            }
            OutlinePart::Window(ends) => {
                let along = Condition::CurveSide(side_of(plane.window(), ends));
                let at_ends = ends.map(|point| at_edge(sample, &point, &along));
                push(&along, &at_ends, ends, &mut found);
            }
        }
    }
    for &region in &regions {
        let around = &plane.regions()[region].boundary;
        for (index, &(one, _)) in around.iter().enumerate() {
            for &(other, _) in &around[index + 1..] {
                reconnection(&plane.curves()[one], &plane.curves()[other], &mut found);
            }
        }
    }
    found.sort_by(|one, other| one.distance.total_cmp(&other.distance));
    found
}

fn of_curve<F: Family>(
    family: &F,
    sample: &Sample<F>,
    curve: usize,
    found: &mut Vec<Candidate<F::Margin>>,
) {
    let plane = &sample.atlas.plane;
    let own = &plane.curves()[curve];
    let Some(ends) = own.ends else {
        let count = own.nodes.len() as f64;
        let guess = own.nodes.iter().map(|node| node.point).sum::<Point>() / count;
        let distances = own.nodes.iter().map(|node| (node.point - guess).norm());
        let distance = distances.fold(0.0, f64::max);
        found.push(Candidate { conditions: Conditions::flat(&own.margin), guess, distance });
        return;
    };
    let along = Condition::Margin(own.margin.clone());
    let at_ends = ends.map(|vertex| at_vertex(sample, vertex, &along));
    let ends = ends.map(|vertex| plane.vertices()[vertex].point);
    push(&along, &at_ends, ends, found);
    of_merging(family, &own.margin, &at_ends, ends, found);
}

/// The candidates in which the extremum of a curve's margin merges with other extrema: a
/// swallowtail, and a cusp at one end of the curve that meets what else vanishes at the other end.
fn of_merging<F: Family>(
    family: &F,
    margin: &F::Margin,
    at_ends: &[Vec<Condition<F::Margin>>; 2],
    ends: [Point; 2],
    found: &mut Vec<Candidate<F::Margin>>,
) {
    let distance = (ends[1] - ends[0]).norm();
    let mut push = |conditions, guess| {
        found.push(Candidate { conditions, guess, distance });
    };
    if let Some(margins) = family.swallowtail(margin) {
        push(Conditions::swallowtail(margins), ends[0].lerp(&ends[1], 0.5));
    }
    for pair in family.cusps(margin) {
        let [one, two] = pair.map(Condition::Margin);
        for (others, guess) in at_ends.iter().zip([ends[1], ends[0]]) {
            for other in others.iter().filter(|other| **other != two) {
                push(Conditions::of(&one, [&two, other]), guess);
            }
        }
    }
}

/// The candidate for two curves of the same margin to reconnect.
fn reconnection<Label, Margin: Clone + PartialEq>(
    one: &Curve<Label, Margin>,
    other: &Curve<Label, Margin>,
    found: &mut Vec<Candidate<Margin>>,
) {
    if one.margin != other.margin {
        return;
    }
    let pairs = one.nodes.iter().flat_map(|a| other.nodes.iter().map(move |b| [a.point, b.point]));
    let nearest = pairs.map(|[a, b]| ((b - a).norm(), a.lerp(&b, 0.5)));
    if let Some((distance, guess)) = nearest.min_by(|a, b| a.0.total_cmp(&b.0)) {
        let conditions = Conditions::flat(&one.margin);
        found.push(Candidate { conditions, guess, distance });
    }
}

/// The candidates for one stretch, with what else vanishes at its ends.
fn push<Margin: Clone + PartialEq>(
    along: &Condition<Margin>,
    at_ends: &[Vec<Condition<Margin>>; 2],
    ends: [Point; 2],
    found: &mut Vec<Candidate<Margin>>,
) {
    let guess = ends[0].lerp(&ends[1], 0.5);
    let distance = (ends[1] - ends[0]).norm();
    for first in &at_ends[0] {
        for second in &at_ends[1] {
            let corners = [along, first, second];
            if corners.iter().all(|condition| condition.is_side()) {
                continue;
            }
            let conditions = Conditions::of(along, [first, second]);
            found.push(Candidate { conditions, guess, distance });
        }
    }
}

/// What vanishes at a vertex besides `along`.
fn at_vertex<F: Family>(
    sample: &Sample<F>,
    vertex: usize,
    along: &Condition<F::Margin>,
) -> Vec<Condition<F::Margin>> {
    let plane = &sample.atlas.plane;
    let own = &plane.vertices()[vertex];
    let mut conditions = Vec::new();
    if own.kind.is_on_window() {
        conditions.extend(sides_at(sample, &own.point));
    }
    let arriving = plane
        .curves()
        .iter()
        .filter(|curve| curve.ends.is_some_and(|ends| ends.contains(&vertex)))
        .map(|curve| &curve.margin);
    for margin in own.margins.iter().chain(arriving) {
        let condition = Condition::Margin(margin.clone());
        if !conditions.contains(&condition) {
            conditions.push(condition);
        }
    }
    conditions.retain(|condition| condition != along);
    conditions
}

/// What vanishes at a point on the window's boundary besides `along`.
fn at_edge<F: Family>(
    sample: &Sample<F>,
    point: &Point,
    along: &Condition<F::Margin>,
) -> Vec<Condition<F::Margin>> {
    let plane = &sample.atlas.plane;
    let near = 10.0 * plane.tolerance();
    let vertices = plane.vertices().iter().enumerate();
    let nearest = vertices
        .map(|(index, vertex)| (index, (vertex.point - point).norm()))
        .filter(|&(_, distance)| distance <= near)
        .min_by(|one, other| one.1.total_cmp(&other.1));
    match nearest {
        Some((vertex, _)) => at_vertex(sample, vertex, along),
        None => sides_at(sample, point).filter(|side| side != along).collect(),
    }
}

/// The sides of the window on which a point lies.
fn sides_at<F: Family>(
    sample: &Sample<F>,
    point: &Point,
) -> impl Iterator<Item = Condition<F::Margin>> {
    let window = sample.atlas.plane.window();
    let near = 10.0 * sample.atlas.plane.tolerance();
    let distances = [
        point.y - window.low.y,
        window.high.x - point.x,
        window.high.y - point.y,
        point.x - window.low.x,
    ];
    (0..4).filter(move |&side: &usize| distances[side].abs() <= near).map(Condition::CurveSide)
}
