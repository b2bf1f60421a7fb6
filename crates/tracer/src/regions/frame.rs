//! The frame of a subdivision: the window's boundary, cut at its corners and at the vertices on it.

use crate::curve::{Curve, Vertex};
use crate::regions::finding::Finding;
use crate::window::{Point, Window};

/// The points on the window's boundary, counterclockwise: vertices, and the corners between them.
///
/// The vertices among `points` are moved onto the boundary, and the corners are added to `points`.
/// A vertex inside from which a short curve leads to the boundary stays where it is.
pub fn frame<Label, Margin>(
    window: &Window,
    curves: &[Curve<Label, Margin>],
    vertices: &[Vertex<Margin>],
    tolerance: f64,
    points: &mut Vec<Point>,
    findings: &mut Vec<Finding<Label>>,
) -> Vec<usize> {
    let stays_inside = |index: usize, point: &Point| {
        let leads = |curve: &Curve<Label, Margin>| {
            let other = match curve.ends {
                Some([start, end]) if start == index => end,
                Some([start, end]) if end == index => start,
                _ => return false,
            };
            vertices[other].kind.is_on_window()
                && curve.nodes.iter().all(|node| (node.point - point).norm() <= tolerance)
        };
        let is_inner = !vertices[index].kind.is_on_window() && window.depth(point) > 0.0;
        is_inner && curves.iter().any(leads)
    };
    let mut around = Vec::new();
    for (index, vertex) in vertices.iter().enumerate() {
        if let Some(point) = window.onto_boundary(&vertex.point, tolerance) {
            if !stays_inside(index, &points[index]) {
                points[index] = point;
                around.push(index);
            }
        } else if !window.contains(&vertex.point) || vertex.kind.is_on_window() {
            findings.push(Finding::VertexOffWindow { vertex: index });
        }
    }
    for corner in window.corners() {
        if !around.iter().any(|&vertex| points[vertex] == corner) {
            around.push(points.len());
        }
        // A corner is added even if it is a vertex, so that the number of points is fixed. It then
        // has no edges.
        points.push(corner);
    }
    around.sort_by(|&i, &j| {
        window.along_boundary(&points[i]).total_cmp(&window.along_boundary(&points[j]))
    });
    around
}

impl Window {
    /// `point`, moved onto the sides of the window that are closer than `tolerance`; `None` if
    /// there are none.
    pub(crate) fn onto_boundary(&self, point: &Point, tolerance: f64) -> Option<Point> {
        let snap = |value: f64, low: f64, high: f64| {
            [low, high].into_iter().find(|side| (value - side).abs() <= tolerance)
        };
        let x = snap(point.x, self.low.x, self.high.x);
        let y = snap(point.y, self.low.y, self.high.y);
        let inside = |value: f64, low: f64, high: f64| low <= value && value <= high;
        let on = x.is_some() && (y.is_some() || inside(point.y, self.low.y, self.high.y))
            || y.is_some() && inside(point.x, self.low.x, self.high.x);
        on.then(|| Point::new(x.unwrap_or(point.x), y.unwrap_or(point.y)))
    }

    /// The length of the boundary, counterclockwise, from `low` to a point on it.
    fn along_boundary(&self, point: &Point) -> f64 {
        let size = self.high - self.low;
        if point.y == self.low.y {
            point.x - self.low.x
        } else if point.x == self.high.x {
            size.x + (point.y - self.low.y)
        } else if point.y == self.high.y {
            size.x + size.y + (self.high.x - point.x)
        } else {
            2.0 * size.x + size.y + (self.high.y - point.y)
        }
    }
}
