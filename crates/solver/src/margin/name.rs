//! Names of margins, which hold while the parameters move.

use std::cmp::Ordering;
use std::hash::{Hash, Hasher};

/// A place in a phase, which moves with the parameters: two that differ in nothing else are the
/// same.
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
    /// Where the guard is looked at from: beyond its local minima, which it passes wherever they
    /// lie.
    pub after: Hint,
    /// The part of the phase which that is; 0 if the guard has no minima before.
    pub part: Hint,
}

/// Where a margin is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Place {
    /// At the local minimum of the guard that is nearest to a place.
    Minimum {
        /// Where it is to be looked for.
        near: Hint,
        /// Its number in its phase, from 0, where it was found.
        number: usize,
    },
    /// Where the run ends, at a terminal guard or at the end of its span.
    End,
}

/// Names a margin: in the phase that follows `exits`, the value of `guard` at `place`.
///
/// Hints say which of several minima is meant. As the parameters move away, [`margin`] returns the
/// margin with hints that have moved along.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Margin {
    /// The phases before.
    pub exits: Vec<Exit>,
    /// The guard that does not fire.
    pub guard: usize,
    /// Where.
    pub place: Place,
}
