//! The parameters for which the integrators compute collisions.

use stickslip_contact::Contact;
use stickslip_contact::domain::{Domain, OutOfDomain};

/// The range of the integrators without viscous damping; a hysteretic force has the damping
/// k₂/k₁ − 1.
///
/// Below this ψ, rounding of v costs too many digits of w.
const UNDAMPED: Domain = Domain {
    engine: "the integrator",
    kappa: (1e-20, 1e10),
    psi: (1e-13, 1e30),
    pull: (1e-33, 1e40),
    damping: (0.0, 1e4),
};

/// The range of the integrators with viscous damping.
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

/// The largest decay of friction. What is faster changes within a step of the velocity that
/// rounding leaves.
const MOST_DECAY: f64 = 1e9;
/// The least part of the static friction that is left at the velocity of the impact. With less a
/// contact is one without friction, but its limit is lost below the least numbers.
const LEAST_SHARE: f64 = 1e-200;

/// The part of it from which on no contact is lost in rounding.
const SURE_SHARE: f64 = 1e-8;

/// A contact whose first phase is lost in rounding, since friction has nearly vanished at impact.
pub(crate) fn lost(contact: &Contact) -> OutOfDomain {
    of_share(contact, SURE_SHARE)
}

fn of_share(contact: &Contact, least: f64) -> OutOfDomain {
    let value = contact.law().friction.share(contact.psi());
    let quantity = "friction at impact over the static one";
    OutOfDomain { engine: DAMPED.engine, quantity, value, least, most: 1.0 }
}

/// Checks that `contact` is in the range of the integrators.
pub(crate) fn integrated(contact: &Contact) -> Result<(), OutOfDomain> {
    let friction = contact.law().friction;
    if !friction.is_constant() {
        let (engine, value, most) = (DAMPED.engine, friction.decay, MOST_DECAY);
        if value > most {
            let quantity = "the decay of friction";
            return Err(OutOfDomain { engine, quantity, value, least: 0.0, most });
        }
        let share = of_share(contact, LEAST_SHARE);
        if share.value < share.least {
            return Err(share);
        }
    }
    let damped = contact.damping() > 0.0 && contact.law().damping.is_viscous();
    if damped { DAMPED.check(contact) } else { UNDAMPED.check(contact) }
}
