//! What holds where codimension-2 points meet.

use crate::family::Family;
use crate::window::Point;

/// What vanishes at a codimension-2 point.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Condition<Margin> {
    /// A margin.
    Margin(Margin),
    /// The distance from a side of the window, counterclockwise from the lower one.
    Side(usize),
}

/// Three conditions for a place in the plane and a value of the third parameter.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Conditions<Margin> {
    /// All three vanish.
    Three([Condition<Margin>; 3]),
    /// Both vanish, and their gradients in the plane are parallel.
    Parallel([Condition<Margin>; 2]),
    /// The first two vanish, and the gradients of the second and the third are parallel: the third
    /// is known to touch the second there, and its value would determine the place to half the
    /// digits only.
    Tangent([Condition<Margin>; 3]),
    /// A margin vanishes together with its gradient in the plane.
    Flat(Margin),
    /// All three margins vanish, and with them three extrema merge on their zero.
    Merged([Margin; 3]),
}

/// What happens at a value of the third parameter where the structure changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum MeetingKind {
    /// Three boundaries pass through one point.
    Crossing,
    /// Two boundaries touch.
    Touch,
    /// A boundary shrinks to a point, or two parts of it reconnect.
    Flat,
    /// Two boundaries cross on the edge of the window.
    Edge,
    /// A boundary touches the edge of the window.
    EdgeTouch,
    /// A boundary passes through a corner of the window.
    Corner,
    /// Three extrema of a guard merge on its zero: two cusps of boundaries and a crossing between
    /// them become one point.
    Swallowtail,
}

impl MeetingKind {
    /// The name, in lower case and with hyphens.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Crossing => "crossing",
            Self::Touch => "touch",
            Self::Flat => "flat",
            Self::Edge => "edge",
            Self::EdgeTouch => "edge-touch",
            Self::Corner => "corner",
            Self::Swallowtail => "swallowtail",
        }
    }
}

impl<Margin: Clone + PartialEq> Conditions<Margin> {
    /// The conditions for the ends of a stretch of the arrangement to meet: what vanishes along it,
    /// and what else vanishes at its ends.
    pub fn of(along: &Condition<Margin>, ends: [&Condition<Margin>; 2]) -> Self {
        let [first, second] = ends;
        if first == second {
            Self::Parallel([along.clone(), first.clone()])
        } else {
            Self::Three([along, first, second].map(Clone::clone))
        }
    }

    /// What happens where the conditions hold.
    pub fn kind(&self) -> MeetingKind {
        let sides = |conditions: &[Condition<Margin>]| {
            conditions.iter().filter(|one| matches!(one, Condition::Side(_))).count()
        };
        match self {
            Self::Three(conditions) | Self::Tangent(conditions) => match sides(conditions) {
                0 => MeetingKind::Crossing,
                1 => MeetingKind::Edge,
                _ => MeetingKind::Corner,
            },
            Self::Parallel(conditions) if sides(conditions) == 0 => MeetingKind::Touch,
            Self::Parallel(_) => MeetingKind::EdgeTouch,
            Self::Flat(_) => MeetingKind::Flat,
            Self::Merged(_) => MeetingKind::Swallowtail,
        }
    }

    fn each_margin(&mut self, mut change: impl FnMut(&mut Margin)) {
        let mut all = |conditions: &mut [Condition<Margin>]| {
            for condition in conditions {
                if let Condition::Margin(margin) = condition {
                    change(margin);
                }
            }
        };
        match self {
            Self::Three(conditions) | Self::Tangent(conditions) => all(conditions),
            Self::Parallel(conditions) => all(conditions),
            Self::Flat(margin) => change(margin),
            Self::Merged(margins) => margins.iter_mut().for_each(change),
        }
    }

    /// Updates the names of margins, which may contain places of minima.
    pub fn move_to<F: Family<Margin = Margin>>(&mut self, family: &F, point: &Point) {
        self.each_margin(|margin| {
            if let Ok(moved) = family.moved(point, margin) {
                *margin = moved;
            }
        });
    }
}
