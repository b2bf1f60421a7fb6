//! Margins: how near a collision comes to other switches, also if its switches are prescribed.
//!
//! A margin belongs to a phase in which something almost happened (see
//! [`mod@stickslip_solver::margin`]). The exact engine decides by three numbers. They are its
//! margins:
//!
//! - A slip phase passes a crest of h if C − h > 0 at the crest.
//! - A slip phase lasts to the end of contact if s·w > 0 at the end.
//! - A stick phase passes a half swing if (L/|y|)² − 1 > 0 where |y|/L is largest. Near the end of
//!   contact this number is linear in the time at which y vanishes; the gap L − |y| is not.
//!
//! Each margin is smooth through 0 as long as the switches before it are prescribed. A switch that
//! ends slip is prescribed as before or after the crest, a switch that ends stick by the number of
//! the half swing.

use stickslip_solver::{Exit, Hint, Margin, Place};

use super::error::{ExactError, too_many, undamped};
use super::flank::Flanks;
use super::limit::Crest;
use super::release::Release;
use super::slide::{Slide, SlipPhase};
use super::swing::{Gap, Swing, half_swing_sign};
use super::trajectory::{Half, Moment, NormalMotion};
use crate::contact::Contact;
use crate::laws::phase::{OTHER_SIDE, SAME_SIDE};

/// Most switches of a collision whose margins are listed. Each margin names the switches before it:
/// the length of a list grows as the square of their number.
const MOST_SWITCHES: usize = 1000;

/// The guards that fire in a collision, in order, with its margins.
#[derive(Clone, Debug, PartialEq)]
pub struct Margins {
    /// The guard of each switch, [`SAME_SIDE`] or [`OTHER_SIDE`].
    pub fired: Vec<usize>,
    /// The margins in the order of their phases, each with its positive value.
    pub near_misses: Vec<(Margin, f64)>,
}

/// All margins of the collision of `contact`, which must have no damping.
///
/// Margins of slip are in units of the reduced velocity w; margins of stick are (L/|y|)² − 1. Up to
/// κ = 400 their zeros are within 1e-15 of the boundaries in ψ.
///
/// ```
/// use stickslip_model::{Contact, exact};
///
/// let contact = Contact::new(18.0, 0.4, 0.0)?;
/// let near = exact::margins(&contact)?;
/// assert_eq!(near.fired.len(), exact::collide(contact)?.switches.len());
/// for (margin, value) in &near.near_misses {
///     let again = exact::margin(&contact, margin)?.expect("it exists here");
///     assert!((again - value).abs() <= 1e-15 * value.max(1.0));
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`collide`](super::collide), and [`ExactError::TooManySwitches`] for more than 1000 switches.
pub fn margins(contact: &Contact) -> Result<Margins, ExactError> {
    undamped(contact)?;
    let slide = Slide::new(contact.kappa());
    let mut found = Margins { fired: Vec::new(), near_misses: Vec::new() };
    let mut exits = Vec::new();
    let mut sliding = SlipPhase::at_impact(contact.psi());
    loop {
        let onset = slide.stick_onset(&sliding);
        let passed = crest_margin(&slide, &sliding).filter(|&value| value >= 0.0);
        let lasts = onset.is_none().then(|| sliding.at_end());
        for (place, value) in [(CREST, passed), (Place::End, lasts)] {
            let margin = || Margin { exits: exits.clone(), guard: SAME_SIDE, place };
            found.near_misses.extend(value.map(|value| (margin(), value)));
        }
        let Some(onset) = onset else { return Ok(found) };
        if found.fired.len() + 2 > MOST_SWITCHES {
            return Err(too_many(contact, MOST_SWITCHES, onset));
        }
        exits.push(slip_exit(onset));
        let swing = swing(&slide, &sliding, onset);
        let release = Release::of(&swing, slide.crest.map(|crest| crest.root));
        let mut after_top = false;
        for k in 0..=release.half_swing {
            let value = top_margin(&slide, &swing, k).filter(|&value| value >= 0.0);
            let place = top_place(k);
            let margin = || Margin { exits: exits.clone(), guard: guard(k), place };
            found.near_misses.extend(value.map(|value| (margin(), value)));
            after_top = value.is_some();
        }
        exits.push(stick_exit(release.half_swing, after_top));
        found.fired.extend([SAME_SIDE, guard(release.half_swing)]);
        sliding = released(&swing, release.half_swing, release.moment);
    }
}

/// The margin `which`, one of the [`margins`] of any contact, of the collision of `contact` with
/// the switches that `which` prescribes.
///
/// It is `None` if these switches cannot be followed, or if there is no such half swing or crest.
///
/// ```
/// use stickslip_model::{Contact, exact};
///
/// // Just above ψ = 2 the contact ends in slip; below it, w would have changed its sign.
/// let near = exact::margins(&Contact::new(63.0, 2.001, 0.0)?)?;
/// let (last, _) = &near.near_misses[0];
/// let value = exact::margin(&Contact::new(63.0, 1.999, 0.0)?, last)?;
/// assert!((value.unwrap() + 0.001).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`ExactError::Damped`] and [`ExactError::Domain`] as [`margins`].
pub fn margin(contact: &Contact, which: &Margin) -> Result<Option<f64>, ExactError> {
    follow(contact, which, |_| ())
}

