//! The parameters for which collisions are computed, and what is said of others.

use crate::contact::Contact;

/// A contact is beyond what an engine computes.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{quantity} = {value:?} is out of the range of {engine}; expected {least:e} to {most:e}")]
pub struct OutOfDomain {
    /// The engine.
    pub engine: &'static str,
    /// What is out of its range.
    pub quantity: &'static str,
    /// Its value.
    pub value: f64,
    /// The least value that is accepted.
    pub least: f64,
    /// The largest.
    pub most: f64,
}

/// Largest scaled stiffness κ that [`collide`](crate::exact::collide) accepts.
///
/// The phase of the spring reaches √κ t_c, of which rounding takes 1e-16: at this stiffness
/// 4e-8 of a radian.
pub const MOST_STIFFNESS: f64 = 1e16;

/// The ranges of one engine.
struct Domain {
    engine: &'static str,
    kappa: (f64, f64),
    psi: (f64, f64),
    /// κψ, of which the spring's force at the first switch and at the end is made.
    pull: (f64, f64),
    damping: (f64, f64),
}

/// The exact solution: beyond, energies and the moments of switches near both ends of contact leave
/// the range of doubles.
const EXACT: Domain = Domain {
    engine: "the exact solution",
    kappa: (1e-100, MOST_STIFFNESS),
    psi: (1e-100, 1e100),
    pull: (1e-200, 1e116),
    damping: (0.0, 0.0),
};

/// The integrators without damping: a slip that has turned round sticks once more at u = (2/3)κ|w|
/// before it ends at u = 0, which is told apart only down to |w| ≈ 1e-12 ψ^{1/3}.
const UNDAMPED: Domain = Domain {
    engine: "the integrator",
    kappa: (1e-20, 1e10),
    psi: (1e-13, 1e30),
    pull: (1e-33, 1e40),
    damping: (0.0, 0.0),
};

/// The integrators with damping: the first stick phase is (a/κψ)² long, and the force at the end
/// rounds to 1e-16. A stronger damping leaves a force of −x/a² at the end, which Dormand–Prince
/// 5(4) does not tell from none, so that the contact goes on.
const DAMPED: Domain = Domain {
    engine: "the integrator",
    kappa: (1e-20, 1e10),
    psi: (1e-20, 1e12),
    pull: (1e-40, 1e22),
    damping: (1e-12, 1e4),
};

/// Holds that the integrators compute `contact`.
pub(crate) fn integrated(contact: &Contact) -> Result<(), OutOfDomain> {
    if contact.damping() > 0.0 { DAMPED.check(contact) } else { UNDAMPED.check(contact) }
}

/// Holds that the exact solution computes `contact`, which is without damping.
pub(crate) fn exact(contact: &Contact) -> Result<(), OutOfDomain> {
    EXACT.check(contact)
}

impl Domain {
    fn check(&self, contact: &Contact) -> Result<(), OutOfDomain> {
        let (kappa, psi) = (contact.kappa(), contact.psi());
        [
            ("kappa", kappa, self.kappa),
            ("psi", psi, self.psi),
            ("kappa·psi", kappa * psi, self.pull),
            ("damping", contact.damping(), self.damping),
        ]
        .into_iter()
        .find(|(_, value, (least, most))| !(least..=most).contains(&value))
        .map_or(Ok(()), |(quantity, value, (least, most))| {
            Err(OutOfDomain { engine: self.engine, quantity, value, least, most })
        })
    }
}
