//! The points a to o of Figure 4.
//!
//! They stand between the boundaries on a line of one stiffness, which are read off the atlas of
//! the whole plane of Figure 4. The tests of the statements compute the same boundaries in another
//! way (`statements::line`). This is an independent check: a test holds that both agree.

use stickslip_model::Collision;
use stickslip_studies::paper::{MOST_RATIO_4, Reading, STIFFNESS, psi, ratio};

use super::course::collide;
use super::reproduction::Reproduction;
use crate::error::ReproductionError;

/// Names of the intervals on the line of the points, from large to small ratios; n' is one that has
/// no letter in the paper.
const NAMES: [&str; 16] =
    ["a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l", "m", "n", "n'", "o"];

/// An interval between two boundaries on a line of one stiffness.
#[derive(Clone, Debug)]
pub struct Interval {
    /// g_t/g_n at its lower and upper end.
    pub ratios: [f64; 2],
    /// The collision in its middle.
    pub collision: Collision,
}

/// A point of Figure 4.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LetteredPoint {
    /// The letter of the point.
    pub name: &'static str,
    /// g_t/g_n in the middle of an interval.
    pub ratio: f64,
}

/// The intervals on the line of the points, from the upper edge of Figure 4 down to 0.
///
/// # Errors
/// Boundaries cannot be traced, or a collision cannot be computed.
pub fn intervals(
    reproduction: &Reproduction,
    reading: Reading,
) -> Result<Vec<Interval>, ReproductionError> {
    let kappa = reading.kappa(STIFFNESS);
    let mut ends = vec![0.0];
    ends.extend(reproduction.boundaries()?.boundaries_at(kappa).into_iter().map(ratio));
    ends.push(MOST_RATIO_4);
    let interval = |ends: &[f64]| {
        let ratios = [ends[0], ends[1]];
        Ok(Interval { ratios, collision: collide(kappa, psi(middle(ratios)))? })
    };
    ends.windows(2).rev().map(interval).collect()
}

/// The points, from large to small ratios: the middles of the intervals where the axis is ακ.
///
/// # Errors
/// The line has another number of intervals than there are names.
pub fn points(intervals: &[Interval]) -> Result<Vec<LetteredPoint>, ReproductionError> {
    if intervals.len() != NAMES.len() {
        let (found, expected) = (intervals.len(), NAMES.len());
        return Err(ReproductionError::Regions {
            kappa: Reading::Axis.kappa(STIFFNESS),
            found,
            expected,
        });
    }
    let named = NAMES.into_iter().zip(intervals);
    let point =
        |(name, interval): (_, &Interval)| LetteredPoint { name, ratio: middle(interval.ratios) };
    Ok(named.map(point).collect())
}

fn middle([low, high]: [f64; 2]) -> f64 {
    f64::midpoint(low, high)
}
