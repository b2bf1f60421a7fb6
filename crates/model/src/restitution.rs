//! The damping with which a contact law has a coefficient of normal restitution.
//!
//! The normal motion depends on nothing else: neither on the tangential spring nor on friction.
//! ε_n falls with the scaled damping a from 1 on. Where force and damping are both linear, or the
//! force is Hertz' and the damping Tsuji's, a does not depend on the velocity; for all other laws
//! ε_n belongs to one normal velocity.

use std::f64::consts::PI;

use stickslip_contact::{Contact, Damping, End, InvalidValue, Law, Normal};

use crate::engines::Engine;
use crate::engines::error::CollisionError;

/// Why no damping is found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RestitutionError {
    /// The coefficient or the damping is out of its range.
    #[error(transparent)]
    Value(#[from] InvalidValue),
    /// No damping makes the contact so inelastic.
    #[error("no damping of this law has e_n = {eps_n:?}; expected {least:?} to 1")]
    Unreachable {
        /// The coefficient.
        eps_n: f64,
        /// The least that was reached.
        least: f64,
    },
    /// A contact cannot be computed.
    #[error(transparent)]
    Collision(#[from] Box<CollisionError>),
}

/// Whether ε_n of the law depends on the velocity: the same damping constant is another scaled
/// damping a.
#[must_use]
pub fn depends_on_velocity(law: Law) -> bool {
    law.damping != Damping::None && critical_damping(law).is_none()
}

/// The scaled damping a of a contact whose damping ratio ζ is 1: 2 where force and damping are
/// linear, and √5 where the force is Hertz' and the damping Tsuji's. `None` for other laws.
///
/// With this ζ = a/a(1), as particle codes define it, a contact that lasts until x = 0 has
/// ζ = −ln ε_n/√(π² + ln² ε_n), in both cases.
///
/// Source: Antypov and Elliott, EPL 94, 50004 (2011).
#[must_use]
pub fn critical_damping(law: Law) -> Option<f64> {
    match (law.normal, law.damping) {
        (Normal::Linear, Damping::Linear) => Some(2.0),
        (Normal::Hertz, Damping::Tsuji) => Some(5.0_f64.sqrt()),
        _ => None,
    }
}

/// Whether a contact lasts until x = 0 with a force that may attract.
fn attracts(law: Law) -> bool {
    law.end == End::Overlap && !law.limit_damping
}

/// ε_n of a law with the scaled damping a: in closed form for linear forces and where a contact
/// with Tsuji's damping of Hertz' force lasts until x = 0, otherwise by [`Engine::Auto`].
///
/// ```
/// use stickslip_model::{presets, restitution};
///
/// // The damping ratio 0.1 of a linear force.
/// let law = presets::find("gran/hooke/history").ok_or("no such law")?.law;
/// assert!((restitution::eps_n(law, 0.2)? - 0.729247614287).abs() < 1e-11);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`RestitutionError`]: the damping is out of its range, or the contact cannot be computed.
pub fn eps_n(law: Law, damping: f64) -> Result<f64, RestitutionError> {
    // The normal motion does not depend on κ and ψ. At κψ = 1 and the like, spring and limit of
    // some laws begin alike, which cannot be integrated.
    let contact = Contact::new(1.1, 0.3, damping)?.with_law(law, 0.0)?;
    if let (Some(critical), true) = (critical_damping(law), attracts(law)) {
        let ratio = damping / critical;
        return Ok((-PI * ratio / (1.0 - ratio * ratio).sqrt()).exp());
    }
    if (law.normal, law.damping) == (Normal::Linear, Damping::Linear) {
        return Ok(until_zero_force(0.5 * damping));
    }
    let (collision, _) = Engine::Auto.collide(contact).map_err(Box::new)?;
    Ok(collision.eps_n)
}

/// ε_n of a linear force with the damping ratio ζ, if the contact ends at F = 0 or the force does
/// not attract.
///
/// Source: Schwager and Pöschel, Granular Matter 9, 465 (2007).
fn until_zero_force(ratio: f64) -> f64 {
    let root = (1.0 - ratio * ratio).abs().sqrt();
    // From there on both quotients are their limits at ζ = 1, to within rounding.
    let angle = if root < 1e-8 {
        2.0
    } else if ratio < 1.0 {
        (2.0 * ratio * root).atan2(2.0 * ratio * ratio - 1.0) / root
    } else {
        ((ratio + root) / (ratio - root)).ln() / root
    };
    (-ratio * angle).exp()
}

/// The scaled damping a with which the law has this ε_n, above 0 and at most 1: in closed form
/// where a contact with linear force and damping, or with Hertz' and Tsuji's, lasts until x = 0;
/// otherwise solved, with an ε_n within 1e-12.
///
/// ```
/// use stickslip_model::{presets, restitution};
///
/// for name in ["gran/hooke/history", "gran/hertz/history", "paper"] {
///     let law = presets::find(name).ok_or("no such law")?.law;
///     let damping = restitution::damping(law, 0.8)?;
///     assert!((restitution::eps_n(law, damping)? - 0.8).abs() < 1e-12);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`RestitutionError`]: ε_n is out of its range, or no damping of this law has it, or a contact
/// cannot be computed.
pub fn damping(law: Law, wanted: f64) -> Result<f64, RestitutionError> {
    /// The largest damping that is tried.
    const MOST: f64 = 128.0;
    let ok = wanted > 0.0 && wanted <= 1.0;
    InvalidValue::check("e_n", wanted, "a number above 0, at most 1", ok)?;
    if wanted == 1.0 {
        return Ok(0.0);
    }
    if law.damping == Damping::None {
        return Err(RestitutionError::Unreachable { eps_n: wanted, least: 1.0 });
    }
    if let (Some(critical), true) = (critical_damping(law), attracts(law)) {
        let log = -wanted.ln();
        return Ok(critical * log / PI.hypot(log));
    }
    let most = f64::min(MOST, (1.0 - 1e-9) * law.endless_from());
    // A contact with far too much damping takes long to compute.
    let (mut low, mut above) = (0.0, 1.0 - wanted);
    let mut high = f64::min(0.5, most);
    let mut below = loop {
        let least = eps_n(law, high)?;
        if least <= wanted {
            break least - wanted;
        }
        if high >= most {
            return Err(RestitutionError::Unreachable { eps_n: wanted, least });
        }
        (low, above) = (high, least - wanted);
        high = f64::min(2.0 * high, most);
    };
    // The rule of false position, where an end that stays counts half (the Illinois rule).
    for _ in 0..100 {
        let guess = low + (high - low) * (above / (above - below));
        if !(low < guess && guess < high) {
            break;
        }
        let excess = eps_n(law, guess)? - wanted;
        if excess.abs() <= f64::EPSILON {
            return Ok(guess);
        }
        if excess > 0.0 {
            (low, above, below) = (guess, excess, 0.5 * below);
        } else {
            (high, below, above) = (guess, excess, 0.5 * above);
        }
        if high - low <= 4.0 * f64::EPSILON * high {
            break;
        }
    }
    Ok(0.5 * (low + high))
}
