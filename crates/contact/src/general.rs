//! A contact with any law, in coordinates in which everything is smooth.
//!
//! With x = uⁿ and dt = n u^{n−1} ds, where n is 1, 2 or 4, the equations of every [`Law`] are
//! polynomial: du/ds = v, and no root is left. Five things need modes of their own:
//!
//! - Where the history is rescaled, it grows as √x while the overlap falls. From greatest
//!   compression on, history over √x is carried, whose equation is polynomial again.
//! - While a hysteretic force falls, uⁿ is the overlap less what is left of it where the force
//!   ends: the equations are those of a force without hysteresis and with another stiffness. Where
//!   the bodies yield, it follows its tangent before.
//! - Where the normal force begins to attract, its absolute value has a kink, and the limit is
//!   zero. Slip goes on behind it if the spring would leave the limit faster than the limit grows;
//!   otherwise the contact sticks.
//! - Where friction decays with the velocity, its coefficient has a kink where the velocity
//!   vanishes. The mode has the sign of the velocity ([`ContactMode::heading`]), and a reversal is
//!   an event.
//! - For the same reason a contact may start in slip: [`Beginning`]. The ratio of both forces at
//!   the start is known in closed form, while a guard near zero would be decided by rounding. So
//!   this start is not an event, and its margin exists beyond the contacts that start so.
//!
//! Neither greatest compression nor the beginning of attraction is a switch.
//!
//! Both the limit and the tangential force may vanish with a power of u at both ends of contact.
//! The power they share is divided out of the guards.

use stickslip_solver::method::{Step, Trial};
use stickslip_solver::{Direction, Guard, Method, Number, ReadableSystem, State};

pub(crate) mod decay;
pub(crate) mod equations;
mod exponents;
pub(crate) mod hysteresis;
mod system;

use crate::contact::Contact;
use crate::law::{ContactEnd, Law, Normal};
use crate::phase::{END, OTHER_SIDE, Regime, SAME_SIDE, Side, longest_first_step};
use equations::Equations;
pub use system::ContactSystem;

/// Number of components.
pub const STATE: usize = 11;
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
/// Until a stick phase is settled, the gap between the force and its limit on the side of the
/// phase, divided by c and a power of u.
pub const GAP: usize = 6;
/// The rate of that gap, divided by c once more.
pub const RATE: usize = 7;
/// The gap on the other side.
pub const FAR_GAP: usize = 8;
/// Its rate.
pub const FAR_RATE: usize = 9;
/// Tangential energy over σ² taken by the dashpot in stick.
pub const DASHPOT: usize = 10;

/// Number of guards.
pub const GUARDS: usize = 5;
/// Guard of greatest compression, where the history is rescaled or the force hysteretic, and
/// before it of yield.
pub const CREST: usize = 3;
/// Guard of a reversal of the tangential velocity. It changes nothing unless friction decays with
/// the velocity.
pub const REVERSAL: usize = 4;

/// A contact with any law, as a hybrid system.
#[derive(Clone, Copy, Debug)]
pub struct GeneralContact {
    contact: Contact,
    equations: Equations,
    beginning: Beginning,
    /// Whether reversals of the tangential velocity are events.
    reversals: bool,
}

/// A phase, and the equations that hold in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ContactMode {
    /// Whether the tangential force has its limit.
    pub regime: Regime,
    /// The side of sliding; in stick, the side from which the spring comes.
    pub side: Side,
    /// The part of the contact.
    pub stage: Stage,
    /// How the phase began.
    pub progress: ModeProgress,
    /// The sign of the tangential velocity, where friction decays with it; otherwise positive.
    pub heading: Side,
}

/// Parts of a contact in which the equations differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// From the start of contact on.
    Main,
    /// Where the bodies yield.
    Yielding,
    /// Behind greatest compression, where the history is rescaled or the force hysteretic.
    Unloading,
    /// Where the normal force attracts.
    Tail,
}

/// How a contact starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Beginning {
    /// In stick.
    Stick,
    /// In slip on side +1, since spring or dashpot would exceed the limit.
    Slip,
    /// In stick, with a history that is reset to the limit less what the dashpot adds: the dashpot
    /// would exceed the limit, but the spring falls behind it.
    Reset,
    /// In slip on side −1: the history is reset, and a spring that stiffens faster than the limit
    /// is at its other limit at once.
    Overturned,
}

/// How a phase began.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModeProgress {
    /// Where the limit is zero: at the start of contact, or where attraction begins; with adhesion
    /// the former alone.
    Touched,
    /// At the start of contact with a reset history.
    Reset,
    /// At a switch.
    Switched,
    /// Long enough ago for the gaps between the force and its limit to be ordinary differences.
    Settled,
}

