//! Margins: how near a collision comes to other switches, also if its switches are prescribed.
//!
//! A margin belongs to a phase in which something almost happened (see
//! [`mod@stickslip_solver::margin`]). The exact engine decides by three numbers. They are its
//! margins:
//!
//! - A slip phase passes the first turn of P = κL + L̈ if g = s·w − dL/dt > 0 there.
//! - A slip phase lasts to the end of contact if g > 0 at the end.
//! - A stick phase passes a half swing if (L/|y|)² − 1 > 0 where |y|/L is largest, and at both of
//!   its tops if it has two. The gap L − |y| vanishes with this number. But the ratio has one
//!   maximum on each half swing, between known places, while the number of minima of the gap is not
//!   known. Near the end of contact the number is linear in the time at which y vanishes; the gap
//!   is not. With damping it is the other way round, and the gap is used (`late`).
//! - With damping, a last stick phase ends on the side on which it does if |y| > 0 at the end of
//!   contact.
//!
//! The name of a top says on which side of the turns it lies. Called first and second, an only top
//! would change its name where another one appears beside it. Where no turn decides, the top has
//! both names.
//!
//! Each margin is smooth through 0 as long as the switches before it are prescribed. A switch that
//! ends slip is prescribed as before or after the turns, a switch that ends stick by the number of
//! the half swing.

use std::f64::consts::PI;

use stickslip_contact::Contact;
use stickslip_contact::phase::{OTHER_SIDE, SAME_SIDE};
use stickslip_solver::margin::{Exit, Hint, Margin, Place};

use super::cusp;
use super::error::{ExactError, checked, too_many};
use super::flank::Flanks;
use super::late::{LateHalfSwing, at_end, beyond_end};
use super::moment::{At, Moment, Motion};
use super::names::{NAMES, TURN, flank_of, guard, numbered, stick_exit};
use super::normal::Trajectory;
use super::phases::{Phase, Task, with_trajectory};
use super::release::Release;
use super::slide::Slide;
use super::slip::SlipPhase;
use super::swing::{Gap, Swing, half_swing_sign};

/// Most switches of a collision whose margins are listed. Each margin names the switches before it:
/// the length of a list grows as the square of their number.
const MOST_SWITCHES: usize = 1000;

/// The guards that fire in a collision, in order, with its margins.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactMargins {
    /// The guard of each switch, [`SAME_SIDE`] or [`OTHER_SIDE`].
    pub fired: Vec<usize>,
    /// The margins in the order of their phases, each with its positive value.
    pub near_misses: Vec<(Margin, f64)>,
}

/// All margins of the collision of `contact`.
///
/// Margins of slip are in units of the reduced velocity w; margins of stick are (L/|y|)² − 1. Up to
/// κ = 400 their zeros are within 1e-15 of the boundaries in ψ.
///
/// ```
/// use stickslip_contact::Contact;
/// use stickslip_exact::exact;
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
pub fn margins(contact: &Contact) -> Result<ContactMargins, ExactError> {
    checked(contact)?;
    with_trajectory(contact, All)
}

/// Finds all margins.
struct All;

impl Task for All {
    type Output = Result<ContactMargins, ExactError>;

    fn run<T: Trajectory>(self, slide: &Slide<T>, contact: &Contact) -> Self::Output {
        let mut found = ContactMargins { fired: Vec::new(), near_misses: Vec::new() };
        let mut exits = Vec::new();
        let mut sliding = match Phase::first(slide, contact.psi()) {
            Phase::Slip(sliding) => sliding,
            Phase::Stick(swing) => passed(&swing, &mut exits, &mut found),
        };
        loop {
            let onset = slide.stick_onset(&sliding);
            let at_turn = slide.turn_margin(&sliding).filter(|&value| value >= 0.0);
            let lasts = onset.is_none().then(|| slide.end_margin(&sliding));
            for (place, value) in [(AT_TURN, at_turn), (Place::End, lasts)] {
                let margin = || Margin { exits: exits.clone(), guard: SAME_SIDE, place };
                found.near_misses.extend(value.map(|value| (margin(), value)));
            }
            let Some(onset) = onset else { return Ok(found) };
            if found.fired.len() + 2 > MOST_SWITCHES {
                return Err(too_many(contact, MOST_SWITCHES, slide, onset));
            }
            exits.push(slip_exit(slide, onset));
            found.fired.push(SAME_SIDE);
            sliding = passed(&swing(slide, &sliding, onset), &mut exits, &mut found);
        }
    }
}

/// The slip phase after `swing`, whose margins are added to `found` and its exit to `exits`.
fn passed<T: Trajectory>(
    swing: &Swing<T>,
    exits: &mut Vec<Exit>,
    found: &mut ContactMargins,
) -> SlipPhase {
    let release = Release::of(swing);
    let mut after_top = false;
    for k in swing.first..=release.half_swing {
        let tops = Tops::of(swing, k).listed().map(|top| top.filter(|&value| value >= 0.0));
        for (place, value) in [top_place(k), second_top_place(k)].into_iter().zip(tops) {
            let margin = || Margin { exits: exits.clone(), guard: guard(k), place };
            found.near_misses.extend(value.map(|value| (margin(), value)));
        }
        after_top = tops[0].is_some();
    }
    let missed = end_margin(swing, release.half_swing);
    found.near_misses.extend(missed.map(|value| {
        let guard = guard(release.half_swing + 1);
        (Margin { exits: exits.clone(), guard, place: Place::End }, value)
    }));
    exits.push(stick_exit(release.half_swing, after_top));
    found.fired.push(guard(release.half_swing));
    released(swing, release.half_swing, release.end)
}

