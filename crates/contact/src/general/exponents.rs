//! The powers of u in a law.

use super::Stage;
use super::hysteresis::Hysteresis;
use crate::contact::Contact;
use crate::law::{Damping, HistoryOf, Law, Normal, Tangential};

/// The powers of u in a law, where x = uⁿ and dt = n u^{n−1} ds.
///
/// With them the law reads
///
/// ```text
/// u' = v    v' = −n u^{n−1} F      F = u^p + a u^d v = u^d (u^{p−d} + a v)
/// h' = nω u^β w                    Q = ω u^ρ h + b a u^d w
/// ```
///
/// where h is the history, scaled by a power of x: what is rescaled while the overlap falls is
/// constant then over √x. Without damping d = p and F = u^p. A hysteretic force is the same with
/// x − x₀ in place of x while the overlap falls, and with a factor; where it yields, F/u^d is no
/// polynomial.
#[expect(clippy::struct_excessive_bools, reason = "each leaves out a term of the equations")]
#[derive(Clone, Copy, Debug)]
pub struct Exponents {
    /// n.
    pub n: u8,
    /// n − 1.
    pub last: u8,
    /// p.
    pub p: u8,
    /// d.
    pub d: u8,
    /// p − d.
    pub bend: u8,
    /// The power of u in the stiffness.
    pub r: u8,
    /// Whether there is viscous damping.
    pub damped: bool,
    /// Whether there is damping with b ≠ 1, so that the dashpots leave a term in the guard of slip,
    /// or a friction that decays, which leaves one of the same power.
    pub uneven: bool,
    /// Whether the normal force is hysteretic.
    pub hysteretic: bool,
    /// Whether the history is rescaled while the overlap falls.
    pub rescaled: bool,
    /// Whether there is a history.
    pub remembers: bool,
    loading: OfStage,
    unloading: OfStage,
}

/// The powers that depend on whether the overlap grows or falls.
#[derive(Clone, Copy, Debug)]
pub struct OfStage {
    /// ρ.
    pub rho: u8,
    /// β.
    pub beta: u8,
    /// m, the power of u that the limit and the tangential force share.
    pub shared: u8,
    /// One more than the power of u that the guard of slip is divided by.
    pub leading: u8,
}

impl Exponents {
    pub fn new(contact: &Contact) -> Self {
        let law = contact.law();
        let damped = contact.damping() > 0.0 && law.damping.is_viscous();
        let n = order(law, damped);
        let half = n / 2;
        let p = match law.normal {
            Normal::Linear => n,
            _ => 3 * half,
        };
        let d = match law.damping {
            _ if !damped => p,
            Damping::Viscoelastic => half,
            Damping::Tsuji => half / 2,
            _ => 0,
        };
        let r = if law.tangential == Tangential::Mindlin { half } else { 0 };
        let last = n - 1;
        let uneven = damped && law.tested_damping(contact.tangential_damping()) != 1.0
            || !law.friction.is_constant();
        let stage = |down: u8| {
            let (rho, beta) = match law.history {
                HistoryOf::Displacement => (r + down, last - down),
                HistoryOf::Force => (down, last + r - down),
                HistoryOf::None => (d, last),
            };
            // The powers of the terms of the guard of slip, plus 1.
            let terms =
                [(true, last + r + 1), (rho != d, d), (p != d, p), (uneven, 2 * d + last + 1)];
            let leading = terms.into_iter().filter(|(there, _)| *there).map(|(_, power)| power);
            OfStage { rho, beta, shared: d.min(rho), leading: leading.min().unwrap_or(0) }
        };
        let rescaled = law.rescaled && law.remembers();
        let unloading = stage(if rescaled { half } else { 0 });
        let (loading, bend) = (stage(0), p - d);
        let remembers = law.remembers();
        let hysteretic = Hysteresis::new(law, contact.damping()).is_some();
        Self {
            n,
            last,
            p,
            d,
            bend,
            r,
            damped,
            uneven,
            hysteretic,
            rescaled,
            remembers,
            loading,
            unloading,
        }
    }

    /// The powers of a stage.
    #[inline(always)]
    pub fn of(&self, stage: Stage) -> OfStage {
        if matches!(stage, Stage::Main | Stage::Yielding) { self.loading } else { self.unloading }
    }
}

/// The least n that makes a law polynomial in u.
fn order(law: Law, damped: bool) -> u8 {
    let roots = law.normal == Normal::Hertz
        || law.remembers() && (law.tangential == Tangential::Mindlin || law.rescaled)
        || (damped && law.damping == Damping::Viscoelastic);
    match (damped && law.damping == Damping::Tsuji, roots) {
        (true, _) => 4,
        (false, true) => 2,
        (false, false) => 1,
    }
}
