//! Isolation by enclosures: it decides where a guard of a readable system crosses zero.
//!
//! A part of the step whose bounds exclude zero has no crossing. A part whose slopes have one sign
//! is monotone, and one whose second derivatives have one sign has at most one extremum: the signs
//! at the ends and at the extremum decide. All other parts are halved. What remains at rounding is
//! a jump, a pole, or a touch that may be a pair of crossings. Without bounds it is a pole if its
//! values, by steps of the method, grow towards it, and otherwise a jump.
//!
//! A guard such as max(0, x − 1) rests on zero for a while: there its bounds are zero. It crosses
//! where it leaves that part, if it was on the other side before or starts there.

use crate::error::RunError;
use crate::events::isolate::{
    AROUND, Beginning, Bracket, Notice, Task, Touch, Verdict, narrow, root,
};
use stickslip_number::{Enclosure, Interval};

/// A guard along a step.
pub(crate) trait Enclosed {
    /// Bounds for value and derivatives by the step fraction, between two step fractions. They
    /// contain what steps of the method to any place in between would give.
    fn over(&mut self, low: f64, high: f64) -> Enclosure;
    /// The same, made tight by an expansion about the middle, and the bounds in the middle. If the
    /// values have one sign, the first bounds stand for both.
    fn bounds(&mut self, low: f64, high: f64) -> (Enclosure, Enclosure);
    /// The value by a step of the method to `theta`, as a number and with its rounding.
    fn truth(&mut self, theta: f64) -> Result<(f64, Interval), RunError>;
    /// Makes bounds between two step fractions tighter, by a step of the method into their middle.
    /// The result is `None` if that does not help; otherwise it says whether only rounding is left.
    fn refine(&mut self, low: f64, high: f64) -> Result<Option<bool>, RunError>;
    /// Returns to the bounds on the whole step.
    fn widen(&mut self);
    /// The value by the dense output.
    fn at(&mut self, theta: f64) -> f64;
}

/// The parts of a step that may be examined before the step counts as too coarse.
const LIMIT: usize = 100_000;
/// A refined part is refined again where the search has come this much closer.
const CLOSER: f64 = 1.0 / 16.0;
/// The accuracy of the place of an extremum, relative to the part of the step that is searched.
const NEAR_EXTREMUM: f64 = 1e-9;
/// Parts of a step are halved at most this often.
const DEPTH: usize = 60;
/// Values without bounds make a pole if they are larger than those around them by this factor, and
/// otherwise a jump.
const GROWS: f64 = 2.0;

/// Finds the first crossing of an enclosed curve from ≥ 0 to < 0, or of both directions. What it
/// notices before the crossing goes to `notice`.
pub(crate) fn first_enclosed_crossing(
    curve: &mut dyn Enclosed,
    task: &Task,
    notice: &mut dyn FnMut(Notice),
) -> Result<Verdict, RunError> {
    let Beginning { theta: first, value, zero_order } = task.beginning;
    let before = (first, value);
    let mut search = Search::new(curve, notice, task, before);
    if zero_order == 0 && value != 0.0 {
        if task.domain && value < 0.0 {
            return Ok(Verdict::StartsBelow);
        }
        return search.walk(first);
    }
    if rests(search.curve, first, task.resolution) {
        (search.before, search.rest) = ((first, 0.0), first);
        return search.walk(first);
    }
    let Some((theta, sign)) = search.leave_zero(first, zero_order) else {
        return Ok(Verdict::TooCoarse);
    };
    if sign < 0.0 && task.domain {
        return Ok(Verdict::StartsBelow);
    }
    if zero_order == 0 && (sign < 0.0 || task.both) {
        // It is zero where it begins, and leaves from there.
        return Ok(Verdict::crossing(sign, Bracket::at(first)));
    }
    search.before = (theta, sign);
    search.walk(theta)
}

/// Whether an enclosed curve rests on zero from a step fraction on: its bounds are zero there, or
/// right behind it if it is beside a jump.
pub(crate) fn rests(curve: &mut dyn Enclosed, first: f64, resolution: f64) -> bool {
    const PARTS: usize = 8;
    let (mut low, mut away) = (first, 4.0 * resolution);
    for _ in 0..PARTS {
        let high = (first + away).min(1.0);
        if high <= low {
            break;
        }
        let Enclosure { value, .. } = curve.over(low, high);
        if value == Interval::ZERO || value.sign() != 0.0 {
            return value == Interval::ZERO;
        }
        (low, away) = (high, 4.0 * away);
    }
    false
}

