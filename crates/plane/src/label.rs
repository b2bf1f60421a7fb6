//! The labels of collisions: what happens, in order.

use stickslip_model::general::Beginning;
use stickslip_model::regularized::{END, OTHER_SIDE, SAME_SIDE};
use stickslip_model::{Collision, Side};

/// What a label of a collision lists, in order.
///
/// With the paper's law these are the guards that fire before the end. With another law, the label
/// begins with [`Self::Begins`]. The order of the variants is the order of labels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum CollisionEvent {
    /// The normal force begins to attract, and the contact sticks from there on, or ends.
    End,
    /// Stick turns into slip, or slip into stick, on the side of the tangential force before.
    SameSide,
    /// The same on the other side.
    OtherSide,
    /// The normal force begins to attract, and slip goes on.
    SlipsOn,
    /// How the contact begins.
    Begins(Beginning),
    /// At the end, ε_t is above 1.
    GainsForward,
    /// At the end, ε_t is below −1.
    GainsBackward,
    /// The collision cannot be computed.
    Fails,
}

/// The label of a collision.
pub type CollisionLabel = Vec<CollisionEvent>;

impl CollisionEvent {
    /// A guard that fires; `None` for one that labels do not list.
    pub(crate) fn fired(guard: usize) -> Option<Self> {
        match guard {
            END => Some(Self::End),
            SAME_SIDE => Some(Self::SameSide),
            OTHER_SIDE => Some(Self::OtherSide),
            _ => None,
        }
    }

    /// The guard that fires.
    pub(crate) fn guard(self) -> Option<usize> {
        match self {
            Self::End | Self::SlipsOn => Some(END),
            Self::SameSide => Some(SAME_SIDE),
            Self::OtherSide => Some(OTHER_SIDE),
            _ => None,
        }
    }

    /// The label of a collision with the paper's law, whichever engine computed it.
    pub fn label(collision: &Collision) -> CollisionLabel {
        let mut side = Side::Positive;
        let event = |switch: &stickslip_model::Switch| {
            let same = std::mem::replace(&mut side, switch.side) == switch.side;
            if same { Self::SameSide } else { Self::OtherSide }
        };
        collision.switches.iter().map(event).collect()
    }
}
