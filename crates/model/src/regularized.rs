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
//! and gap' = rate in stick, gap = 0 in slip, where −rate is the guard. The state holds gap/c and rate/c² with
//! c = max(1, √κ), which makes their errors comparable to those of w.

use stickslip_solver::{Direction, Guard, HybridSystem, Method, State, Step};

use crate::contact::{Contact, Regime, Side};

/// Components of the state.
pub const STATE: usize = 7;
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
/// gap/c.
pub const GAP: usize = 4;
/// rate/c².
pub const RATE: usize = 5;
/// Normal energy taken by damping.
pub const DAMPING: usize = 6;

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

/// The contact as a hybrid system in (u, v, t, w, gap, rate), with a quadrature for the energy ledger.
#[derive(Clone, Copy, Debug)]
pub struct Regularized {
    contact: Contact,
    /// c = max(1, √κ).
    stiffness: f64,
    /// 1/c.
    softness: f64,
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
        let stiffness = contact.kappa().sqrt().max(1.0);
        Self { contact, stiffness, softness: 1.0 / stiffness }
    }

    /// The state at the start of contact.
    #[must_use]
    pub fn start(&self) -> State<STATE> {
        let mut y = State::zeros();
        y[V] = 1.0;
        y[W] = self.contact.psi();
        y[RATE] = self.softness * self.softness * self.contact.damping();
        y
    }

    /// Scaled normal force F = x^{3/2} + a √x v.
    #[must_use]
    pub fn normal_force(&self, y: &State<STATE>) -> f64 {
        self.force(y[U], y[V]).value
    }

    /// Reduced elongation y of the spring in a state of `phase`.
    #[must_use]
    pub fn spring(&self, phase: Phase, y: &State<STATE>) -> f64 {
        phase.side.sign() * (self.normal_force(y) - self.stiffness * y[GAP]) / self.contact.kappa()
    }

    #[inline(always)]
    fn force(&self, u: f64, v: f64) -> Force {
        if self.contact.damping() > 0.0 { self.force_of::<true>(u, v) } else { self.force_of::<false>(u, v) }
    }

    #[inline(always)]
    fn force_of<const DAMPED: bool>(&self, u: f64, v: f64) -> Force {
        let uu = u * u;
        if DAMPED {
            let a = self.contact.damping();
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
        } else {
            let dv = -2.0 * uu * uu;
            Force {
                value: uu * u,
                first: 3.0 * uu * v,
                second: 3.0 * u * (2.0 * v * v + u * dv),
                deceleration: dv,
            }
        }
    }

    #[inline(always)]
    fn slip<const DAMPED: bool>(&self, side: Side, y: &State<STATE>) -> State<STATE> {
        let (u, v) = (y[U], y[V]);
        let sign = side.sign();
        let force = self.force_of::<DAMPED>(u, v);
        State::from([
            v,
            force.deceleration,
            2.0 * u,
            sign * force.deceleration,
            0.0,
            0.0,
            if DAMPED { 2.0 * self.contact.damping() * (u * v) * (u * v) } else { 0.0 },
        ])
    }

    #[inline(always)]
    fn stick<const DAMPED: bool>(&self, side: Side, y: &State<STATE>) -> State<STATE> {
        let (u, v, w) = (y[U], y[V], y[W]);
        let sign = side.sign();
        let force = self.force_of::<DAMPED>(u, v);
        let kappa = self.contact.kappa();
        let spring = force.value - self.stiffness * y[GAP];
        State::from([
            v,
            force.deceleration,
            2.0 * u,
            (-2.0 * sign * u) * spring,
            self.stiffness * y[RATE],
            self.softness * self.softness
                * ((force.second - (2.0 * sign * kappa) * (v * w)) + (4.0 * kappa * u * u) * spring),
            if DAMPED { 2.0 * self.contact.damping() * (u * v) * (u * v) } else { 0.0 },
        ])
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
        match (phase.regime, self.contact.damping() > 0.0) {
            (Regime::Slip, false) => self.slip::<false>(phase.side, y),
            (Regime::Slip, true) => self.slip::<true>(phase.side, y),
            (Regime::Stick, false) => self.stick::<false>(phase.side, y),
            (Regime::Stick, true) => self.stick::<true>(phase.side, y),
        }
    }

    /// Each regime's step is compiled by itself: what a regime's right-hand side does not use (the spring while
    /// sliding, the quadratures) then costs no stage.
    fn step<M: Method>(
        &self,
        phase: Phase,
        s: f64,
        y0: &State<STATE>,
        f0: &State<STATE>,
        h: f64,
    ) -> Step<STATE> {
        let side = phase.side;
        match (phase.regime, self.contact.damping() > 0.0) {
            (Regime::Slip, false) => Step::take::<M>(&mut |_, y| self.slip::<false>(side, y), s, y0, f0, h),
            (Regime::Slip, true) => Step::take::<M>(&mut |_, y| self.slip::<true>(side, y), s, y0, f0, h),
            (Regime::Stick, false) => Step::take::<M>(&mut |_, y| self.stick::<false>(side, y), s, y0, f0, h),
            (Regime::Stick, true) => Step::take::<M>(&mut |_, y| self.stick::<true>(side, y), s, y0, f0, h),
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
                [end, y[GAP], 2.0 * force - self.stiffness * y[GAP]]
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