/// The last sign that an enclosed curve shows on a step at whose end it is zero, if it starts with
/// `value`. The result is 0 if bounds do not decide.
pub(crate) fn last_enclosed_sign(
    curve: &mut dyn Enclosed,
    value: f64,
    resolution: f64,
) -> Result<f64, RunError> {
    let beginning = Beginning { theta: 0.0, value, zero_order: 0 };
    let (domain, both) = (false, false);
    let task = Task { beginning, domain, both, end: 0.0, resolution, widest: 1.0 };
    let (notice, before) = (&mut |_| {}, (0.0, value));
    let mut search = Search { through: true, ..Search::new(curve, notice, &task, before) };
    let known = search.walk(0.0)? == Verdict::None && search.before.1 != 0.0;
    Ok(if known { search.before.1.signum() } else { 0.0 })
}

/// A part of the step on which bounds have been refined.
struct Refined {
    /// Its end and its width.
    end: f64,
    width: f64,
    /// Whether only rounding is left of the error of the path.
    exact: bool,
}

/// The search for a crossing, from left to right.
struct Search<'a> {
    curve: &'a mut dyn Enclosed,
    notice: &'a mut dyn FnMut(Notice),
    task: &'a Task,
    /// The last place where the sign was seen, and that sign.
    before: (f64, f64),
    /// The end of the last part on which bounds were zero.
    rest: f64,
    /// What may be hidden since the last sign, where rounding hid the sign.
    hidden: Option<Notice>,
    /// Whether it goes on over crossings.
    through: bool,
    /// The parts that were examined.
    count: usize,
}

impl<'a> Search<'a> {
    fn new(
        curve: &'a mut dyn Enclosed,
        notice: &'a mut dyn FnMut(Notice),
        task: &'a Task,
        before: (f64, f64),
    ) -> Self {
        let rest = f64::NEG_INFINITY;
        Self { curve, notice, task, before, rest, hidden: None, through: false, count: 0 }
    }

    /// A part of the step on which a guard that starts from zero has one sign, by its end, and that
    /// sign. The result is `None` if no sign shows.
    fn leave_zero(&mut self, first: f64, zero_order: u32) -> Option<(f64, f64)> {
        let mut width = 1.0 - first;
        for _ in 0..DEPTH {
            let high = first + width;
            let Enclosure { slope, bend, .. } = self.over(first, high);
            // A guard that leaves a simple zero has a slope of one sign; from a double one, a bend.
            let sign = match zero_order {
                0 | 1 => slope.sign(),
                2 => bend.sign(),
                _ => 0.0,
            };
            if sign != 0.0 && slope.is_bounded() {
                return Some((high, sign));
            }
            if zero_order < 2 && slope.is_bounded() && bend.sign() != 0.0 && width < 1e-6 {
                // The slope starts from 0 too. If it were only small, a shorter step would show it.
                let start = self.over(first, first).slope;
                if (start.lower() + start.upper()).abs() <= 1e-3 * start.width() {
                    return Some((high, bend.sign()));
                }
            }
            if width <= self.task.resolution {
                break;
            }
            width *= 0.25;
        }
        self.leave_zero_by_values(first)
    }

    /// The same, from bounds of the values on parts that grow from the narrowest one on. They also
    /// give the sign of a guard whose slope is zero or unbounded where it starts.
    fn leave_zero_by_values(&mut self, first: f64) -> Option<(f64, f64)> {
        let (mut known, mut away) = (None, self.task.resolution);
        while first + away < 1.0 {
            let (low, high) = (first + away, (first + 4.0 * away).min(1.0));
            let sign = self.over(low, high).value.sign();
            if sign == 0.0 || known.is_some_and(|(_, before)| before != sign) {
                break;
            }
            known = Some((high, sign));
            away *= 4.0;
        }
        known
    }

    fn over(&mut self, low: f64, high: f64) -> Enclosure {
        self.count += 1;
        self.curve.over(low, high)
    }

