//! How a contact starts.

use super::{Equations, powers};
use crate::general::{
    Beginning, ContactMode, ModeProgress, SPRING, STATE, Stage, T as TIME, U, V, W,
};
use crate::phase::{Regime, Side};

impl Equations {
    /// Coulomb's limit at the start of contact, if it is 1 at rest.
    pub fn first_limit(&self, psi: f64) -> f64 {
        let w = psi / self.velocity_unit;
        self.decay.as_ref().map_or(1.0, |decay| decay.share(Side::Positive, w))
    }

    /// The state at the start of contact.
    pub fn start(&self, psi: f64) -> [f64; STATE] {
        let mut y = [0.0; STATE];
        y[V] = 1.0 / self.by_v;
        y[W] = psi / self.velocity_unit;
        y
    }

    /// How the contact starts.
    pub fn beginning(&self, psi: f64) -> Beginning {
        let e = self.exponents;
        match self.beginning_margins(psi) {
            [Some(room), _] if room > 0.0 => Beginning::Stick,
            [Some(_), _] if e.of(Stage::Main).rho > e.d => Beginning::Overturned,
            [Some(_), Some(excess)] if excess < 0.0 => Beginning::Reset,
            [None, _] if self.first_orders().0 < self.first_orders().1 => Beginning::Stick,
            _ => Beginning::Slip,
        }
    }

    /// The orders of the zeros from which the limit and the tangential force start, divided by u^m.
    pub fn first_orders(&self) -> (u8, u8) {
        let e = self.exponents;
        let of = e.of(Stage::Main);
        // What is not there counts as if it began later.
        let spring = if e.remembers { of.rho - of.shared + of.beta + 1 } else { u8::MAX };
        let dashpot = e.d - of.shared;
        (dashpot, if self.tested > 0.0 { dashpot.min(spring) } else { spring })
    }

    /// Whether limit and force start from zeros of third order and may nearly agree. A dense output
    /// does not tell their difference from zero.
    pub fn starts_flat(&self) -> bool {
        self.first_orders() == (3, 3)
    }

    /// The length s after which a contact is integrated that starts from zeros of third order.
    pub fn first_moment(&self) -> f64 {
        1e-3 * self.kappa.max(1.0).powf(-0.2)
    }

    /// The state of a contact that starts in stick from zeros of third order, up to the
    /// [`Self::first_moment`]. What is neglected is below rounding.
    pub fn early(&self, psi: f64, s: f64) -> [f64; STATE] {
        let fifth = s.powi(5);
        let mut y = self.start(psi);
        y[U] = s * (1.0 - fifth / 15.0);
        y[V] = 1.0 - 0.4 * fifth;
        y[W] *= 1.0 - 4.0 / 15.0 * self.kappa * fifth;
        y[SPRING] = self.spring_rate * y[W] * s.powi(3) / 3.0;
        y[TIME] = s * s;
        y
    }

    /// See [`super::GeneralContact::beginning_margins`].
    pub fn beginning_margins(&self, psi: f64) -> [Option<f64>; 2] {
        let e = self.exponents;
        let (limit, force) = self.first_orders();
        if limit != force {
            return [None; 2];
        }
        if e.damped {
            let ratio = self.tangential_damping * psi / self.first_limit(psi);
            let mode = ContactMode {
                heading: Side::Positive,
                regime: Regime::Slip,
                side: Side::Positive,
                stage: Stage::Main,
                progress: ModeProgress::Touched,
            };
            let may_fall_behind = e.remembers && e.of(Stage::Main).rho == e.d;
            let excess = || self.stretching(mode, &powers(0.0), &self.start(psi));
            return [Some(1.0 - ratio), may_fall_behind.then(excess)];
        }
        let spring = f64::from(e.n) * self.kappa * psi / f64::from(e.of(Stage::Main).beta + 1);
        [Some(1.0 - spring / self.first_limit(psi)), None]
    }
}
