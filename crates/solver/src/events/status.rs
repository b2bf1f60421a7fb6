//! What is known about a guard on the step at hand.

use crate::events::isolate::Bracket;
use crate::events::quick::{self, Quick};
use crate::hybrid::Direction;

/// What is known about a guard on the step at hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Status {
    /// The guard does not fire.
    Clear,
    /// The quick look could not decide.
    Unclear,
    /// The guard fires at this crossing.
    Fires(Crossing),
}

/// A crossing of `sign`·guard from ≥ 0 to < 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Crossing {
    pub(crate) sign: f64,
    pub(crate) bracket: Bracket,
}

impl Crossing {
    /// A crossing at the start of the step.
    pub(crate) const fn at_start(sign: f64) -> Self {
        Self { sign, bracket: Bracket::at(0.0) }
    }

    /// A crossing near `theta` of a guard that is monotone on the whole step.
    pub(crate) fn alone(sign: f64, theta: f64) -> Status {
        Status::Fires(Self {
            sign,
            bracket: Bracket { low: 0.0, high: 1.0, guess: theta, rests: false },
        })
    }
}

impl Status {
    /// What the six values show about a guard that starts from a zero of this `order`. The part
    /// `trust` of the next-to-last term of their expansion counts as error.
    pub(crate) fn from_values(
        column: &[f64; 6],
        direction: Direction,
        order: u32,
        trust: f64,
    ) -> Self {
        let sign = if direction == Direction::Rising { -1.0 } else { 1.0 };
        let look = |sign: f64| quick::look(&column.map(|v| sign * v), order, trust);
        match look(sign) {
            Quick::Negative if direction == Direction::Below => {
                Self::Fires(Crossing::at_start(sign))
            }
            Quick::Positive | Quick::Negative => Self::Clear,
            Quick::Falls { theta } => Crossing::alone(sign, theta),
            Quick::Unclear if direction == Direction::Either => match look(-1.0) {
                Quick::Falls { theta } => Crossing::alone(-1.0, theta),
                _ => Self::Unclear,
            },
            Quick::Unclear => Self::Unclear,
        }
    }
}
