//! The exact engine: collisions from their solution, without integration.
//!
//! The normal motion does not feel the tangential one: for each damping there is one trajectory,
//! which is known to rounding. In slip s·w − v is constant; in stick the spring oscillates
//! harmonically in time. Only the moments of the switches have to be solved for. Each is the single
//! root of a function in a bracket on which the function is known to be monotone or to cross zero
//! once. Nothing is searched by sampling, so that no switch is missed and none is invented. The
//! functions that decide also give the [`margins`]: how near the collision came to other switches.
//!
//! The engine is the oracle of the integrator. It shares the contact, the result type and the names
//! of margins with it, and nothing else: this crate lies below the integrator.
//!
//! Source files in reading order: `moment` and `slip` are what a collision is made of; `normal` is
//! the interface of normal motions, with the closed form without damping and the expansion with it;
//! `slide` finds the end of a slip phase, `swing` and `release` the end of a stick phase, `phases`
//! begins a collision, `margin` and `late` follow prescribed switches, `course` has the normal
//! motion at any time, `cusp` what vanishes where grazes end in one point.
//!
//! Source of the law: Schwager, Becker and Pöschel, Eur. Phys. J. E 27, 107 (2008). The statements
//! on which the decisions rest are proved in PROOFS.md of this crate.

use stickslip_contact::{Collision, Contact, EnergyLedger, Regime, Side, Switch};

use error::{checked, too_many};
use moment::{At, Moment, Motion};
use normal::Trajectory;
use phases::{Phase, Task, with_trajectory};
use release::Release;
use slide::Slide;
use slip::SlipPhase;
use swing::Swing;

mod boundaries;
mod course;
mod cusp;
mod distance;
mod error;
mod flank;
mod late;
mod margin;
mod moment;
mod names;
mod normal;
mod onset;
mod phases;
mod release;
mod slide;
mod slip;
mod swing;

pub use crate::domain::MOST_STIFFNESS;
pub use boundaries::{small_impact_boundary, top_boundary};
pub use course::{NormalState, normal_state};
pub use cusp::{cusps, swallowtail};
pub use distance::distance;
pub use error::ExactError;
pub use margin::{ContactMargins, margin, margins, moved};
pub use normal::undamped::CONTACT_TIME;

/// Most switches that [`collide`] lists for one collision; they take about 170 MB.
///
/// The count grows as √κ t_c/π: for κ = 1e13 it is 3.3 million.
pub const MOST_SWITCHES: usize = 4_000_000;

/// The collision of `contact` from the exact solution.
///
/// Accuracy without damping, against 22-digit references for κ from 0.02 to 1e4 and ψ from 0.003
/// to 3:
///
/// - w is within 1e-15.
/// - Switch times, and y and w at the switches, are within 1e-14; at relative distances down to
///   1e-10 from a graze they are within 1e-11.
/// - The relative error of `time_left` is at most twice the relative error of w.
/// - The number of switches is right down to a relative distance of 1e-14 from a boundary at which
///   it changes. A touch within rounding is not a switch.
///
/// With damping, against 25-digit references for κ from 1e-6 to 1e6, ψ from 1e-10 to 10 and a from
/// 1e-6 to 1e4, ε_t is within 1e-15 (1 + √κ), and ε_n and the contact time have relative errors
/// below 1e-15.
///
/// Numbers keep their accuracy as long as κψ, the scale of √x at the first switch, is above about
/// 1e-100.
///
/// Cost: without damping 0.2 µs for each switch at every stiffness, with damping two to three times
/// that, and twice as much again if the thread's last collision had another damping. The result is
/// a pure function of `contact`.
///
/// ```
/// use stickslip_contact::Contact;
/// use stickslip_exact::exact;
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
/// [`ExactError::Domain`] unless κ is from 1e-100 to [`MOST_STIFFNESS`] and ψ from 1e-100 to 1e100,
/// or with a damping from 1e-60 to 1e4 both from 1e-60; [`ExactError::TooManySwitches`] if there
/// are more switches than [`MOST_SWITCHES`].
pub fn collide(contact: Contact) -> Result<Collision, ExactError> {
    let mut collision = Collision::before(contact);
    collide_into(contact, &mut collision)?;
    Ok(collision)
}

/// As [`collide`], into a collision whose memory is used again: a sweep allocates memory only where
/// a collision has more switches than any before.
///
/// ```
/// use stickslip_contact::{Collision, Contact};
/// use stickslip_exact::exact;
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
/// As [`collide`]; `collision` then contains the switches found so far.
pub fn collide_into(contact: Contact, collision: &mut Collision) -> Result<(), ExactError> {
    collide_within(contact, collision, MOST_SWITCHES)
}

