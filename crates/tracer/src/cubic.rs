//! The cubic between two nodes, which makes a curve of points with tangents.

pub(crate) mod bernstein;
mod search;

use crate::cubic::bernstein::each_root;
use crate::curve::Node;
use crate::lengths::Lengths;
use crate::window::Point;

/// A cubic curve in the plane, given by its Bézier points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cubic {
    /// The first point, two handles and the last point.
    pub points: [Point; 4],
}

impl Cubic {
    /// The cubic from `from` to `to` with their tangents.
    ///
    /// Both handles have the length (2/3)·|chord|/(1 + cos(θ/2)), where θ is the angle between the
    /// tangents. On a circle of radius R this is the optimal length (4/3) R tan(θ/4), with an error
    /// of 4 R (θ/4)⁶/27. On other curves the error is of fourth order in the chord.
    ///
    /// ```
    /// use stickslip_tracer::{Cubic, Node, Point};
    ///
    /// let node = |angle: f64| Node {
    ///     point: Point::new(angle.cos(), angle.sin()),
    ///     tangent: Point::new(-angle.sin(), angle.cos()),
    /// };
    /// let arc = Cubic::between(&node(0.0), &node(0.1));
    /// for i in 0..=10 {
    ///     assert!((arc.at(f64::from(i) / 10.0).norm() - 1.0).abs() < 1e-10);
    /// }
    /// ```
    #[must_use]
    pub fn between(from: &Node, to: &Node) -> Self {
        let cosine = from.tangent.dot(&to.tangent).clamp(-1.0, 1.0);
        let half = (0.5 * (1.0 + cosine)).sqrt();
        let handle = 2.0 / 3.0 * (to.point - from.point).norm() / (1.0 + half);
        Self {
            points: [
                from.point,
                from.point + handle * from.tangent,
                to.point - handle * to.tangent,
                to.point,
            ],
        }
    }

    /// The straight line from `from` to `to`.
    #[must_use]
    pub fn line(from: Point, to: Point) -> Self {
        let third = (to - from) / 3.0;
        Self { points: [from, from + third, to - third, to] }
    }

    /// The point at `t` in [0, 1].
    #[must_use]
    pub fn at(&self, t: f64) -> Point {
        let [a, b, c, d] = self.points;
        let s = 1.0 - t;
        a * (s * s * s) + b * (3.0 * s * s * t) + c * (3.0 * s * t * t) + d * (t * t * t)
    }

    /// The derivative with respect to `t`.
    #[must_use]
    pub fn derivative(&self, t: f64) -> Point {
        let [a, b, c] = self.hodograph();
        let s = 1.0 - t;
        a * (s * s) + b * (2.0 * s * t) + c * (t * t)
    }

    /// The parts before and after `t`. The point between them is the same in both to the last bit.
    #[must_use]
    pub fn split(&self, t: f64) -> [Self; 2] {
        let [a, b, c, d] = self.points;
        let (ab, bc, cd) = (a.lerp(&b, t), b.lerp(&c, t), c.lerp(&d, t));
        let (abc, bcd) = (ab.lerp(&bc, t), bc.lerp(&cd, t));
        let middle = abc.lerp(&bcd, t);
        [Self { points: [a, ab, abc, middle] }, Self { points: [middle, bcd, cd, d] }]
    }

    /// The same points in the other direction.
    #[must_use]
    pub fn reversed(&self) -> Self {
        let [a, b, c, d] = self.points;
        Self { points: [d, c, b, a] }
    }

    /// ½∫(x dy − y dx) along the curve, with coordinates relative to `origin`, exact up to
    /// rounding. Summed over a closed counterclockwise path, it is the area inside.
    #[must_use]
    pub fn area(&self, origin: &Point) -> f64 {
        let [a, b, c, d] = self.points.map(|point| point - origin);
        let sum = 6.0 * (a.perp(&b) + c.perp(&d))
            + 3.0 * (a.perp(&c) + b.perp(&c) + b.perp(&d))
            + a.perp(&d);
        sum / 20.0
    }

    /// The parameters in (0, 1) that divide the cubic into pieces along which x, y and the
    /// direction are monotone, in ascending order.
    #[must_use]
    pub fn monotone_cuts(&self) -> Vec<f64> {
        // Closer to an end, the coordinates on the two sides of an extremum differ by rounding
        // only.
        let ends = Lengths::PARTS.same;
        let [a, b, c] = self.hodograph();
        let mut cuts = Vec::new();
        let mut keep = |t: f64| {
            if t > ends && t < 1.0 - ends {
                cuts.push(t);
            }
        };
        each_root(&[a.x, b.x, c.x], &mut keep);
        each_root(&[a.y, b.y, c.y], &mut keep);
        // c′ × c″ is of degree 2, because the cubic terms cancel.
        each_root(&[a.perp(&b), 0.5 * a.perp(&c), b.perp(&c)], &mut keep);
        cuts.sort_by(f64::total_cmp);
        cuts.dedup_by(|later, earlier| *later - *earlier < ends);
        cuts
    }

    /// The distance of `point` from the curve: the least distance from the ends and from the points
    /// at the roots of (c(t) − point)·c′(t).
    #[must_use]
    pub fn distance(&self, point: &Point) -> f64 {
        let p = self.points.map(|own| own - point);
        let d = self.hodograph();
        // The product of degrees 3 and 2 in the Bernstein basis of degree 5.
        let product = [
            p[0].dot(&d[0]),
            0.4 * p[0].dot(&d[1]) + 0.6 * p[1].dot(&d[0]),
            0.1 * p[0].dot(&d[2]) + 0.6 * p[1].dot(&d[1]) + 0.3 * p[2].dot(&d[0]),
            0.3 * p[1].dot(&d[2]) + 0.6 * p[2].dot(&d[1]) + 0.1 * p[3].dot(&d[0]),
            0.6 * p[2].dot(&d[2]) + 0.4 * p[3].dot(&d[1]),
            p[3].dot(&d[2]),
        ];
        let mut least = p[0].norm().min(p[3].norm());
        each_root(&product, &mut |t| least = least.min((self.at(t) - point).norm()));
        least
    }

    /// The Bézier points of the derivative.
    fn hodograph(&self) -> [Point; 3] {
        let [a, b, c, d] = self.points;
        [3.0 * (b - a), 3.0 * (c - b), 3.0 * (d - c)]
    }
}
