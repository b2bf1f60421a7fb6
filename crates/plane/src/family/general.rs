//! Collisions with any contact law, as a family that the tracer can follow.
//!
//! The label of a run says how the contact begins, which guards fire, and whether slip goes on
//! where the normal force begins to attract. The first exit in the name of a margin is not an exit
//! of a guard but the beginning of the contact, so that a margin is followed beyond the contacts
//! that begin so.
//!
//! A run stops soon behind the end of contact. Where the normal force begins to attract, a
//! prescribed itinerary may wait for something that does not come, and the equations without their
//! end would take as many steps as a run may. The normal motion does not depend on the tangential
//! one and is the same at all points of a plane, so its end is known beforehand.

use stickslip_model::general::{
    Beginning, CREST, ContactMode, ContactSystem, GUARDS, GeneralContact, REVERSAL, STATE,
};
use stickslip_model::regularized::{END, OTHER_SIDE, SAME_SIDE};
use stickslip_model::{Contact, Regime, Side};
use stickslip_solver::margin::{
    Exit, FollowedRun, Margin, Margins, Place, follow, margin, margins,
};
use stickslip_solver::{Dop853, Observer, Options, Outcome, Run, Start, State, SwitchEvent, run};
use stickslip_tracer::{FreeRun, Point};

use super::CollisionPlane;
use crate::label::{CollisionEvent, CollisionLabel};

/// What is added to the place of a beginning in its list, where it stands for a guard in the name
/// of a margin.
const BEGINS: usize = GUARDS + 1;
/// The first number that stands for nothing in the names of margins.
pub(super) const BEYOND_GUARDS: usize = BEGINS + BEGINNINGS.len();

const BEGINNINGS: [Beginning; 4] =
    [Beginning::Stick, Beginning::Slip, Beginning::Reset, Beginning::Overturned];

/// Where runs stop that miss the end of contact, as a part of the contact. A margin is needed a
/// little beyond the place where it exists, but an itinerary that is not followed up to there is
/// not followed at all.
const BEYOND: f64 = 1.1;

/// The most steps of the collisions in two corners of the window, from which the limit of all
/// follows. The more a contact is damped that only creeps, the more steps it takes.
const LONGEST: usize = 20_000;

/// Collisions with any law, integrated.
#[derive(Clone, Copy, Debug)]
pub struct GeneralFamily {
    pub(super) plane: CollisionPlane,
    pub(super) options: Options,
    /// Where runs stop that have not come to the end of contact. The normal motion, and with it
    /// the end, is the same at all points of the plane, or between two.
    span: f64,
}

/// What the runs of the family are made of.
type System = (GeneralContact, Start<ContactMode, STATE>);

/// Where else a run is looked at that fails, in parts of what rounding leaves open of a place.
const BESIDE: [(f64, f64); 4] = [(10.0, 0.0), (-10.0, 0.0), (0.0, 10.0), (0.0, -10.0)];

impl GeneralFamily {
    /// The family, with options for every run.
    pub(super) fn new(plane: &CollisionPlane, options: Options) -> Self {
        let motions = plane.normal_motions();
        let stiffest = motions[0].kappa().max(motions[1].kappa());
        let oscillations = stiffest.sqrt().min(1e5);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 1e7")]
        let mut max_steps = 1000 + (100.0 * oscillations) as usize;
        let (mut span, longest) = (0.0_f64, Options { max_steps: LONGEST, ..options });
        for contact in motions {
            let (system, start) = started(&GeneralContact::new(contact));
            match run(Dop853, &system, start, f64::INFINITY, &longest, &mut ()) {
                Ok(Run { outcome: Outcome::EndedByGuard { .. }, s, statistics, .. }) => {
                    span = span.max(BEYOND * s);
                    // A run that follows a prescribed itinerary may never end.
                    max_steps = max_steps.max(4 * (statistics.accepted + statistics.rejected));
                }
                _ => span = f64::INFINITY,
            }
        }
        Self { plane: *plane, options: Options { max_steps, ..options }, span }
    }

    fn system(&self, point: &Point) -> GeneralContact {
        GeneralContact::new(self.plane.contact_or_any(point))
    }

    /// The label of the run at a point. Collisions that cannot be computed have one of their own.
    pub(super) fn label(&self, point: &Point) -> CollisionLabel {
        self.labelled(point).map_or_else(failed, |(label, _)| label)
    }

    /// The label of the run at a point, and its ε_t.
    ///
    /// On a boundary, a last phase can be as short as rounding, so that its guards cannot be looked
    /// at. Then the run beside the point counts, at a distance far below the accuracy of traces.
    pub(super) fn labelled(&self, point: &Point) -> Option<(CollisionLabel, f64)> {
        let errors = Point::from(self.plane.sheet().errors());
        let beside = |(x, y)| self.labelled_at(&(point + errors.component_mul(&Point::new(x, y))));
        self.labelled_at(point).or_else(|| BESIDE.into_iter().find_map(beside))
    }