/// The margin `which`, one of the [`margins`] of any contact, of the collision of `contact` with
/// the switches that `which` prescribes.
///
/// It is `None` if these switches cannot be followed, or if there is no such half swing or crest.
///
/// ```
/// use stickslip_contact::Contact;
/// use stickslip_exact::exact;
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
/// [`ExactError::Domain`] as [`margins`].
pub fn margin(contact: &Contact, which: &Margin) -> Result<Option<f64>, ExactError> {
    Ok(follow(contact, which, |_| ())?.and_then(|(_, value)| value))
}

/// The margin `which` with hints that fit the collision of `contact`, as
/// [`stickslip_solver::margin::margin()`] returns it. A margin that does not exist is returned
/// unchanged. Only the margin of a half swing's single top gets the name that [`margins`] would
/// give it.
///
/// # Errors
/// As [`margin`].
pub fn moved(contact: &Contact, which: &Margin) -> Result<Margin, ExactError> {
    let mut exits = Vec::with_capacity(which.exits.len());
    let found = follow(contact, which, |exit| exits.push(exit))?;
    Ok(found.map_or_else(|| which.clone(), |(place, _)| Margin { exits, place, ..*which }))
}

/// Follows the switches that `which` prescribes, calls `on_exit` with each, and returns the place
/// in the name of the margin there, with its value if it exists.
fn follow(
    contact: &Contact,
    which: &Margin,
    on_exit: impl FnMut(Exit),
) -> Result<Option<(Place, Option<f64>)>, ExactError> {
    checked(contact)?;
    Ok(with_trajectory(contact, Prescribed { which, on_exit }))
}

/// Finds one margin with the switches that it prescribes.
struct Prescribed<'m, E> {
    which: &'m Margin,
    on_exit: E,
}

impl<E: FnMut(Exit)> Task for Prescribed<'_, E> {
    type Output = Option<(Place, Option<f64>)>;

    fn run<T: Trajectory>(mut self, slide: &Slide<T>, contact: &Contact) -> Self::Output {
        let which = self.which;
        let mut exits = which.exits.iter();
        let mut phase = Phase::first(slide, contact.psi());
        loop {
            let sliding = match phase {
                Phase::Slip(sliding) => sliding,
                Phase::Stick(swing) => {
                    let Some(exit) = exits.next() else { return margin_of_stick(&swing, which) };
                    let (k, after_top) = flank_of(exit);
                    let flanks = if k < swing.first { None } else { Flanks::of(&swing, k) };
                    let (moment, after_top) = flanks?.exit(&swing, after_top)?;
                    (self.on_exit)(stick_exit(k, after_top));
                    released(&swing, k, slide.path.at(moment))
                }
            };
            let Some(exit) = exits.next() else {
                let value = match which.place {
                    Place::End => Some(slide.end_margin(&sliding)),
                    Place::Minimum { number, .. } => cusp::of_slip(slide, &sliding, number),
                    _ => None,
                };
                return value.map(|value| (which.place, Some(value)));
            };
            let onset = prescribed_onset(slide, &sliding, exit)?;
            (self.on_exit)(slip_exit(slide, onset));
            phase = Phase::Stick(swing(slide, &sliding, onset));
        }
    }
}

/// The place of the first turn of a slip phase.
const AT_TURN: Place = Place::Minimum { near: Hint(0.0), number: TURN };

/// The margins of the tops of R on one half swing, before the turns and after them.
#[derive(Clone, Copy, Debug)]
struct Tops {
    /// Both margins. The only top of a half swing has both names if no turn decides.
    values: [Option<f64>; 2],
    /// Which name the only top is listed with.
    only: Option<usize>,
}

impl Tops {
    /// 1/R² − 1 at the tops of R on half swing `k`, or what a [`LateHalfSwing`] has instead of the
    /// last.
    ///
    /// On the first half swing after slip this number has a double zero at the start of the phase.
    /// It is divided by the square of the angle since then, so that it is not flat where the length
    /// of the phase goes to 0.
    fn of<T: Trajectory>(swing: &Swing<T>, k: u32) -> Self {
        let none = Self { values: [None; 2], only: None };
        let Some(flanks) = Flanks::of(swing, k) else { return none };
        let at_top = |top: Option<Moment>| {
            let top = swing.path.at(top?);
            let Gap { value, q, .. } = swing.gap(k, &top);
            let excess = value / q * (value / q + 2.0);
            let angle = swing.spring.omega * swing.elapsed(&top);
            Some(if k == 0 { excess / (angle * angle) } else { excess })
        };
        let late = LateHalfSwing::of(swing, k);
        let last = |top: Option<Moment>| match &late {
            Some(late) => late.margin(swing),
            None => at_top(top).or_else(|| beyond_end(swing, k)),
        };
        if flanks.rises_again() {
            let values = [at_top(flanks.top(swing)), last(flanks.second_top(swing))];
            return Self { values, only: None };
        }
        let value = last(flanks.top(swing));
        let values = flanks.called().map(|is| value.filter(|_| is));
        Self { values, only: Some(usize::from(flanks.is_after(swing))) }
    }

