//! The names of points at which two conditions hold together.

use stickslip_solver::margin::{Margin, Place};

use crate::curve::{Curve, Vertex};
use crate::lengths::{Lengths, angle};
use crate::regions::subdivision::Subdivision;
use crate::tracing::network::Network;
use crate::window::{Point, Window};

/// What happens at a vertex inside the window: a point of codimension 2, at which two conditions
/// hold together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SpecialPoint {
    /// Two boundaries cross that have nothing to do with each other.
    Crossing,
    /// Two different extrema graze in one run.
    DoubleGraze,
    /// Two extrema of one guard merge where they graze: two boundaries end with one tangent.
    Cusp,
    /// A graze reaches the end of the run, and a boundary of events at the end goes on.
    GrazeAtEnd,
    /// Two events happen at one instant: both at the end of the run, or two that swap their order.
    SimultaneousEvents,
    /// Two boundaries touch: one begins on the other with its tangent. The boundary of a graze
    /// behind another graze does so, with a square root.
    Tangency,
    /// None of these: a boundary ends, or turns into another one.
    Other,
}

/// The end of a curve at a vertex.
struct Arrival<'a> {
    margin: &'a Margin,
    /// The unit vector from the vertex along the curve.
    away: Point,
}

impl<Label> Network<Label, Margin> {
    /// The names of the vertices inside the window, with their indices.
    ///
    /// They follow from the margins of the curves that end at a vertex, and from the directions of
    /// these curves there. Curves that enclose less than 0.02 radians are taken for tangent.
    #[must_use]
    pub fn special_points(&self) -> Vec<(usize, SpecialPoint)> {
        special_points(&self.curves, &self.vertices, &self.window)
    }
}

impl<Label> Subdivision<Label, Margin> {
    /// The names of the vertices inside the window, with their indices, see
    /// [`Network::special_points`].
    #[must_use]
    pub fn special_points(&self) -> Vec<(usize, SpecialPoint)> {
        special_points(&self.curves, self.vertices(), &self.window)
    }
}

fn special_points<Label>(
    curves: &[Curve<Label, Margin>],
    vertices: &[Vertex<Margin>],
    window: &Window,
) -> Vec<(usize, SpecialPoint)> {
    let mut arrivals: Vec<Vec<Arrival>> = vertices.iter().map(|_| Vec::new()).collect();
    for curve in curves {
        let Some([start, end]) = curve.ends else { continue };
        let last = curve.nodes.len() - 1;
        let margin = &curve.margin;
        arrivals[start].push(Arrival { margin, away: curve.nodes[0].tangent });
        arrivals[end].push(Arrival { margin, away: -curve.nodes[last].tangent });
    }
    let inside = |vertex: &Vertex<Margin>| !vertex.kind.is_on_window();
    // Margins are cubic in the distance from a cusp, so that each branch has an end of its own.
    let near = 3.0 * Lengths::of(window.extent().min()).piece;
    let partner = |index: usize| {
        let beside = |other: &usize| {
            let distance = (vertices[*other].point - vertices[index].point).norm();
            *other != index && arrivals[*other].len() == 1 && distance <= near
        };
        (0..vertices.len()).find(beside).filter(|_| arrivals[index].len() == 1)
    };
    (0..vertices.len())
        .filter(|&index| inside(&vertices[index]) && !arrivals[index].is_empty())
        .map(|index| {
            let around = std::iter::once(index).chain(partner(index));
            let around: Vec<&Arrival> = around.flat_map(|index| &arrivals[index]).collect();
            (index, name(&around))
        })
        .collect()
}

/// The name of a vertex at which curves arrive.
fn name(arrivals: &[&Arrival<'_>]) -> SpecialPoint {
    let places = || arrivals.iter().map(|arrival| arrival.margin.place);
    let is_graze = |place: &Place| matches!(place, Place::Minimum { .. } | Place::Maximum { .. });
    let pairs = || {
        (0..arrivals.len()).flat_map(|index| {
            arrivals[index + 1..].iter().map(move |other| (arrivals[index], *other))
        })
    };
    let meets_end = |(one, other): (&Arrival<'_>, &Arrival<'_>)| {
        let [one, other] = [one.margin, other.margin];
        let graze_and_end = is_graze(&one.place) && other.place == Place::End
            || is_graze(&other.place) && one.place == Place::End;
        graze_and_end && same_phase(one, other)
    };
    let tangent = |(one, other): (&Arrival<'_>, &Arrival<'_>)| {
        one.away.dot(&other.away) > 0.0 && one.away.perp(&other.away).abs() < angle::TANGENT
    };
    let turns_back = |(one, other): (&Arrival<'_>, &Arrival<'_>)| one.away.dot(&other.away) > 0.0;
    let all_graze = places().all(|place| is_graze(&place));
    let is_order = |place: Place| matches!(place, Place::Exit(_));
    if arrivals.len() < 4 && pairs().any(meets_end) {
        SpecialPoint::GrazeAtEnd
    } else if places().all(|place| place == Place::End) || places().any(is_order) {
        SpecialPoint::SimultaneousEvents
    } else if arrivals.len() == 2 {
        let merges = all_graze && pairs().all(turns_back);
        if merges { SpecialPoint::Cusp } else { SpecialPoint::Other }
    } else if pairs().any(tangent) {
        SpecialPoint::Tangency
    } else if arrivals.len() >= 3 && all_graze {
        SpecialPoint::DoubleGraze
    } else if arrivals.len() >= 4 {
        SpecialPoint::Crossing
    } else {
        SpecialPoint::Other
    }
}

/// Whether the same guards fired before. The places from which each guard is watched do not matter.
pub(super) fn same_phase(one: &Margin, other: &Margin) -> bool {
    let [one, other] = [one, other].map(|margin| margin.exits.iter().map(|exit| exit.guard));
    one.eq(other)
}