    /// The value at a place, with the sign that a step of the method finds. It is 0 if rounding
    /// hides the sign.
    fn value(&mut self, theta: f64, touch: bool) -> Result<f64, RunError> {
        if theta >= 1.0 {
            return Ok(self.task.end);
        }
        let sign = self.over(theta, theta).value.sign();
        if sign != 0.0 {
            return Ok(sign * self.curve.at(theta).abs().max(f64::MIN_POSITIVE));
        }
        let (value, bounds) = self.curve.truth(theta)?;
        if touch {
            (self.notice)(Notice::Touch(Touch { theta, margin: value }));
        }
        Ok(bounds.sign() * value.abs().max(f64::MIN_POSITIVE))
    }

    /// Notes the value at a place. The result is the crossing that it completes, if there is one.
    fn visit(&mut self, theta: f64, value: f64) -> Option<Verdict> {
        if value == 0.0 {
            return None;
        }
        let before = std::mem::replace(&mut self.before, (theta, value));
        let turns = before.1 * value < 0.0;
        match self.hidden.take() {
            Some(pole @ Notice::Pole(_)) if turns => {
                // The other direction may be examined by another search.
                if value < 0.0 || self.task.both {
                    (self.notice)(pole);
                }
                // A domain ends at a pole too.
                if !self.task.domain {
                    return None;
                }
            }
            Some(touch @ Notice::Touch(_)) if !turns && before.1 != 0.0 => (self.notice)(touch),
            _ => {}
        }
        let falls = before.1 >= 0.0 && value < 0.0;
        let rises = self.task.both && before.1 <= 0.0 && value > 0.0;
        if (falls || rises) && !self.through {
            if self.rest >= before.0 {
                let bracket = Bracket::behind_rest(self.rest, theta);
                return Some(Verdict::crossing(value, bracket));
            }
            let (curve, side) = (&mut *self.curve, -value.signum());
            let mut at = |theta: f64| side * curve.at(theta);
            let low = (before.0, at(before.0).max(0.0));
            let high = (theta, at(theta).min(-f64::MIN_POSITIVE));
            let guess = root(at, low, high);
            let bracket = Bracket { low: before.0, high: theta, guess, rests: false };
            return Some(Verdict::crossing(value, bracket));
        }
        None
    }

    fn walk(&mut self, low: f64) -> Result<Verdict, RunError> {
        let mut pending = [(0.0, 0.0); DEPTH + 2];
        pending[0] = (low, 1.0);
        let mut pieces = usize::from(low < 1.0);
        let mut refined: Option<Refined> = None;
        while pieces > 0 {
            pieces -= 1;
            let (low, high) = pending[pieces];
            if self.count > LIMIT {
                return Ok(Verdict::TooCoarse);
            }
            if refined.as_ref().is_some_and(|part| low >= part.end) {
                self.curve.widen();
                refined = None;
            }
            self.count += 1;
            let (bounds, centre) = self.curve.bounds(low, high);
            if bounds.value == Interval::ZERO {
                self.rest = high;
                continue;
            }
            let sign = bounds.value.sign();
            let (slope, bend) = (bounds.slope, bounds.bend);
            if sign != 0.0 {
                self.look_between(low, sign);
                if let Some(crossing) = self.visit(high, sign) {
                    return Ok(crossing);
                }
                continue;
            }
            let monotone = slope.is_bounded() && slope.sign() != 0.0;
            let turns_once = slope.is_bounded() && bend.is_bounded() && bend.sign() != 0.0;
            // The error of the path, and not the guard, makes these bounds.
            let blurred = bounds.value.magnitude() <= 4.0 * centre.value.width();
            let narrow = high - low <= self.task.resolution || pieces + 2 > DEPTH;
            if blurred && !narrow && !monotone && !turns_once {
                let closer = |part: &Refined| !part.exact && high - low < CLOSER * part.width;
                if refined.as_ref().is_none_or(closer)
                    && let Some(exact) = self.curve.refine(low, high)?
                {
                    refined = Some(Refined { end: high, width: high - low, exact });
                    pending[pieces] = (low, high);
                    pieces += 1;
                    continue;
                }
            }
            let exact = narrow || refined.as_ref().is_some_and(|part| part.exact);
            let crossing = if monotone {
                self.follow(&[high])?
            } else if turns_once {
                // A maximum above zero and a minimum below it change nothing.
                let matters = self.before.1 * bend.sign() > 0.0;
                let turn = if matters { self.extremum(low, high) } else { high };
                if turn < high { self.follow(&[turn, high])? } else { self.follow(&[high])? }
            } else if blurred && exact && slope.is_bounded() {
                self.follow(&[0.5 * (low + high), high])?
            } else if narrow {
                self.irregular(low, high, &bounds)?
            } else {
                let middle = 0.5 * (low + high);
                pending[pieces] = (middle, high);
                pending[pieces + 1] = (low, middle);
                pieces += 2;
                None
            };
            if let Some(crossing) = crossing {
                return Ok(crossing);
            }
        }
        Ok(Verdict::None)
    }

