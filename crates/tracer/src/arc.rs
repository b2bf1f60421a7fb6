//! The cubic between two nodes, as steps and searches need it.

use crate::curve::Node;
use crate::family::Point;

/// The cubic that leaves one node and reaches the next with their tangents, θ from 0 to 1.
///
/// Both handles are (2/3)·|chord|/(1 + cos(φ/2)) long, φ the angle between the tangents, as for an arc of a circle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arc {
    points: [Point; 4],
}

impl Arc {
    pub fn between(from: &Node, to: &Node) -> Self {
        let cosine = from.tangent.dot(&to.tangent).clamp(-1.0, 1.0);
        let half = (0.5 * (1.0 + cosine)).sqrt();
        let handle = 2.0 / 3.0 * (to.point - from.point).norm() / (1.0 + half);
        let (leave, reach) = (from.tangent * handle, to.tangent * handle);
        Self { points: [from.point, from.point + leave, to.point - reach, to.point] }
    }

    pub fn chord(&self) -> f64 {
        (self.points[3] - self.points[0]).norm()
    }

    /// The point at θ, which may lie beyond the ends.
    pub fn point(&self, theta: f64) -> Point {
        let [a, b, c, d] = self.points;
        let rest = 1.0 - theta;
        a * (rest * rest * rest)
            + b * (3.0 * rest * rest * theta)
            + c * (3.0 * rest * theta * theta)
            + d * (theta * theta * theta)
    }

    /// The derivative by θ.
    pub fn velocity(&self, theta: f64) -> Point {
        let [a, b, c, d] = self.points;
        let rest = 1.0 - theta;
        (b - a) * (3.0 * rest * rest)
            + (c - b) * (6.0 * rest * theta)
            + (d - c) * (3.0 * theta * theta)
    }

    pub fn tangent(&self, theta: f64) -> Point {
        self.velocity(theta).normalize()
    }

    /// Least and greatest coordinates of the four points whose hull holds the piece.
    pub fn bounds(&self) -> [Point; 2] {
        let [a, b, c, d] = self.points;
        [a.inf(&b).inf(&c).inf(&d), a.sup(&b).sup(&c).sup(&d)]
    }

    /// The place θ in [0, 1] that is closest to `point`, and its distance; for pieces that turn by less than a right angle.
    pub fn closest(&self, point: &Point) -> (f64, f64) {
        let chord = self.points[3] - self.points[0];
        let mut theta =
            ((point - self.points[0]).dot(&chord) / chord.norm_squared()).clamp(0.0, 1.0);
        for _ in 0..8 {
            let velocity = self.velocity(theta);
            let next = theta + (point - self.point(theta)).dot(&velocity) / velocity.norm_squared();
            let next = if next.is_finite() { next.clamp(0.0, 1.0) } else { theta };
            let moved = (next - theta).abs();
            theta = next;
            if moved < 1e-15 {
                break;
            }
        }
        (theta, (point - self.point(theta)).norm())
    }

    /// The places θ in [0, 1) where it crosses the segment from `a` to `b`, for pieces that turn by less than a right angle, each
    /// with the place on the segment, from 0 to 1.
    pub fn crossings(&self, a: &Point, b: &Point) -> Vec<[f64; 2]> {
        let along = b - a;
        let heights = self.points.map(|point| along.perp(&(point - a)));
        let mut found = Vec::new();
        for theta in cubic_roots(heights) {
            let place = (self.point(theta) - a).dot(&along) / along.norm_squared();
            if (0.0..=1.0).contains(&place) {
                found.push([theta, place]);
            }
        }
        found
    }
}

/// Zeros in [0, 1) of a cubic in Bernstein form, by subdivision until a part has at most one change of sign.
fn cubic_roots(coefficients: [f64; 4]) -> Vec<f64> {
    let mut roots = Vec::new();
    let mut parts = vec![(coefficients, 0.0, 1.0, 0)];
    while let Some(([a, b, c, d], low, high, depth)) = parts.pop() {
        let positive = |value: f64| value >= 0.0;
        let changes =
            [(a, b), (b, c), (c, d)].iter().filter(|(x, y)| positive(*x) != positive(*y)).count();
        match changes {
            0 => {}
            1 => roots.push(bisect([a, b, c, d], low, high)),
            _ if depth < 40 => {
                let middle = 0.5 * (low + high);
                let [before, after] = halve([a, b, c, d]);
                parts.push((after, middle, high, depth + 1));
                parts.push((before, low, middle, depth + 1));
            }
            // A double root to rounding: no crossing.
            _ => {}
        }
    }
    roots
}

fn halve([a, b, c, d]: [f64; 4]) -> [[f64; 4]; 2] {
    let (ab, bc, cd) = (0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + d));
    let (abc, bcd) = (0.5 * (ab + bc), 0.5 * (bc + cd));
    let middle = 0.5 * (abc + bcd);
    [[a, ab, abc, middle], [middle, bcd, cd, d]]
}

fn bisect(mut coefficients: [f64; 4], mut low: f64, mut high: f64) -> f64 {
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        let [before, after] = halve(coefficients);
        if (before[0] >= 0.0) == (before[3] >= 0.0) {
            (coefficients, low) = (after, middle);
        } else {
            (coefficients, high) = (before, middle);
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crossings_of_an_arc_with_a_line() {
        let node = |angle: f64| Node {
            point: Point::new(angle.cos(), angle.sin()),
            tangent: Point::new(-angle.sin(), angle.cos()),
        };
        let arc = Arc::between(&node(-0.1), &node(0.1));
        let found = arc.crossings(&Point::new(0.999, -1.0), &Point::new(0.999, 1.0));
        assert_eq!(found.len(), 2);
        for [theta, place] in found {
            let crossing = arc.point(theta);
            assert!((crossing - Point::new(0.999, 2.0 * place - 1.0)).norm() < 1e-14);
            assert!((crossing.norm() - 1.0).abs() < 3e-9);
        }
        let (theta, distance) = arc.closest(&Point::new(1.1, 0.0));
        assert!((theta - 0.5).abs() < 1e-12 && (distance - 0.1).abs() < 1e-9);
    }
}
