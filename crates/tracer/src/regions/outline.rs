//! The window's boundary, cut at its corners and at the vertices on it.

use crate::family::{Point, Window};

impl Window {
    /// The corners, counterclockwise from `low`.
    #[must_use]
    pub fn corners(&self) -> [Point; 4] {
        let (low, high) = (self.low, self.high);
        [low, Point::new(high.x, low.y), high, Point::new(low.x, high.y)]
    }

    /// Its area.
    #[must_use]
    pub fn area(&self) -> f64 {
        let size = self.high - self.low;
        size.x * size.y
    }

    /// `point` moved onto the sides of the window that are within `tolerance` of it; `None` if there are none.
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

    /// How far along the boundary, counterclockwise from `low`, a point on it lies.
    pub(crate) fn along_boundary(&self, point: &Point) -> f64 {
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