    /// Both margins, each top with one name.
    fn listed(&self) -> [Option<f64>; 2] {
        let [before, after] = self.values;
        match self.only {
            None => self.values,
            Some(0) => [before, None],
            Some(_) => [None, after],
        }
    }
}

/// The place of the top before the turns on half swing `k` among these tops on its side.
fn top_place(k: u32) -> Place {
    numbered(k, TOP)
}

/// The place of the top after the turns.
fn second_top_place(k: u32) -> Place {
    numbered(k, SECOND)
}

/// What the numbers of tops before the turns are counted from.
const TOP: usize = 0;

/// What the numbers of tops after the turns are counted from.
const SECOND: usize = NAMES;

/// The margin `which`, of the phase `swing`, after its place.
fn margin_of_stick<T: Trajectory>(
    swing: &Swing<T>,
    which: &Margin,
) -> Option<(Place, Option<f64>)> {
    let Place::Minimum { number, .. } = which.place else {
        let side = if which.guard == SAME_SIDE { -1.0 } else { 1.0 };
        return Some((which.place, Some(side * swing.spring.omega * at_end(swing).0)));
    };
    let (number, what) = (number % NAMES, number - number % NAMES);
    let k = u32::try_from(number).ok()?.checked_mul(2)? + u32::from(which.guard == OTHER_SIDE);
    if k < swing.first {
        return None;
    }
    if !matches!(what, TOP | SECOND) {
        return Some((which.place, Some(cusp::of_stick(swing, k, what)?)));
    }
    let tops = Tops::of(swing, k);
    let value = tops.values[usize::from(what == SECOND)];
    match tops.only {
        None => value.map(|value| (which.place, Some(value))),
        Some(0) => Some((top_place(k), value)),
        Some(_) => Some((second_top_place(k), value)),
    }
}

/// ω|y| at the end of contact, if the phase would last until then without its exit on half swing
/// `k`, and if the exit is as late as the contact's end where y vanishes there.
///
/// That is so if the spring is slower than its limit there, and if both half swings between which y
/// changes its sign can have an exit. On the first one after slip R only falls. There y vanishes
/// without a change of its sign, with the length of the phase.
pub fn end_margin<T: Trajectory>(swing: &Swing<T>, k: u32) -> Option<f64> {
    let sign = half_swing_sign(k);
    let limit_rate = swing.path.motion(Moment::END).limit_rate(&swing.spring);
    let (y, w) = at_end(swing);
    let last = swing.moment_at_angle(f64::from(k) * PI) == Moment::END;
    let rises_at_first = swing.turns.is_some_and(|[turn, _]| swing.start.moment.is_before(turn));
    let least = if rises_at_first { 0 } else { swing.first.max(1) };
    let possible = sign * w < 0.0 || k > least;
    (last && possible && limit_rate < 0.0 && sign * w > limit_rate)
        .then_some(sign * swing.spring.omega * y)
}

/// The exit at the end of a slip phase; its hint is 0 before the split of the turns and 1 after it.
fn slip_exit<T: Trajectory>(slide: &Slide<T>, onset: Moment) -> Exit {
    let after = if onset.is_before(slide.path.split()) { 0.0 } else { 1.0 };
    Exit::falling(SAME_SIDE, after)
}

/// The moment at which the slip phase ends as `exit` prescribes.
fn prescribed_onset<T: Trajectory>(
    slide: &Slide<T>,
    sliding: &SlipPhase,
    exit: &Exit,
) -> Option<Moment> {
    let Some([_, turn]) = slide.turns else { return slide.stick_onset(sliding) };
    if exit.after.0 < 0.5 {
        return slide.onset_before_turn(sliding);
    }
    // After the second turn g falls: it must still be positive there.
    let low = sliding.start.or_later(turn);
    let within = slide.guard(sliding, &slide.path.at(low)) >= 0.0;
    if within { slide.onset_after_turn(sliding) } else { None }
}

/// The stick phase that starts at `onset`.
pub fn swing<'t, T: Trajectory>(
    slide: &Slide<'t, T>,
    sliding: &SlipPhase,
    onset: Moment,
) -> Swing<'t, T> {
    let start = slide.path.at(onset);
    Swing::new(slide, start, sliding.velocity_at(&start))
}

/// The slip phase that starts where `swing` ends on half swing `k`.
fn released<T: Trajectory>(swing: &Swing<T>, k: u32, end: At<T::Motion>) -> SlipPhase {
    let (_, velocity) = swing.motion(swing.elapsed(&end));
    SlipPhase::new(swing.path.impulse(), &end, half_swing_sign(k) * velocity)
}
