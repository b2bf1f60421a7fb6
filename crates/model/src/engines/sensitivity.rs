//! Derivatives of a collision with respect to its parameters.
//!
//! The equations of the law are computed with dual numbers, which carry a derivative. The solver
//! integrates the derivatives together with the state and takes them through every switch
//! ([`stickslip_solver::sensitivity`]).
//!
//! Without damping a contact ends where u = 0. With damping it ends where F = u (u² + a v) = 0,
//! which is earlier by a in time, to first order. This is added to the derivative of the contact
//! time at a = 0, which is the derivative from above.

use stickslip_contact::phase::{END, Phase};
use stickslip_contact::regularized::Regularized;
use stickslip_contact::regularized::components::{STATE, T, U, V, W};
use stickslip_contact::regularized::derivatives::PARAMETERS;
use stickslip_contact::regularized::equations::ContactParameter;
use stickslip_contact::{Contact, Regime};
use stickslip_solver::method::Columns;
use stickslip_solver::sensitivity::{SwitchSensitivity, Variation, sensitivities_with};
use stickslip_solver::{Outcome, State};

use super::error::CollisionError;
use super::integrator::Collider;

/// A value and its derivatives.
const VALUES: usize = 1 + PARAMETERS;

/// A result of a collision with its derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Derived {
    /// The result.
    pub value: f64,
    /// Derivative with respect to the scaled stiffness κ.
    pub kappa: f64,
    /// Derivative with respect to the impact ratio ψ.
    pub psi: f64,
    /// Derivative with respect to the scaled damping a; at a = 0 the derivative from above.
    pub damping: f64,
}

/// The results of a collision with their derivatives.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Sensitivity {
    /// Coefficient of normal restitution.
    pub eps_n: Derived,
    /// Coefficient of tangential restitution ε_t.
    pub eps_t: Derived,
    /// Reduced tangential velocity w at the end.
    pub final_velocity: Derived,
    /// Scaled duration of the contact.
    pub contact_time: Derived,
    /// Scaled times of the switches since the start of contact, in order.
    pub switch_times: Vec<Derived>,
}

impl Collider {
    /// Integrates one collision with the derivatives of its results with respect to κ, ψ and a.
    ///
    /// The derivatives hold for unchanged switches. Relative to their largest value during the
    /// collision they are about as accurate as the results. At a relative distance d from a graze,
    /// the derivatives of the switch beside it grow as 1/√d, and their relative error grows by the
    /// same factor.
    ///
    /// ```
    /// use stickslip_model::{Collider, Contact};
    ///
    /// let collider = Collider::default();
    /// let sensitivity = collider.sensitivity(Contact::new(63.0, 0.5, 0.0)?)?;
    ///
    /// let h = 1e-5;
    /// let [more, less] = [63.0 + h, 63.0 - h]
    ///     .map(|kappa| collider.collide(Contact::new(kappa, 0.5, 0.0).unwrap()).unwrap());
    /// let difference = (more.eps_t() - less.eps_t()) / (2.0 * h);
    /// assert!((sensitivity.eps_t.kappa - difference).abs() < 1e-7);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`Self::collide`]. A switch that is a graze has no derivatives: the error is
    /// [`RunError::State`](stickslip_solver::RunError::State).
    pub fn sensitivity(&self, contact: Contact) -> Result<Sensitivity, CollisionError> {
        contact.require_paper("the sensitivity")?;
        let system = Regularized::new(contact);
        let mut start = Columns::<STATE, VALUES>::zeros();
        start.set_column(0, &system.start());
        for (j, by) in ContactParameter::ALL.into_iter().enumerate() {
            let by = State::from(system.equations.start_by(contact.psi(), by));
            start.set_column(1 + j, &by);
        }
        let (from, options) = ((Phase::first(&contact), 0.0), self.options_for(&contact)?);
        let found = sensitivities_with(self.pair(), &system, from, start, f64::INFINITY, &options)?;
        let phases = found.switches.iter().chain([&found.end]);
        let mut time = [0.0; VALUES];
        let times: Vec<_> = phases
            .map(|end| {
                time = add(time, component(end, T));
                time
            })
            .collect();
        if found.outcome != (Outcome::EndedByGuard { guard: END }) {
            return Err(CollisionError::Unfinished { outcome: found.outcome, time: time[0] });
        }
        let derived = |values: [f64; VALUES]| {
            let [value, ln_kappa, ln_psi, damping] = values;
            Derived {
                value,
                kappa: ln_kappa / contact.kappa(),
                psi: ln_psi / contact.psi(),
                damping,
            }
        };
        let end = &found.end;
        let final_velocity =
            derived(component(end, W).map(|part| system.equations.velocity_unit * part));
        let earlier = if contact.damping() > 0.0 { 0.0 } else { 1.0 };
        let contact_time = derived(time);
        // A contact that sticks to its end, to rounding, has its last switch at the end.
        let sticks = end.mode.regime == Regime::Stick;
        let switches = found.switches.len() + usize::from(sticks);
        Ok(Sensitivity {
            eps_n: derived(compression_rate(&system, end).map(|part| -part)),
            eps_t: final_velocity.over_psi(contact.psi()),
            final_velocity,
            contact_time: Derived { damping: contact_time.damping - earlier, ..contact_time },
            switch_times: times[..switches].iter().copied().map(derived).collect(),
        })
    }
}

impl Derived {
    /// The quotient by the parameter ψ.
    fn over_psi(self, psi: f64) -> Self {
        let Self { value, kappa, psi: slope, damping } = self;
        let quotient = value / psi;
        Self {
            value: quotient,
            kappa: kappa / psi,
            psi: (slope - quotient) / psi,
            damping: damping / psi,
        }
    }
}

/// A component of the state at the end of a phase, and its derivatives.
fn component(end: &SwitchSensitivity<Phase, STATE, VALUES>, index: usize) -> [f64; VALUES] {
    std::array::from_fn(|j| end.state[(index, j)])
}

/// The rate of the compression at the end of a phase, and its derivatives.
fn compression_rate(
    system: &Regularized,
    end: &SwitchSensitivity<Phase, STATE, VALUES>,
) -> [f64; VALUES] {
    let state = end.state.column(0).into_owned();
    let mut rate = [system.compression_rate(&state); VALUES];
    for (index, part) in rate[1..].iter_mut().enumerate() {
        let y = end.state.column(1 + index).into_owned();
        let change = Variation { s: 0.0, parameter: Some(index), y };
        let (equations, y) = system.along(&state, &change);
        *part = equations.compression_rate::<true>(y[U], y[V]).eps;
    }
    rate
}

fn add<const N: usize>(a: [f64; N], b: [f64; N]) -> [f64; N] {
    std::array::from_fn(|i| a[i] + b[i])
}
