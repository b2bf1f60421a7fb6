//! Traced boundaries as graphs over the first axis.

use stickslip_model::{Collision, Engine};
use stickslip_plane::atlas::Division;
use stickslip_plane::{CollisionPlane, Range};
use stickslip_tracer::{Cubic, Node, Point};

/// The least distance at which a boundary is looked for, as a part of y.
const NEAREST: f64 = 1e-12;
/// Walls that are closer than this part of x are one: traced boundaries are not finer.
const MERGED: f64 = 1e-11;

/// A part of a boundary along which x rises, as y over x. These are the two axes of the table, and
/// not the traced coordinates.
pub struct Chain {
    plane: CollisionPlane,
    /// Parts along which x rises, in the order of x.
    cubics: Vec<Cubic>,
    /// The itineraries of collisions below and above.
    sides: [String; 2],
}

impl Chain {
    fn ends(&self) -> [f64; 2] {
        let first = self.cubics[0].points[0];
        let last = self.cubics[self.cubics.len() - 1].points[3];
        [first, last].map(|point| self.plane.parameters(&point)[0])
    }

    /// Whether the chain has a point at `x`.
    pub fn covers(&self, x: f64) -> bool {
        let [low, high] = self.ends();
        (low..=high).contains(&x)
    }

    /// y of the chain at `x`, or at its nearer end, as accurate as it was traced.
    pub fn y_at(&self, x: f64) -> f64 {
        let x = self.plane.chart().abscissa(x);
        let behind = self.cubics.partition_point(|cubic| cubic.points[3].x < x);
        let cubic = &self.cubics[behind.min(self.cubics.len() - 1)];
        self.plane.parameters(&cubic.at(parameter_at(cubic, x)))[1]
    }

    /// The lesser of the differences in y from the chain at the `distance` in x on both sides.
    pub fn rise(&self, x: f64, distance: f64) -> f64 {
        let y = self.y_at(x);
        let rise = |x| (self.y_at(x) - y).abs();
        rise(x - distance).min(rise(x + distance))
    }

    /// y of the boundary at `x` to the last digits, by bisection of what collisions do from `y` on,
    /// up to the distance `reach`. It is `y` itself where collisions so near do not have the
    /// switches of the two sides.
    pub fn refined(&self, x: f64, y: f64, reach: f64, collision: &mut Collision) -> f64 {
        let mut side_of = |y: f64| {
            let contact = self.plane.contact_at([x, y]).ok()?;
            Engine::Exact.collide_into(contact, collision).ok()?;
            let itinerary = collision.itinerary();
            self.sides.iter().position(|side| *side == itinerary)
        };
        let mut distance = NEAREST * y;
        while distance <= reach {
            let (mut low, mut high) = (y - distance, y + distance);
            if side_of(low) == Some(0) && side_of(high) == Some(1) {
                loop {
                    let middle = f64::midpoint(low, high);
                    if middle <= low || middle >= high {
                        return middle;
                    }
                    match side_of(middle) {
                        Some(0) => low = middle,
                        Some(_) => high = middle,
                        None => return y,
                    }
                }
            }
            distance *= 4.0;
        }
        y
    }
}

/// The parameter at which a cubic with rising x has the coordinate `x`, by bisection, or the nearer
/// end.
fn parameter_at(cubic: &Cubic, x: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    if x <= cubic.points[0].x {
        return low;
    }
    if x >= cubic.points[3].x {
        return high;
    }
    loop {
        let middle = f64::midpoint(low, high);
        if middle <= low || middle >= high {
            return middle;
        }
        if cubic.at(middle).x < x { low = middle } else { high = middle }
    }
}

/// Boundaries as chains, and all x at which a chain begins or ends, with the ends of the window, in
/// ascending order.
pub struct Boundaries {
    pub chains: Vec<Chain>,
    pub walls: Vec<f64>,
}

impl Boundaries {
    pub fn of(division: &Division) -> Self {
        let Division { plane, regions, .. } = division;
        let width = regions.window().extent().x;
        let Range { low, high } = plane.sheet().sides[0];
        let mut chains = Vec::new();
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
            for (rises, cubics) in monotone(&nodes) {
                // The left side is above where the curve runs to the right.
                let [left, right] = curve.sides.clone();
                let sides = if rises { [right, left] } else { [left, right] };
                let [from, to] = [cubics[0].points[0].x, cubics[cubics.len() - 1].points[3].x];
                let chain = Chain { plane: *plane, cubics, sides };
                walls.extend(chain.ends());
                // Otherwise the boundary is a wall.
                if to - from > MERGED * width {
                    chains.push(chain);
                }
            }
        }
        Self { chains, walls: merged(walls, low, high) }
    }
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