/// The margin `which` with hints that fit the collision of `contact`, as
/// [`stickslip_solver::margin()`] returns it. A margin that does not exist is returned unchanged.
///
/// # Errors
/// As [`margin`].
pub fn moved(contact: &Contact, which: &Margin) -> Result<Margin, ExactError> {
    let mut exits = Vec::with_capacity(which.exits.len());
    let found = follow(contact, which, |exit| exits.push(exit))?;
    Ok(found.map_or_else(|| which.clone(), |_| Margin { exits, ..*which }))
}

/// Follows the switches that `which` prescribes, calls `on_exit` with each, and returns the margin.
fn follow(
    contact: &Contact,
    which: &Margin,
    mut on_exit: impl FnMut(Exit),
) -> Result<Option<f64>, ExactError> {
    undamped(contact)?;
    Ok(follow_exits(contact, which, &mut on_exit))
}

fn follow_exits(contact: &Contact, which: &Margin, on_exit: &mut impl FnMut(Exit)) -> Option<f64> {
    let slide = Slide::new(contact.kappa());
    let mut sliding = SlipPhase::at_impact(contact.psi());
    let mut exits = which.exits.iter();
    while let Some(onset) = exits.next() {
        let onset = prescribed_onset(&slide, &sliding, onset)?;
        on_exit(slip_exit(onset));
        let swing = swing(&slide, &sliding, onset);
        let Some(exit) = exits.next() else {
            let &Margin { guard: side, place: Place::Minimum { number, .. }, .. } = which else {
                return None;
            };
            let even = u32::try_from(number).ok()?.checked_mul(2)?;
            return top_margin(&slide, &swing, even + u32::from(side == OTHER_SIDE));
        };
        let (k, after_top) = flank_of(exit);
        let crest = slide.crest.map(|crest| crest.root);
        let (moment, after_top) = Flanks::of(&swing, crest, k)?.exit(&swing, after_top)?;
        on_exit(stick_exit(k, after_top));
        sliding = released(&swing, k, moment);
    }
    match which.place {
        Place::End => Some(sliding.at_end()),
        Place::Minimum { .. } => crest_margin(&slide, &sliding),
    }
}

/// The place of the only crest of a slip phase.
const CREST: Place = Place::Minimum { near: Hint(0.0), number: 0 };

/// C − h at the crest, if the phase passes the crest before the largest compression.
pub fn crest_margin(slide: &Slide, sliding: &SlipPhase) -> Option<f64> {
    let Crest { root, height } = slide.crest?;
    let passes = sliding.start.is_before(Moment { half: Half::Compression, root });
    passes.then(|| sliding.at_start() - height)
}

/// 1/R² − 1 at the top of R on half swing `k`.
///
/// On the first half swing this number has a double zero at the start of the phase. It is divided
/// by the square of the angle since then, so that it is not flat where the length of the phase goes
/// to 0.
fn top_margin(slide: &Slide, swing: &Swing, k: u32) -> Option<f64> {
    let flanks = Flanks::of(swing, slide.crest.map(|crest| crest.root), k)?;
    let top = flanks.top(swing)?;
    let Gap { value, q, .. } = swing.gap(k, top, NormalMotion::at(top));
    let excess = value / q * (value / q + 2.0);
    let angle = swing.omega * swing.start.time_until(top);
    Some(if k == 0 { excess / (angle * angle) } else { excess })
}

/// The place of the top of half swing `k` among the tops on its side.
fn top_place(k: u32) -> Place {
    Place::Minimum { near: Hint(f64::from(k)), number: (k / 2) as usize }
}

/// The guard that fires on half swing `k`.
fn guard(k: u32) -> usize {
    if k.is_multiple_of(2) { SAME_SIDE } else { OTHER_SIDE }
}

/// The exit at the end of a slip phase; its hint is 0 before the crest and 1 after it.
fn slip_exit(onset: Moment) -> Exit {
    let after = if onset.half == Half::Compression { 0.0 } else { 1.0 };
    Exit { guard: SAME_SIDE, after: Hint(after), part: Hint(0.0) }
}

/// The moment at which the slip phase ends as `exit` prescribes.
fn prescribed_onset(slide: &Slide, sliding: &SlipPhase, exit: &Exit) -> Option<Moment> {
    if slide.crest.is_none() {
        return slide.stick_onset(sliding);
    }
    if exit.after.0 < 0.5 {
        return slide.onset_before_crest(sliding);
    }
    let within = -sliding.at_end() <= slide.highest().height;
    if within { slide.onset_after_crest(sliding) } else { None }
}

/// The exit at the end of a stick phase; its hint is the number of the half swing, and 1/2 more
/// after the top of R.
fn stick_exit(k: u32, after_top: bool) -> Exit {
    let after = f64::from(k) + if after_top { 0.5 } else { 0.0 };
    Exit { guard: guard(k), after: Hint(after), part: Hint(0.0) }
}

/// The half swing of the exit of a stick phase, and whether the exit is after the top of R.
fn flank_of(exit: &Exit) -> (u32, bool) {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number")]
    let k = exit.after.0 as u32;
    (k, exit.after.0 - f64::from(k) > 0.25)
}

/// The stick phase that starts at `onset`.
pub fn swing(slide: &Slide, sliding: &SlipPhase, onset: Moment) -> Swing {
    let normal = NormalMotion::at(onset);
    Swing::new(slide, onset, normal, sliding.velocity_at(onset, normal))
}

/// The slip phase that starts where `swing` ends on half swing `k`.
fn released(swing: &Swing, k: u32, moment: Moment) -> SlipPhase {
    let (_, velocity) = swing.motion(swing.start.time_until(moment));
    SlipPhase::new(moment, NormalMotion::at(moment), half_swing_sign(k) * velocity)
}
