//! A contact with any law, in coordinates in which everything is smooth.
//!
//! With x = uⁿ and dt = n u^{n−1} ds, where n is 1, 2 or 4, the equations of every [`Law`] are
//! polynomial: du/ds = v, and no root is left. Three things need a mode of their own:
//!
//! - Where the history is rescaled, it grows as √x while the overlap falls. From greatest
//!   compression on, history over √x is carried, whose equation is polynomial again.
//! - Where the normal force begins to attract, its absolute value has a kink. Behind it the limit
//!   grows from zero, and a stick phase is tried first: it is over at once where the contact slips.
//! - In the same way a contact starts in stick, and slips at once where the spring or its dashpot
//!   would exceed the limit. Its history is then reset.
//!
//! Neither greatest compression nor the beginning of attraction is a switch.
//!
//! Both the limit and the tangential force may vanish with a power of u at both ends of contact.
//! The power they share is divided out of the guards.

use stickslip_solver::{Direction, Guard, Number, ReadableSystem, State};

pub(crate) mod equations;
mod exponents;

use super::phase::{END, OTHER_SIDE, Regime, SAME_SIDE, Side};
use crate::contact::Contact;
use crate::laws::law::{End, Law};
use equations::Equations;

/// Number of components.
pub const STATE: usize = 8;
/// u, the n-th root of the overlap.
pub const U: usize = 0;
/// v = dx/dt where the damping a is below 1, otherwise a³(v + u^{p−d}/a).
pub const V: usize = 1;
/// The history, scaled as in [`regularized`](super::regularized::SPRING).
pub const SPRING: usize = 2;
/// w/σ with σ = min(1, ψ).
pub const W: usize = 3;
/// Time since the phase began.
pub const T: usize = 4;
/// Normal energy taken by damping.
pub const DAMPING: usize = 5;
/// gap/c, in the first step of a stick phase.
pub const GAP: usize = 6;
/// rate/c², in the first step of a stick phase.
pub const RATE: usize = 7;

/// Number of guards.
pub const GUARDS: usize = 5;
/// Guard of greatest compression, where the history is rescaled.
pub const CREST: usize = 3;
/// Guard of a reversal of the tangential velocity, which changes nothing.
pub const REVERSAL: usize = 4;

/// A contact with any law, as a hybrid system.
#[derive(Clone, Copy, Debug)]
pub struct GeneralContact {
    contact: Contact,
    equations: Equations,
    /// Whether reversals of the tangential velocity are events.
    reversals: bool,
}

/// A phase, and the equations that hold in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mode {
    /// Whether the tangential force has its limit.
    pub regime: Regime,
    /// The side of sliding; in stick, the side from which the spring comes.
    pub side: Side,
    /// The part of the contact.
    pub stage: Stage,
    /// How the phase began.
    pub progress: Progress,
}

/// Parts of a contact in which the equations differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// From the start of contact on.
    Main,
    /// Behind greatest compression, where the history is rescaled.
    Unloading,
    /// Where the normal force attracts.
    Tail,
}

/// How a phase began.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// Where the limit is zero: at the start of contact, or where attraction begins.
    Touched,
    /// At the start of contact with a reset history.
    Reset,
    /// At a switch.
    Switched,
    /// It has taken its first step.
    Settled,
}

impl Stage {
    /// The sign of the normal force.
    fn sign(self) -> f64 {
        if self == Self::Tail { -1.0 } else { 1.0 }
    }
}

impl GeneralContact {
    /// The system of one contact.
    #[must_use]
    pub fn new(contact: Contact) -> Self {
        Self { contact, equations: Equations::new(&contact), reversals: false }
    }

    /// The same system, with an event at every reversal of the tangential velocity.
    #[must_use]
    pub fn with_reversals(self) -> Self {
        Self { reversals: true, ..self }
    }

    /// The parameters of the contact.
    #[must_use]
    pub fn contact(&self) -> Contact {
        self.contact
    }

    /// The mode in which every contact starts.
    #[must_use]
    pub fn first(&self) -> Mode {
        Mode {
            regime: Regime::Stick,
            side: Side::Positive,
            stage: Stage::Main,
            progress: Progress::Touched,
        }
    }

    /// The state at the start of contact.
    #[must_use]
    pub fn start(&self) -> State<STATE> {
        self.equations.start(self.contact.psi()).into()
    }

    /// Reduced tangential velocity w.
    #[must_use]
    pub fn velocity(&self, y: &State<STATE>) -> f64 {
        self.equations.velocity(array(y))
    }

    /// Rate v of the overlap.
    #[must_use]
    pub fn compression_rate(&self, y: &State<STATE>) -> f64 {
        self.equations.compression_rate(array(y))
    }

    /// Overlap x.
    #[must_use]
    pub fn overlap(&self, y: &State<STATE>) -> f64 {
        // Where a contact ends, rounding may make u negative.
        y[U].max(0.0).powi(i32::from(self.equations.exponents.n))
    }

    /// Scaled normal force F.
    #[must_use]
    pub fn normal_force(&self, y: &State<STATE>) -> f64 {
        self.equations.normal_force(array(y))
    }

    /// The tangential force Q against the motion, in units of μ times the scaled normal force.
    #[must_use]
    pub fn tangential_force(&self, mode: Mode, y: &State<STATE>) -> f64 {
        match mode.regime {
            Regime::Slip => mode.side.sign() * mode.stage.sign() * self.normal_force(y),
            Regime::Stick => self.equations.tangential_force(mode.stage, array(y)),
        }
    }

