//! Cusps and swallowtails: where extrema merge on their zeros, and boundaries end.
//!
//! A slip phase grazes stick where g = 0 at the first [turn](Trajectory::turns), and a stick phase
//! that has just begun grazes slip soon after. The two turns meet, as κ is increased, at the
//! [split](Trajectory::split), and both boundaries end where that happens and g = 0 there. With
//! δ = 1 − κ/κ_c, the one is at a distance δ^{3/2} beside the other. Neither margin exists beyond
//! the place, and each locates it to 1e-7 of a window or worse. But the place is a simple zero of
//! two numbers that are smooth on all sides: P and g at the split.
//!
//! On a half swing with two tops of R, the top before the turns merges with the bottom between them
//! where W = 0 at the first turn. If the gap D is 0 there too, the boundary of this top ends in a
//! cusp, with the boundary of the slip phase that begins at the top. D and W at the first turn are
//! smooth there.
//!
//! Where P, D and W are 0 at the split, both tops merge with the bottom. That is a swallowtail: in
//! a plane of κ and ψ it happens at single dampings.

use stickslip_contact::Contact;
use stickslip_contact::phase::OTHER_SIDE;
use stickslip_solver::margin::{Exit, Margin, Place};

use super::flank::{at_first_turn, at_split};
use super::moment::Motion;
use super::names::{NAMES, TURN, flank_of, guard, numbered};
use super::normal::Trajectory;
use super::slide::Slide;
use super::slip::SlipPhase;
use super::swing::{Gap, Swing};

/// What the number in the name of the margin P at the split is counted from.
const PULL: usize = 2 * NAMES;
/// The same for g at the split.
const GUARD: usize = 3 * NAMES;
/// The same for D at the first turn.
const TURN_GAP: usize = 4 * NAMES;
/// The same for W at the first turn.
const TURN_RATE: usize = 5 * NAMES;
/// The same for D at the split.
const SPLIT_GAP: usize = 6 * NAMES;
/// The same for W at the split.
const SPLIT_RATE: usize = 7 * NAMES;

/// The names of pairs of numbers that vanish together where the boundary of `which` may end in a
/// cusp. [`margin`](super::margin()) computes them.
///
/// ```
/// use stickslip_contact::Contact;
/// use stickslip_exact::exact;
///
/// // The cusp without damping, at ψ = 1: grazes of the first slip phase end there.
/// let kappa = 6.0 / 5.0 * 1.25_f64.powf(0.2) * 1.25;
/// let cusp = Contact::new(kappa, 1.0, 0.0)?;
/// let near = exact::margins(&Contact::new(1.5, 1.02, 0.0)?)?;
/// let pairs = exact::cusps(&cusp, &near.near_misses[0].0);
/// for name in &pairs[0] {
///     assert!(exact::margin(&cusp, name)?.expect("it exists everywhere").abs() < 1e-15);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn cusps(contact: &Contact, which: &Margin) -> Vec<[Margin; 2]> {
    match graze(contact, which) {
        Some(Graze::Slip) => {
            let slip = [PULL, GUARD].map(|what| named(&which.exits, 0, what));
            let before =
                which.exits.split_last().and_then(|(exit, exits)| of_top(exits, flank_of(exit).0));
            std::iter::once(slip).chain(before).collect()
        }
        Some(Graze::Stick(0)) => {
            let slip = which.exits.split_last().map(|(_, exits)| exits);
            slip.map(|exits| [PULL, GUARD].map(|what| named(exits, 0, what))).into_iter().collect()
        }
        Some(Graze::Stick(k)) => of_top(&which.exits, k).into_iter().collect(),
        None => Vec::new(),
    }
}

/// The names of three numbers that vanish together where the boundary of `which` takes part in a
/// swallowtail, if it can: three extrema of a stick phase merge on their zero.
pub fn swallowtail(contact: &Contact, which: &Margin) -> Option<[Margin; 3]> {
    let (exits, k) = match graze(contact, which)? {
        Graze::Slip => {
            let (exit, exits) = which.exits.split_last()?;
            (exits, flank_of(exit).0)
        }
        Graze::Stick(0) => {
            let (_, exits) = which.exits.split_last()?;
            let (exit, exits) = exits.split_last()?;
            (exits, flank_of(exit).0)
        }
        Graze::Stick(k) => (&which.exits[..], k),
    };
    (k > 0).then(|| [PULL, SPLIT_GAP, SPLIT_RATE].map(|what| named(exits, k, what)))
}

/// A graze that may end in a cusp.
enum Graze {
    /// A slip phase grazes stick.
    Slip,
    /// A stick phase grazes slip on the half swing with this number.
    Stick(u32),
}

fn graze(contact: &Contact, which: &Margin) -> Option<Graze> {
    let Place::Minimum { number, .. } = which.place else { return None };
    // Without damping, phases with an even number are slip.
    let sticks = which.exits.len().is_multiple_of(2) != (contact.damping() == 0.0);
    if !sticks {
        return (number == TURN).then_some(Graze::Slip);
    }
    let k = u32::try_from(2 * (number % NAMES)).ok()? + u32::from(which.guard == OTHER_SIDE);
    (number < PULL).then_some(Graze::Stick(k))
}

/// What vanishes where the top before the turns ends, on half swing `k` of the phase after `exits`.
fn of_top(exits: &[Exit], k: u32) -> Option<[Margin; 2]> {
    (k > 0).then(|| [TURN_GAP, TURN_RATE].map(|what| named(exits, k, what)))
}

fn named(exits: &[Exit], k: u32, what: usize) -> Margin {
    Margin { exits: exits.to_vec(), guard: guard(k), place: numbered(k, what) }
}

/// The margin of a slip phase with this number in its name: one of a [cusp](cusps), or g at the
/// first turn.
pub fn of_slip<T: Trajectory>(slide: &Slide<T>, sliding: &SlipPhase, number: usize) -> Option<f64> {
    match number {
        TURN => slide.turn_margin(sliding),
        PULL => Some(slide.path.motion(slide.path.split()).pull(&slide.spring)),
        GUARD => Some(slide.guard(sliding, &slide.path.at(slide.path.split()))),
        _ => None,
    }
}

/// The margin of half swing `k` of a stick phase that is called `what`: one of a [cusp](cusps) or
/// of a [`swallowtail`].
pub fn of_stick<T: Trajectory>(swing: &Swing<T>, k: u32, what: usize) -> Option<f64> {
    // D/q and the rate of ln R.
    let excess = |gap: Gap| gap.value / gap.q;
    let rate = |gap: Gap| gap.turning() / (gap.q * (gap.q + gap.value));
    match what {
        PULL => Some(swing.path.motion(swing.path.split()).pull(&swing.spring)),
        TURN_GAP => at_first_turn(swing, k).map(excess),
        TURN_RATE => at_first_turn(swing, k).map(rate),
        SPLIT_GAP => at_split(swing, k).map(excess),
        SPLIT_RATE => at_split(swing, k).map(rate),
        _ => None,
    }
}
