//! Functions that are zero at special orbits and smooth beside them.

use nalgebra::DMatrix;

use super::SpecialKind;
use super::borders::Borders;
use super::point::{Along, Point};

/// How far a multiplier may be from where a special orbit has one.
const NEAR: f64 = 1e-4;

/// A function along a branch.
pub(super) enum Test {
    /// How the parameter goes on.
    Fold,
    /// The derivatives for solutions that come back with the other sign, bordered.
    Flip(Borders),
    /// The derivatives for solutions that come back as they are, bordered.
    Singular(Borders),
    /// The derivatives along the branch, bordered.
    BranchPoint(Borders),
    /// The size of complex multipliers, less 1.
    NeimarkSacker,
    /// The rate of the condition at the end of a segment.
    Rate(usize),
}

impl Test {
    /// The functions from a point on.
    pub fn all(along: &Along<'_>, point: &Point) -> Vec<Self> {
        let slopes = &point.evaluation.slopes;
        let flip = Borders::of(&along.equations.returning(slopes, -1.0));
        let branch_point = Borders::of(&bordered_by_tangent(point));
        let fixed =
            [Self::BranchPoint(branch_point), Self::Fold, Self::Flip(flip), Self::NeimarkSacker];
        fixed.into_iter().chain((0..point.evaluation.ends.len()).map(Self::Rate)).collect()
    }

    /// The function at a point, if it has a value there.
    pub fn value(&self, along: &Along<'_>, point: &Point) -> Option<f64> {
        match self {
            Self::Fold => Some(point.tangent[point.tangent.len() - 1]),
            Self::Flip(borders) => {
                borders.value(&along.equations.returning(&point.evaluation.slopes, -1.0))
            }
            Self::Singular(borders) => {
                borders.value(&along.equations.returning(&point.evaluation.slopes, 1.0))
            }
            Self::BranchPoint(borders) => borders.value(&bordered_by_tangent(point)),
            Self::NeimarkSacker => complex_size(point),
            Self::Rate(segment) => {
                // The tick of a clock does not graze.
                let event = &point.evaluation.ends[*segment].event;
                let moves = event.guard_by.rows(0, event.slopes.len()).amax() > 0.0;
                moves.then(|| event.rate())
            }
        }
    }

    /// What a zero of the function at a point is called, and the segment where it is; `None` if it
    /// is not a special orbit.
    pub fn kind(
        &self,
        along: &Along<'_>,
        before: &Point,
        point: &Point,
    ) -> Option<(SpecialKind, Option<usize>)> {
        let has = |re: f64| {
            point
                .orbit
                .multipliers
                .as_ref()
                .is_none_or(|all| all.iter().any(|it| (it[0] - re).hypot(it[1]) < NEAR))
        };
        match self {
            Self::Fold | Self::Singular(_) => has(1.0).then_some((SpecialKind::Fold, None)),
            Self::Flip(_) => has(-1.0).then_some((SpecialKind::Flip, None)),
            Self::BranchPoint(_) => has(1.0).then_some((SpecialKind::BranchPoint, None)),
            Self::NeimarkSacker => {
                let near = complex_size(point).is_some_and(|size| size.abs() < NEAR);
                near.then_some((SpecialKind::NeimarkSacker, None))
            }
            Self::Rate(segment) => {
                let slides = before.evaluation.ends[*segment].event.slides_behind();
                let kind = along.touch(before, *segment, slides);
                Some((kind, Some(*segment)))
            }
        }
    }
}

/// The size of complex multipliers less 1, of those that are nearest to it.
fn complex_size(point: &Point) -> Option<f64> {
    let sizes = point.orbit.multipliers.iter().flatten().filter(|[_, im]| *im > 0.0);
    let sizes = sizes.map(|[re, im]| re.hypot(*im) - 1.0);
    sizes.min_by(|one, other| one.abs().total_cmp(&other.abs()))
}

fn bordered_by_tangent(point: &Point) -> DMatrix<f64> {
    let slopes = &point.evaluation.slopes;
    let count = slopes.nrows();
    let mut all = slopes.clone().insert_row(count, 0.0);
    all.row_mut(count).copy_from(&point.tangent.transpose());
    all
}
