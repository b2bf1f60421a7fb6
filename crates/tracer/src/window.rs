//! The parameter plane: its points, and the window that is traced.

use nalgebra::Vector2;

/// A point of the parameter plane, in the coordinates in which it is traced.
///
/// A family whose parameters span decades uses their logarithms as coordinates.
pub type Point = Vector2<f64>;

/// A rectangle of the parameter plane, in the coordinates of [`Point`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Window {
    /// The corner with the least coordinates.
    pub low: Point,
    /// The corner with the greatest coordinates.
    pub high: Point,
}

impl Window {
    /// Width and height.
    #[must_use]
    pub fn extent(&self) -> Point {
        self.high - self.low
    }

    /// The area.
    #[must_use]
    pub fn area(&self) -> f64 {
        let size = self.high - self.low;
        size.x * size.y
    }

    /// The corners, counterclockwise from `low`.
    #[must_use]
    pub fn corners(&self) -> [Point; 4] {
        let (low, high) = (self.low, self.high);
        [low, Point::new(high.x, low.y), high, Point::new(low.x, high.y)]
    }

    /// The window with its edges moved outwards, by a fraction of its shorter extent.
    pub(crate) fn with_room(&self, part: f64) -> Self {
        let by = Point::repeat(part * self.extent().min());
        Self { low: self.low - by, high: self.high + by }
    }

    /// How far inside the window a point lies: its distance from the nearest edge, below 0 outside.
    pub(crate) fn depth(&self, point: &Point) -> f64 {
        (point - self.low).min().min((self.high - point).min())
    }

    /// Whether a point lies inside or on the edge.
    #[must_use]
    pub fn contains(&self, point: &Point) -> bool {
        (0..2).all(|axis| (self.low[axis]..=self.high[axis]).contains(&point[axis]))
    }
}
