//! Parts of boundaries along which the first axis rises.

use stickslip_model::{Collision, Engine};
use stickslip_plane::CollisionPlane;
use stickslip_tracer::Cubic;

/// The least distance at which a boundary is looked for, as a part of y.
const NEAREST: f64 = 1e-12;

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
    pub cubics: Vec<Cubic>,
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
    pub fn move_end(&mut self, end: usize, x: f64) {
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

    /// The itinerary of the collision at a place, computed in `collision`; `None` if there is no
    /// collision.
    pub fn itinerary_at(&self, place: [f64; 2], collision: &mut Collision) -> Option<String> {
        let contact = self.plane.contact_at(place).ok()?;
        Engine::Auto.collide_into(contact, collision).ok()?;
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
