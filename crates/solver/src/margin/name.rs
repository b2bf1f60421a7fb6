//! The names of margins, which stay the same while the parameters move.

use std::cmp::Ordering;
use std::hash::{Hash, Hasher};

/// A place that moves with the parameters. All hints are equal, so that margins which differ only
/// in their hints are equal.
#[derive(Clone, Copy, Debug)]
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

/// How a phase of a prescribed run ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Exit {
    /// The guard that fires.
    pub guard: usize,
    /// The place after which the guard may fire. It lies after the guard's local minima, which are
    /// passed even if the guard is negative there.
    pub after: Hint,
    /// That place as a part of the phase, or 0 if the guard has no minima before it fires.
    pub part: Hint,
}

/// The place where a margin is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Place {
    /// The local minimum of the guard that is nearest to a place.
    Minimum {
        /// The place near which the minimum is expected.
        near: Hint,
        /// The number of the minimum in its phase, from 0, in the run that found it.
        number: usize,
    },
    /// The end of the run, at a terminal guard or at the end of its span.
    End,
}

/// The name of a margin: the value of `guard` at `place`, in the phase that follows `exits`.
///
/// Hints tell which of several minima is meant. When the parameters move,
/// [`margin`](crate::margin()) returns the name with hints that have moved along.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Margin {
    /// The exits of the earlier phases, in order.
    pub exits: Vec<Exit>,
    /// The guard that does not fire.
    pub guard: usize,
    /// The place in the phase.
    pub place: Place,
}
