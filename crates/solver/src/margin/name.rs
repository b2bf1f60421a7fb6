//! The names of margins, which stay the same while the parameters move.

use std::cmp::Ordering;
use std::hash::{Hash, Hasher};

/// A place that moves with the parameters. All hints are equal, so that margins which differ only
/// in their hints are equal.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Hint(pub f64);

impl PartialEq for Hint {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Eq for Hint {}

impl PartialOrd for Hint {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Hint {
    fn cmp(&self, _: &Self) -> Ordering {
        Ordering::Equal
    }
}

impl Hash for Hint {
    fn hash<H: Hasher>(&self, _: &mut H) {}
}

/// How a guard fires.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Way {
    /// It falls through zero.
    Falling,
    /// It rises through zero.
    Rising,
    /// It is negative where its phase begins, and bounds the domain of the mode.
    AtOnce,
}

/// How a phase of a prescribed run ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Exit {
    /// The guard that fires.
    pub guard: usize,
    /// How it fires.
    pub way: Way,
    /// Whether the condition of the transition is positive; `None` if the transition has no
    /// condition ([`transition_condition`](crate::HybridSystem::transition_condition)).
    pub branch: Option<bool>,
    /// The place after which the guard may fire. It lies after the guard's extrema, which are
    /// passed even if the guard is beyond zero there.
    pub after: Hint,
    /// That place as a part of the phase, or 0 if the guard has no extrema before it fires.
    pub part: Hint,
}

impl Exit {
    /// An exit by a guard that falls, at any place after `after`.
    #[must_use]
    pub const fn falling(guard: usize, after: f64) -> Self {
        Self { guard, way: Way::Falling, branch: None, after: Hint(after), part: Hint(0.0) }
    }
}

/// The place where a margin is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Place {
    /// The start of the phase.
    Start {
        /// Which derivative of the guard is meant, up to a positive factor: 0 for the guard itself,
        /// 1 if the guard starts from a zero, 2 if the zero is a double one.
        derivative: u32,
    },
    /// The local minimum of the guard that is nearest to a place; a local maximum if the guard
    /// fires while rising.
    Minimum {
        /// The place near which the minimum is expected.
        near: Hint,
        /// The number of the minimum in its phase, from 0, in the run that found it.
        number: usize,
    },
    /// The other kind of extremum, where the guard touches zero from its other side: a local
    /// maximum, or a local minimum if the guard fires while rising. A guard that bounds the domain
    /// of its mode has no such margins.
    Maximum {
        /// The place near which the maximum is expected.
        near: Hint,
        /// The number of the maximum in its phase, from 0, in the run that found it.
        number: usize,
    },
    /// Where another guard ends the phase.
    Exit(Exit),
    /// Where the guard itself ends the phase. The margin is not the guard but the condition of its
    /// transition.
    Branch(Exit),
    /// The end of the run, at a terminal guard or at the end of its span.
    End,
    /// Before the run: the condition of its start that has the number of the guard. A family of
    /// runs has such conditions; a system has none.
    Condition,
}

/// The name of a margin: the value of `guard` at `place`, in the phase that follows `exits`.
///
/// Hints say which of several extrema is meant. When the parameters move,
/// [`margin`](crate::margin::margin()) returns the name with hints that have moved along.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Margin {
    /// The exits of the earlier phases, in order.
    pub exits: Vec<Exit>,
    /// The guard that does not fire.
    pub guard: usize,
    /// The place in the phase.
    pub place: Place,
}
