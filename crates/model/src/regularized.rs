//! The collision in coordinates in which everything is smooth.
//!
//! With u = √x and dt = 2u ds the law of Schwager, Becker and Pöschel (Eur. Phys. J. E 27, 107) becomes
//! polynomial. The force F = u(u² + a v) and the spring are carried as
//!
//! - gap = F − s κ y, by how much the spring is below the limit on the side s it comes from,
//! - rate = d gap/ds,
//!
//! so that the double zero with which a stick phase starts is exact: gap and rate both start from 0 and no
//! difference of nearly equal numbers is ever taken. In both regimes
//!
//! ```text
//! u' = v     v' = −2u²(u² + a v)     t' = 2u     w' = −2s u (F − gap)
//! rate' = F'' − 2sκ v w + 4κ u² (F − gap)
//! ```
//!
//! and gap' = rate in stick, gap = 0 in slip, where −rate is the guard.

use stickslip_solver::{Direction, Guard, HybridSystem, State};

use crate::contact::{Contact, Regime, Side};

/// Components of the state.
pub const STATE: usize = 8;
/// Guards of a phase.
pub const GUARDS: usize = 3;

/// u = √x.
pub const U: usize = 0;
/// v = dx/dt.
pub const V: usize = 1;
/// Time since the phase began.
pub const T: usize = 2;
/// Reduced tangential velocity.
pub const W: usize = 3;
/// F − s κ y.
pub const GAP: usize = 4;
/// d gap/ds.
pub const RATE: usize = 5;
/// Tangential energy taken by sliding.
pub const SLIDING: usize = 6;
/// Normal energy taken by damping.
pub const DAMPING: usize = 7;

/// Guard of the end of contact.
pub const END: usize = 0;
/// Guard of the switch on the side at hand.
pub const SAME_SIDE: usize = 1;
/// Guard of the switch to slip on the other side.
pub const OTHER_SIDE: usize = 2;

/// A phase of the contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Phase {
    /// Its law.
    pub regime: Regime,
    /// The side of sliding; in stick, the side from which the spring comes.
    pub side: Side,
    /// Whether the contact starts with it.
    pub first: bool,
}

impl Phase {
    /// The first phase: slip without damping, since the limit grows as t^{3/2} and the spring as t; stick
    /// with it, since the limit then grows as a √t.
    #[must_use]
    pub fn first(contact: &Contact) -> Self {
        let regime = if contact.damping() > 0.0 { Regime::Stick } else { Regime::Slip };
        Self { regime, side: Side::Positive, first: true }
    }
}

/// The contact as a hybrid system in (u, v, t, w, gap, rate), with two quadratures for the energy ledger.
#[derive(Clone, Copy, Debug)]
pub struct Regularized {
    contact: Contact,
}

/// The force F and its first two derivatives with respect to s.
#[derive(Clone, Copy)]
struct Force {
    value: f64,
    first: f64,
    second: f64,
    /// dv/ds.
    deceleration: f64,
}

impl Regularized {
    /// The system of one contact.
    #[must_use]
    pub fn new(contact: Contact) -> Self {
        Self { contact }
    }

    /// The state at the start of contact.
    #[must_use]
    pub fn start(&self) -> State<STATE> {
        let mut y = State::zeros();
        y[V] = 1.0;
        y[W] = self.contact.psi();
        y[RATE] = self.contact.damping();
        y
    }

    /// Reduced elongation y of the spring in a state of `phase`.
    #[must_use]
    pub fn spring(&self, phase: Phase, y: &State<STATE>) -> f64 {
        phase.side.sign() * (self.force(y[U], y[V]).value - y[GAP]) / self.contact.kappa()
    }

    #[inline(always)]
    fn force(&self, u: f64, v: f64) -> Force {
        let a = self.contact.damping();
        let uu = u * u;
        let f1 = uu + a * v;
        let dv = -2.0 * uu * f1;
        let df1 = 2.0 * u * v + a * dv;
        let ddv = -2.0 * u * (2.0 * v * f1 + u * df1);
        let ddf1 = 2.0 * (v * v + u * dv) + a * ddv;
        Force {
            value: u * f1,
            first: v * f1 + u * df1,
            second: dv * f1 + 2.0 * v * df1 + u * ddf1,
            deceleration: dv,
        }
    }

    /// The guard of slip on side s: s w − dL/dt, in the form that has no zero of its own where u = 0.
    #[inline(always)]
    fn slip_guard(&self, side: Side, y: &State<STATE>) -> f64 {
        let (u, v, w) = (y[U], y[V], y[W]);
        let pull = self.contact.kappa() * side.sign() * w;
        if self.contact.damping() > 0.0 {
            2.0 * u * pull - self.force(u, v).first
        } else {
            pull - 1.5 * u * v
        }
    }
}

impl HybridSystem<STATE, GUARDS> for Regularized {
    type Mode = Phase;

    #[inline(always)]
    fn field(&self, phase: Phase, _s: f64, y: &State<STATE>) -> State<STATE> {
        let (kappa, a) = (self.contact.kappa(), self.contact.damping());
        let (u, v, w) = (y[U], y[V], y[W]);
        let sign = phase.side.sign();
        let force = self.force(u, v);
        let loss = 2.0 * a * (u * v) * (u * v);
        match phase.regime {
            Regime::Slip => State::from([
                v,
                force.deceleration,
                2.0 * u,
                sign * force.deceleration,
                0.0,
                0.0,
                force.value * (2.0 * u * sign * w - force.first / kappa),
                loss,
            ]),
            Regime::Stick => {
                let drag = 2.0 * u * (force.value - y[GAP]);
                State::from([
                    v,
                    force.deceleration,
                    2.0 * u,
                    -sign * drag,
                    y[RATE],
                    force.second - 2.0 * kappa * (sign * v * w - u * drag),
                    0.0,
                    loss,
                ])
            }
        }
    }

    #[inline(always)]
    fn guards(&self, phase: Phase) -> [Guard; GUARDS] {
        let end = Guard::new(Direction::Below).terminal();
        // Without damping the contact starts at u = 0; with it both forces start from 0 in stick.
        let end = if phase.first && phase.regime == Regime::Slip { end.from_zero(1) } else { end };
        let leave = Guard::new(Direction::Below);
        match (phase.regime, phase.first) {
            (Regime::Slip, _) => [end, leave, Guard::OFF],
            (Regime::Stick, true) => [end, leave.from_zero(1), leave.from_zero(1)],
            (Regime::Stick, false) => [end, leave.from_zero(2), leave],
        }
    }

    #[inline(always)]
    fn guard_values(&self, phase: Phase, _s: f64, y: &State<STATE>) -> [f64; GUARDS] {
        let a = self.contact.damping();
        let end = if a > 0.0 { y[U] * y[U] + a * y[V] } else { y[U] };
        match phase.regime {
            Regime::Slip => [end, self.slip_guard(phase.side, y), 1.0],
            Regime::Stick => {
                let force = y[U] * (y[U] * y[U] + a * y[V]);
                [end, y[GAP], 2.0 * force - y[GAP]]
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
        let regime = match phase.regime {
            Regime::Slip => Regime::Stick,
            Regime::Stick => Regime::Slip,
        };
        let side = if guard == OTHER_SIDE { phase.side.opposite() } else { phase.side };
        let mut y = *y;
        y[T] = 0.0;
        y[GAP] = 0.0;
        y[RATE] = 0.0;
        (Phase { regime, side, first: false }, y)
    }
}
