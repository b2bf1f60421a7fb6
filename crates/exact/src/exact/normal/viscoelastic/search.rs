//! Moments of the damped motion that are given by a time, a force, or the end of a slip phase.

use super::series::State;
use super::{NormalMotion, Viscoelastic};
use crate::exact::moment::{At, Half, Moment, Motion, Spring};
use crate::exact::normal::Trajectory;
use crate::exact::slip::SlipPhase;

impl Viscoelastic {
    /// The moment a time `duration` after `from`, or before if it is negative, with an error in
    /// time below `slack`, or a third of the fourth power of a step.
    pub(super) fn shifted(&self, from: &At<NormalMotion>, duration: f64, slack: f64) -> Moment {
        /// The error of the first guess, and of what follows from the first evaluation.
        const ERRORS: [f64; 2] = [3e-5, 1e-9];
        if duration == 0.0 {
            return from.moment;
        }
        let time = self.time(from) + duration;
        let left = self.time_left(from) - duration;
        if left <= 0.0 {
            return Moment::END;
        }
        if time <= 0.0 {
            return Moment::START;
        }
        let half = if time < self.middle_time { Half::Compression } else { Half::Decompression };
        let near = if half == Half::Compression { time } else { left };
        let pieces = self.half(half);
        // The node before or after, whichever is nearer in time.
        let nodes = &pieces.nodes[..pieces.inner];
        let next = nodes.partition_point(|node| node.near_time <= near);
        let nearer =
            next < nodes.len() && nodes[next].near_time - near < near - nodes[next - 1].near_time;
        let index = if nearer { next } else { next - 1 };
        let node = &nodes[index];
        // t = 2U s + V s² − (2/3)U²Q s³ + …, in the direction of the root coordinate.
        let State { u, v, q } = node.state;
        let (v, step) = (half.sign() * v, near - node.near_time);
        let rough = step / (u + (u * u + v * step).max(0.0).sqrt());
        let cubic = -2.0 / 3.0 * u * u * q;
        let slope = 2.0 * (u + rough * v);
        let shift = cubic * rough * rough * rough / slope;
        let rough = if shift.abs() < 0.1 * rough.abs() { rough - shift } else { rough };
        let [early, late] = self.middle();
        let most = if half == Half::Compression { early } else { late };
        let mut root = (pieces.grid.place(index) + rough).clamp(0.0, most);
        // Close to the end a bracket must be better than the time left.
        let slack = if left < 1e-4 { 0.0 } else { slack };
        for error in ERRORS {
            if error <= slack {
                break;
            }
            let motion = self.motion(Moment { half, root });
            let change = (near - motion.near_time) / (2.0 * motion.u);
            if !change.is_finite() {
                break;
            }
            root = (root + change).clamp(0.0, most);
        }
        Moment { half, root }
    }

    /// Node `index` among the nodes of both halves in the order of time.
    fn node_in_time(&self, index: usize) -> Moment {
        let [first, last] = &self.halves;
        if index < first.inner {
            Moment { half: Half::Compression, root: first.grid.place(index) }
        } else {
            let from_end = first.inner + last.inner - 1 - index;
            Moment { half: Half::Decompression, root: last.grid.place(from_end) }
        }
    }

    /// All nodes in the order of time, from the start to the end of contact.
    pub(super) fn nodes_in_time(&self) -> impl Iterator<Item = Moment> {
        (0..self.halves[0].inner + self.halves[1].inner).map(|index| self.node_in_time(index))
    }

    /// The start and end of a time during which F is above `force`: all of it but a twentieth of a
    /// piece at either end, or if that is not certain but a whole one.
    pub(super) fn stronger_than(&self, force: f64) -> Option<[Moment; 2]> {
        let end = |half: Half| {
            let pieces = self.half(half);
            let force_at = |index: usize| {
                let State { u, q, .. } = pieces.nodes[index].state;
                u * q
            };
            let moment = |root: f64| Moment { half, root };
            let inner = (1..pieces.inner).find(|&index| force_at(index) > force)?;
            // Linear interpolation, moved inwards.
            let (near, far) = (pieces.grid.place(inner), pieces.grid.place(inner - 1));
            let part = (force_at(inner) - force) / (force_at(inner) - force_at(inner - 1));
            let refined = moment(near + (far - near) * (part - 0.05).max(0.0));
            let certain = self.motion(refined).force > force;
            Some(if certain { refined } else { moment(near) })
        };
        Some([end(Half::Compression)?, end(Half::Decompression)?])
    }

    /// A shorter bracket of the end of a slip phase, and a guess.
    ///
    /// g falls through 0 once between `low` and `high`; its signs at the nodes between them show in
    /// which piece.
    pub(super) fn around_meeting(
        &self,
        spring: &Spring,
        sliding: &SlipPhase,
        low: Moment,
        high: Moment,
    ) -> (Moment, Moment, Option<Moment>) {
        let all = self.halves[0].inner + self.halves[1].inner;
        let moment = |index: usize| self.node_in_time(index);
        let partition = |is_before: &dyn Fn(Moment) -> bool| {
            let (mut first, mut last) = (0, all);
            while first < last {
                let middle = usize::midpoint(first, last);
                if is_before(moment(middle)) { first = middle + 1 } else { last = middle }
            }
            first
        };
        let mut first = partition(&|node| !low.is_before(node));
        let mut last = partition(&|node| node.is_before(high));
        // The nodes from `first` up to, but not, `last` are inside; those before it have g > 0.
        let (mut before, mut after) = (None, None);
        while first < last {
            let middle = usize::midpoint(first, last);
            let at = self.at(moment(middle));
            let slope = -2.0 * at.motion.u * at.motion.pull(spring);
            let guard = sliding.guard(spring, &at);
            if guard > 0.0 {
                (first, before) = (middle + 1, Some((at.moment, guard, slope)));
            } else {
                (last, after) = (middle, Some((at.moment, guard, slope)));
            }
        }
        let place = |end: Option<(Moment, f64, f64)>| {
            end.map(|(moment, guard, slope)| (self.place(moment), guard, slope))
        };
        let guess = guess_between(place(before), place(after)).map(|s| self.moment(s));
        (before.map_or(low, |end| end.0), after.map_or(high, |end| end.0), guess)
    }
}

/// Where a function that falls from a place to another one vanishes, from its values and slopes.
///
/// The place as a function of the value is a cubic through both ends; with one end only, it is a
/// straight line.
fn guess_between(before: Option<(f64, f64, f64)>, after: Option<(f64, f64, f64)>) -> Option<f64> {
    match (before, after) {
        (Some((s0, g0, d0)), Some((s1, g1, d1))) => {
            let part = g0 / (g0 - g1);
            if d0 >= 0.0 || d1 >= 0.0 {
                return Some(s0 + part * (s1 - s0));
            }
            let width = g1 - g0;
            let (m0, m1) = (width / d0, width / d1);
            let (t, rest) = (part, 1.0 - part);
            Some(
                rest * rest * ((1.0 + 2.0 * t) * s0 + t * m0)
                    + t * t * ((1.0 + 2.0 * rest) * s1 - rest * m1),
            )
        }
        (Some((s, g, d)), None) | (None, Some((s, g, d))) if d < 0.0 => Some(s - g / d),
        _ => None,
    }
}
