//! The points a…o of Figure 4.

use stickslip_model::Collision;

use super::course::collide;
use super::reproduction::{MOST_RATIO, Reproduction};
use crate::error::StudyError;
use crate::paper::{Reading, STIFFNESS, psi, ratio};

/// Names of the intervals on the line of the points, from large to small ratios; n' is one that has
/// no letter in the paper.
const NAMES: [&str; 16] =
    ["a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l", "m", "n", "n'", "o"];

/// What lies between two boundaries on a line of one stiffness.
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
    /// Its letter.
    pub name: &'static str,
    /// g_t/g_n, the middle of an interval.
    pub ratio: f64,
}

impl Interval {
    /// Its middle, in g_t/g_n.
    pub fn middle(&self) -> f64 {
        f64::midpoint(self.ratios[0], self.ratios[1])
    }
}

/// The intervals on the line of the points, from the upper edge of Figure 4 down to 0.
///
/// # Errors
/// Boundaries cannot be traced, or a collision cannot be computed.
pub fn intervals(
    reproduction: &Reproduction,
    reading: Reading,
) -> Result<Vec<Interval>, StudyError> {
    let kappa = reading.kappa(STIFFNESS);
    let mut ends = vec![0.0];
    ends.extend(reproduction.boundaries()?.atlas.boundaries_at(kappa).into_iter().map(ratio));
    ends.push(MOST_RATIO);
    let interval = |ends: &[f64]| {
        let ratios = [ends[0], ends[1]];
        Ok(Interval { ratios, collision: collide(kappa, psi(f64::midpoint(ends[0], ends[1])))? })
    };
    ends.windows(2).rev().map(interval).collect()
}

/// The points, from large to small ratios: the middles of the intervals where the axis is ακ.
///
/// # Errors
/// The line has another number of intervals than there are names.
pub fn points(intervals: &[Interval]) -> Result<Vec<LetteredPoint>, StudyError> {
    if intervals.len() != NAMES.len() {
        let (found, expected) = (intervals.len(), NAMES.len());
        return Err(StudyError::Regions { kappa: Reading::Axis.kappa(STIFFNESS), found, expected });
    }
    let named = NAMES.into_iter().zip(intervals);
    Ok(named.map(|(name, interval)| LetteredPoint { name, ratio: interval.middle() }).collect())
}