impl Stage {
    /// The sign of the normal force.
    fn sign(self) -> f64 {
        if self == Self::Tail { -1.0 } else { 1.0 }
    }
}

impl GeneralContact {
    /// The system of one contact, whose law has no adhesion.
    ///
    /// # Panics
    /// If the law has adhesion: its system is an
    /// [`AdhesiveContact`](crate::adhesive::AdhesiveContact).
    pub fn new(contact: Contact) -> Self {
        assert!(!contact.law().normal.is_adhesive(), "the system has no adhesion");
        let equations = Equations::new(&contact).off_the_border(contact.psi());
        let beginning = equations.beginning(contact.psi());
        Self { contact, equations, beginning, reversals: false }
    }

    /// How the contact starts.
    pub fn beginning(&self) -> Beginning {
        self.beginning
    }

    /// See [`Contact::start_layer`].
    pub(crate) fn start_layer(&self) -> Option<f64> {
        let e = self.equations.exponents;
        if self.beginning != Beginning::Overturned {
            return None;
        }
        // The dashpot's force grows as u^d, that of the reset spring as u^ρ.
        let excess = self.contact.tangential_damping() * self.contact.psi()
            / self.equations.first_limit(self.contact.psi());
        let power = f64::from(e.n) / f64::from(e.of(Stage::Main).rho - e.d);
        Some(((excess + 1.0) / (excess - 1.0)).powf(power))
    }

    /// The same system with another start, for margins that are followed beyond the contacts that
    /// have them.
    pub fn beginning_with(self, beginning: Beginning) -> Self {
        Self { beginning, ..self }
    }

    /// The numbers whose signs decide how the contact starts: one minus the ratio of tangential
    /// force and limit, if both grow alike, and the rate at which the spring exceeds the limit, if
    /// it may fall behind.
    pub fn beginning_margins(&self) -> [Option<f64>; 2] {
        Equations::new(&self.contact).beginning_margins(self.contact.psi())
    }

    /// The part of the overlap that pushes: x, but x − x₀ while a hysteretic force falls.
    pub fn compression(&self, y: &State<STATE>) -> f64 {
        // Where a contact ends, rounding may make u negative.
        y[U].max(0.0).powi(i32::from(self.equations.exponents.n))
    }

    /// Whether a slip is missing behind a contact that ends in `mode`. Where a damped contact ends
    /// at F = 0, its limit falls below every spring before, but the slip that follows may be
    /// shorter than rounding.
    pub fn lacks_slip(&self, mode: ContactMode) -> bool {
        let vanishes =
            self.equations.exponents.damped && self.contact.law().end == ContactEnd::Force;
        vanishes && mode.regime == Regime::Stick && !self.equations.is_frictionless()
    }

    /// Whether an attracting tail follows where the normal force vanishes.
    fn attracts(&self) -> bool {
        let Law { limit_damping, end, .. } = self.contact.law();
        self.equations.exponents.damped && end == ContactEnd::Overlap && !limit_damping
    }

    /// The mode that follows `mode` where `guard` fires. Where attraction begins, slip goes on if
    /// it `slips`.
    pub fn after(&self, mode: ContactMode, guard: usize, slips: bool) -> ContactMode {
        let (regime, side, progress) = match (guard, mode.regime) {
            (REVERSAL, _) => {
                let heading = mode.heading.opposite();
                return ContactMode { heading, progress: ModeProgress::Settled, ..mode };
            }
            (CREST, _) => {
                let yields = mode.stage == Stage::Main && self.equations.yields();
                let stage = if yields { Stage::Yielding } else { Stage::Unloading };
                return ContactMode { stage, progress: ModeProgress::Settled, ..mode };
            }
            (END, _) => {
                let (regime, progress) = if slips && !self.equations.exponents.remembers {
                    (Regime::Slip, ModeProgress::Settled)
                } else if slips {
                    (Regime::Slip, ModeProgress::Switched)
                } else {
                    (Regime::Stick, ModeProgress::Touched)
                };
                return ContactMode { regime, progress, stage: Stage::Tail, ..mode };
            }
            (OTHER_SIDE, Regime::Stick) => {
                (Regime::Slip, mode.side.opposite(), ModeProgress::Switched)
            }
            (_, Regime::Stick) => (Regime::Slip, mode.side, ModeProgress::Switched),
            (_, Regime::Slip) => (Regime::Stick, mode.side, ModeProgress::Switched),
        };
        ContactMode { regime, side, progress, ..mode }
    }

    /// How much faster than the limit the spring leaves it where attraction begins in a slip phase.
    fn excess_in_tail(&self, mode: ContactMode, y: &State<STATE>) -> f64 {
        let tail = self.after(mode, END, true);
        self.equations.guards(tail, array(y))[SAME_SIDE]
    }
}