fn collide_within(
    contact: Contact,
    collision: &mut Collision,
    limit: usize,
) -> Result<(), ExactError> {
    collision.reset(contact);
    checked(&contact)?;
    with_trajectory(&contact, Collide { collision, limit })
}

/// Computes a whole collision.
struct Collide<'c> {
    collision: &'c mut Collision,
    /// Most switches.
    limit: usize,
}

impl Task for Collide<'_> {
    type Output = Result<(), ExactError>;

    fn run<T: Trajectory>(self, slide: &Slide<T>, contact: &Contact) -> Result<(), ExactError> {
        let Self { collision, limit } = self;
        let path = slide.path;
        let unit = path.time_unit();
        let switches = &mut collision.switches;
        let switch = |at: &At<T::Motion>, to, side, spring: f64, velocity| Switch {
            time: path.time(at) * unit,
            time_left: path.time_left(at) * unit,
            to,
            side,
            spring: spring * unit,
            velocity,
        };
        let mut totals = Totals::default();
        let mut side = Side::Positive;
        let mut phase = Phase::first(slide, contact.psi());
        let final_velocity = loop {
            phase = match phase {
                Phase::Stick(swing) => {
                    let release = Release::of(&swing);
                    let released = slide.limit(&release.end);
                    totals.stick(slide.spring.kappa, swing.elongation, released);
                    totals.reversals += release.reversals;
                    let velocity = side.sign() * release.velocity;
                    if !release.half_swing.is_multiple_of(2) {
                        side = side.opposite();
                    }
                    let sign = side.sign();
                    switches.push(switch(
                        &release.end,
                        Regime::Slip,
                        side,
                        sign * released,
                        velocity,
                    ));
                    Phase::Slip(SlipPhase::new(path.impulse(), &release.end, sign * velocity))
                }
                Phase::Slip(sliding) => {
                    let Some(onset) = slide.stick_onset(&sliding) else {
                        let end = path.at(Moment::END);
                        let velocity = sliding.velocity_at(&end).0;
                        totals.slip(&sliding, &end, velocity);
                        break side.sign() * velocity;
                    };
                    if switches.len() + 2 > limit {
                        return Err(too_many(contact, limit, slide, onset));
                    }
                    let start = path.at(onset);
                    let velocity = sliding.velocity_at(&start);
                    totals.slip(&sliding, &start, velocity.0);
                    let swing = Swing::new(slide, start, velocity);
                    let sign = side.sign();
                    switches.push(switch(
                        &start,
                        Regime::Stick,
                        side,
                        sign * swing.elongation,
                        sign * velocity.0,
                    ));
                    Phase::Stick(swing)
                }
            };
        };
        collision.eps_n = path.restitution();
        collision.final_velocity = final_velocity;
        collision.contact_time = path.contact_time() * unit;
        collision.reversals = totals.reversals;
        collision.energy = totals.ledger(contact.psi(), final_velocity, path.energy());
        Ok(())
    }
}

/// The totals over the phases so far.
#[derive(Debug, Default)]
struct Totals {
    /// ∫ F (s·w − dL/dt) dt over the slip phases, apart from κL²/2 at the end of the last one.
    sliding: f64,
    /// Sign changes of the tangential velocity.
    pub reversals: usize,
}

impl Totals {
    /// Adds a slip phase up to `end`, where s·w is `velocity`.
    ///
    /// With F dt = −dv and s·w linear in v, ∫ F s·w dt is the impulse times the mean of s·w.
    pub fn slip<M: Motion>(&mut self, sliding: &SlipPhase, end: &At<M>, velocity: f64) {
        self.sliding += 0.5 * sliding.impulse_until(end) * (sliding.velocity + velocity);
        self.reversals += usize::from((sliding.velocity > 0.0) != (velocity > 0.0));
    }

    /// Adds a stick phase, during which L changes from `stuck` to `released`.
    ///
    /// As L is 0 at both ends of contact, ∫ F dL over the slip phases is minus the change of κL²/2
    /// over the stick phases.
    pub fn stick(&mut self, kappa: f64, stuck: f64, released: f64) {
        self.sliding += 0.5 * kappa * (released - stuck) * (released + stuck);
    }

    /// The energy ledger of a collision whose w is `psi` at the start and `final_velocity` at the
    /// end, with the energy of its normal motion.
    pub fn ledger(&self, psi: f64, final_velocity: f64, normal: EnergyLedger) -> EnergyLedger {
        EnergyLedger {
            tangential_initial: 0.5 * psi * psi,
            tangential_final: 0.5 * final_velocity * final_velocity,
            sliding: self.sliding,
            tangential_damping: 0.0,
            spring_left: 0.0,
            ..normal
        }
    }
}

#[cfg(test)]
mod tests;
