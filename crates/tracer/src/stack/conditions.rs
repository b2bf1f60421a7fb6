//! What holds where codimension-2 points meet.

use crate::family::Family;
use crate::window::Point;

/// What vanishes at a codimension-2 point.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Condition<Margin> {
    /// A margin.
    Margin(Margin),
    /// The distance from a side of the window, counterclockwise from the lower one.
    CurveSide(usize),
    /// The angle between the boundaries of two conditions in the plane.
    Angle(Box<[Condition<Margin>; 2]>),
    /// The slope of a margin along an axis of the plane.
    Slope(Margin, usize),
}

/// Three conditions for a place in the plane and a value of the third parameter.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Conditions<Margin> {
    pub kind: MeetingKind,
    pub three: [Condition<Margin>; 3],
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
    pub fn of(along: &Condition<Margin>, [first, second]: [&Condition<Margin>; 2]) -> Self {
        let angle = Condition::Angle(Box::new([along.clone(), first.clone()]));
        let (kind, third) = if first != second {
            let sides = [along, first, second].into_iter().filter(|one| one.is_side()).count();
            let kinds = [MeetingKind::Crossing, MeetingKind::Edge, MeetingKind::Corner];
            (kinds[sides.min(2)], second.clone())
        } else if along.is_side() || first.is_side() {
            (MeetingKind::EdgeTouch, angle)
        } else {
            (MeetingKind::Touch, angle)
        };
        Self { kind, three: [along.clone(), first.clone(), third] }
    }

    /// The conditions for a boundary to shrink to a point, or to reconnect: a margin vanishes
    /// together with its gradient in the plane.
    pub fn flat(margin: &Margin) -> Self {
        let slope = |axis| Condition::Slope(margin.clone(), axis);
        let three = [Condition::Margin(margin.clone()), slope(0), slope(1)];
        Self { kind: MeetingKind::Flat, three }
    }

    /// The conditions for three extrema to merge on their zero.
    pub fn swallowtail(margins: [Margin; 3]) -> Self {
        Self { kind: MeetingKind::Swallowtail, three: margins.map(Condition::Margin) }
    }

    /// The same point, where one of two boundaries is known to touch the other: their angle in the
    /// place of the value of one of them, which determines the place to half the digits only.
    pub fn touching(&self, [kept, touching]: [usize; 2]) -> Self {
        let [kept, rest] = [kept, 3 - kept - touching].map(|index| self.three[index].clone());
        let angle = Box::new([kept.clone(), self.three[touching].clone()]);
        Self { kind: self.kind, three: [rest, kept, Condition::Angle(angle)] }
    }

    /// Whether values of margins and distances vanish, and nothing else.
    pub fn are_values(&self) -> bool {
        let is_value = |one: &_| matches!(one, Condition::Margin(_) | Condition::CurveSide(_));
        self.three.iter().all(is_value)
    }

    /// Whether three boundaries, or sides of the window, pass through the point.
    pub fn are_boundaries(&self) -> bool {
        self.are_values() && self.kind != MeetingKind::Swallowtail
    }

    /// Updates the names of margins, which may contain places of minima.
    pub fn move_to<F: Family<Margin = Margin>>(&mut self, family: &F, point: &Point) {
        self.three.iter_mut().for_each(|condition| condition.move_to(family, point));
    }
}

impl<Margin> Condition<Margin> {
    pub const fn is_side(&self) -> bool {
        matches!(self, Self::CurveSide(_))
    }

    fn move_to<F: Family<Margin = Margin>>(&mut self, family: &F, point: &Point) {
        match self {
            Self::Margin(margin) | Self::Slope(margin, _) => {
                if let Ok(moved) = family.moved(point, margin) {
                    *margin = moved;
                }
            }
            Self::CurveSide(_) => {}
            Self::Angle(two) => two.iter_mut().for_each(|one| one.move_to(family, point)),
        }
    }
}
