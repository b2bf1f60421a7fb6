//! The collision in coordinates in which everything is smooth.
//!
//! With u = √x and dt = 2u ds the law of Schwager, Becker and Pöschel (Eur. Phys. J. E 27, 107)
//! becomes polynomial, with the force F = u(u² + a v) and ω = √κ:
//!
//! ```text
//! u' = v     v' = −2u²(u² + a v)     t' = 2u
//! stick: (ωy)' = 2uω w     w' = −2uω (ωy)
//! slip:  w' = −2s u F      y = s F/κ
//! ```
//!
//! At the start of a stick phase the spring is at its limit and moves as fast as the limit does:
//! gap = F − s κ y has a double zero there. Until it is
//! [open](crate::phase::PhaseProgress::Settled) the gap is therefore a component of its own that
//! starts with gap = 0 and rate = gap' = 0:
//!
//! ```text
//! gap' = rate     rate' = F'' − 2sκ v w + 4u²κ s κ y
//! ```
//!
//! However short the phase is, the gap is then never the difference of two nearly equal numbers.
//! From a thousandth of the limit on, the gap is an ordinary difference, with two components less.
//! That is nearly always so after the first step. After a short step the difference would be
//! rounding, and would end the phase at once.
//!
//! For the same reason a³(v + u²/a) is integrated instead of v where a ≥ 1: the contact ends where
//! it vanishes.
//!
//! Other laws are in [`general`](crate::general), with powers of u that are data. This file is
//! compiled for the two regimes of the paper's law, and its results stay the same, bit for bit. A
//! test integrates the paper's law through both.

use stickslip_solver::method::{Step, Trial};
use stickslip_solver::{Direction, Guard, Method, Number, ReadableSystem, State};

pub mod components;
pub mod derivatives;
pub mod equations;

use crate::contact::Contact;
pub use crate::phase::{END, GUARDS, OTHER_SIDE, Phase, PhaseProgress, SAME_SIDE};
use crate::phase::{Regime, Side, longest_first_step};
use components::array;
pub use components::{DAMPING, GAP, RATE, SPRING, STATE, T, U, V, W};
use equations::{Equations, Force};

/// The contact as a hybrid system.
#[derive(Clone, Copy, Debug)]
pub struct Regularized {
    contact: Contact,
    /// Its equations for plain numbers.
    pub equations: Equations<f64>,
}

impl Regularized {
    /// The system of one contact: that of the paper's law at its κ, ψ and a, whatever law it has.
    pub fn new(contact: Contact) -> Self {
        let contact = contact.with_paper_law();
        Self { contact, equations: Equations::new(&contact) }
    }

    /// The parameters of the contact.
    pub fn contact(&self) -> Contact {
        self.contact
    }

    /// The state at the start of contact.
    pub fn start(&self) -> State<STATE> {
        self.equations.start(self.contact.psi()).into()
    }

    /// Reduced tangential velocity w.
    #[inline(always)]
    pub fn velocity(&self, y: &State<STATE>) -> f64 {
        self.equations.velocity(array(y))
    }

    /// Rate v of the scaled compression.
    #[inline(always)]
    pub fn compression_rate(&self, y: &State<STATE>) -> f64 {
        if self.is_damped() { self.equations.compression_rate::<true>(y[U], y[V]) } else { y[V] }
    }

    /// Scaled normal force F = x^{3/2} + a √x v.
    pub fn normal_force(&self, y: &State<STATE>) -> f64 {
        self.force(y[U], y[V]).value
    }

    /// Reduced elongation y of the spring in a state of `phase`.
    pub fn spring(&self, phase: Phase, y: &State<STATE>) -> f64 {
        let force = match phase.regime {
            Regime::Slip => phase.side.sign() * self.normal_force(y),
            Regime::Stick => self.equations.spring_force * y[SPRING],
        };
        force / self.contact.kappa()
    }

    /// The phase that follows `phase` where `guard` fires at `y`.
    pub(crate) fn next(&self, phase: Phase, guard: usize, y: &State<STATE>) -> Phase {
        let mut other_side = guard == OTHER_SIDE;
        if phase.regime == Regime::Stick && self.is_damped() && y[SPRING] != 0.0 {
            // Where the limit falls to 0 and the spring is as small as rounding, only the sign of
            // the spring tells which side it is on.
            other_side = (y[SPRING] > 0.0) != (phase.side == Side::Positive);
        }
        phase.after(other_side)
    }

    #[inline(always)]
    fn is_damped(&self) -> bool {
        self.contact.damping() > 0.0
    }

    #[inline(always)]
    fn force(&self, u: f64, v: f64) -> Force<f64> {
        if self.is_damped() {
            self.equations.force::<true>(u, v)
        } else {
            self.equations.force::<false>(u, v)
        }
    }
}

impl ReadableSystem<STATE, GUARDS> for Regularized {
    type Mode = Phase;

    #[inline(always)]
    fn field<T: Number>(&self, phase: Phase, _s: T, y: &[T; STATE]) -> [T; STATE] {
        let equations = self.equations.of::<T>();
        if self.is_damped() {
            equations.field::<true>(phase, y)
        } else {
            equations.field::<false>(phase, y)
        }
    }

