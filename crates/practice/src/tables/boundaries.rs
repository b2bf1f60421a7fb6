//! Traced boundaries as graphs over the first axis.

use stickslip_model::{Collision, Engine};
use stickslip_plane::atlas::Division;
use stickslip_plane::{CollisionPlane, Range};
use stickslip_tracer::{Cubic, Node, Point};

use super::turns::turn;

/// The least distance at which a boundary is looked for, as a part of y.
const NEAREST: f64 = 1e-12;
/// Walls that are closer than this part of x are one: traced boundaries are not finer.
const MERGED: f64 = 1e-11;

/// A part of a boundary along which x rises, as y over x. These are the two axes of the table, and
/// not the traced coordinates.
pub struct Chain {
    pub plane: CollisionPlane,
    /// x of both ends.
    pub ends: [f64; 2],
    /// By how much x of both ends was less as it was traced.
    pub shifts: [f64; 2],
    /// The itineraries of collisions below and above.
    pub sides: [String; 2],
    /// Parts along which x rises, in the order of x.
    cubics: Vec<Cubic>,
}

impl Chain {
    /// Whether the chain has a point at `x`.
    pub fn covers(&self, x: f64) -> bool {
        let [low, high] = self.ends;
        (low..=high).contains(&x)
    }

    /// y of the chain at `x`, or at its nearer end, as accurate as it was traced.
    pub fn y_at(&self, x: f64) -> f64 {
        let [low, high] = self.ends;
        let part = (x - low) / (high - low);
        let shift = self.shifts[0] * (1.0 - part) + self.shifts[1] * part;
        let x = self.plane.chart().abscissa(x - shift);
        let behind = self.cubics.partition_point(|cubic| cubic.points[3].x < x);
        let cubic = &self.cubics[behind.min(self.cubics.len() - 1)];
        self.plane.parameters(&cubic.at(parameter_at(cubic, x)))[1]
    }

    /// Moves an end a little, and the rest of the chain with it.
    fn move_end(&mut self, end: usize, x: f64) {
        self.shifts[end] = x - self.ends[end];
        self.ends[end] = x;
    }

    /// The lesser of the differences in y from the chain at the `distance` in x on both sides, as
    /// far as the chain reaches.
    pub fn rise(&self, x: f64, distance: f64) -> f64 {
        let y = self.y_at(x);
        let sides = [x - distance, x + distance].into_iter().filter(|&x| self.covers(x));
        sides.map(|x| (self.y_at(x) - y).abs()).reduce(f64::min).unwrap_or(0.0)
    }

    /// y of the boundary at `x` to the last digits, by bisection of what collisions do from `y` on,
    /// up to the distance `reach`. It is `y` itself where collisions so near do not have the
    /// switches of the two sides.
    pub fn refined(&self, x: f64, y: f64, reach: f64, collision: &mut Collision) -> f64 {
        let mut side_of = |y: f64| {
            let itinerary = self.itinerary_at([x, y], collision)?;
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

    /// The itinerary of the collision at a place, computed in `collision`; `None` if there is none.
    pub fn itinerary_at(&self, place: [f64; 2], collision: &mut Collision) -> Option<String> {
        let contact = self.plane.contact_at(place).ok()?;
        Engine::Exact.collide_into(contact, collision).ok()?;
        Some(collision.itinerary())
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
