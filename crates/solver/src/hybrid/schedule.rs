//! The times at which a clock fires.
//!
//! A clock is a guard: it has a place in the list, a priority, a count and a transition. Only its
//! time is found in another way.

use stickslip_number::InvalidValue;

/// Times in order, for [`Schedule::at`].
///
/// ```
/// use stickslip_solver::Times;
///
/// assert!(Times::new(vec![0.0, 0.5, 2.0]).is_ok());
/// assert!(Times::new(vec![0.5, 0.0, 2.0]).is_err());
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Times(Vec<f64>);

impl Times {
    /// These `times`.
    ///
    /// # Errors
    /// [`InvalidValue`] unless the times are numbers in ascending or in descending order. Equal
    /// times count once.
    pub fn new(mut times: Vec<f64>) -> Result<Self, InvalidValue> {
        check_order(&times)?;
        if times.first() > times.last() {
            times.reverse();
        }
        Ok(Self(times))
    }
}

/// The times at which a [clock](crate::Guard::clock) fires. The search for the next one takes the
/// same time for a thousand as for ten.
///
/// ```
/// use stickslip_solver::{Schedule, Times};
///
/// let doses = Times::new(vec![0.0, 8.0, 24.0])?;
/// assert_eq!(Schedule::at(&doses).next_after(8.0), 24.0);
/// assert_eq!(Schedule::every(0.25, 0.125).next_after(0.3), 0.375);
/// # Ok::<(), stickslip_solver::InvalidValue>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schedule<'a> {
    ticks: Ticks<'a>,
    /// Whether the run goes backwards, so that its time is −s.
    reversed: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Ticks<'a> {
    Never,
    Once(f64),
    At(&'a [f64]),
    Every { period: f64, phase: f64 },
}

impl<'a> Schedule<'a> {
    /// No time at all.
    pub const NEVER: Self = Self::of(Ticks::Never);

    const fn of(ticks: Ticks<'a>) -> Self {
        Self { ticks, reversed: false }
    }

    /// One time.
    #[must_use]
    pub const fn once(time: f64) -> Self {
        Self::of(Ticks::Once(time))
    }

    /// These times.
    #[must_use]
    pub fn at(times: &'a Times) -> Self {
        Self::of(Ticks::At(&times.0))
    }

    /// The times `phase` + k·`period` for all integers k. The period is a finite number above 0 and
    /// the phase a finite number; a run with others is an error.
    #[must_use]
    pub const fn every(period: f64, phase: f64) -> Self {
        Self::of(Ticks::Every { period, phase })
    }

    /// The first time after `s`, infinite if there is none. It is NaN if the schedule is not valid.
    #[must_use]
    pub fn next_after(self, s: f64) -> f64 {
        if self.reversed { -self.last_before(-s) } else { self.first_after(s) }
    }

    /// The same times in −s.
    pub(crate) fn reversed(self) -> Self {
        Self { reversed: !self.reversed, ..self }
    }

    fn first_after(self, s: f64) -> f64 {
        match self.ticks {
            Ticks::Once(time) if time > s || time.is_nan() => time,
            Ticks::Never | Ticks::Once(_) => f64::INFINITY,
            Ticks::At(times) => {
                let next = times.partition_point(|&time| time <= s);
                times.get(next).copied().unwrap_or(f64::INFINITY)
            }
            Ticks::Every { period, phase } => tick(period, phase, s, |time| time > s),
        }
    }

    fn last_before(self, s: f64) -> f64 {
        match self.ticks {
            Ticks::Once(time) if time < s || time.is_nan() => time,
            Ticks::Never | Ticks::Once(_) => f64::NEG_INFINITY,
            Ticks::At(times) => {
                let before = times.partition_point(|&time| time < s);
                before.checked_sub(1).map_or(f64::NEG_INFINITY, |last| times[last])
            }
            Ticks::Every { period, phase } => -tick(period, -phase, -s, |time| -time < s),
        }
    }
}

/// The first time `phase` + k·`period` near `s` that is `late` enough; NaN if there is none.
fn tick(period: f64, phase: f64, s: f64, late: impl Fn(f64) -> bool) -> f64 {
    if !(period > 0.0 && period.is_finite() && phase.is_finite()) {
        return f64::NAN;
    }
    let first = ((s - phase) / period).floor();
    // Rounding may have put the quotient on the other side of an integer.
    let times = [-1.0, 0.0, 1.0, 2.0].map(|k| (first + k) * period + phase);
    times.into_iter().find(|&time| late(time)).unwrap_or(f64::NAN)
}

/// Checks that `times` are numbers in ascending or in descending order.
pub(crate) fn check_order(times: &[f64]) -> Result<(), InvalidValue> {
    let descending = times.iter().find(|&&s| s != times[0]).is_some_and(|&s| s < times[0]);
    let in_order = |i: usize| {
        !times[i].is_nan()
            && (i == 0 || {
                let (before, after) = (times[i - 1], times[i]);
                if descending { after <= before } else { after >= before }
            })
    };
    match (0..times.len()).find(|&i| !in_order(i)) {
        Some(index) => {
            let expected = "numbers in ascending or in descending order";
            Err(InvalidValue::new(format!("times[{index}]"), times[index], expected))
        }
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_follow_each_other_in_both_directions() {
        let times = Times::new(vec![2.0, 1.0, 1.0, -3.0]).expect("descending times");
        for schedule in [Schedule::at(&times), Schedule::every(0.1, 0.03), Schedule::once(1.0)] {
            let ascending: Vec<f64> =
                std::iter::successors(Some(-4.0), |&s| Some(schedule.next_after(s)))
                    .skip(1)
                    .take_while(|&s| s < 5.0)
                    .collect();
            assert!(ascending.windows(2).all(|pair| pair[0] < pair[1]));
            let back = schedule.reversed();
            let descending: Vec<f64> =
                std::iter::successors(Some(-5.0), |&s| Some(back.next_after(s)))
                    .skip(1)
                    .take_while(|&s| s < 4.0)
                    .map(|s| -s)
                    .collect();
            let again: Vec<f64> = descending.into_iter().rev().collect();
            assert_eq!(again, ascending);
        }
        assert_eq!(Schedule::every(0.1, 0.0).next_after(0.35), 0.4);
        assert!(Schedule::every(0.0, 0.0).next_after(0.3).is_nan());
    }
}
