//! A sample point well inside every region.

use crate::regions::arrangement::faces::Faces;
use crate::regions::arrangement::piece::Edge;
use crate::regions::arrangement::slabs::Slabs;
use crate::regions::region::Region;
use crate::window::Point;

/// Sets `sample` and `clearance` of every region.
///
/// The search starts at the best of several places halfway between two boundaries. It moves as long
/// as the distance from all boundaries grows. The result is a local maximum of the distance,
/// accurate to a thirtieth, but not always the greatest one.
pub(crate) fn place_samples<Label>(
    regions: &mut [Region<Label>],
    slabs: &Slabs,
    edges: &[Edge],
    faces: &Faces,
) {
    let mut bounding: Vec<Vec<usize>> = vec![Vec::new(); regions.len()];
    for (edge, sides) in edges.iter().zip(&faces.of_edges) {
        for face in sides.iter().flatten() {
            bounding[*face].extend(edge.pieces.clone());
        }
    }
    for ((region, pieces), gaps) in regions.iter_mut().zip(&bounding).zip(gaps(slabs, faces)) {
        let clearance = |point: &Point| clearance(slabs, pieces, point);
        let start = candidates(slabs, &gaps)
            .map(|point| (clearance(&point), point))
            .reduce(|best, next| if next.0 > best.0 { next } else { best });
        let Some((mut best, mut sample)) = start else { continue };
        let (first, last) = (slabs.walls[0], slabs.walls[slabs.count()]);
        let face = |point: &Point| {
            if point.x <= first || point.x >= last {
                return None;
            }
            let slab = slabs.at(point.x);
            let below = slabs.below(slab, point).checked_sub(1)?;
            faces.of_gap(slabs, slab, below)
        };
        let own = face(&sample);
        let mut step = 0.25 * (last - first);
        while step > best.max(f64::MIN_POSITIVE) / 32.0 {
            let better = DIRECTIONS
                .iter()
                .map(|&(x, y)| sample + step * Point::new(x, y))
                .filter(|point| face(point) == own)
                .map(|point| (clearance(&point), point))
                .find(|&(distance, _)| distance > best + step / 64.0);
            if let Some(better) = better {
                (best, sample) = better;
            } else {
                step *= 0.5;
            }
        }
        (region.sample, region.clearance) = (sample, best);
    }
}

/// The directions in which a sample point is moved.
const DIRECTIONS: [(f64, f64); 8] = {
    const D: f64 = std::f64::consts::FRAC_1_SQRT_2;
    [(1.0, 0.0), (D, D), (0.0, 1.0), (-D, D), (-1.0, 0.0), (-D, -D), (0.0, -1.0), (D, -D)]
};

/// The parts of every region, one in each gap of a slab: the slab, and the position of the gap.
fn gaps(slabs: &Slabs, faces: &Faces) -> Vec<Vec<(usize, usize)>> {
    let mut gaps = vec![Vec::new(); faces.count];
    for slab in 0..slabs.count() {
        for position in 0..slabs.of(slab).len().saturating_sub(1) {
            if let Some(face) = faces.of_gap(slabs, slab, position) {
                gaps[face].push((slab, position));
            }
        }
    }
    gaps
}

/// The middles of some parts, evenly spread over all of them, and of the highest part.
fn candidates(slabs: &Slabs, gaps: &[(usize, usize)]) -> impl Iterator<Item = Point> {
    const SPREAD: usize = 48;
    let ends = |(slab, position): (usize, usize)| {
        let x = slabs.middle(slab);
        let [below, above] =
            [position, position + 1].map(|k| slabs.pieces[slabs.of(slab)[k]].y_at(x));
        (x, below, above)
    };
    let height = |&gap: &(usize, usize)| {
        let (_, below, above) = ends(gap);
        above - below
    };
    let highest = gaps.iter().copied().max_by(|a, b| height(a).total_cmp(&height(b)));
    let count = gaps.len().min(SPREAD);
    let spread = (0..count).map(|i| gaps[(2 * i + 1) * gaps.len() / (2 * count)]);
    spread
        .chain(highest)
        .map(move |gap| {
            let (x, below, above) = ends(gap);
            Point::new(x, 0.5 * (below + above))
        })
        .collect::<Vec<_>>()
        .into_iter()
}

/// The distance of `point` from the nearest of `pieces`.
fn clearance(slabs: &Slabs, pieces: &[usize], point: &Point) -> f64 {
    let pieces = pieces.iter().map(|&piece| &slabs.pieces[piece]);
    let mut least = pieces
        .clone()
        .map(|piece| (piece.first() - point).norm_squared())
        .fold(f64::INFINITY, f64::min)
        .sqrt();
    for piece in pieces {
        if piece.box_distance(point) < least {
            least = least.min(piece.cubic.distance(point));
        }
    }
    least
}
