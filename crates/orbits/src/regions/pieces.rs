//! The curves on which orbits change, divided where they meet.

use rayon::prelude::*;
use stickslip_tracer::{
    Cubic, Curve, Node, Point, Vertex, VertexKind, Window,
    regions::{Finding, Subdivision},
    tracing::Unresolved,
};

use super::cover::{Cover, are_near};
use super::{FollowedOrbits, OrbitBoundary, RegionOptions};
use crate::branch::curve::{SpecialCurve, distance};
use crate::branch::{SpecialKind, SpecialOrbit};
use crate::error::OrbitError;
use crate::orbit::Orbit;

/// Two places so near, in parts of the longer side of the window, are one vertex.
const ONE_VERTEX: f64 = 1e-6;
/// How far from a curve its sides are looked at, in parts of the window.
const ASIDE: f64 = 1e-6;
/// Rounds of dividing curves where they cross.
const ROUNDS: usize = 20;

/// What makes the regions.
pub(super) struct Drawn {
    pub curves: Vec<Piece>,
    pub vertices: Vec<Vertex<OrbitBoundary>>,
    pub unresolved: Vec<Unresolved<FollowedOrbits>>,
    pub nodes: usize,
}

type Piece = Curve<FollowedOrbits, OrbitBoundary>;

/// What is special: its kind, segment and rule.
type What = (SpecialKind, Option<usize>, Option<usize>);

/// The curves of all that is special on the lines of a cover and changes what is followed.
pub(super) fn draw(
    cover: &Cover<'_>,
    window: &Window,
    options: &RegionOptions,
) -> Result<Drawn, OrbitError> {
    let size = window.extent().max();
    let mut sheet = Sheet {
        cover,
        size,
        window: *window,
        pieces: Vec::new(),
        vertices: Vec::new(),
        unresolved: Vec::new(),
    };
    // A point between makes the error 16 times less.
    let interpolation = options.tolerance * size;
    for point in &cover.lost {
        sheet.doubt(*point);
    }
    // Special orbits by what they are; curves of one kind may be the same.
    let mut kinds: Vec<(What, Vec<&SpecialOrbit>)> = Vec::new();
    for line in &cover.branches {
        let branch = &line.branch;
        if branch.objection.is_some()
            && let Some(last) = branch.points.last()
        {
            sheet.doubt(cover.place(last));
        }
        for special in &branch.specials {
            let beside = [special.behind.checked_sub(1), Some(special.behind)];
            let mut beside = beside.into_iter().flatten().filter_map(|k| branch.points.get(k));
            let inside = window.contains(&cover.place(&special.orbit));
            if !inside || !beside.any(Orbit::is_admissible) {
                continue;
            }
            let what = (special.kind, special.segment, special.rule);
            match kinds.iter_mut().find(|(own, _)| *own == what) {
                Some((_, all)) => all.push(special),
                None => kinds.push((what, vec![special])),
            }
        }
    }
    let followed = kinds.par_iter().map(|(_, specials)| {
        let mut known: Vec<(SpecialCurve, &SpecialOrbit)> = Vec::new();
        let mut lost: Vec<Point> = Vec::new();
        for &special in specials {
            if known.iter().any(|(curve, _)| passes(curve, special, cover, size)) {
                continue;
            }
            let (parameters, window) = (cover.parameters, cover.window);
            let most = Some(interpolation);
            match cover.orbits.curve_within(special, parameters, window, &options.branch, most) {
                Ok(curve) => known.push((curve, special)),
                Err(_) => lost.push(cover.place(&special.orbit)),
            }
        }
        (known, lost)
    });
    let mut all: Vec<(SpecialCurve, &SpecialOrbit)> = Vec::new();
    for (known, lost) in followed.collect::<Vec<_>>() {
        for point in lost {
            sheet.doubt(point);
        }
        all.extend(known);
    }
    // Of curves that are one, as where a segment vanishes at each fold, the first kind is drawn.
    all.sort_by_key(|(curve, _)| curve.kind);
    let reach = 10.0 * interpolation;
    for (place, (curve, special)) in all.iter().enumerate() {
        if !all[..place].iter().any(|(other, _)| covers(cover, other, curve, reach)) {
            sheet.add(curve, special);
        }
    }
    sheet.divide(options.tolerance * size)?;
    sheet.label();
    sheet.tidy();
    let nodes = sheet.pieces.iter().map(|it| it.nodes.len()).sum();
    let Sheet { pieces, vertices, unresolved, .. } = sheet;
    Ok(Drawn { curves: pieces, vertices, unresolved, nodes })
}