    fn labelled_at(&self, point: &Point) -> Option<(CollisionLabel, f64)> {
        let (system, start) = started(&self.system(point));
        let mut fired = Fired(vec![CollisionEvent::Begins(system.beginning())]);
        let found = run(Dop853, &system, start, f64::INFINITY, &self.options, &mut fired).ok()?;
        if found.outcome != (Outcome::EndedByGuard { guard: END }) {
            return None;
        }
        fired.0.pop();
        let last = system.last_slip(found.mode, &found.state);
        fired.0.extend(last.and_then(|(guard, _)| CollisionEvent::fired(guard)));
        Some((fired.0, restitution(&system, &found.state)))
    }

    /// ε_t at a point, with the itinerary prescribed that `exits` name, and the exits there.
    pub(super) fn prescribed(&self, point: &Point, exits: &[Exit]) -> Option<(Vec<Exit>, f64)> {
        let (begins, exits) = exits.split_first()?;
        let system = self.system(point).beginning_with(BEGINNINGS[begins.guard - BEGINS]);
        let (system, start) = started(&system);
        // A run that cannot follow the itinerary has no such end.
        let found = follow(Dop853, &system, start, self.span, &self.options, exits).ok()?;
        let FollowedRun { mut exits, run } = found?;
        exits.insert(0, *begins);
        let ended = run.outcome == (Outcome::EndedByGuard { guard: END });
        ended.then(|| (exits, restitution(&system, &run.state)))
    }

    /// The label of the run at a point, and its margins.
    pub(super) fn free_run(&self, point: &Point) -> FreeRun<CollisionLabel, Margin> {
        let (system, start) = started(&self.system(point));
        // Where a last phase is as short as rounding, its guards cannot be looked at. The label is
        // known without them, and changes beside such a point need the margins of its neighbours.
        let Ok(found) = margins(Dop853, &system, start, self.span, &self.options) else {
            return FreeRun { label: self.label(point), margins: Vec::new() };
        };
        let label = known_label(&found, &system).unwrap_or_else(|| self.label(point));
        let begins = Exit::falling(code(system.beginning()), 0.0);
        let mut found: Vec<_> = found
            .near_misses
            .into_iter()
            .map(|miss| (begun(begins, miss.margin), miss.value))
            .filter(|(margin, _)| is_sure(margin))
            .collect();
        let longest = found.iter().map(|(margin, _)| &margin.exits).max_by_key(|exits| exits.len());
        let corners = longest.map_or_else(Vec::new, |exits| corners(&system, exits));
        for corner in corners {
            if let Some(value) = self.margin(point, &corner) {
                found.push((corner, value));
            }
        }
        for (margin, value) in (0..).zip(system.beginning_margins()) {
            found.extend(value.map(|value| (beginning(margin), value)));
        }
        FreeRun { label, margins: found }
    }

    /// The value of a margin at a point, and its name there.
    pub(super) fn near_miss(&self, point: &Point, which: &Margin) -> Option<(Margin, f64)> {
        let system = self.system(point);
        let Some((begins, exits)) = which.exits.split_first() else {
            let Place::Start { derivative } = which.place else { return None };
            let value = system.beginning_margins().into_iter().nth(derivative as usize)?;
            return Some((which.clone(), value?));
        };
        let (system, start) = started(&system.beginning_with(begun_with(begins)));
        let inner = Margin { exits: exits.to_vec(), ..which.clone() };
        // A run that cannot follow the itinerary has no such margin.
        let found = margin(Dop853, &system, start, self.span, &self.options, &inner).ok()??;
        if inner.place == Place::End && found.s >= self.span {
            return None;
        }
        Some((begun(*begins, found.margin), found.value))
    }

    /// The value of a margin at a point.
    pub(super) fn margin(&self, point: &Point, which: &Margin) -> Option<f64> {
        self.near_miss(point, which).map(|(_, value)| value)
    }
}

/// The label of a collision that cannot be computed.
pub fn failed() -> CollisionLabel {
    vec![CollisionEvent::Fails]
}

/// Whether the itinerary changes where a margin vanishes, and not only the order of events.
pub fn is_sure(margin: &Margin) -> bool {
    match margin.place {
        _ if matches!(margin.guard, CREST | REVERSAL) => false,
        Place::Minimum { .. } | Place::Maximum { .. } | Place::End | Place::Branch(_) => true,
        Place::Exit(exit) => exit.guard == END,
        Place::Start { .. } => margin.exits.is_empty(),
        // Collisions have no conditions.
        Place::Condition => false,
    }
}

/// ε_t of a collision that ends in a state.
fn restitution(system: &GeneralContact, end: &State<STATE>) -> f64 {
    system.velocity(end) / system.contact().psi()
}

