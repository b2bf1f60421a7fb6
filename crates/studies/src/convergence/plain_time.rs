//! The collision in plain time: the law as the paper writes it, for studies of convergence.
//!
//! ```text
//! ẋ = v     v̇ = −F     F = x^{3/2} + a √x v
//! stick: ẏ = w, ẇ = −κ y     slip: ẇ = −s F, y = s F/κ
//! ```
//!
//! F is not smooth where x = 0. Without damping this is so at both ends of contact: F ~ t^{3/2},
//! and a method of order 5 or 8 converges with order about 2.5 here. With damping only the start
//! has x = 0, since contact ends at F = 0 with x > 0; but there F ~ a√t, and the order is about
//! 1.5. [`stickslip_model::regularized`] is the same collision without that defect. Only studies of
//! convergence ([`super::measure()`]) should use this one.

use stickslip_model::regularized::{Phase, PhaseProgress};
use stickslip_model::{Contact, Regime};
use stickslip_solver::{Direction, Guard, HybridSystem, State};

/// The number of components: x, v, y, w.
pub const STATE: usize = 4;
const X: usize = 0;
const V: usize = 1;
const Y: usize = 2;
/// Index of the reduced tangential velocity.
pub const W: usize = 3;

const OTHER_SIDE: usize = 2;

/// The contact as a hybrid system in (x, v, y, w) and time.
#[derive(Clone, Copy, Debug)]
pub struct PlainTime {
    contact: Contact,
}

impl PlainTime {
    /// The system of one contact: the paper's law at its κ, ψ and a, whatever law it has.
    pub fn new(contact: Contact) -> Self {
        Self { contact }
    }

    /// The state at the start of contact.
    pub fn start(&self) -> State<STATE> {
        State::from([0.0, 1.0, 0.0, self.contact.psi()])
    }

    fn force(&self, y: &State<STATE>) -> f64 {
        // A trial step may end beyond the end of contact.
        let x = y[X].max(0.0);
        x.sqrt() * (x + self.contact.damping() * y[V])
    }
}

impl HybridSystem<STATE, 3> for PlainTime {
    type Mode = Phase;

    fn field(&self, phase: Phase, _s: f64, y: &State<STATE>) -> State<STATE> {
        let force = self.force(y);
        match phase.regime {
            Regime::Slip => State::from([y[V], -force, 0.0, -phase.side.sign() * force]),
            Regime::Stick => State::from([y[V], -force, y[W], -self.contact.kappa() * y[Y]]),
        }
    }

    fn guards(&self, phase: Phase) -> [Guard; 3] {
        let end = Guard::new(Direction::Below).terminal();
        let leave = Guard::new(Direction::Below);
        match (phase.regime, phase.progress) {
            (Regime::Slip, PhaseProgress::Touched) => [end.from_zero(1), leave, Guard::OFF],
            (Regime::Slip, _) => [end, leave, Guard::OFF],
            (Regime::Stick, PhaseProgress::Touched) => [end, leave.from_zero(1), Guard::OFF],
            (Regime::Stick, PhaseProgress::Settled) => [end, leave, leave],
            (Regime::Stick, _) => [end, leave.from_zero(2), leave],
        }
    }

    fn guard_values(&self, phase: Phase, _s: f64, y: &State<STATE>) -> [f64; 3] {
        let (sign, kappa, a) = (phase.side.sign(), self.contact.kappa(), self.contact.damping());
        let (x, v, force) = (y[X], y[V], self.force(y));
        let end = x + a * v;
        let pull = kappa * sign * y[Y];
        match (phase.regime, phase.progress) {
            (Regime::Slip, _) if a > 0.0 => {
                // s κ w − dF/dt, times √x.
                let rate = 1.5 * x * v + a * (0.5 * v * v - x * force);
                [end, kappa * sign * y[W] * x.max(0.0).sqrt() - rate, 1.0]
            }
            (Regime::Slip, _) => [end, kappa * sign * y[W] - 1.5 * x.max(0.0).sqrt() * v, 1.0],
            // The gaps on both sides multiplied, which is smooth at x = 0 as each of them is not.
            (Regime::Stick, PhaseProgress::Touched) => [end, x * end * end - pull * pull, 1.0],
            (Regime::Stick, _) => [end, force - pull, force + pull],
        }
    }

    fn transition(
        &self,
        phase: Phase,
        guard: usize,
        _s: f64,
        y: &State<STATE>,
    ) -> (Phase, State<STATE>) {
        let first_stick = phase.regime == Regime::Stick && phase.progress == PhaseProgress::Touched;
        let other = if first_stick { y[Y] < 0.0 } else { guard == OTHER_SIDE };
        let next = phase.after(other);
        let mut y = *y;
        if next.regime == Regime::Stick {
            y[Y] = next.side.sign() * self.force(&y) / self.contact.kappa();
        }
        (next, y)
    }
}
