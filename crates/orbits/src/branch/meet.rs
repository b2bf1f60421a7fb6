//! Where two branches meet.
//!
//! Along a branch the search for points is singular there. With a further unknown that unfolds the
//! meeting, it is regular (Moore, *SIAM J. Numer. Anal.* 17, 567, 1980): the equations are zero up
//! to a multiple of the direction that their derivatives do not reach, and this direction exists.

use nalgebra::{DMatrix, DVector};

use super::borders::{null_vector, plane};
use super::point::{Along, Point};
use crate::error::OrbitError;
use crate::newton::search;

/// How far unknowns are moved for differences.
const APART: f64 = 1e-5;
/// The multiple at a meeting is 0: two branches that only pass each other have a larger one.
const PASSED: f64 = 1e-8;

impl Along<'_> {
    /// The point where another branch meets that of a point, within a length ahead of it and about
    /// at a part of that length; and how far ahead it is.
    pub fn meeting(
        &self,
        from: &Point,
        length: f64,
        part: f64,
    ) -> Result<(f64, Point), OrbitError> {
        let (equations, count) = (self.equations, self.equations.count());
        let start = &from.place + part * length * &from.tangent;
        let near = equations.at(&start)?.slopes;
        let across = null_vector(&near.transpose());
        let [u, v] = plane(&near);
        // Two numbers that are zero where a direction is not reached.
        let lost = |slopes: &DMatrix<f64>| {
            let mut all = slopes.clone().insert_rows(count, 2, 0.0).insert_column(count + 1, 0.0);
            all.view_mut((0, count + 1), (count, 1)).copy_from(&across);
            for (row, own) in [&u, &v].into_iter().enumerate() {
                all.view_mut((count + row, 0), (1, count + 1)).copy_from(&own.transpose());
            }
            let mut right = DVector::zeros(count + 2);
            right[count + 1] = 1.0;
            let solved = all.transpose().lu().solve(&right).ok_or(NOWHERE)?;
            Ok::<_, OrbitError>(solved.rows(count, 2).into_owned())
        };
        let found = search(equations, &start.insert_row(count + 1, 0.0), |all, wanted| {
            let place = all.rows(0, count + 1).into_owned();
            let evaluation = equations.at(&place)?;
            let mut values = evaluation.values + all[count + 1] * &across;
            values = values.insert_rows(count, 2, 0.0);
            values.rows_mut(count, 2).copy_from(&lost(&evaluation.slopes)?);
            if !wanted {
                return Ok((values, None));
            }
            let mut slopes = DMatrix::zeros(count + 2, count + 2);
            slopes.view_mut((0, 0), (count, count + 1)).copy_from(&evaluation.slopes);
            slopes.view_mut((0, count + 1), (count, 1)).copy_from(&across);
            for unknown in 0..=count {
                let mut beside = [place.clone(), place.clone()];
                beside[0][unknown] += APART;
                beside[1][unknown] -= APART;
                let [above, below] = beside.map(|it| lost(&equations.at(&it)?.slopes));
                let by = (above? - below?) / (2.0 * APART);
                slopes.view_mut((count, unknown), (2, 1)).copy_from(&by);
            }
            Ok((values, Some(slopes)))
        })?;
        let place = found.at.rows(0, count + 1).into_owned();
        let at = from.tangent.dot(&(&place - &from.place));
        let is_there = found.at[count + 1].abs() <= PASSED && (0.0..=length).contains(&at);
        if !is_there {
            return Err(NOWHERE);
        }
        let (evaluation, draft) = (equations.at(&place)?, equations.draft(&place));
        let orbit = self.orbits.orbit(equations, &draft, &evaluation, found.error)?;
        let tangent = from.tangent.clone();
        Ok((at, Point { place, tangent, evaluation, orbit }))
    }
}

const NOWHERE: OrbitError =
    OrbitError::nowhere("the branch has no place where another one meets it");
