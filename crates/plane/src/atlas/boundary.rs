//! What the tracer's margins mean for a collision.

use stickslip_model::general::ContactMode;
use stickslip_model::{Contact, Regime};
use stickslip_solver::margin::{Margin, Place};

use crate::family::general;

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
        // Margins of the exact engine name no beginning, since the paper's law has one alone.
        let (begins, exits) = match margin.exits.split_first() {
            Some((first, exits)) if general::is_beginning(first) => (Some(first), exits),
            _ => (None, &margin.exits[..]),
        };
        let fired = exits.iter().map(|exit| (exit.guard, exit.branch == Some(true)));
        let phases = general::phases(contact, begins.map(general::begun_with), fired);
        match (margin.place, phases.last()) {
            (Place::End, _) => Self::EndOfContact,
            (Place::Start { .. }, _) => Self::StartOfContact,
            (Place::Branch(_) | Place::Exit(_) | Place::Condition, _) => Self::StartOfTail,
            (_, Some(ContactMode { regime: Regime::Slip, .. })) => Self::SlipGraze,
            _ => Self::StickGraze,
        }
    }
}
