//! The parameters for which the integrators compute collisions.

use stickslip_contact::domain::{Domain, OutOfDomain};
use stickslip_contact::{Contact, Law};

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

/// The range of the pull-off force f. What is weaker acts for less than a step at the start of
/// contact. With what is stronger, ε_n is lost in the energy of the attraction, f^{5/3} in size.
const PULL_OFF: (f64, f64) = (1e-8, 1e2);
/// The strongest damping beside adhesion: what it damps away takes steps of its own.
const ADHESIVE_DAMPING: f64 = 1e2;

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
    let Law { friction, normal, pull_off, .. } = contact.law();
    if normal.is_adhesive() {
        let ranges = [
            ("pull_off", pull_off, PULL_OFF),
            ("damping", contact.damping(), (0.0, ADHESIVE_DAMPING)),
        ];
        for (quantity, value, (least, most)) in ranges {
            if !(least..=most).contains(&value) {
                return Err(OutOfDomain { engine: DAMPED.engine, quantity, value, least, most });
            }
        }
    }
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