impl ContactSystem for GeneralContact {
    fn with_reversals(self) -> Self {
        Self { reversals: true, ..self }
    }

    fn contact(&self) -> Contact {
        self.contact
    }

    fn first(&self) -> ContactMode {
        let (regime, side, progress) = match self.beginning {
            Beginning::Stick if self.equations.starts_flat() => {
                (Regime::Stick, Side::Positive, ModeProgress::Settled)
            }
            Beginning::Stick => (Regime::Stick, Side::Positive, ModeProgress::Touched),
            Beginning::Slip => (Regime::Slip, Side::Positive, ModeProgress::Touched),
            Beginning::Reset => (Regime::Stick, Side::Positive, ModeProgress::Reset),
            Beginning::Overturned => (Regime::Slip, Side::Negative, ModeProgress::Touched),
        };
        ContactMode { regime, side, stage: Stage::Main, progress, heading: Side::Positive }
    }

    fn start(&self) -> State<STATE> {
        if self.beginning == Beginning::Stick && self.equations.starts_flat() {
            return self.equations.early(self.contact.psi(), self.equations.first_moment()).into();
        }
        self.equations.enter(self.first(), &self.equations.start(self.contact.psi())).into()
    }

    fn state_before_start(&self, time: f64) -> State<STATE> {
        if self.beginning == Beginning::Stick && self.equations.starts_flat() {
            return self.equations.early(self.contact.psi(), time.sqrt()).into();
        }
        self.start()
    }

    fn velocity(&self, y: &State<STATE>) -> f64 {
        self.equations.velocity(array(y))
    }

    fn compression_rate(&self, y: &State<STATE>) -> f64 {
        self.equations.compression_rate(array(y))
    }

    fn overlap(&self, mode: ContactMode, y: &State<STATE>) -> f64 {
        self.compression(y) + self.equations.left_over(mode.stage)
    }

    fn flight(&self, mode: ContactMode, y: &State<STATE>) -> f64 {
        match self.contact.law().end {
            ContactEnd::Overlap => self.overlap(mode, y) / -self.compression_rate(y),
            ContactEnd::Force => 0.0,
        }
    }

    fn clock_rate(&self, y: &State<STATE>) -> f64 {
        let n = i32::from(self.equations.exponents.n);
        f64::from(n) * y[U].powi(n - 1)
    }

    fn taken_by_dashpot(&self, y: &State<STATE>) -> f64 {
        self.equations.taken_by_dashpot(array(y))
    }

    fn normal_force(&self, mode: ContactMode, y: &State<STATE>) -> f64 {
        self.equations.normal_force(mode.stage, array(y))
    }

    fn limit(&self, mode: ContactMode, y: &State<STATE>) -> f64 {
        let limit = mode.stage.sign() * self.normal_force(mode, y);
        self.equations.rubbed(mode, array(y), limit)
    }

    fn tangential_force(&self, mode: ContactMode, y: &State<STATE>) -> f64 {
        match mode.regime {
            Regime::Slip => mode.side.sign() * self.limit(mode, y),
            Regime::Stick => self.equations.tangential_force(mode.stage, array(y)),
        }
    }

    fn last_slip(&self, mode: ContactMode, y: &State<STATE>) -> Option<(usize, f64)> {
        self.lacks_slip(mode).then(|| self.equations.last_slip(mode, array(y)))
    }

    fn compression_energy(&self, y: &State<STATE>) -> f64 {
        let pushed = self.compression(y);
        match self.contact.law().normal {
            Normal::Linear => 0.5 * pushed * pushed,
            _ => 0.4 * pushed.powf(2.5),
        }
    }
}

impl ReadableSystem<STATE, GUARDS> for GeneralContact {
    type Mode = ContactMode;

    #[inline(always)]
    fn field<T: Number>(&self, mode: ContactMode, _s: T, y: &[T; STATE]) -> [T; STATE] {
        self.equations.field(mode, y)
    }

    /// Each right-hand side has a step that is compiled for it and knows which components are
    /// constant.
    fn step<M: Method>(&self, mode: ContactMode, trial: &Trial<'_, STATE>, step: &mut Step<STATE>) {
        macro_rules! take {
            ($part:ident; $($still:ident)*) => {{
                let slope = &mut trial.slope.clone_owned();
                $(slope[$still] = 0.0;)*
                let trial = &Trial { slope, ..*trial };
                let mut field = |_, y: &State<STATE>| self.equations.$part(mode, array(y)).into();
                step.take::<M>(&mut field, trial);
            }};
        }
        match (mode.regime, mode.progress) {
            (Regime::Slip, _) => take!(slip; SPRING GAP RATE FAR_GAP FAR_RATE DASHPOT),
            (Regime::Stick, ModeProgress::Settled) => take!(stick; GAP RATE FAR_GAP FAR_RATE),
            (Regime::Stick, _) => take!(first_stick;),
        }
    }

