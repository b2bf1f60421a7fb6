//! Cusps: where the grazes while sliding and while sticking end.
//!
//! A slip phase grazes stick where g = 0 at the first [turn](Trajectory::turns), and a stick phase
//! that has just begun grazes slip soon after. The two turns meet, as κ is increased, at the
//! [split](Trajectory::split), and both boundaries end where that happens and g = 0 there. With
//! δ = 1 − κ/κ_c, the one is at a distance δ^{3/2} beside the other, so that neither margin tells
//! the place well, nor exists beyond it. But it is a simple zero of two numbers that are smooth on
//! all sides: P and g at the split.

use stickslip_solver::{Hint, Margin, Place};

use super::margin::TURN;
use super::normal::{Motion, Trajectory};
use super::slide::{Slide, SlipPhase};
use crate::contact::Contact;
use crate::laws::phase::SAME_SIDE;

/// The number in the name of the margin P at the split: more than there are half swings.
const PULL: usize = 1 << 21;
/// The number in the name of the margin g at the split.
const GUARD: usize = PULL + 1;

/// The names of two numbers that vanish together where the boundary of `which` ends in a cusp;
/// `None` if it has none. [`margin`](super::margin()) computes them.
///
/// ```
/// use stickslip_model::{Contact, exact};
///
/// // The cusp without damping, at ψ = 1: grazes of the first slip phase end there.
/// let kappa = 6.0 / 5.0 * 1.25_f64.powf(0.2) * 1.25;
/// let cusp = Contact::new(kappa, 1.0, 0.0)?;
/// let near = exact::margins(&Contact::new(1.5, 1.02, 0.0)?)?;
/// let names = exact::cusp(&cusp, &near.near_misses[0].0).expect("a slip graze");
/// for name in &names {
///     assert!(exact::margin(&cusp, name)?.expect("it exists everywhere").abs() < 1e-15);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn cusp(contact: &Contact, which: &Margin) -> Option<[Margin; 2]> {
    let is_graze = matches!(which.place, Place::Minimum { number: 0, .. });
    if !is_graze || which.guard != SAME_SIDE {
        return None;
    }
    // Without damping, the phases with an even number are those of slip.
    let sticks = which.exits.len().is_multiple_of(2) != (contact.damping() == 0.0);
    let slip = which.exits.len().checked_sub(usize::from(sticks))?;
    Some([PULL, GUARD].map(|number| Margin {
        exits: which.exits[..slip].to_vec(),
        guard: SAME_SIDE,
        place: Place::Minimum { near: Hint(0.0), number },
    }))
}

/// The margin of a slip phase with this number in its name: one of a [`cusp`], or g at the first
/// turn.
pub fn of_slip<T: Trajectory>(slide: &Slide<T>, sliding: &SlipPhase, number: usize) -> Option<f64> {
    match number {
        TURN => slide.turn_margin(sliding),
        PULL => Some(slide.path.motion(slide.path.split()).pull(&slide.spring)),
        GUARD => Some(slide.guard(sliding, &slide.path.at(slide.path.split()))),
        _ => None,
    }
}
