//! The outlines of regions: closed rings of curves and of parts of the window's boundary.

use crate::regions::region::CurveSide;
use crate::regions::subdivision::Subdivision;
use crate::window::Point;

/// A part of the outline of a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OutlinePart {
    /// A whole curve, given by its index, and the side on which the region lies. If this is the
    /// right side, the outline follows the curve backwards.
    Curve(usize, CurveSide),
    /// A straight part of the window's boundary.
    Window([Point; 2]),
}

impl<Label, Margin> Subdivision<Label, Margin> {
    /// The rings around a region, with the region on their left: a counterclockwise ring around the
    /// whole, and a clockwise ring around each island.
    ///
    /// No ring comes to a vertex twice. A region that touches itself at a vertex may therefore have
    /// several counterclockwise rings. If there are [findings](Self::findings), rings that do not
    /// close are left out.
    #[must_use]
    pub fn outlines(&self, region: usize) -> Vec<Vec<OutlinePart>> {
        let mut rings = Vec::new();
        let mut unused = Vec::new();
        for (index, edge) in self.edges.iter().enumerate() {
            for (side, face) in
                [CurveSide::Left, CurveSide::Right].into_iter().zip(self.faces.of_edges[index])
            {
                if face != Some(region) {
                    continue;
                }
                let stretch = if index < self.curves.len() {
                    OutlinePart::Curve(index, side)
                } else {
                    // A part of the window's boundary is one piece, in its direction or reversed.
                    let piece = &self.slabs.pieces[edge.pieces.start];
                    let [first, last] = [piece.first(), piece.last()];
                    OutlinePart::Window(if piece.forward { [first, last] } else { [last, first] })
                };
                match (edge.ends, side) {
                    (None, _) => rings.push(vec![stretch]),
                    (Some([from, to]), CurveSide::Left) => unused.push((from, to, stretch)),
                    (Some([from, to]), CurveSide::Right) => unused.push((to, from, stretch)),
                }
            }
        }
        let mut path: Vec<(usize, usize, OutlinePart)> = Vec::new();
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