/// Whether a curve passes through a special orbit.
fn passes(curve: &SpecialCurve, special: &SpecialOrbit, cover: &Cover<'_>, size: f64) -> bool {
    let point = cover.place(&special.orbit);
    let segments = &special.orbit.segments;
    let same_rule =
        |orbit: &Orbit| orbit.segments.len() == segments.len() && curve.kind == special.kind;
    curve.points.windows(2).any(|pair| {
        let [from, to] = [0, 1].map(|k| cover.place(&pair[k]));
        let chord = to - from;
        let t = chord.dot(&(point - from)) / chord.norm_squared();
        let aside = (from + t * chord - point).norm();
        let sagitta = 1e-6 * size + 0.1 * chord.norm();
        same_rule(&pair[0])
            && (-0.01..=1.01).contains(&t)
            && aside <= sagitta
            && are_near(&pair[usize::from(t > 0.5)], &special.orbit, 0.05)
    })
}

/// The nodes of a curve.
fn nodes(cover: &Cover<'_>, curve: &SpecialCurve) -> Vec<Node> {
    let all = curve.points.iter().zip(&curve.tangents);
    all.map(|(orbit, tangent)| Node { point: cover.place(orbit), tangent: (*tangent).into() })
        .collect()
}

/// Whether a curve lies on another one, as near as this.
fn covers(cover: &Cover<'_>, one: &SpecialCurve, other: &SpecialCurve, reach: f64) -> bool {
    let own = nodes(cover, one);
    other.points.iter().all(|orbit| {
        let point = cover.place(orbit);
        let mut cubics = own.windows(2).map(|pair| Cubic::between(&pair[0], &pair[1]));
        cubics.any(|cubic| distance(&cubic, &point) <= reach)
    })
}

struct Sheet<'a> {
    cover: &'a Cover<'a>,
    window: Window,
    /// The longer side of the window.
    size: f64,
    pieces: Vec<Piece>,
    vertices: Vec<Vertex<OrbitBoundary>>,
    unresolved: Vec<Unresolved<FollowedOrbits>>,
}

