//! Tangential restitution without a spring: laws to compare the collision with.
//!
//! Source: Schwager, Becker and Pöschel, Eur. Phys. J. E 27, 107 (2008), equations (15), (16) and
//! the end of section 4.

use stickslip_solver::{
    Direction, Dop853, Guard, Number, Options, Outcome, ReadableSystem, Start, State, run,
};

use crate::engines::error::CollisionError;

/// ε_t of pure Coulomb sliding, max(0, 1 − (1 + ε_n)/ψ), which is max(0, 1 − μ(1 + ε_n)/α ·
/// g_n/g_t).
///
/// It holds for every law of the normal force if surfaces that have come to rest stay at rest.
/// [`slide`] integrates the same contact.
///
/// ```
/// use stickslip_model::limits::coulomb;
///
/// assert_eq!(coulomb::restitution(4.0, 1.0), 0.5);
/// assert_eq!(coulomb::restitution(1.0, 1.0), 0.0);
/// ```
pub fn restitution(psi: f64, eps_n: f64) -> f64 {
    pragmatic(psi, eps_n, 0.0)
}

/// ε_t of the pragmatic model max(`floor`, 1 − (1 + ε_n)/ψ): a constant replaces everything that is
/// not pure sliding.
///
/// ```
/// use stickslip_model::limits::coulomb;
///
/// assert_eq!(coulomb::pragmatic(1.0, 1.0, -0.2), -0.2);
/// ```
pub fn pragmatic(psi: f64, eps_n: f64, floor: f64) -> f64 {
    let sliding = 1.0 - (1.0 + eps_n) / psi;
    if sliding < floor { floor } else { sliding }
}

/// A law of the normal force, F = x^{n/2}(x + a ẋ) in scaled units: n = 0 is the linear spring with
/// dashpot, n = 1 viscoelastic spheres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalLaw {
    /// The number n of powers of √x.
    pub half_powers: u8,
    /// The scaled damping a, 0 or above.
    pub damping: f64,
}

/// The result of a contact with pure Coulomb friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sliding {
    /// Coefficient of normal restitution ε_n.
    pub eps_n: f64,
    /// Coefficient of tangential restitution ε_t.
    pub eps_t: f64,
}

/// Integrates a contact with pure Coulomb friction: ẇ = −F until w = 0, and w = 0 from then on.
///
/// The errors of both coefficients are below 1e-12.
///
/// ```
/// use stickslip_model::limits::coulomb::{self, NormalLaw};
///
/// let dashpot = NormalLaw { half_powers: 0, damping: 0.4 };
/// let sliding = coulomb::slide(dashpot, 3.0)?;
/// assert!(sliding.eps_n < 0.8);
/// assert!((sliding.eps_t - coulomb::restitution(3.0, sliding.eps_n)).abs() < 1e-12);
/// # Ok::<(), stickslip_model::CollisionError>(())
/// ```
///
/// # Errors
/// [`CollisionError`]: the contact does not end, as with much damping, or numbers are out of range.
pub fn slide(law: NormalLaw, psi: f64) -> Result<Sliding, CollisionError> {
    let options = Options { rtol: 1e-14, atol: 1e-14, max_steps: 100_000, ..Options::default() };
    let start = Start { mode: Friction::Sliding, s: 0.0, state: State::from([0.0, 1.0, psi]) };
    let end = run(Dop853, &SlidingContact(law), start, f64::INFINITY, &options, &mut ())?;
    if !matches!(end.outcome, Outcome::EndedByGuard { .. }) {
        return Err(CollisionError::Unfinished { outcome: end.outcome, time: end.s });
    }
    let eps_t = match end.mode {
        Friction::Sliding => end.state[2] / psi,
        Friction::Resting => 0.0,
    };
    Ok(Sliding { eps_n: -end.state[1], eps_t })
}

/// The two regimes of pure Coulomb friction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Friction {
    Sliding,
    Resting,
}

/// A contact with pure Coulomb friction.
struct SlidingContact(NormalLaw);

/// The state is u = √x, v = ẋ and w, with dt = 2u ds: the equations are polynomials.
impl ReadableSystem<3, 2> for SlidingContact {
    type Mode = Friction;

    fn field<T: Number>(&self, mode: Friction, _s: T, y: &[T; 3]) -> [T; 3] {
        let (u, v) = (y[0], y[1]);
        let force = u.powi(i32::from(self.0.half_powers)) * (u * u + v * self.0.damping);
        let pull = match mode {
            Friction::Sliding => force,
            Friction::Resting => T::from(0.0),
        };
        [v, u * -2.0 * force, u * -2.0 * pull]
    }

    fn guards(&self, mode: Friction) -> [Guard; 2] {
        let end = Guard::new(Direction::Below).terminal();
        match mode {
            // Without damping the contact begins where it ends.
            Friction::Sliding if self.0.damping == 0.0 => {
                [end.from_zero(1), Guard::new(Direction::Below)]
            }
            Friction::Sliding => [end, Guard::new(Direction::Below)],
            Friction::Resting => [end, Guard::OFF],
        }
    }

    fn guard_values<T: Number>(&self, _mode: Friction, _s: T, y: &[T; 3]) -> [T; 2] {
        let (u, v) = (y[0], y[1]);
        [if self.0.damping > 0.0 { u * u + v * self.0.damping } else { u }, y[2]]
    }

    fn transition(
        &self,
        _mode: Friction,
        _guard: usize,
        _s: f64,
        y: &State<3>,
    ) -> (Friction, State<3>) {
        (Friction::Resting, *y)
    }
}
