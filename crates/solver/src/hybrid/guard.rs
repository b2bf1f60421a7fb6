//! What makes a run switch.

/// When a guard fires.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// As soon as it is negative: the guard bounds the domain of its mode. One that is negative
    /// when the mode is entered fires there and then, so that transitions lead to where it is
    /// not; a run whose transitions do not ends as [`Outcome::Zeno`](crate::Outcome::Zeno).
    Below,
    /// When it falls through zero; one that starts negative waits until it has risen.
    Falling,
    /// When it rises through zero.
    Rising,
    /// When it changes sign.
    Either,
    /// Never: the guard is not part of this mode.
    Off,
}

/// A guard of a mode: when its value fires a switch, and what is known of it when the mode is
/// entered.
///
/// ```
/// use stickslip_solver::{Direction, Guard};
///
/// // Height above the floor: ends the run, and starts from zero as the body is thrown up.
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
    /// A guard that is not part of the mode.
    pub const OFF: Self = Self::new(Direction::Off);

    /// A guard that fires in `direction` and causes a transition.
    #[must_use]
    pub const fn new(direction: Direction) -> Self {
        Self { direction, zero_order: 0, terminal: false, yields: false }
    }

    /// The guard starts from a zero of this order whenever the mode is entered, also where the run
    /// starts.
    ///
    /// There is no need to say so of a guard that is exactly 0 there and rises. It takes this where
    /// rounding may leave something else than 0, and where the zero is double: which way the
    /// guard leaves it would be anybody's guess.
    ///
    /// The zero is divided out before any root is looked for, so the guard can neither fire at the
    /// start nor need a nudge away from it. What the state's rounding leaves at the start is
    /// taken as zero. Of a double zero least is left where guard and slope are components of
    /// the state that start from exactly 0.
    #[must_use]
    pub const fn from_zero(self, order: u32) -> Self {
        Self { zero_order: order, ..self }
    }

    /// The guard ends the run instead of causing a transition.
    #[must_use]
    pub const fn terminal(self) -> Self {
        Self { terminal: true, ..self }
    }

    /// The guard gives way to every other one that fires at the same place.
    #[must_use]
    pub const fn yielding(self) -> Self {
        Self { yields: true, ..self }
    }

    /// When the guard fires.
    #[must_use]
    pub const fn direction(&self) -> Direction {
        self.direction
    }

    /// Order of the zero from which it starts; 0 for none.
    #[must_use]
    pub const fn zero_order(&self) -> u32 {
        self.zero_order
    }

    /// Whether it ends the run.
    #[must_use]
    pub const fn ends_run(&self) -> bool {
        self.terminal
    }

    /// Whether it gives way to the others.
    #[must_use]
    pub const fn gives_way(&self) -> bool {
        self.yields
    }
}