    /// The force of the spring in units of κ: where the stiffness is constant, its elongation y.
    #[must_use]
    pub fn spring(&self, mode: Mode, y: &State<STATE>) -> f64 {
        let rest = self.equations.dashpot_force(array(y));
        (self.tangential_force(mode, y) - rest) / self.contact.kappa()
    }

    /// Whether an attracting tail follows where the normal force vanishes.
    fn attracts(&self) -> bool {
        let Law { limit_damping, end, .. } = self.contact.law();
        self.equations.exponents.damped && end == End::Overlap && !limit_damping
    }

    /// The order of the zero from which the guards of the first phase start.
    fn first_order(&self) -> u32 {
        let e = self.equations.exponents;
        let of = e.of(Stage::Main);
        u32::from((e.d - of.shared).min(of.rho - of.shared + of.beta + 1))
    }

    /// Whether a slip that is over at the very start of contact is followed by slip on the other
    /// side.
    ///
    /// The history has then been reset to the limit, less what the dashpot adds. A spring that
    /// grows faster than the limit is at its other limit at once.
    fn overturns(&self) -> bool {
        let e = self.equations.exponents;
        e.of(Stage::Main).rho > e.d
    }
}

impl ReadableSystem<STATE, GUARDS> for GeneralContact {
    type Mode = Mode;

    #[inline(always)]
    fn field<T: Number>(&self, mode: Mode, _s: T, y: &[T; STATE]) -> [T; STATE] {
        self.equations.field(mode, y)
    }

    #[inline(always)]
    fn guards(&self, mode: Mode) -> [Guard; GUARDS] {
        let e = self.equations.exponents;
        let of = e.of(mode.stage);
        let below = Guard::new(Direction::Below).smooth();
        let touched = matches!(mode.progress, Progress::Touched | Progress::Reset);
        // A phase that starts from a zero may be much shorter than a step.
        let leave = if touched { Guard::new(Direction::Below) } else { below };
        let end = if self.attracts() && mode.stage != Stage::Tail { below } else { below.terminal() };
        // Where both limits are 0, a spring that is there slips first.
        let end = if mode.regime == Regime::Stick { end.yielding() } else { end };
        // Without damping the contact starts at u = 0.
        let starts = touched && mode.stage != Stage::Tail && !e.damped;
        let end = if starts { end.from_zero(1) } else { end };
        let [same, other] = match (mode.regime, mode.progress) {
            (Regime::Slip, _) => [below, Guard::OFF],
            (_, Progress::Touched) => {
                let order = if mode.stage == Stage::Tail { 1 } else { self.first_order() };
                [leave.from_zero(order); 2]
            }
            (_, Progress::Reset) => [
                leave.from_zero(u32::from(of.leading - of.shared)),
                leave.from_zero(u32::from(e.d - of.shared)),
            ],
            (_, Progress::Switched) => [below.from_zero(2), below],
            (_, Progress::Settled) => [below, below],
        };
        let crest =
            if e.rescaled && mode.stage == Stage::Main { below } else { Guard::OFF };
        let reversal = Guard::new(Direction::Either).smooth();
        [end, same, other, crest, if self.reversals { reversal } else { Guard::OFF }]
    }

    #[inline(always)]
    fn guard_values<T: Number>(&self, mode: Mode, _s: T, y: &[T; STATE]) -> [T; GUARDS] {
        self.equations.guards(mode, y)
    }

    fn longest_first_step(&self, _mode: Mode, _s: f64, y: &State<STATE>) -> f64 {
        super::longest_first_step(y[U], self.compression_rate(y))
    }

    #[inline(always)]
    fn settle(&self, mode: Mode) -> Mode {
        Mode { progress: Progress::Settled, ..mode }
    }

    fn transition(
        &self,
        mode: Mode,
        guard: usize,
        _s: f64,
        y: &State<STATE>,
    ) -> (Mode, State<STATE>) {
        let next = match guard {
            REVERSAL => return (mode, *y),
            CREST => {
                let next = Mode { stage: Stage::Unloading, ..self.settle(mode) };
                return (next, self.equations.turn(array(y)).into());
            }
            END => Mode {
                regime: Regime::Stick,
                stage: Stage::Tail,
                progress: Progress::Touched,
                ..mode
            },
            _ => self.switched(mode, guard, y),
        };
        (next, self.equations.enter(next, array(y)).into())
    }
}

impl GeneralContact {
    /// The mode that follows `mode` where the spring reaches or leaves its limit.
    fn switched(&self, mode: Mode, guard: usize, y: &State<STATE>) -> Mode {
        let starts = y[U] == 0.0;
        let (regime, side, progress) = match mode.regime {
            Regime::Slip if starts && self.overturns() => {
                (Regime::Slip, Side::Negative, Progress::Switched)
            }
            Regime::Slip if starts => (Regime::Stick, mode.side, Progress::Reset),
            Regime::Slip => (Regime::Stick, mode.side, Progress::Switched),
            Regime::Stick => {
                let side = if guard == OTHER_SIDE { mode.side.opposite() } else { mode.side };
                (Regime::Slip, side, Progress::Switched)
            }
        };
        debug_assert!(matches!(guard, SAME_SIDE | OTHER_SIDE));
        Mode { regime, side, progress, ..mode }
    }
}

fn array(y: &State<STATE>) -> &[f64; STATE] {
    &y.data.0[0]
}
