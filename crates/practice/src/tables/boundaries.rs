//! Traced boundaries as graphs over the first axis.

use stickslip_model::Collision;
use stickslip_plane::atlas::CollisionAtlas;
use stickslip_plane::{CollisionPlane, Range};
use stickslip_tracer::{Cubic, Node, Point};

use super::chain::Chain;

/// Walls that are closer than this part of x are one: traced boundaries are not finer.
const MERGED: f64 = 1e-11;

/// Boundaries as chains, and all x at which a chain begins or ends, with the ends of the window, in
/// ascending order.
pub struct Boundaries {
    pub chains: Vec<Chain>,
    pub walls: Vec<f64>,
}

impl Boundaries {
    pub fn of(division: &CollisionAtlas) -> Self {
        let CollisionAtlas { plane, regions, .. } = division;
        let shortest = MERGED * regions.window().extent().x;
        let Range { low, high } = plane.sheet().sides[0];
        let mut all = Vec::new();
        let mut walls = vec![low, high];
        for curve in regions.curves() {
            let mut nodes = curve.nodes.clone();
            if let Some([first, last]) = curve.ends {
                let vertices = regions.vertices();
                let end = nodes.len() - 1;
                nodes[0].point = vertices[first].point;
                nodes[end].point = vertices[last].point;
            } else {
                nodes.push(nodes[0]);
            }
            let mut chains = chains(plane, &nodes, &curve.sides);
            // Otherwise the boundary is a wall.
            let is_long = |chain: &Chain| {
                let first = chain.cubics[0].points[0];
                chain.cubics[chain.cubics.len() - 1].points[3].x - first.x > shortest
            };
            for k in 1..chains.len() {
                let ((_, one), (rises, other)) = (&chains[k - 1], &chains[k]);
                // The first one falls, and both begin at the turn; or it rises, and both end there.
                let end = usize::from(!rises);
                let both = is_long(one) && is_long(other);
                if let Some(turn) = both.then(|| turn(one, other, end)).flatten() {
                    chains[k - 1].1.move_end(end, turn);
                    chains[k].1.move_end(end, turn);
                }
            }
            for (_, chain) in chains {
                walls.extend(chain.ends);
                if is_long(&chain) {
                    all.push(chain);
                }
            }
        }
        Self { chains: all, walls: merged(walls, low, high) }
    }
}

/// The chains of a curve, in its order, and whether x rises in its direction.
fn chains(
    plane: &CollisionPlane,
    nodes: &[Node],
    [left, right]: &[String; 2],
) -> Vec<(bool, Chain)> {
    let chain = |(rises, cubics): (bool, Vec<Cubic>)| {
        // The left side is above where the curve runs to the right.
        let [below, above] = if rises { [right, left] } else { [left, right] };
        let ends = [cubics[0].points[0], cubics[cubics.len() - 1].points[3]];
        let ends = ends.map(|point| plane.parameters(&point)[0]);
        let sides = [below.clone(), above.clone()];
        (rises, Chain { plane: *plane, ends, shifts: [0.0; 2], sides, cubics })
    };
    monotone(nodes).into_iter().map(chain).collect()
}

/// The parts of a curve along which x rises or falls, each in the direction in which it rises, and
/// whether that is the direction of the curve.
fn monotone(nodes: &[Node]) -> Vec<(bool, Vec<Cubic>)> {
    let mut parts: Vec<(bool, Vec<Cubic>)> = Vec::new();
    for pair in nodes.windows(2) {
        for cubic in pieces(&Cubic::between(&pair[0], &pair[1])) {
            let rise = cubic.points[3].x - cubic.points[0].x;
            if rise == 0.0 {
                continue;
            }
            let rises = rise > 0.0;
            match parts.last_mut() {
                Some((direction, cubics)) if *direction == rises => cubics.push(cubic),
                _ => parts.push((rises, vec![cubic])),
            }
        }
    }
    let forwards = |(rises, mut cubics): (bool, Vec<Cubic>)| {
        if !rises {
            cubics.reverse();
            for cubic in &mut cubics {
                cubic.points.reverse();
            }
        }
        (rises, cubics)
    };
    let mut parts: Vec<_> = parts.into_iter().map(forwards).collect();
    // A curve that runs straight up has no part.
    if parts.is_empty() {
        let ends: [Point; 2] = [nodes[0].point, nodes[nodes.len() - 1].point];
        parts.push((true, vec![Cubic::line(ends[0], ends[1])]));
    }
    parts
}

/// The pieces of a cubic between its turns.
fn pieces(cubic: &Cubic) -> Vec<Cubic> {
    let (mut rest, mut done) = (*cubic, 0.0);
    let mut pieces = Vec::new();
    for cut in cubic.monotone_cuts() {
        let [part, after] = rest.split((cut - done) / (1.0 - done));
        pieces.push(part);
        (rest, done) = (after, cut);
    }
    pieces.push(rest);
    pieces
}

/// Different walls in ascending order, from `low` to `high`.
fn merged(mut walls: Vec<f64>, low: f64, high: f64) -> Vec<f64> {
    walls.sort_by(f64::total_cmp);
    let mut kept = vec![low];
    for wall in walls {
        let last = kept[kept.len() - 1];
        if wall - last > MERGED * wall && high - wall > MERGED * wall {
            kept.push(wall);
        }
    }
    kept.push(high);
    kept
}

/// The distance from a turn, as a part of x, at which its opening is measured.
const OPENING: f64 = 1e-8;

/// x of the turn at which two chains meet with their lower (0) or upper (1) ends.
///
/// Across the opening, x of the boundary over y is close to a parabola. Three crossings of it
/// determine the y of the turn, and a fourth one its x. `None` where collisions do not have the
/// switches of the two sides.
pub fn turn(one: &Chain, other: &Chain, end: usize) -> Option<f64> {
    let traced = one.ends[end];
    let inwards = OPENING * if end == 0 { traced } else { -traced };
    let [first, second] = [one, other].map(|chain| chain.y_at(traced + inwards));
    let outside = if first < second { &one.sides[0] } else { &other.sides[0] };
    let inside = if first < second { &one.sides[1] } else { &other.sides[1] };
    let (y, half) = (f64::midpoint(first, second), 0.5 * (first - second).abs());
    let mut collision = Collision::before(one.plane.contact_at([traced, y]).ok()?);
    let mut crossing = |y: f64| {
        let mut is = |x: f64, side: &String| {
            one.itinerary_at([x, y], &mut collision).is_some_and(|itinerary| itinerary == *side)
        };
        let (mut out, mut into) = (traced - 2.0 * inwards, traced + 2.0 * inwards);
        if !is(out, outside) || !is(into, inside) {
            return None;
        }
        loop {
            let middle = f64::midpoint(out, into);
            if middle == out || middle == into {
                return Some(middle);
            }
            if is(middle, inside) { into = middle } else { out = middle }
        }
    };
    let [below, at, above] = [crossing(y - half)?, crossing(y)?, crossing(y + half)?];
    let bend = below - 2.0 * at + above;
    let shift = 0.5 * half * (below - above) / bend;
    if shift.abs() <= half { crossing(y + shift) } else { None }
}
