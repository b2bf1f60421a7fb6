//! What one guard of a readable system does on a step, by bounds along the quick path.

use crate::events::examination::Examination;
use crate::events::path::{Part, Path};
use crate::events::quick;
use crate::events::status::{Crossing, Status};
use crate::hybrid::Direction;
use crate::method::Method;
use crate::system::{PerComponent, PerGuard, System};
use smallvec::SmallVec;
use stickslip_number::Enclosure;

/// A step is divided at most into 2 to this power parts.
const HALVINGS: u32 = 3;

/// The quick path along a step, and bounds of all guards on those of its parts that were looked at.
///
/// A part is bounded once for all guards, so that the cost of a step is linear in their number.
pub(crate) struct Sight<S: System> {
    path: Path<S::Components>,
    parts: SmallVec<[Bounds<S>; 1]>,
}

struct Bounds<S: System> {
    part: Part<S::Components>,
    whole: PerGuard<S, Enclosure>,
    /// The bounds in the middle of the part, if they were needed.
    centre: Option<PerGuard<S, Enclosure>>,
}

impl<S: System> Sight<S> {
    pub(crate) fn along(path: Path<S::Components>) -> Self {
        Self { path, parts: SmallVec::new() }
    }
}

impl<S: System> Examination<'_, S> {
    /// What bounds of a guard along the quick path say about it. Its six values on the step are in
    /// `column`.
    ///
    /// A guard that is monotone or bends in one direction crosses zero once if its ends have
    /// different signs. Otherwise bounds on parts of the step may decide that.
    pub(crate) fn glance_at_bounds<M: Method>(
        &mut self,
        guard: usize,
        column: &[f64; 6],
        sight: &mut Sight<S>,
    ) -> Status {
        let (direction, order) =
            (self.phase.guards[guard].direction(), self.phase.zero_orders[guard]);
        let falls = matches!(direction, Direction::Below | Direction::Falling);
        let [start, .., end] = *column;
        if column.iter().any(|value| value.is_nan()) {
            return Status::Unclear;
        }
        let at_zero = start == 0.0 || order > 0;
        if end == 0.0 || start == 0.0 && order == 0 && !falls {
            return Status::Unclear;
        }
        let bounds = self.bounds(guard, sight, 0.0, 1.0);
        let known = bounds.slope.is_bounded();
        let monotone = known && bounds.slope.sign() != 0.0;
        let bend = if known { bounds.bend.sign() } else { 0.0 };
        // The sign with which the step begins.
        let first = match order {
            0 if start != 0.0 => start.signum(),
            0 | 1 if monotone => bounds.slope.sign(),
            0 | 1 if bend != 0.0 => {
                let start = sight.path.part(0.0, 0.0).centre(&sight.path);
                self.enclosed(start)[guard].slope.sign()
            }
            2 => bend,
            _ => 0.0,
        };
        if first == 0.0 || start == 0.0 && order == 0 && first < 0.0 {
            return Status::Unclear;
        }
        if first < 0.0 && direction == Direction::Below {
            return Status::Fires(Crossing::at_start(1.0));
        }
        // From a zero, a guard returns only if it bends back.
        let back = order < 2 && !monotone && bend == -first;
        if first * end < 0.0
            && if at_zero {
                back
            } else {
                monotone
                    || bend != 0.0
                    || self.crosses_once(guard, sight, first, (0.0, 1.0), HALVINGS)
            }
        {
            if !direction.fires_from(first) {
                return Status::Clear;
            }
            let root = quick::only_root(&column.map(|value| first * value), M::QUICK_ERROR);
            return root.map_or(Status::Unclear, |theta| Crossing::alone(first, theta));
        }
        let stays = monotone || bend == -first || at_zero && bend == first;
        let may_stay = first * end > 0.0;
        let clear = may_stay && (stays || !at_zero && self.same_side(guard, sight, &bounds));
        if clear { Status::Clear } else { Status::Unclear }
    }

    /// Whether a guard with these `bounds` on the step has one sign throughout.
    fn same_side(&mut self, guard: usize, sight: &mut Sight<S>, bounds: &Enclosure) -> bool {
        bounds.value.sign() != 0.0 || self.side_in_halves(guard, sight, (0.0, 1.0), HALVINGS) != 0.0
    }

    /// Whether a guard changes its sign once between two step fractions, from the sign of `first`:
    /// where its bounds on small parts do not exclude zero, it moves towards the other sign.
    fn crosses_once(
        &mut self,
        guard: usize,
        sight: &mut Sight<S>,
        first: f64,
        (low, high): (f64, f64),
        halvings: u32,
    ) -> bool {
        let middle = 0.5 * (low + high);
        halvings > 0
            && [(low, middle), (middle, high)].into_iter().all(|part| {
                let Enclosure { value, slope, .. } = self.bounds(guard, sight, part.0, part.1);
                value.sign() != 0.0
                    || slope.is_bounded() && slope.sign() * first < 0.0
                    || self.crosses_once(guard, sight, first, part, halvings - 1)
            })
    }

    /// Bounds of all guards from bounds of time and state.
    fn enclosed(
        &mut self,
        (s, y): (Enclosure, PerComponent<S, Enclosure>),
    ) -> PerGuard<S, Enclosure> {
        self.statistics.enclosures += 1;
        self.system.enclose(self.phase.mode, s, &y)
    }

    /// Bounds of a guard between two step fractions, along a path.
    fn bounds(&mut self, guard: usize, sight: &mut Sight<S>, low: f64, high: f64) -> Enclosure {
        let Sight { path, parts } = sight;
        let known = parts.iter().position(|it| it.part.low == low && it.part.high == high);
        let place = known.unwrap_or_else(|| {
            let part = path.part(low, high);
            let whole = self.enclosed(part.whole(path));
            parts.push(Bounds { part, whole, centre: None });
            parts.len() - 1
        });
        let Bounds { part, whole, centre } = &mut parts[place];
        let plain = whole[guard];
        if plain.value.sign() != 0.0 || !plain.slope.is_bounded() {
            return plain;
        }
        let centre = centre.get_or_insert_with(|| self.enclosed(part.centre(path)));
        plain.about(&centre[guard], 0.5 * (high - low))
    }

    /// The sign that a guard has in both halves between two step fractions, 0 if the bounds do not
    /// exclude zero.
    fn side_in_halves(
        &mut self,
        guard: usize,
        sight: &mut Sight<S>,
        (low, high): (f64, f64),
        halvings: u32,
    ) -> f64 {
        if halvings == 0 {
            return 0.0;
        }
        let middle = 0.5 * (low + high);
        let left = self.side(guard, sight, (low, middle), halvings - 1);
        if left != 0.0 && self.side(guard, sight, (middle, high), halvings - 1) == left {
            left
        } else {
            0.0
        }
    }

    /// The sign that a guard has between two step fractions, 0 if the bounds do not exclude zero.
    fn side(&mut self, guard: usize, sight: &mut Sight<S>, part: (f64, f64), halvings: u32) -> f64 {
        let sign = self.bounds(guard, sight, part.0, part.1).value.sign();
        if sign == 0.0 { self.side_in_halves(guard, sight, part, halvings) } else { sign }
    }
}
