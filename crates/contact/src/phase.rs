//! The phases of a contact, and the guards that end them.

use std::fmt;

use crate::contact::Contact;

/// Number of guards of a phase.
pub const GUARDS: usize = 3;

/// Guard of the end of contact.
pub const END: usize = 0;
/// Guard of the switch that stays on the side of the phase.
pub const SAME_SIDE: usize = 1;
/// Guard of the switch to slip on the other side.
pub const OTHER_SIDE: usize = 2;

/// The law that the tangential force obeys.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "lowercase"))]
pub enum Regime {
    /// Coulomb sliding: the force has its limit μ F_n.
    Slip,
    /// The tangential spring: the force is below the limit.
    Stick,
}

impl Regime {
    /// `slip` or `stick`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Slip => "slip",
            Self::Stick => "stick",
        }
    }
}

impl fmt::Display for Regime {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The side of the spring's limit: the sign s of the elongation y = s L while sliding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// s = +1, the side of the initial motion.
    Positive,
    /// s = −1.
    Negative,
}

impl Side {
    /// The sign s = ±1.
    pub fn sign(self) -> f64 {
        match self {
            Self::Positive => 1.0,
            Self::Negative => -1.0,
        }
    }

    /// The other side.
    pub fn opposite(self) -> Self {
        match self {
            Self::Positive => Self::Negative,
            Self::Negative => Self::Positive,
        }
    }
}

/// A phase of the contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Phase {
    /// The law that holds.
    pub regime: Regime,
    /// The side of sliding; in stick, the side from which the spring comes.
    pub side: Side,
    /// How far it is from its start.
    pub progress: PhaseProgress,
}

/// How far a phase is from its start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PhaseProgress {
    /// The contact has just begun.
    Touched,
    /// A switch has just happened.
    Switched,
    /// The gap between the spring and its limit has become open.
    Settled,
}

impl Phase {
    /// The first phase.
    ///
    /// The spring grows as t. Without damping its limit grows as t^{3/2}, and the first phase is
    /// slip. With damping the limit grows as a √t, and the first phase is stick.
    pub fn first(contact: &Contact) -> Self {
        let regime = if contact.damping() > 0.0 { Regime::Stick } else { Regime::Slip };
        Self { regime, side: Side::Positive, progress: PhaseProgress::Touched }
    }

    /// The phase that follows: the other regime, and the other side if the spring has reached its
    /// limit there.
    pub fn after(self, on_other_side: bool) -> Self {
        let regime = match self.regime {
            Regime::Slip => Regime::Stick,
            Regime::Stick => Regime::Slip,
        };
        let side = if on_other_side { self.side.opposite() } else { self.side };
        Self { regime, side, progress: PhaseProgress::Switched }
    }
}

/// Whether the `gap` between the spring and its limit may be computed as a difference from now on.
/// As long as it is a smaller part of the `terms` of the limit, errors of steps and rounding may
/// exceed it.
#[inline(always)]
pub(crate) fn is_open(gap: f64, terms: f64) -> bool {
    const OPEN: f64 = 1e-3;
    gap > OPEN * terms
}

/// The longest first step of a phase, by the guard that ends the contact and its rate. Near its end
/// a contact has no other scale than the time that is left, which may be far below the tolerance.
pub(crate) fn longest_first_step(end: f64, rate: f64) -> f64 {
    /// The step goes at most this part of the time left beyond it.
    const BEYOND: f64 = 1.5;
    if rate < 0.0 { BEYOND * end / -rate } else { f64::INFINITY }
}