    /// Each right-hand side has a step that is compiled for it and knows which components are
    /// constant. Those cost nothing, and a quadrature costs no stage.
    fn step<M: Method>(&self, phase: Phase, trial: &Trial<'_, STATE>, step: &mut Step<STATE>) {
        let side = phase.side;
        let settled = phase.progress == PhaseProgress::Settled;
        macro_rules! take {
            ($part:ident $damped:literal ($($side:ident)?); $($still:ident)*) => {{
                let slope = &mut trial.slope.clone_owned();
                $(slope[$still] = 0.0;)*
                let trial = &Trial { slope, ..*trial };
                let mut field = |_, y: &State<STATE>| {
                    self.equations.$part::<$damped>($($side,)? array(y)).into()
                };
                step.take::<M>(&mut field, trial);
            }};
        }
        match (phase.regime, self.is_damped()) {
            (Regime::Slip, false) => take!(slip false (side); SPRING DAMPING GAP RATE),
            (Regime::Slip, true) => take!(slip true (side); SPRING GAP RATE),
            (Regime::Stick, false) if settled => take!(stick false (); DAMPING GAP RATE),
            (Regime::Stick, true) if settled => take!(stick true (); GAP RATE),
            (Regime::Stick, false) => take!(first_stick false (side); DAMPING),
            (Regime::Stick, true) => take!(first_stick true (side);),
        }
    }

    /// All guards are polynomials of the components, of a degree below that of the right-hand side,
    /// so that error control covers them. To bound them on every step would cost a seventh of its
    /// instructions.
    #[inline(always)]
    fn guards(&self, phase: Phase) -> [Guard; GUARDS] {
        let end = Guard::new(Direction::Below).smooth().terminal();
        // With damping both limits are 0 at the end: a spring that is there then slips first.
        let damped_stick = phase.regime == Regime::Stick && self.is_damped();
        let end = if damped_stick { end.priority(-1) } else { end };
        let leave = Guard::new(Direction::Below).smooth();
        match (phase.regime, phase.progress) {
            // Without damping the contact starts at u = 0.
            (Regime::Slip, PhaseProgress::Touched) => [end.from_zero(1), leave, Guard::OFF],
            (Regime::Slip, _) => [end, leave, Guard::OFF],
            // With damping both limits and the spring start from 0.
            (Regime::Stick, PhaseProgress::Touched) => {
                [end, leave.from_zero(1), leave.from_zero(1)]
            }
            (Regime::Stick, PhaseProgress::Switched) => [end, leave.from_zero(2), leave],
            (Regime::Stick, PhaseProgress::Settled) => [end, leave, leave],
        }
    }

    #[inline(always)]
    fn guard_values<T: Number>(&self, phase: Phase, _s: T, y: &[T; STATE]) -> [T; GUARDS] {
        let equations = self.equations.of::<T>();
        if self.is_damped() {
            equations.guards::<true>(phase, y)
        } else {
            equations.guards::<false>(phase, y)
        }
    }

    /// Rates with respect to s. Those of stick without damping have a factor u, which is divided
    /// out: they do not vanish where the contact ends.
    fn guard_rates(&self, phase: Phase, _s: f64, y: &State<STATE>) -> [f64; GUARDS] {
        let a = self.contact.damping();
        let (u, v) = (y[U], self.compression_rate(y));
        let dv = if a > 0.0 {
            self.equations.deceleration::<true>(u, y[V])
        } else {
            self.equations.deceleration::<false>(u, v)
        };
        let end = if a > 0.0 { 2.0 * u * v + a * dv } else { v };
        let force = self.force(u, y[V]);
        match phase.regime {
            Regime::Slip => {
                // s κ w' = κ dv, with w' = −2s u F = s dv.
                let pull = self.equations.stretching(phase.side, array(y));
                let pull_rate = self.contact.kappa() * dv;
                let leave = if a > 0.0 {
                    2.0 * (v * pull + u * pull_rate) - force.second
                } else {
                    pull_rate - 1.5 * (v * v + u * dv)
                };
                [end, leave, 0.0]
            }
            Regime::Stick => {
                let shared = if a > 0.0 { 1.0 } else { u };
                let Equations { spring_force, spring_rate, scale, .. } = self.equations;
                let stretch = phase.side.sign() * spring_force * spring_rate * y[W];
                let (force, pull) =
                    if a > 0.0 { (force.first, u * stretch) } else { (3.0 * u * v, stretch) };
                let gap = if phase.progress == PhaseProgress::Settled {
                    force - pull
                } else {
                    scale * y[RATE] / shared
                };
                [end, gap, force + pull]
            }
        }
    }

    fn longest_first_step(&self, phase: Phase, s: f64, y: &State<STATE>) -> f64 {
        let end = if self.is_damped() { self.equations.push::<true>(y[U], y[V]) } else { y[U] };
        longest_first_step(end, self.guard_rates(phase, s, y)[END])
    }

    #[inline(always)]
    fn settle(&self, phase: Phase, y: &State<STATE>) -> Phase {
        if phase.regime == Regime::Slip || phase.progress == PhaseProgress::Settled {
            return phase;
        }
        if self.equations.is_open(array(y)) {
            Phase { progress: PhaseProgress::Settled, ..phase }
        } else {
            phase
        }
    }

    fn transition(
        &self,
        phase: Phase,
        guard: usize,
        _s: f64,
        y: &State<STATE>,
    ) -> (Phase, State<STATE>) {
        let next = self.next(phase, guard, y);
        let y = if self.is_damped() {
            self.equations.enter::<true>(next, array(y))
        } else {
            self.equations.enter::<false>(next, array(y))
        };
        (next, y.into())
    }
}
