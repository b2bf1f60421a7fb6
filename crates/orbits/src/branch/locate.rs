//! Special orbits between two points of a branch.

use super::point::{Along, Point};
use super::test::Test;
use super::{SpecialKind, SpecialOrbit};
use crate::error::OrbitError;
use crate::orbit::Orbit;

/// A bracket of this part of a step is a place.
const NARROW: f64 = 1e-13;
/// A fold so near a branch point, in parts of a step, is that branch point.
const BESIDE: f64 = 1e-3;
/// So is a fold at so nearly the same parameter, in parts of its range: where branches meet, the
/// parameter may stand still.
const SAME: f64 = 1e-8;
/// What is left of a function at its zero, at most, of its values at both points. Otherwise it
/// jumps.
const JUMP: f64 = 1e-6;
/// The greatest number of points of a search.
const ROUNDS: usize = 100;

impl Along<'_> {
    /// The special orbits between two neighbours, in order.
    pub fn specials(&self, from: &Point, to: &Point) -> Result<Vec<SpecialOrbit>, OrbitError> {
        let length = from.tangent.dot(&(&to.place - &from.place));
        let mut found: Vec<(f64, SpecialOrbit)> = Vec::new();
        let mut meeting: Option<(f64, Point)> = None;
        for test in Test::all(self, from) {
            let values = (test.value(self, from), test.value(self, to));
            let (Some(one), Some(other)) = values else { continue };
            // A zero at the end belongs to the next step.
            if (one < 0.0) == (other < 0.0) || other == 0.0 {
                continue;
            }
            let value = |point: &Point| test.value(self, point);
            if let Test::BranchPoint(_) = test {
                meeting = self.meeting(from, length, one / (one - other)).ok();
            }
            // Beside a branch point others are inaccurate, and a rate may be zero there too.
            let size = JUMP * one.abs().max(other.abs());
            let is_zero = |point: &Point| value(point).is_some_and(|value| value.abs() <= size);
            let meets = match test {
                Test::BranchPoint(_) => meeting.clone(),
                Test::Rate(_) => meeting.clone().filter(|(_, point)| is_zero(point)),
                _ => None,
            };
            let zero = match meets {
                Some(meets) => Ok(Some(meets)),
                None => self.zero(from, (length, one, other), value),
            };
            let zero = match (zero, &test) {
                // At a pitchfork the parameter may turn back.
                (Err(_), Test::Fold) if !found.is_empty() => None,
                (zero, _) => zero?,
            };
            let Some((at, point)) = zero else { continue };
            // There are no multipliers at a graze. What is zero there is a rate.
            if matches!(test, Test::Flip(_)) && point.orbit.multipliers.is_none() {
                continue;
            }
            let [low, high] = self.range;
            let same = |(other, special): &(f64, SpecialOrbit)| {
                let apart = (special.value - self.value(&point.place)).abs();
                (at - other).abs() <= BESIDE * length || apart <= SAME * (high - low)
            };
            if matches!(test, Test::Fold) && found.iter().any(same) {
                continue;
            }
            if let Some((kind, segment)) = test.kind(self, from, &point) {
                let rule = segment.map(|segment| self.equations.legs()[segment].rule);
                found.push((at, self.special(kind, segment, rule, point)));
            }
        }
        if let Some((at, special)) = self.change(from, to, length, &found)? {
            found.push((at, special));
        }
        found.sort_by(|one, other| one.0.total_cmp(&other.0));
        Ok(found.into_iter().map(|(_, special)| special).collect())
    }

    pub(super) fn special(
        &self,
        kind: SpecialKind,
        segment: Option<usize>,
        rule: Option<usize>,
        point: Point,
    ) -> SpecialOrbit {
        let value = self.value(&point.place);
        SpecialOrbit { kind, value, behind: 0, segment, rule, orbit: point.orbit }
    }

    /// Where a function changes its sign from `one` at a point to `other` ahead by a length.
    pub fn zero(
        &self,
        from: &Point,
        signs: (f64, f64, f64),
        function: impl Fn(&Point) -> Option<f64>,
    ) -> Result<Option<(f64, Point)>, OrbitError> {
        zero(signs, |at| {
            let point = self.ahead(from, at)?;
            Ok(function(&point).map(|value| (value, point)))
        })
    }
}

/// Whether more multipliers pass the unit circle between two neighbours than the special orbits
/// that were found explain. Where something happens at a segment, multipliers may jump.
pub(super) fn passes_unseen(from: &Orbit, to: &Orbit, found: &[SpecialOrbit]) -> bool {
    let (Some(before), Some(behind)) = (from.outside(), to.outside()) else { return false };
    let passed = behind[0].saturating_sub(before[1]).max(before[0].saturating_sub(behind[1]));
    let explained = found.iter().map(|special| match special.kind {
        SpecialKind::Fold | SpecialKind::Flip | SpecialKind::BranchPoint => 1,
        SpecialKind::NeimarkSacker => 2,
        _ => usize::MAX,
    });
    passed > explained.fold(0, usize::saturating_add)
}

/// Where a function changes its sign from `one` to `other` within a length, with what it is
/// computed from: by false position in the manner of Illinois. `None` if the function ceases
/// between, or jumps.
pub(super) fn zero<T>(
    (length, one, other): (f64, f64, f64),
    mut function: impl FnMut(f64) -> Result<Option<(f64, T)>, OrbitError>,
) -> Result<Option<(f64, T)>, OrbitError> {
    let (mut low, mut high) = ((0.0, one), (length, other));
    let most = JUMP * one.abs().max(other.abs());
    let mut side = 0;
    let mut last: Option<(f64, f64, T)> = None;
    for _ in 0..ROUNDS {
        let part = low.1 / (low.1 - high.1);
        let part = if part > 0.0 && part < 1.0 { part } else { 0.5 };
        let at = low.0 + part * (high.0 - low.0);
        let Some((value, found)) = function(at)? else { return Ok(None) };
        let before = last.replace((at, value, found)).map(|(at, ..)| at);
        let stays = before.is_some_and(|before| (at - before).abs() <= NARROW * length);
        if value == 0.0 || stays || (high.0 - low.0).abs() <= NARROW * length {
            break;
        }
        if (value < 0.0) == (low.1 < 0.0) {
            low = (at, value);
            if side == -1 {
                high.1 *= 0.5;
            }
            side = -1;
        } else {
            high = (at, value);
            if side == 1 {
                low.1 *= 0.5;
            }
            side = 1;
        }
    }
    Ok(last.filter(|(_, value, _)| value.abs() <= most).map(|(at, _, found)| (at, found)))
}
