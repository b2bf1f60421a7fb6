//! Guards: when a run switches.

/// When a guard fires.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// As soon as it is negative: the guard bounds the domain of its mode. A guard that is negative
    /// when the mode is entered fires at once. Transitions should therefore lead to places where
    /// it is not negative; otherwise the run ends with
    /// [`Outcome::Zeno`](crate::Outcome::Zeno).
    Below,
    /// When it falls through zero. A guard that starts negative must rise first.
    Falling,
    /// When it rises through zero.
    Rising,
    /// When it falls or rises through zero.
    Either,
    /// Never: the guard is not part of this mode.
    Off,
}

/// A guard of a mode: when it fires, what it causes, and whether it starts from zero.
///
/// ```
/// use stickslip_solver::{Direction, Guard};
///
/// // Height above the floor. It ends the run, and starts from zero when the body is thrown up.
/// let floor = Guard::new(Direction::Below).from_zero(1).terminal();
/// assert!(floor.ends_run() && floor.zero_order() == 1);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Guard {
    direction: Direction,
    zero_order: u32,
    terminal: bool,
    yields: bool,
}

impl Guard {
    /// A guard that is not part of the mode, for unused places.
    pub const OFF: Self = Self::new(Direction::Off);

    /// A guard that fires in `direction` and causes a transition.
    #[must_use]
    pub const fn new(direction: Direction) -> Self {
        Self { direction, zero_order: 0, terminal: false, yields: false }
    }

    /// Declares that the guard starts from a zero of this order whenever the mode is entered, also
    /// at the start of the run.
    ///
    /// A guard that is exactly 0 there and rises does not need this. Two kinds of guards do: those
    /// whose value may differ from 0 by rounding, and those with a double zero, because their side
    /// after the zero could not be told otherwise.
    ///
    /// The zero is divided out before the search for roots. So the guard does not fire at the
    /// start, and nobody has to nudge the state away from it. A value there that is only due to
    /// rounding of the state counts as zero. A double zero is most accurate if guard and slope are
    /// components of the state that start from exactly 0.
    #[must_use]
    pub const fn from_zero(self, order: u32) -> Self {
        Self { zero_order: order, ..self }
    }

    /// Makes the guard end the run instead of causing a transition.
    #[must_use]
    pub const fn terminal(self) -> Self {
        Self { terminal: true, ..self }
    }

    /// Makes the guard yield to every other guard that fires at the same place: the other one
    /// decides the transition.
    #[must_use]
    pub const fn yielding(self) -> Self {
        Self { yields: true, ..self }
    }

    /// When the guard fires.
    #[must_use]
    pub const fn direction(&self) -> Direction {
        self.direction
    }

    /// The order of the zero from which the guard starts, or 0 if there is none.
    #[must_use]
    pub const fn zero_order(&self) -> u32 {
        self.zero_order
    }

    /// Whether the guard ends the run.
    #[must_use]
    pub const fn ends_run(&self) -> bool {
        self.terminal
    }

    /// Whether the guard yields to others that fire at the same place.
    #[must_use]
    pub const fn yields(&self) -> bool {
        self.yields
    }
}