impl Sheet<'_> {
    /// Something at a place is not explained.
    fn doubt(&mut self, point: Point) {
        let known = self.unresolved.iter().any(|it| match it {
            Unresolved::Change { between, .. } => (between[0] - point).norm() <= 1e-6 * self.size,
            _ => false,
        });
        if !known {
            let labels = [FollowedOrbits::default(), FollowedOrbits::default()];
            self.unresolved.push(Unresolved::Change { between: [point, point], labels });
        }
    }

    /// The vertex at a place.
    fn vertex(&mut self, point: Point, kind: VertexKind, margin: &OrbitBoundary) -> usize {
        let near = ONE_VERTEX * self.size;
        let place = self.vertices.iter().position(|it| (it.point - point).norm() <= near);
        let place = place.unwrap_or_else(|| {
            self.vertices.push(Vertex { point, kind, margins: Vec::new() });
            self.vertices.len() - 1
        });
        let own = &mut self.vertices[place];
        if !own.margins.contains(margin) {
            own.margins.push(margin.clone());
        }
        if own.kind == VertexKind::Degenerate {
            own.kind = kind;
        }
        place
    }

    /// The vertex at an end of a curve.
    fn end(&mut self, node: &Node, margin: &OrbitBoundary) -> usize {
        let Window { low, high } = self.window;
        let inside = (node.point - low).inf(&(high - node.point)).min();
        let on_edge = inside <= 1e-9 * self.size;
        let kind = if on_edge { VertexKind::WindowEdge } else { VertexKind::Degenerate };
        self.vertex(node.point, kind, margin)
    }

    /// The pieces of a curve between its meetings.
    fn add(&mut self, curve: &SpecialCurve, special: &SpecialOrbit) {
        let system = self.cover.orbits.system();
        let mode = special.segment.map(|segment| special.orbit.segments[segment].leg.mode);
        let rule = mode.zip(special.rule);
        let margin = OrbitBoundary {
            kind: curve.kind,
            segment: special.segment,
            rule: rule.map(|(mode, rule)| system.modes[mode].rules[rule].name(rule)),
        };
        if curve.objection.is_some() {
            for orbit in [curve.points.first(), curve.points.last()].into_iter().flatten() {
                let place = self.cover.place(orbit);
                let Window { low, high } = self.window;
                if (place - low).inf(&(high - place)).min() > 1e-9 * self.size {
                    self.doubt(place);
                }
            }
        }
        let node = |orbit: &Orbit, tangent: [f64; 2]| Node {
            point: self.cover.place(orbit),
            tangent: tangent.into(),
        };
        let mut all: Vec<(Node, bool, bool)> = Vec::new();
        let mut meetings = curve.meetings.iter().peekable();
        for (k, (orbit, tangent)) in curve.points.iter().zip(&curve.tangents).enumerate() {
            while let Some(met) = meetings.next_if(|it| it.behind <= k) {
                let is_cusp = met.kind == SpecialKind::Cusp;
                all.push((node(&met.orbit, met.tangent), true, is_cusp));
            }
            all.push((node(orbit, *tangent), false, false));
        }
        all.extend(
            meetings
                .map(|met| (node(&met.orbit, met.tangent), true, met.kind == SpecialKind::Cusp)),
        );
        if curve.closed
            && let Some(first) = all.first().copied()
        {
            all.push((first.0, false, false));
        }
        // Nodes at one place are one.
        let near = 1e-3 * ONE_VERTEX * self.size;
        all.dedup_by(|later, earlier| {
            let same = (later.0.point - earlier.0.point).norm() <= near;
            if same {
                earlier.1 |= later.1;
                earlier.2 |= later.2;
            }
            same
        });
        let cuts: Vec<usize> = (0..all.len()).filter(|&k| all[k].1).collect();
        let last = all.len().saturating_sub(1);
        if last == 0 {
            return;
        }
        let mut bounds: Vec<usize> = [0].into_iter().chain(cuts.iter().copied()).collect();
        bounds.push(last);
        bounds.dedup();
        let whole = curve.closed && cuts.is_empty();
        for pair in bounds.windows(2) {
            let mut nodes: Vec<Node> = all[pair[0]..=pair[1]].iter().map(|it| it.0).collect();
            nodes.dedup_by(|later, earlier| (later.point - earlier.point).norm() <= near);
            let count = nodes.len();
            if count < 2 {
                continue;
            }
            // At a cusp the direction is that of the side from which it is reached.
            let chord = |one: &Node, other: &Node| (other.point - one.point).normalize();
            if all[pair[0]].2 {
                nodes[0].tangent = chord(&nodes[0], &nodes[1]);
            }
            if all[pair[1]].2 {
                nodes[count - 1].tangent = chord(&nodes[count - 2], &nodes[count - 1]);
            }
            let ends = (!whole).then(|| {
                let ends = [nodes[0], nodes[count - 1]].map(|it| self.end(&it, &margin));
                nodes[0].point = self.vertices[ends[0]].point;
                nodes[count - 1].point = self.vertices[ends[1]].point;
                ends
            });
            if count == 2 && nodes[0].point == nodes[1].point {
                continue;
            }
            let sides = [FollowedOrbits::default(), FollowedOrbits::default()];
            self.pieces.push(Curve { margin: margin.clone(), sides, nodes, ends });
        }
    }

    /// Divides pieces where they cross.
    fn divide(&mut self, tolerance: f64) -> Result<(), OrbitError> {
        for _ in 0..ROUNDS {
            let (pieces, vertices) = (self.pieces.clone(), self.vertices.clone());
            let plane = Subdivision::new(self.window, pieces, vertices, tolerance);
            let plane = plane.map_err(|error| OrbitError::Regions(error.to_string()))?;
            let crossings = plane.findings().iter().filter_map(|it| match it {
                Finding::Crossing { curves: [Some(one), Some(other)], point } => {
                    Some(([*one, *other], *point))
                }
                _ => None,
            });
            let mut crossings: Vec<_> = crossings.collect();
            // Each piece is divided once in a round, since its parts have other places.
            let mut used = Vec::new();
            crossings.retain(|(pair, _)| {
                let free = pair[0] != pair[1] && !pair.iter().any(|it| used.contains(it));
                used.extend(pair);
                free
            });
            if crossings.is_empty() {
                return Ok(());
            }
            for (pair, point) in crossings {
                let [one, other] = pair.map(|it| self.pieces[it].margin.clone());
                self.vertex(point, VertexKind::Crossing, &one);
                let vertex = self.vertex(point, VertexKind::Crossing, &other);
                for piece in pair {
                    self.split(piece, vertex);
                }
            }
        }
        Ok(())
    }

    /// Divides a piece at a vertex on it.
    fn split(&mut self, piece: usize, vertex: usize) {
        let point = self.vertices[vertex].point;
        let own = self.pieces[piece].clone();
        let cubics = own.nodes.windows(2).map(|pair| Cubic::between(&pair[0], &pair[1]));
        let near = cubics.map(|cubic| {
            let mut t = (0..=20).map(|k| f64::from(k) / 20.0).min_by(|a, b| {
                let away = |t: f64| (cubic.at(t) - point).norm();
                away(*a).total_cmp(&away(*b))
            });
            let mut at = t.take().unwrap_or(0.5);
            for _ in 0..20 {
                let along = cubic.derivative(at);
                at += along.dot(&(point - cubic.at(at))) / along.norm_squared();
                at = at.clamp(0.0, 1.0);
            }
            ((cubic.at(at) - point).norm(), at, cubic)
        });
        let nearest = near.enumerate().min_by(|one, other| one.1.0.total_cmp(&other.1.0));
        let Some((k, (_, at, cubic))) = nearest else { return };
        if own.ends.is_some_and(|ends| ends.contains(&vertex)) {
            return;
        }
        let tangent = cubic.derivative(at).normalize();
        let middle = Node { point, tangent };
        let first: Vec<Node> = own.nodes[..=k].iter().copied().chain([middle]).collect();
        let second: Vec<Node> =
            [middle].into_iter().chain(own.nodes[k + 1..].iter().copied()).collect();
        let parts = if let Some([from, to]) = own.ends {
            vec![(first, [from, vertex]), (second, [vertex, to])]
        } else {
            // A closed curve begins and ends there.
            let nodes = second.into_iter().chain(first.into_iter().skip(1)).collect();
            vec![(nodes, [vertex, vertex])]
        };
        let made = parts.into_iter().map(|(mut nodes, ends)| {
            nodes.dedup_by(|later, earlier| later.point == earlier.point);
            Curve { nodes, ends: Some(ends), ..own.clone() }
        });
        let mut made: Vec<Piece> = made.filter(|it| it.nodes.len() > 1).collect();
        if let Some(first) = made.pop() {
            self.pieces[piece] = first;
            self.pieces.extend(made);
        }
    }

    /// Asks for the labels beside each piece, in its middle.
    fn label(&mut self) {
        let extent = self.window.extent();
        let middles = self.pieces.iter().map(|piece| {
            let length = |pair: &[Node]| (pair[1].point - pair[0].point).norm();
            let whole: f64 = piece.nodes.windows(2).map(length).sum();
            let mut before = 0.0;
            let middle = piece.nodes.windows(2).find(|pair| {
                before += length(pair);
                before >= 0.5 * whole
            });
            let pair = middle.unwrap_or(&piece.nodes[..2]);
            let cubic = Cubic::between(&pair[0], &pair[1]);
            let along = cubic.derivative(0.5).component_div(&extent).normalize();
            let left = Point::new(-along.y, along.x).component_mul(&extent);
            let point = cubic.at(0.5);
            [point + ASIDE * left, point - ASIDE * left]
        });
        let middles: Vec<[Point; 2]> = middles.collect();
        let labels = middles.par_iter().map(|both| both.map(|it| self.cover.label(&it)));
        let labels: Vec<_> = labels.collect();
        let pieces = std::mem::take(&mut self.pieces);
        for ((piece, labels), both) in pieces.into_iter().zip(labels).zip(middles) {
            match labels {
                [Ok(left), Ok(right)] if left == right => {}
                [Ok(left), Ok(right)] => {
                    self.pieces.push(Curve { sides: [left, right], ..piece });
                }
                _ => self.doubt(both[0].lerp(&both[1], 0.5)),
            }
        }
    }

    /// Leaves out vertices at which nothing ends.
    fn tidy(&mut self) {
        let ends = self.pieces.iter().filter_map(|it| it.ends).flatten();
        let used: std::collections::BTreeSet<usize> = ends.collect();
        let places: Vec<usize> = used.into_iter().collect();
        self.vertices = places.iter().map(|place| self.vertices[*place].clone()).collect();
        for end in self.pieces.iter_mut().filter_map(|it| it.ends.as_mut()).flatten() {
            *end = places.binary_search(end).unwrap_or(0);
        }
    }
}
