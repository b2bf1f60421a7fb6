//! The parameters for which the exact engines compute collisions.

use stickslip_contact::Contact;
use stickslip_contact::domain::{Domain, OutOfDomain};

/// Largest scaled stiffness κ that [`collide`](crate::exact::collide) accepts.
///
/// The phase of the spring reaches √κ t_c, which rounding changes by a part of 1e-16: at this
/// stiffness by 4e-8 of a radian.
pub const MOST_STIFFNESS: f64 = 1e16;

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
