//! The exact engine: collisions without damping, from their closed-form solution.
//!
//! Without damping v² + (4/5) x^{5/2} = 1, so the normal motion is one universal trajectory. In
//! slip s·w − v is constant, in stick the spring swings harmonically in time. Only the moments at
//! which one turns into the other have to be solved for, and each is the one root of a function
//! in a bracket on which that function is known to be monotone or to cross once: no switch is
//! looked for by sampling, so none is missed and none invented. What decides tells how near the
//! collision came to other switches, too: its [`margins`].
//!
//! Source of the law: Schwager, Becker and Pöschel, Eur. Phys. J. E 27, 107 (2008).

mod account;
mod boundaries;
mod error;
mod flank;
mod limit;
mod margin;
mod onset;
mod refined_exit;
mod refined_onset;
mod release;
mod slide;
mod swing;
mod trajectory;

pub use super::domain::MOST_STIFFNESS;
use crate::contact::Contact;
use crate::laws::phase::{Regime, Side};
use crate::result::{Collision, Switch};
use account::Account;
pub use boundaries::{small_impact_boundary, top_boundary};
pub use error::ExactError;
use error::{too_many, undamped};
pub use margin::{Margins, margin, margins, moved};
use release::Release;
use slide::{Slide, SlipPhase};
use swing::Swing;
pub use trajectory::CONTACT_TIME;
use trajectory::{Moment, NormalMotion};

/// Most switches of a collision that [`collide`] lists, about 190 MB of them.
///
/// The count grows as √κ t_c/π; κ = 1e13 has 3.3 million.
pub const MOST_SWITCHES: usize = 4_000_000;

/// The collision of `contact`, which must be without damping, from the exact solution.
///
/// Accuracy, against 22-digit references for κ from 0.02 to 1e4 and ψ from 0.003 to 3: w within
/// 1e-15; switch times, and y and w at them, within 1e-14, and within 1e-11 down to a relative
/// distance 1e-10 from a graze; `time_left` relative to itself within twice the relative error
/// of w. The count is right down to a relative distance 1e-14 from a boundary at which it
/// changes; a touch within rounding is no switch. Numbers keep their accuracy as long as κψ, the
/// scale of √x at the first switch, is above about 1e-100.
///
/// Cost: 0.2 µs a switch, whatever the stiffness. The result is a pure function of `contact`.
///
/// ```
/// use stickslip_model::{Contact, exact};
///
/// // From ψ = 2 on there is no switch at this stiffness, and ε_t = 1 − 2/ψ.
/// let sliding = exact::collide(Contact::new(63.0, 2.5, 0.0)?)?;
/// assert!(sliding.switches.is_empty());
/// assert!((sliding.eps_t() - 0.2).abs() < 1e-15);
///
/// // At ψ = 1 the spring sticks three times and the motion ends reversed.
/// let collision = exact::collide(Contact::new(63.0, 1.0, 0.0)?)?;
/// assert_eq!(collision.itinerary(), "+o-o+o-o+");
/// assert!(collision.energy.tangential_unbalanced().abs() < 1e-14);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`ExactError::Damped`] if the contact is damped, [`ExactError::Domain`] unless κ is from 1e-100
/// to [`MOST_STIFFNESS`] and ψ from 1e-100 to 1e100, [`ExactError::TooManySwitches`] if there are
/// more switches than [`MOST_SWITCHES`].
pub fn collide(contact: Contact) -> Result<Collision, ExactError> {
    let mut collision = Collision::before(contact);
    collide_into(contact, &mut collision)?;
    Ok(collision)
}

/// As [`collide`], into a collision whose memory is used again: no number of switches makes a sweep
/// allocate more than once.
///
/// ```
/// use stickslip_model::{Collision, Contact, exact};
///
/// let contact = |psi| Contact::new(18.0, psi, 0.0);
/// let mut collision = Collision::before(contact(0.5)?);
/// let mut count = 0;
/// for psi in [0.5, 1.0, 1.5] {
///     exact::collide_into(contact(psi)?, &mut collision)?;
///     count += collision.switches.len();
/// }
/// assert_eq!(count, 10);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`collide`]; `collision` then holds the switches found so far.
pub fn collide_into(contact: Contact, collision: &mut Collision) -> Result<(), ExactError> {
    collide_within(contact, collision, MOST_SWITCHES)
}

fn collide_within(
    contact: Contact,
    collision: &mut Collision,
    limit: usize,
) -> Result<(), ExactError> {
    collision.reset(contact);
    undamped(&contact)?;
    let switches = &mut collision.switches;
    let slide = Slide::new(contact.kappa());
    let mut account = Account::default();
    let mut side = Side::Positive;
    let mut sliding = SlipPhase::at_impact(contact.psi());
    while let Some(onset) = slide.stick_onset(&sliding) {
        if switches.len() + 2 > limit {
            return Err(too_many(&contact, limit, onset));
        }
        let point = NormalMotion::at(onset);
        let velocity = sliding.velocity_at(onset, point);
        account.slip(&sliding, onset, point, velocity.0);
        let swing = Swing::new(&slide, onset, point, velocity);
        let release = Release::of(&swing, slide.crest.map(|crest| crest.root));
        let released = slide.limit(release.point);
        account.stick(slide.kappa, swing.elongation, released);
        account.reversals += release.reversals;

        let orientation = side.sign();
        switches.push(Switch {
            time: onset.time(),
            time_left: onset.time_left(),
            to: Regime::Stick,
            side,
            spring: orientation * swing.elongation,
            velocity: orientation * velocity.0,
        });
        if !release.half_swing.is_multiple_of(2) {
            side = side.opposite();
        }
        let velocity = orientation * release.velocity;
        switches.push(Switch {
            time: release.moment.time(),
            time_left: release.moment.time_left(),
            to: Regime::Slip,
            side,
            spring: side.sign() * released,
            velocity,
        });
        sliding = SlipPhase::new(release.moment, release.point, side.sign() * velocity);
    }
    let end = NormalMotion::at(Moment::END);
    let velocity = sliding.velocity_at(Moment::END, end).0;
    account.slip(&sliding, Moment::END, end, velocity);
    let final_velocity = side.sign() * velocity;
    collision.eps_n = 1.0;
    collision.final_velocity = final_velocity;
    collision.contact_time = CONTACT_TIME;
    collision.reversals = account.reversals;
    collision.energy = account.ledger(contact.psi(), final_velocity);
    Ok(())
}

#[cfg(test)]
mod tests;