    #[inline(always)]
    fn guards(&self, mode: ContactMode) -> [Guard; GUARDS] {
        let e = self.equations.exponents;
        let of = e.of(mode.stage);
        let below = Guard::new(Direction::Below).smooth();
        let touched = matches!(mode.progress, ModeProgress::Touched | ModeProgress::Reset);
        // A phase that starts from a zero may be much shorter than a step.
        let leave = if touched { Guard::new(Direction::Below) } else { below };
        let end =
            if self.attracts() && mode.stage != Stage::Tail { below } else { below.terminal() };
        // Where both limits are 0, a spring that is there slips first.
        let end = if mode.regime == Regime::Stick { end.priority(-1) } else { end };
        // Without damping the contact starts at u = 0.
        let starts = touched && mode.stage != Stage::Tail && !e.damped;
        let end = if starts { end.from_zero(1) } else { end };
        let [same, other] = match (mode.regime, mode.progress) {
            _ if self.equations.is_frictionless() => [Guard::OFF; 2],
            (Regime::Slip, ModeProgress::Switched) if !e.remembers => {
                [below.from_zero(1), Guard::OFF]
            }
            (Regime::Slip, _) => [leave, Guard::OFF],
            (_, ModeProgress::Touched) => {
                let (limit, force) = self.equations.first_orders();
                let order = if mode.stage == Stage::Tail { 1 } else { limit.min(force).into() };
                [leave.from_zero(order); 2]
            }
            (_, ModeProgress::Reset) => [
                leave.from_zero(u32::from(of.leading - of.shared)),
                leave.from_zero(u32::from(e.d - of.shared)),
            ],
            (_, ModeProgress::Switched) => {
                [below.from_zero(if e.remembers { 2 } else { 1 }), below]
            }
            (_, ModeProgress::Settled) => [below, below],
        };
        let loads = matches!(mode.stage, Stage::Main | Stage::Yielding);
        let turns = (e.rescaled || e.hysteretic) && loads;
        let crest = if turns { below } else { Guard::OFF };
        let reversal = if self.equations.decays() {
            below
        } else if self.reversals {
            Guard::new(Direction::Either).smooth()
        } else {
            Guard::OFF
        };
        [end, same, other, crest, reversal]
    }

    #[inline(always)]
    fn guard_values<T: Number>(&self, mode: ContactMode, _s: T, y: &[T; STATE]) -> [T; GUARDS] {
        self.equations.guards(mode, y)
    }

    fn longest_first_step(&self, mode: ContactMode, s: f64, y: &State<STATE>) -> f64 {
        let end = self.guard_values(mode, s, array(y))[END];
        longest_first_step(end, self.guard_rates(mode, s, y)[END])
    }

    #[inline(always)]
    fn settle(&self, mode: ContactMode, y: &State<STATE>) -> ContactMode {
        let opens = mode.regime == Regime::Slip
            || mode.progress != ModeProgress::Settled && self.equations.is_open(mode, array(y));
        if opens { ContactMode { progress: ModeProgress::Settled, ..mode } } else { mode }
    }

    fn transition(
        &self,
        mode: ContactMode,
        guard: usize,
        _s: f64,
        y: &State<STATE>,
    ) -> (ContactMode, State<STATE>) {
        if guard == REVERSAL {
            if !self.equations.decays() {
                return (mode, *y);
            }
            let mut y = *y;
            y[W] = 0.0;
            return (self.after(mode, guard, false), y);
        }
        let slips = mode.regime == Regime::Slip && self.excess_in_tail(mode, y) >= 0.0;
        let next = self.after(mode, guard, slips);
        if guard == CREST {
            let turned = match next.stage {
                Stage::Yielding => *array(y),
                _ => self.equations.turn(array(y)),
            };
            // A contact that begins to stick here would lose the gap to its limit in rounding.
            if mode.progress == ModeProgress::Switched && self.equations.is_at_limit(mode, array(y))
            {
                let next = ContactMode { progress: ModeProgress::Switched, ..next };
                return (next, self.equations.at_limit(next, turned).into());
            }
            return (next, turned.into());
        }
        (next, self.equations.enter(next, array(y)).into())
    }

    fn transition_condition(
        &self,
        mode: ContactMode,
        guard: usize,
        _s: f64,
        y: &State<STATE>,
    ) -> f64 {
        let branches = guard == END && mode.regime == Regime::Slip && self.attracts();
        if branches { self.excess_in_tail(mode, y) } else { f64::NAN }
    }
}

fn array(y: &State<STATE>) -> &[f64; STATE] {
    &y.data.0[0]
}