fn started(system: &GeneralContact) -> System {
    (*system, Start { mode: system.first(), s: 0.0, state: system.start() })
}

/// The label of a free run from its margins. The sign of a margin says whether slip goes on where
/// attraction begins. A last slip that is shorter than rounding does not show in the margins.
fn known_label(found: &Margins, system: &GeneralContact) -> Option<CollisionLabel> {
    if found.outcome != (Outcome::EndedByGuard { guard: END }) {
        return None;
    }
    let slips_on = found.near_misses.iter().find_map(|miss| match miss.margin.place {
        Place::Branch(exit) if exit.guard == END => exit.branch,
        _ => None,
    });
    let mut label = vec![CollisionEvent::Begins(system.beginning())];
    let mut mode = system.first();
    for &guard in &found.fired {
        mode = system.after(mode, guard, slips_on == Some(true));
        match CollisionEvent::fired(guard) {
            Some(CollisionEvent::End) if slips_on? => label.push(CollisionEvent::SlipsOn),
            event => label.extend(event),
        }
    }
    (!system.lacks_slip(mode)).then_some(label)
}

fn code(beginning: Beginning) -> usize {
    BEGINS + BEGINNINGS.iter().position(|other| *other == beginning).unwrap_or(0)
}

fn begun(begins: Exit, mut margin: Margin) -> Margin {
    margin.exits.insert(0, begins);
    margin
}

/// A margin of the beginning itself.
fn beginning(derivative: u32) -> Margin {
    Margin { exits: Vec::new(), guard: SAME_SIDE, place: Place::Start { derivative } }
}

/// The margins of stick phases that a slip follows with which the contact ends, or with which
/// attraction begins: there the limit is zero, and the sign of the tangential force in a longer
/// stick phase decides on which side the contact slips.
fn corners(system: &GeneralContact, exits: &[Exit]) -> Vec<Margin> {
    let mut mode = system.first();
    let mut corners = Vec::new();
    for (place, exit) in exits.iter().enumerate().skip(1) {
        let next = exits.get(place + 1);
        let switches = matches!(exit.guard, SAME_SIDE | OTHER_SIDE);
        if mode.regime == Regime::Stick && switches && next.is_none_or(|next| next.guard == END) {
            let place_of = next.map_or(Place::End, |next| Place::Exit(*next));
            let exits = exits[..place].to_vec();
            corners.push(Margin { exits, guard: SAME_SIDE, place: place_of });
        }
        mode = system.after(mode, exit.guard, exit.branch == Some(true));
    }
    corners
}

/// Records the guards that fire.
struct Fired(CollisionLabel);

impl Observer<ContactMode, STATE> for Fired {
    fn on_switch(&mut self, event: &SwitchEvent<ContactMode, STATE>) {
        let slips_on = event.guard == END && event.to.regime == Regime::Slip;
        match CollisionEvent::fired(event.guard) {
            Some(_) if slips_on => self.0.push(CollisionEvent::SlipsOn),
            event => self.0.extend(event),
        }
    }
}

/// Whether an exit in the name of a margin stands for a beginning.
pub fn is_beginning(exit: &Exit) -> bool {
    exit.guard >= BEGINS
}

/// The beginning that stands for a guard in the first exit of a margin.
pub fn begun_with(exit: &Exit) -> Beginning {
    BEGINNINGS[exit.guard - BEGINS]
}

/// The phases of a collision that begins so, and whose guards fire in this order; `END` with
/// whether slip goes on.
pub fn phases(
    contact: &Contact,
    begins: Option<Beginning>,
    fired: impl Iterator<Item = (usize, bool)>,
) -> Vec<ContactMode> {
    let mut system = GeneralContact::new(*contact);
    if let Some(begins) = begins {
        system = system.beginning_with(begins);
    }
    let mut phases = vec![system.first()];
    for (guard, slips) in fired {
        phases.push(system.after(phases[phases.len() - 1], guard, slips));
    }
    phases
}

/// The itinerary of a collision with this label: one character per phase, and none where it is not
/// known.
pub fn itinerary(contact: &Contact, label: &[CollisionEvent]) -> String {
    if label == failed() {
        return String::new();
    }
    let begins = label.iter().find_map(|event| match event {
        CollisionEvent::Begins(begins) => Some(*begins),
        _ => None,
    });
    let fired =
        label.iter().filter_map(|event| Some((event.guard()?, *event == CollisionEvent::SlipsOn)));
    let mut itinerary = String::new();
    for phase in phases(contact, begins, fired) {
        let character = match (phase.regime, phase.side) {
            (Regime::Stick, _) => 'o',
            (Regime::Slip, Side::Positive) => '+',
            (Regime::Slip, Side::Negative) => '-',
        };
        // Slip that goes on is one phase.
        if !itinerary.ends_with(character) {
            itinerary.push(character);
        }
    }
    itinerary
}
