//! Touches and poles that are noticed on a step, until the step is accepted.

use smallvec::SmallVec;

use crate::events::isolate::{Notice, Touch};
use crate::hybrid::{Grazing, Pole};

/// Notices of a guard that are closer together than this part of the step count as one: `Either` is
/// examined in both directions, and shortened steps are examined again.
const SAME: f64 = 1e-8;

/// The number of notices on a step up to which nothing is allocated.
pub(crate) const FEW: usize = 4;

/// What isolation notices of a guard besides its crossings, for the observer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Noticed<Mode> {
    Touch(Grazing<Mode>),
    Pole(Pole<Mode>),
}

impl<Mode: Copy> Noticed<Mode> {
    /// What isolation of `sign` times a guard noticed on the step from `s` of size `h`.
    pub(crate) fn of(
        notice: Notice,
        (guard, sign): (usize, f64),
        mode: Mode,
        (s, h): (f64, f64),
    ) -> Self {
        match notice {
            Notice::Touch(Touch { theta, margin }) => {
                Self::Touch(Grazing { s: s + theta * h, mode, guard, margin: sign * margin })
            }
            Notice::Pole(theta) => Self::Pole(Pole { s: s + theta * h, mode, guard }),
        }
    }

    /// The guard, whether it touches zero, and the place.
    fn about(&self) -> (usize, bool, f64) {
        match *self {
            Self::Touch(touch) => (touch.guard, true, touch.s),
            Self::Pole(pole) => (pole.guard, false, pole.s),
        }
    }
}

/// The touches and poles on a step. Those behind a switch do not happen.
#[derive(Debug)]
pub(crate) struct Notices<Mode>(SmallVec<[Noticed<Mode>; FEW]>);

impl<Mode: Copy> Notices<Mode> {
    pub(crate) fn new() -> Self {
        Self(SmallVec::new())
    }

    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }

    /// Adds what was noticed on a step of size `h`, if it is new.
    pub(crate) fn add(&mut self, noticed: Noticed<Mode>, h: f64) {
        let (guard, touches, s) = noticed.about();
        let same = |other: &Noticed<Mode>| {
            let (of, touch, at) = other.about();
            (of, touch) == (guard, touches) && (at - s).abs() <= SAME * h
        };
        if !self.0.iter().any(same) {
            self.0.push(noticed);
        }
    }

    /// Removes the first one, if it is not behind `until`.
    #[inline]
    pub(crate) fn next_until(&mut self, until: f64) -> Option<Noticed<Mode>> {
        if self.0.is_empty() {
            return None;
        }
        let place = |index: &usize| self.0[*index].about().2;
        let first = (0..self.0.len()).min_by(|a, b| place(a).total_cmp(&place(b)))?;
        (place(&first) <= until).then(|| self.0.remove(first))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn notices_come_in_order_once_and_up_to_a_place() {
        let touch = |s: f64| Noticed::Touch(Grazing { s, mode: (), guard: 0, margin: 0.0 });
        let pole = |s: f64| Noticed::Pole(Pole { s, mode: (), guard: 0 });
        let mut notices = Notices::new();
        for noticed in [touch(2.0), touch(1.0), touch(1.0 + 1e-9), pole(1.5), touch(3.0)] {
            notices.add(noticed, 1.0);
        }
        let noticed: Vec<_> = std::iter::from_fn(|| notices.next_until(2.0)).collect();
        assert_eq!(noticed, [touch(1.0), pole(1.5), touch(2.0)]);
        assert_eq!(notices.next_until(f64::INFINITY), Some(touch(3.0)));
    }
}
