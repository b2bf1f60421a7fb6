//! The parameters for which engines compute collisions, and the error for all others.

use crate::contact::Contact;

/// A contact is out of the range of an engine.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{quantity} = {value:?} is out of the range of {engine}; expected {least:e} to {most:e}")]
pub struct OutOfDomain {
    /// The engine in words.
    pub engine: &'static str,
    /// The quantity that is out of its range.
    pub quantity: &'static str,
    /// The value of the quantity.
    pub value: f64,
    /// The least value of the range.
    pub least: f64,
    /// The largest value of the range.
    pub most: f64,
}

/// Largest scaled stiffness κ that [`collide`](crate::exact::collide) accepts.
///
/// The phase of the spring reaches √κ t_c, which rounding changes by a part of 1e-16: at this
/// stiffness by 4e-8 of a radian.
pub const MOST_STIFFNESS: f64 = 1e16;

/// The ranges of one engine.
struct Domain {
    engine: &'static str,
    kappa: (f64, f64),
    psi: (f64, f64),
    /// Range of κψ, which decides the spring's force at the first switch and at the end.
    pull: (f64, f64),
    damping: (f64, f64),
}

/// The range of the exact solution. Beyond it, energies and the moments of switches near both ends
/// of contact leave the range of doubles.
const EXACT: Domain = Domain {
    engine: "the exact solution",
    kappa: (1e-100, MOST_STIFFNESS),
    psi: (1e-100, 1e100),
    pull: (1e-200, 1e116),
    damping: (0.0, 0.0),
};

/// The range of the exact solution with damping: where κψ is far above the square root of the
/// damping, the first stick phase is (a/κψ)² long.
const EXACT_DAMPED: Domain = Domain {
    engine: "the exact solution",
    kappa: (1e-60, MOST_STIFFNESS),
    psi: (1e-60, 1e60),
    pull: (1e-100, 1e70),
    damping: (1e-60, 1e4),
};

/// The range of the exact solution of linear contacts.
const LINEAR: Domain = Domain {
    engine: "the exact solution of linear contacts",
    kappa: (1e-60, 1e10),
    psi: (1e-60, 1e60),
    pull: (1e-100, 1e70),
    damping: (1e-60, 1e4),
};

/// The largest damping for it where the normal force attracts. Near 2, where contacts become
/// endless, the coefficient of normal restitution leaves the range of doubles.
const ATTRACTING: f64 = 1.9999;

/// The range of the integrators without damping.
///
/// Below this ψ, rounding of v costs too many digits of w.
const UNDAMPED: Domain = Domain {
    engine: "the integrator",
    kappa: (1e-20, 1e10),
    psi: (1e-13, 1e30),
    pull: (1e-33, 1e40),
    damping: (0.0, 0.0),
};

/// The range of the integrators with damping.
///
/// The first stick phase is (a/κψ)² long: with a weaker damping it may be lost or invented, within
/// the tolerance of a step. A stronger damping leaves a force of −x/a² at the end, which
/// Dormand–Prince 5(4) does not distinguish from 0: the contact would not end.
const DAMPED: Domain = Domain {
    engine: "the integrator",
    kappa: (1e-20, 1e10),
    psi: (1e-13, 1e12),
    pull: (1e-33, 1e22),
    damping: (1e-8, 1e4),
};

/// Checks that `contact` is in the range of the integrators.
pub(crate) fn integrated(contact: &Contact) -> Result<(), OutOfDomain> {
    if contact.damping() > 0.0 { DAMPED.check(contact) } else { UNDAMPED.check(contact) }
}

/// Checks that `contact` is in the range of the exact solution.
pub(crate) fn exact(contact: &Contact) -> Result<(), OutOfDomain> {
    if contact.damping() > 0.0 { EXACT_DAMPED.check(contact) } else { EXACT.check(contact) }
}

/// Checks that `contact`, whose normal force may attract, is in the range of the exact solution of
/// linear contacts.
pub(crate) fn linear(contact: &Contact, attracts: bool) -> Result<(), OutOfDomain> {
    let damping = match (contact.damping() > 0.0, attracts) {
        (false, _) => (0.0, 0.0),
        (true, false) => LINEAR.damping,
        (true, true) => (LINEAR.damping.0, ATTRACTING),
    };
    Domain { damping, ..LINEAR }.check(contact)
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
