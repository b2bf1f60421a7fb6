//! The window's boundary, cut at its corners and at the vertices on it, and the outlines of
//! regions.

use crate::family::{Point, Window};
use crate::regions::subdivision::{Side, Subdivision};

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

    /// `point` moved onto the sides of the window that are within `tolerance` of it; `None` if
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

/// A part of the outline of a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stretch {
    /// A whole curve, by its index, with the side of it on which the region lies: backwards if that
    /// is the right.
    Curve(usize, Side),
    /// A straight part of the window's boundary.
    Window([Point; 2]),
}

impl<Label, Margin> Subdivision<Label, Margin> {
    /// The rings around a region, which lies on their left: one around all of it counterclockwise
    /// and one clockwise around each island. Where the region touches itself at a vertex, rings
    /// end there, so that none comes to a vertex twice; it may then have
    /// several counterclockwise ones. With [findings](Self::findings), rings that do not close are
    /// left out.
    #[must_use]
    pub fn outlines(&self, region: usize) -> Vec<Vec<Stretch>> {
        let mut rings = Vec::new();
        let mut unused = Vec::new();
        for (index, edge) in self.edges.iter().enumerate() {
            for (side, face) in
                [Side::Left, Side::Right].into_iter().zip(self.faces.of_edges[index])
            {
                if face != Some(region) {
                    continue;
                }
                let stretch = if index < self.curves.len() {
                    Stretch::Curve(index, side)
                } else {
                    // A side of the window is one piece, in its direction or turned.
                    let piece = &self.slabs.pieces[edge.pieces.start];
                    let [first, last] = [piece.first(), piece.last()];
                    Stretch::Window(if piece.forward { [first, last] } else { [last, first] })
                };
                match (edge.ends, side) {
                    (None, _) => rings.push(vec![stretch]),
                    (Some([from, to]), Side::Left) => unused.push((from, to, stretch)),
                    (Some([from, to]), Side::Right) => unused.push((to, from, stretch)),
                }
            }
        }
        let mut path: Vec<(usize, usize, Stretch)> = Vec::new();
        loop {
            let at = path.last().map(|&(_, to, _)| to);
            let next = unused.iter().position(|&(from, ..)| at.is_none_or(|at| at == from));
            match next {
                Some(next) => path.push(unused.remove(next)),
                None if path.is_empty() => return rings,
                None => path.clear(),
            }
            let end = path.last().map(|&(_, to, _)| to);
            if let Some(start) = path.iter().position(|&(from, ..)| Some(from) == end) {
                rings.push(path.drain(start..).map(|(_, _, stretch)| stretch).collect());
            }
        }
    }
}
