//! The collision in three parameters instead of two: κ, g_t/g_n and μ/α.
//!
//! The scaled equations (23) and (24) of Schwager, Becker and Pöschel, Eur. Phys. J. E 27, 107
//! (2008), in the coordinates of [`regularized`], written and integrated without what other modules
//! know of κ and ψ.
//!
//! ```
//! use stickslip_model::{Contact, exact};
//! use stickslip_studies::three_parameters::ThreeParameters;
//!
//! let collision = exact::collide(Contact::new(18.0, 0.5, 0.0)?)?;
//! for friction in [0.5, 1.4] {
//!     let (eps_t, _) = ThreeParameters { reset: true, kappa: 18.0, friction }.eps_t(0.5)?;
//!     assert!((eps_t - collision.eps_t()).abs() < 1e-9);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use stickslip_model::regularized::{OTHER_SIDE, Phase, PhaseProgress};
use stickslip_model::{CollisionError, Regime, Side, regularized};
use stickslip_solver::{
    Direction, Dop853, Guard, HybridSystem, Options, Outcome, Start, State, run,
};

/// The number of components: u, v, y, w in the coordinates of [`regularized`].
const STATE: usize = 4;

/// The undamped contact in the scaled units of (23, 24), with friction f = μ/α kept: |F_t| ≤ f
/// x^{3/2}.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThreeParameters {
    /// Whether the spring is reset to its limit while sliding; if not, it is the spring of
    /// [`unreset`](crate::unreset).
    pub reset: bool,
    /// The stiffness κ.
    pub kappa: f64,
    /// The friction f = μ/α.
    pub friction: f64,
}

impl ThreeParameters {
    /// ε_t at ψ = (g_t/g_n)/f, and how the run ended: at the guard of the end of contact, unless it
    /// was given up.
    ///
    /// # Errors
    /// The integration fails.
    pub fn eps_t(&self, psi: f64) -> Result<(f64, Outcome), CollisionError> {
        let ratio = psi * self.friction;
        let size = ratio.min(1.0) * 1e-14;
        let options = Options { rtol: 1e-14, atol: size, max_step: 0.1, ..Options::default() };
        let (regime, side, progress) = (Regime::Slip, Side::Positive, PhaseProgress::Touched);
        let mode = Phase { regime, side, progress };
        let start = Start { mode, s: 0.0, state: State::from([0.0, 1.0, 0.0, ratio]) };
        let end = run(Dop853, self, start, f64::INFINITY, &options, &mut ())?;
        Ok((end.state[3] / ratio, end.outcome))
    }
}

impl HybridSystem<STATE, { regularized::GUARDS }> for ThreeParameters {
    type Mode = Phase;

    fn field(&self, phase: Phase, _s: f64, state: &State<STATE>) -> State<STATE> {
        let [u, v, y, w] = *state.as_ref();
        let follows = phase.regime == Regime::Stick || !self.reset;
        let pull = match phase.regime {
            Regime::Slip => phase.side.sign() * self.friction * u * u * u,
            Regime::Stick => self.kappa * y,
        };
        let stretch = if follows { 2.0 * u * w } else { 0.0 };
        State::from([v, -2.0 * u.powi(4), stretch, -2.0 * u * pull])
    }

    fn guards(&self, phase: Phase) -> [Guard; 3] {
        let end = Guard::new(Direction::Below).terminal();
        let leave = Guard::new(Direction::Below);
        let reset = self.reset;
        match (phase.regime, phase.progress) {
            (Regime::Slip, PhaseProgress::Touched) if reset => {
                [end.from_zero(1), leave, Guard::OFF]
            }
            (Regime::Slip, PhaseProgress::Touched) => {
                [end.from_zero(1), leave.from_zero(2), Guard::OFF]
            }
            (Regime::Slip, _) if reset => [end, leave, Guard::OFF],
            (Regime::Slip, _) => [end, leave.from_zero(1), Guard::OFF],
            (Regime::Stick, _) => [end, leave.from_zero(if reset { 2 } else { 1 }), leave],
        }
    }

    fn guard_values(&self, phase: Phase, _s: f64, state: &State<STATE>) -> [f64; 3] {
        let [u, v, y, w] = *state.as_ref();
        let (sign, limit) = (phase.side.sign(), self.friction * u * u * u);
        let pull = sign * self.kappa * y;
        match (phase.regime, self.reset) {
            (Regime::Slip, true) => [u, sign * self.kappa * w - 1.5 * self.friction * u * v, 1.0],
            (Regime::Slip, false) => [u, pull - limit, 1.0],
            (Regime::Stick, _) => [u, limit - pull, limit + pull],
        }
    }

    fn transition(
        &self,
        phase: Phase,
        guard: usize,
        _s: f64,
        state: &State<STATE>,
    ) -> (Phase, State<STATE>) {
        let next = phase.after(guard == OTHER_SIDE);
        let mut state = *state;
        if next.regime == Regime::Stick && self.reset {
            state[2] = next.side.sign() * self.friction * state[0].powi(3) / self.kappa;
        }
        (next, state)
    }
}
