//! How far a collision is from other switches, as one number.

use std::f64::consts::FRAC_PI_2;

use super::MOST_SWITCHES;
use super::error::{ExactError, too_many, undamped};
use super::flank::Flanks;
use super::margin::{crest_margin, swing};
use super::release::Release;
use super::slide::{Slide, SlipPhase};
use super::swing::Swing;
use super::trajectory::{Half, Moment, NormalMotion};
use crate::contact::Contact;

/// The distance of `contact`, which must have no damping, from other switches.
///
/// It is the least margin of the collision as a velocity, in units of ψ. The norm √(w² + κy²) of
/// the difference of two contacts with the same normal motion never grows, so that the switches are
/// the same at every ψ' with |ψ' − ψ| below the distance times ψ, as long as the distance is below
/// 0.1. It is at most 1.
///
/// ```
/// use stickslip_model::{Contact, exact};
///
/// // The boundary is ψ = 2.
/// let distance = exact::distance(&Contact::new(63.0, 2.5, 0.0)?)?;
/// assert!((distance - 0.2).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`collide`](super::collide).
pub fn distance(contact: &Contact) -> Result<f64, ExactError> {
    undamped(contact)?;
    let slide = Slide::new(contact.kappa());
    let crest = slide.crest.map(|crest| crest.root);
    let mut sliding = SlipPhase::at_impact(contact.psi());
    let mut least = contact.psi();
    for _ in 0..MOST_SWITCHES {
        let at_crest = crest_margin(&slide, &sliding);
        // A slip that ends before the crest would not have lasted to the end of contact.
        let passes = at_crest.is_none_or(|margin| margin >= 0.0);
        let at_end = passes.then(|| sliding.at_end());
        least = at_crest.into_iter().chain(at_end).fold(least, |least, m| least.min(m.abs()));
        let Some(onset) = slide.stick_onset(&sliding) else { return Ok(least / contact.psi()) };
        let swing = swing(&slide, &sliding, onset);
        let release = Release::of(&swing, crest);
        let gaps = half_swings(release.half_swing).filter_map(|k| top_gap(&swing, crest, k));
        let gaps = gaps.chain(bend_gap(&swing, crest, &release));
        least = gaps.fold(least, |least, gap| least.min(swing.omega * gap.abs()));
        let velocity = super::swing::half_swing_sign(release.half_swing) * release.velocity;
        sliding = SlipPhase::new(release.moment, release.normal, velocity);
    }
    Err(too_many(contact, MOST_SWITCHES, sliding.start))
}

/// The half swings up to the `last` one on which the spring may come nearest to its limit. The
/// limit rises and then falls: they are among the first and the last ones.
fn half_swings(last: u32) -> impl Iterator<Item = u32> {
    const ENDS: u32 = 3;
    (0..=last.min(ENDS)).chain((last.saturating_sub(ENDS)..=last).filter(|&k| k > ENDS))
}

/// The gap D where the spring is nearest to its limit on half swing `k`, relative to the limit.
fn top_gap(swing: &Swing, crest: Option<f64>, k: u32) -> Option<f64> {
    let top = Flanks::of(swing, crest, k)?.top(swing)?;
    Some(swing.gap(k, top, NormalMotion::at(top)).value)
}

/// The gap where it bends upwards again on the first half swing, if the phase does not end before.
/// There it may fall to 0 if the phase starts a little earlier or later.
fn bend_gap(swing: &Swing, crest: Option<f64>, release: &Release) -> Option<f64> {
    let bend = Moment { half: Half::Decompression, root: crest? };
    let reached = swing.start.is_before(bend) && bend.is_before(release.moment);
    let angle = swing.omega * swing.start.time_until(bend);
    // A difference δ of w at the start is a difference δ sin θ/ω of the gap at the angle θ.
    let part = if angle < FRAC_PI_2 { angle.sin() } else { 1.0 };
    reached.then(|| swing.gap(0, bend, NormalMotion::at(bend)).value / part)
}
