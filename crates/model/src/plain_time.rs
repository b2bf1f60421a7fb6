//! The collision in plain time: the law as the paper writes it, for convergence studies.
//!
//! ```text
//! ẋ = v     v̇ = −F     stick: ẏ = w, ẇ = −κ y     slip: ẇ = −s F, y = s F/κ     F = x^{3/2} + a √x v
//! ```
//!
//! The power 3/2 is not smooth where x = 0, at both ends of contact: a method of order 5 or 8 converges with order
//! about 2.5 here. [`crate::regularized`] is the same collision without that defect; nothing but the studies
//! should use this one.

use stickslip_solver::{Direction, Guard, HybridSystem, State};

use crate::contact::{Contact, Regime, Side};
use crate::regularized::{Phase, Progress};

/// Components: x, v, y, w.
pub const STATE: usize = 4;
const X: usize = 0;
const V: usize = 1;
const Y: usize = 2;
/// Reduced tangential velocity.
pub const W: usize = 3;

/// Guard of the end of contact.
pub const END: usize = 0;
const OTHER_SIDE: usize = 2;

/// The undamped contact as a hybrid system in (x, v, y, w) and time.
#[derive(Clone, Copy, Debug)]
pub struct PlainTime {
    contact: Contact,
}

impl PlainTime {
    /// The system of one contact; its damping is not part of it.
    #[must_use]
    pub fn new(contact: Contact) -> Self {
        Self { contact }
    }

    /// The first phase: slip on side +1.
    #[must_use]
    pub fn first(&self) -> Phase {
        Phase { regime: Regime::Slip, side: Side::Positive, progress: Progress::Touched }
    }

    /// The state at the start of contact.
    #[must_use]
    pub fn start(&self) -> State<STATE> {
        State::from([0.0, 1.0, 0.0, self.contact.psi()])
    }

    fn force(y: &State<STATE>) -> f64 {
        // A trial step may end beyond the end of contact.
        y[X].max(0.0).powf(1.5)
    }
}

impl HybridSystem<STATE, 3> for PlainTime {
    type Mode = Phase;

    fn field(&self, phase: Phase, _s: f64, y: &State<STATE>) -> State<STATE> {
        let force = Self::force(y);
        match phase.regime {
            Regime::Slip => State::from([y[V], -force, 0.0, -phase.side.sign() * force]),
            Regime::Stick => State::from([y[V], -force, y[W], -self.contact.kappa() * y[Y]]),
        }
    }

    fn guards(&self, phase: Phase) -> [Guard; 3] {
        let end = Guard::new(Direction::Below).terminal();
        let leave = Guard::new(Direction::Below);
        match (phase.regime, phase.progress) {
            (Regime::Slip, Progress::Touched) => [end.from_zero(1), leave, Guard::OFF],
            (Regime::Slip, _) => [end, leave, Guard::OFF],
            (Regime::Stick, Progress::Settled) => [end, leave, leave],
            (Regime::Stick, _) => [end, leave.from_zero(2), leave],
        }
    }

    fn guard_values(&self, phase: Phase, _s: f64, y: &State<STATE>) -> [f64; 3] {
        let (sign, kappa) = (phase.side.sign(), self.contact.kappa());
        match phase.regime {
            Regime::Slip => [y[X], kappa * sign * y[W] - 1.5 * y[X].max(0.0).sqrt() * y[V], 1.0],
            Regime::Stick => {
                let (force, pull) = (Self::force(y), kappa * sign * y[Y]);
                [y[X], force - pull, force + pull]
            }
        }
    }

    fn transition(
        &self,
        phase: Phase,
        guard: usize,
        _s: f64,
        y: &State<STATE>,
    ) -> (Phase, State<STATE>) {
        let next = phase.after(guard == OTHER_SIDE);
        let mut y = *y;
        if next.regime == Regime::Stick {
            y[Y] = next.side.sign() * Self::force(&y) / self.contact.kappa();
        }
        (next, y)
    }
}
