//! What traces need of the cubic between two nodes: places on it and crossings.

use crate::cubic::Cubic;
use crate::cubic::bernstein::each_root;
use crate::window::Point;

impl Cubic {
    pub(crate) fn chord(&self) -> f64 {
        (self.points[3] - self.points[0]).norm()
    }

    pub(crate) fn tangent(&self, theta: f64) -> Point {
        self.derivative(theta).normalize()
    }

    /// The least and the greatest coordinates of the four Bézier points, which enclose the cubic.
    pub(crate) fn bounds(&self) -> [Point; 2] {
        let [a, b, c, d] = self.points;
        [a.inf(&b).inf(&c).inf(&d), a.sup(&b).sup(&c).sup(&d)]
    }

    /// The place θ in [0, 1] that is closest to `point`, and its distance. The cubic must turn by
    /// less than a right angle.
    pub(crate) fn closest(&self, point: &Point) -> (f64, f64) {
        let chord = self.points[3] - self.points[0];
        let mut theta =
            ((point - self.points[0]).dot(&chord) / chord.norm_squared()).clamp(0.0, 1.0);
        for _ in 0..8 {
            let velocity = self.derivative(theta);
            let next = theta + (point - self.at(theta)).dot(&velocity) / velocity.norm_squared();
            let next = if next.is_finite() { next.clamp(0.0, 1.0) } else { theta };
            let moved = (next - theta).abs();
            theta = next;
            if moved < 1e-15 {
                break;
            }
        }
        (theta, (point - self.at(theta)).norm())
    }

    /// The places θ in [0, 1) where the cubic crosses the segment from `a` to `b`, each with the
    /// place on the segment, from 0 to 1. The cubic must turn by less than a right angle.
    pub(crate) fn crossings(&self, a: &Point, b: &Point) -> Vec<[f64; 2]> {
        let along = b - a;
        let heights = self.points.map(|point| along.perp(&(point - a)));
        let mut found = Vec::new();
        let mut keep = |theta: f64| {
            let place = (self.at(theta) - a).dot(&along) / along.norm_squared();
            if (0.0..=1.0).contains(&place) {
                found.push([theta, place]);
            }
        };
        if heights[0] == 0.0 {
            keep(0.0);
        }
        each_root(&heights, &mut keep);
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::Node;

    #[test]
    fn crossings_of_an_arc_with_a_line() {
        let node = |angle: f64| Node {
            point: Point::new(angle.cos(), angle.sin()),
            tangent: Point::new(-angle.sin(), angle.cos()),
        };
        let arc = Cubic::between(&node(-0.1), &node(0.1));
        let found = arc.crossings(&Point::new(0.999, -1.0), &Point::new(0.999, 1.0));
        assert_eq!(found.len(), 2);
        for [theta, place] in found {
            let crossing = arc.at(theta);
            assert!((crossing - Point::new(0.999, 2.0 * place - 1.0)).norm() < 1e-14);
            assert!((crossing.norm() - 1.0).abs() < 3e-9);
        }
        let (theta, distance) = arc.closest(&Point::new(1.1, 0.0));
        assert!((theta - 0.5).abs() < 1e-12 && (distance - 0.1).abs() < 1e-9);
    }
}