    /// Notes the values at places between which the guard is monotone. All but the last are
    /// extrema. The result is the crossing that they complete, if there is one.
    fn follow(&mut self, places: &[f64]) -> Result<Option<Verdict>, RunError> {
        for (index, &theta) in places.iter().enumerate() {
            let value = self.value(theta, index + 1 < places.len())?;
            let crossing = self.visit(theta, value);
            if crossing.is_some() {
                return Ok(crossing);
            }
        }
        Ok(None)
    }

    /// A part that cannot be divided: a kink, a jump or a pole. The result is the crossing there,
    /// if there is one.
    ///
    /// Where rounding hides the sign at the end of the part, the first sign that shows behind it
    /// counts. Steps of the method to places this close together need not be in order.
    fn irregular(
        &mut self,
        low: f64,
        high: f64,
        bounds: &Enclosure,
    ) -> Result<Option<Verdict>, RunError> {
        if !bounds.value.is_bounded() && self.grows(low, high) {
            self.hidden = Some(Notice::Pole(high));
        } else if self.hidden.is_none() {
            let margin = if high >= 1.0 { self.task.end } else { self.curve.truth(high)?.0 };
            self.hidden = Some(Notice::Touch(Touch { theta: high, margin }));
        }
        let sign = if high >= 1.0 { self.task.end } else { self.over(high, high).value.sign() };
        Ok(self.visit(high, sign))
    }

    /// Looks at a place between two parts of opposite signs, whose bounds both exclude zero: a
    /// jump, or a pole that rounding has put into neither part.
    fn look_between(&mut self, place: f64, sign: f64) {
        let width = self.task.resolution;
        let (last, before) = self.before;
        let turns = before * sign < 0.0 && last >= place && place > self.task.beginning.theta;
        if turns && self.hidden.is_none() && self.grows(place - width, place + width) {
            self.hidden = Some(Notice::Pole(place));
        }
    }

    /// Whether values grow towards a narrow part of the step, by steps of the method.
    fn grows(&mut self, low: f64, high: f64) -> bool {
        let away = AROUND * (high - low);
        let mut largest = |places: [f64; 2]| {
            let inside = places.into_iter().filter(|theta| (0.0..=1.0).contains(theta));
            inside.fold(0.0, |most: f64, theta| {
                let there = self.curve.truth(theta);
                // Where there is no value, nothing grows.
                most.max(there.map_or(0.0, |(value, _)| value.abs()))
            })
        };
        largest([low, high]) > GROWS * largest([low - away, high + away])
    }

    /// The extremum between two step fractions, where the second derivatives have one sign.
    fn extremum(&mut self, low: f64, high: f64) -> f64 {
        let width = high - low;
        let mut slope = |part: f64| {
            let theta = low + part * width;
            let Enclosure { slope, .. } = self.over(theta, theta);
            slope.lower() + slope.upper()
        };
        let (at_low, at_high) = (slope(0.0), slope(1.0));
        if (at_low > 0.0) == (at_high > 0.0) {
            return high;
        }
        let sign = if at_low > 0.0 { 1.0 } else { -1.0 };
        let ends = ((0.0, sign * at_low), (1.0, sign * at_high));
        // The value changes with the square of the distance from the extremum.
        let (left, right) = narrow(|part| sign * slope(part), ends.0, ends.1, NEAR_EXTREMUM);
        low + 0.5 * (left.0 + right.0) * width
    }
}
