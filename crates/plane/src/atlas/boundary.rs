//! What the tracer's guards and margins mean for a collision.

use stickslip_model::general::Mode;
use stickslip_model::regularized::{OTHER_SIDE, Phase};
use stickslip_model::{Contact, Regime, Side};
use stickslip_solver::margin::{Margin, Place};

use crate::family::general;
use crate::label::CollisionEvent;

/// What happens on a boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum BoundaryKind {
    /// A switch falls on the end of contact.
    EndOfContact,
    /// While sticking, the force touches its limit.
    StickGraze,
    /// While sliding, the spring all but sticks.
    SlipGraze,
    /// At the start of contact, the tangential force exceeds its limit.
    StartOfContact,
    /// Where the normal force begins to attract, slip goes on or begins.
    StartOfTail,
}

impl BoundaryKind {
    /// Its name in files and pictures.
    pub const fn name(self) -> &'static str {
        match self {
            Self::EndOfContact => "end-of-contact",
            Self::StickGraze => "stick-graze",
            Self::SlipGraze => "slip-graze",
            Self::StartOfContact => "start-of-contact",
            Self::StartOfTail => "start-of-tail",
        }
    }

    /// The kind of a boundary on which `margin` vanishes.
    pub fn of(contact: &Contact, margin: &Margin) -> Self {
        if !contact.obeys_paper() {
            return Self::of_general(contact, margin);
        }
        let guards = margin.exits.iter().map(|exit| exit.guard);
        match (margin.place, phases(contact, guards).last().map(|phase| phase.regime)) {
            (Place::End, _) => Self::EndOfContact,
            (Place::Minimum { .. }, Some(Regime::Slip)) => Self::SlipGraze,
            // The exact engine has no other places.
            _ => Self::StickGraze,
        }
    }

    /// The same of a contact with any law.
    fn of_general(contact: &Contact, margin: &Margin) -> Self {
        let begins = margin.exits.first().map(general::begun_with);
        let fired = margin.exits.iter().skip(1).map(|exit| (exit.guard, exit.branch == Some(true)));
        let phases = general::phases(contact, begins, fired);
        match (margin.place, phases.last()) {
            (Place::End, _) => Self::EndOfContact,
            (Place::Start { .. }, _) => Self::StartOfContact,
            (Place::Branch(_) | Place::Exit(_), _) => Self::StartOfTail,
            (_, Some(Mode { regime: Regime::Slip, .. })) => Self::SlipGraze,
            _ => Self::StickGraze,
        }
    }
}

/// The itinerary of a collision with this label: one character per phase.
pub(crate) fn itinerary(contact: &Contact, label: &[CollisionEvent]) -> String {
    if !contact.obeys_paper() {
        return general::itinerary(contact, label);
    }
    let character = |phase: Phase| match (phase.regime, phase.side) {
        (Regime::Stick, _) => 'o',
        (Regime::Slip, Side::Positive) => '+',
        (Regime::Slip, Side::Negative) => '-',
    };
    phases(contact, label.iter().filter_map(|event| event.guard())).map(character).collect()
}

/// The first phase of a collision, and the phase after each guard that fired.
fn phases(contact: &Contact, guards: impl Iterator<Item = usize>) -> impl Iterator<Item = Phase> {
    let first = Phase::first(contact);
    let later = guards.scan(first, |phase, guard| {
        *phase = phase.after(guard == OTHER_SIDE);
        Some(*phase)
    });
    std::iter::once(first).chain(later)
}
