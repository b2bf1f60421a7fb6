//! How far a collision is from other switches, as one number.

use std::f64::consts::FRAC_PI_2;

use stickslip_contact::Contact;

use super::MOST_SWITCHES;
use super::error::{ExactError, checked, too_many};
use super::flank::Flanks;
use super::late::LateHalfSwing;
use super::margin::{end_margin, swing};
use super::moment::At;
use super::normal::Trajectory;
use super::phases::{Phase, Task, with_trajectory};
use super::release::Release;
use super::slide::Slide;
use super::slip::SlipPhase;
use super::swing::{AT_IMPACT, Swing};

/// The distance of `contact` from other switches.
///
/// It is the least margin of the collision as a velocity, in units of ψ. The norm √(w² + κy²) of
/// the difference of two contacts with the same normal motion never grows, so that the switches are
/// the same at every ψ' with |ψ' − ψ| below the distance times ψ, as long as the distance is below
/// 0.1. It is at most 1.
///
/// ```
/// use stickslip_contact::Contact;
/// use stickslip_exact::exact;
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
    checked(contact)?;
    with_trajectory(contact, Nearest)
}

/// Finds the least margin.
struct Nearest;

impl Task for Nearest {
    type Output = Result<f64, ExactError>;

    fn run<T: Trajectory>(self, slide: &Slide<T>, contact: &Contact) -> Self::Output {
        let mut least = contact.psi();
        let mut sliding = match Phase::first(slide, contact.psi()) {
            Phase::Slip(sliding) => sliding,
            Phase::Stick(swing) => passed(&swing, &mut least),
        };
        for _ in 0..MOST_SWITCHES {
            let at_turn = slide.turn_margin(&sliding);
            // A slip that ends before the turn would not have lasted to the end of contact.
            let passes = at_turn.is_none_or(|margin| margin >= 0.0);
            let at_end = passes.then(|| slide.end_margin(&sliding));
            least = at_turn.into_iter().chain(at_end).fold(least, |least, m| least.min(m.abs()));
            let Some(onset) = slide.stick_onset(&sliding) else {
                return Ok(least / contact.psi());
            };
            sliding = passed(&swing(slide, &sliding, onset), &mut least);
        }
        Err(too_many(contact, MOST_SWITCHES, slide, sliding.start))
    }
}

/// The slip phase after `swing`; `least` becomes the least of itself and the gaps as velocities.
fn passed<T: Trajectory>(swing: &Swing<T>, least: &mut f64) -> SlipPhase {
    let release = Release::of(swing);
    let halves = half_swings(swing.first, release.half_swing);
    let tops = halves.clone().flat_map(|k| top_gaps(swing, k)).flatten();
    let late = halves.filter_map(|k| late_gap(swing, k));
    let others = bend_gap(swing, &release).into_iter().chain(end_margin(swing, release.half_swing));
    let gaps = tops.chain(late).chain(others);
    *least = gaps.fold(*least, |least, gap| least.min(gap.abs()));
    let velocity = super::swing::half_swing_sign(release.half_swing) * release.velocity;
    SlipPhase::new(swing.path.impulse(), &release.end, velocity)
}

/// The velocity by which w would have to differ for another `gap` at `at`, as far as that is 0.
///
/// A difference δ of w at the start of the phase is a difference δ sin θ/ω of the gap at the angle
/// θ. If the spring may differ too, the gap differs by at most δ/ω, where √(w² + κy²) does by δ.
fn as_velocity<T: Trajectory>(swing: &Swing<T>, at: &At<T::Motion>, gap: f64, alone: bool) -> f64 {
    let angle = swing.spring.omega * swing.elapsed(at);
    let part = if alone && angle < FRAC_PI_2 { angle.sin() } else { 1.0 };
    swing.spring.omega * gap / part
}

/// The half swings from the `first` to the `last` one on which the spring may come nearest to its
/// limit. The limit rises and then falls, so they are among the first and the last half swings.
fn half_swings(first: u32, last: u32) -> impl Iterator<Item = u32> + Clone {
    const ENDS: u32 = 3;
    let early = first + ENDS;
    (first..=last.min(early)).chain((last.saturating_sub(ENDS)..=last).filter(move |&k| k > early))
}

/// The gaps D, as velocities, where the spring is nearest to its limit on half swing `k`.
fn top_gaps<T: Trajectory>(swing: &Swing<T>, k: u32) -> [Option<f64>; 2] {
    let Some(flanks) = Flanks::of(swing, k) else { return [None; 2] };
    [flanks.top(swing), flanks.second_top(swing)].map(|top| {
        let at = swing.path.at(top?);
        // At impact the spring is 0 without any error.
        Some(as_velocity(swing, &at, swing.gap(k, &at).value, swing.first == AT_IMPACT))
    })
}

/// The gap D, as a velocity, where it is least on half swing `k`, near the end of contact. A spring
/// that falls with its limit is nearest to it there, and relative to the limit at the end itself.
fn late_gap<T: Trajectory>(swing: &Swing<T>, k: u32) -> Option<f64> {
    let at = LateHalfSwing::of(swing, k)?.least(swing)?;
    Some(as_velocity(swing, &at, swing.gap(k, &at).value, swing.first == AT_IMPACT))
}

/// The gap, as a velocity, where it bends upwards again on the first half swing after slip, if the
/// phase does not end before. There it may fall to 0 if the phase starts a little earlier or later.
fn bend_gap<T: Trajectory>(swing: &Swing<T>, release: &Release<T::Motion>) -> Option<f64> {
    let [_, bend] = swing.turns?;
    let start = swing.start.moment;
    let reached = start.is_before(bend) && bend.is_before(release.end.moment);
    let bend = swing.path.at(bend);
    let velocity = || as_velocity(swing, &bend, swing.gap(0, &bend).value, true);
    (reached && swing.first != AT_IMPACT).then(velocity)
}
