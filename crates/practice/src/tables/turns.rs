//! The places at which a boundary turns back in x, to the last digits.
//!
//! Beside a turn y is a root of the distance in x. An error of 1e-11 in the x at which the root
//! begins would be one of 1e-6 in y.

use stickslip_model::Collision;

use super::chain::Chain;

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
