//! Functions that are zero at special orbits and smooth beside them.

use nalgebra::DMatrix;

use super::SpecialKind;
use super::borders::Borders;
use super::point::{Along, Point};

/// How far a multiplier may be from where a special orbit has one.
const NEAR: f64 = 1e-4;

/// A function along a branch.
#[derive(Clone)]
pub(super) enum Test {
    /// How the parameter goes on.
    Fold,
    /// The derivatives for solutions that come back with the other sign, bordered.
    Flip(Borders),
    /// The derivatives for solutions that come back as they are, bordered.
    Singular(Borders),
    /// The derivatives along the branch, bordered.
    BranchPoint(Borders),
    /// The product, over all pairs of multipliers, of what the product of a pair has above 1. It is
    /// smooth where two complex multipliers become real.
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
            Self::NeimarkSacker => pairs(point),
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
            Self::NeimarkSacker => has_torus(point).then_some((SpecialKind::NeimarkSacker, None)),
            Self::Rate(segment) => {
                let slides = before.evaluation.ends[*segment].event.slides_behind();
                let kind = along.touch(before, *segment, slides);
                Some((kind, Some(*segment)))
            }
        }
    }
}

/// The product of μⱼμₖ − 1 over all pairs of multipliers, a function of their symmetric functions.
fn pairs(point: &Point) -> Option<f64> {
    let all = point.orbit.multipliers.as_ref()?;
    let mut product = [1.0, 0.0];
    for (j, [re, im]) in all.iter().enumerate() {
        for [other_re, other_im] in &all[j + 1..] {
            let [x, y] = [re * other_re - im * other_im - 1.0, re * other_im + im * other_re];
            product = [product[0] * x - product[1] * y, product[0] * y + product[1] * x];
        }
    }
    (all.len() > 1).then_some(product[0])
}

/// Whether two complex multipliers have the size 1.
pub(super) fn has_torus(point: &Point) -> bool {
    let mut all = point.orbit.multipliers.iter().flatten();
    all.any(|[re, im]| *im > 0.0 && (re.hypot(*im) - 1.0).abs() < NEAR)
}

fn bordered_by_tangent(point: &Point) -> DMatrix<f64> {
    let slopes = &point.evaluation.slopes;
    let count = slopes.nrows();
    let mut all = slopes.clone().insert_row(count, 0.0);
    all.row_mut(count).copy_from(&point.tangent.transpose());
    all
}
