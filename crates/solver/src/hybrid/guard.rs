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
    /// At the times of its [schedule](crate::HybridSystem::schedule). Its value is not used.
    Clock,
    /// Never: the guard is not part of this mode.
    Off,
}

impl Direction {
    /// The signs with which a guard has to be multiplied, so that it fires where it falls.
    pub(crate) fn signs(self) -> &'static [f64] {
        match self {
            Self::Rising => &[-1.0],
            Self::Either => &[1.0, -1.0],
            _ => &[1.0],
        }
    }

    /// Whether a guard that crosses zero, and comes from this side, fires.
    pub(crate) fn fires_from(self, before: f64) -> bool {
        self.signs().iter().any(|sign| sign * before > 0.0)
    }

    /// Whether a guard that has left this side of zero acts: also a clock, which has no sides.
    pub(crate) fn acts_from(self, before: f64) -> bool {
        self == Self::Clock || self.is_edge() && self.fires_from(before)
    }

    /// Whether the guard's values decide when it fires.
    pub(crate) fn has_values(self) -> bool {
        !matches!(self, Self::Off | Self::Clock)
    }

    /// Whether the guard fires where it crosses zero, and not as long as it is negative.
    pub(crate) fn is_edge(self) -> bool {
        matches!(self, Self::Falling | Self::Rising | Self::Either)
    }
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
    terminal: u32,
    priority: i8,
    sees_jumps: bool,
    smooth: bool,
}

impl Guard {
    /// A guard that is not part of the mode, for unused places.
    pub const OFF: Self = Self::new(Direction::Off);

    /// A guard that fires in `direction` and causes a transition.
    #[must_use]
    pub const fn new(direction: Direction) -> Self {
        let (priority, sees_jumps, smooth) = (0, false, false);
        Self { direction, zero_order: 0, terminal: 0, priority, sees_jumps, smooth }
    }

    /// A guard that fires at the times of its [schedule](crate::HybridSystem::schedule).
    #[must_use]
    pub const fn clock() -> Self {
        Self::new(Direction::Clock)
    }

    /// Declares that the guard starts from a zero of this order whenever the mode is entered, also
    /// at the start of the run.
    ///
    /// A guard that is exactly 0 there and rises does not need this. Two kinds of guards do: guards
    /// whose value may differ from 0 by rounding, and guards with a double zero, whose side after
    /// the zero would be unknown otherwise.
    ///
    /// The zero is divided out before the search for roots. So the guard does not fire at the
    /// start, and nobody has to nudge the state away from it; a nudge or a dead time would miss a
    /// switch that follows soon. A value there that is only due to rounding of the state counts as
    /// zero. A double zero is most accurate if guard and slope are components of the state that
    /// start from exactly 0.
    #[must_use]
    pub const fn from_zero(self, order: u32) -> Self {
        Self { zero_order: order, ..self }
    }

    /// Makes the guard end the run instead of causing a transition.
    #[must_use]
    pub const fn terminal(self) -> Self {
        self.terminal_after(1)
    }

    /// Makes the guard end the run when it fires for the `count`-th time. Before that it causes
    /// transitions. With a count of 0 it never ends the run.
    ///
    /// Guards are counted by their place, whatever the mode, or by the
    /// [counter](crate::HybridSystem::counter) that the system gives them. A counter is needed
    /// where one place in the list holds different guards in different modes.
    #[must_use]
    pub const fn terminal_after(self, count: u32) -> Self {
        Self { terminal: count, ..self }
    }

    /// Declares that the guard is as smooth as the solution: a combination of few components of the
    /// state, or of the time, in which nothing is steep or fast.
    ///
    /// On most steps its sign then follows from six states that the step knows anyway. For the
    /// other guards of a [readable system](crate::ReadableSystem) the solver bounds them on every
    /// step, which is always right and costs more. Guards of other systems are sampled either way.
    #[must_use]
    pub const fn smooth(self) -> Self {
        Self { smooth: true, ..self }
    }

    /// The priority of the guard, 0 unless it is given. Of guards that fire at one instant, guards
    /// of higher priority act first, and guards of equal priority in the order of the list.
    #[must_use]
    pub const fn priority(self, priority: i8) -> Self {
        Self { priority, ..self }
    }

    /// Makes the guard fire, too, if a transition carries its value across zero. Without this,
    /// only a continuous change is a crossing.
    #[must_use]
    pub const fn sees_jumps(self) -> Self {
        Self { sees_jumps: true, ..self }
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

    /// Whether the guard ends the run when it fires next.
    #[must_use]
    pub const fn ends_run(&self) -> bool {
        self.terminal == 1
    }

    /// Whether six values are enough: the guard is smooth, or not part of the mode.
    pub(crate) fn needs_no_look(&self) -> bool {
        self.smooth || !self.direction.has_values()
    }

    /// The guard, declared to be smooth if `other` is.
    pub(crate) fn as_smooth_as(self, other: &Self) -> Self {
        Self { smooth: other.smooth, ..self }
    }

    /// The guard after it has fired `count` times.
    pub(crate) fn fired(self, count: u32) -> Self {
        let left = self.terminal.saturating_sub(count).max(1);
        Self { terminal: if self.terminal == 0 { 0 } else { left }, ..self }
    }

    /// How often the guard fires until it ends the run, or 0 if it never ends it.
    #[must_use]
    pub const fn fires_until_end(&self) -> u32 {
        self.terminal
    }

    /// Whether the guard is declared to be as smooth as the solution.
    #[must_use]
    pub const fn is_smooth(&self) -> bool {
        self.smooth
    }

    /// The priority with which the guard acts among the guards of one instant.
    pub(crate) fn rank(&self) -> i8 {
        self.priority
    }

    /// Whether the guard fires where a transition carries its value across zero.
    pub(crate) fn watches_jumps(&self) -> bool {
        self.sees_jumps
    }
}
