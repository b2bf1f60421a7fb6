//! Collisions of a family with one boundary: where |ε_t| is 1.
//!
//! ε_t is continuous, but has kinks where the itinerary changes. With the itinerary prescribed it
//! is smooth, so that the boundary has another margin for each itinerary, and a vertex where the
//! itinerary changes. Labels do not tell itineraries: whatever these do, the regions are those of
//! |ε_t|.

use stickslip_model::CollisionError;
use stickslip_model::general::{CREST, REVERSAL};
use stickslip_solver::margin::{Exit, Margin, Place};
use stickslip_tracer::{Family, FreeRun, Point};

use super::CollisionPlane;
use super::general::{self, BEYOND_GUARDS, GeneralFamily};
use crate::label::{CollisionEvent, CollisionLabel};

/// What stands for a guard in the margin 1 − ε_t.
const FORWARD: usize = BEYOND_GUARDS;
/// What stands for a guard in the margin 1 + ε_t.
const BACKWARD: usize = BEYOND_GUARDS + 1;

/// Collisions with any law, with labels that say whether |ε_t| is above 1, and nothing else.
#[derive(Clone, Copy, Debug)]
pub struct GainingFamily(GeneralFamily);

impl GainingFamily {
    /// The collisions of a plane, integrated as for any law.
    pub(super) fn new(plane: &CollisionPlane) -> Self {
        Self(plane.general())
    }

    fn level(&self, point: &Point, which: &Margin) -> Option<(Margin, f64)> {
        let (exits, eps_t) = self.0.prescribed(point, &which.exits)?;
        let value = if which.guard == FORWARD { 1.0 - eps_t } else { 1.0 + eps_t };
        Some((Margin { exits, ..which.clone() }, value))
    }
}

/// Whether collisions with this label have |ε_t| above 1.
pub fn gains(label: &[CollisionEvent]) -> bool {
    use CollisionEvent::{GainsBackward, GainsForward};
    matches!(label.last(), Some(GainsForward | GainsBackward))
}

/// ε_t where this margin vanishes, if that makes it 1 in size.
pub fn level(margin: &Margin) -> Option<f64> {
    match margin.guard {
        FORWARD => Some(1.0),
        BACKWARD => Some(-1.0),
        _ => None,
    }
}

fn is_level(margin: &Margin) -> bool {
    level(margin).is_some()
}

fn labelled(eps_t: f64) -> CollisionLabel {
    let forward = (eps_t > 1.0).then_some(CollisionEvent::GainsForward);
    let backward = (eps_t < -1.0).then_some(CollisionEvent::GainsBackward);
    forward.into_iter().chain(backward).collect()
}

impl Family for GainingFamily {
    type Label = CollisionLabel;
    type Margin = Margin;
    type Error = CollisionError;

    fn label(&self, point: &Point) -> Result<CollisionLabel, CollisionError> {
        let found = self.0.labelled(point);
        Ok(found.map_or_else(general::failed, |(_, eps_t)| labelled(eps_t)))
    }

    fn margin(&self, point: &Point, margin: &Margin) -> Result<Option<f64>, CollisionError> {
        let found = if is_level(margin) {
            self.level(point, margin).map(|(_, value)| value)
        } else {
            self.0.margin(point, margin)
        };
        Ok(found)
    }

    fn moved(&self, point: &Point, margin: &Margin) -> Result<Margin, CollisionError> {
        let found = if is_level(margin) {
            self.level(point, margin)
        } else {
            self.0.near_miss(point, margin)
        };
        Ok(found.map_or_else(|| margin.clone(), |(moved, _)| moved))
    }

    fn is_sure(&self, margin: &Margin) -> bool {
        is_level(margin)
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<CollisionLabel, Margin>, CollisionError> {
        let FreeRun { label, mut margins } = self.0.free_run(point);
        // Margins of the last phase have all exits.
        let is_whole = |exits: &Vec<Exit>| {
            let listed = |exit: &&Exit| !matches!(exit.guard, CREST | REVERSAL);
            exits.iter().filter(listed).count() == label.len()
        };
        let exits = margins.iter().map(|(margin, _)| &margin.exits).find(|exits| is_whole(exits));
        let Some(exits) = exits.cloned() else {
            return Ok(FreeRun { label: self.label(point)?, margins });
        };
        for guard in [FORWARD, BACKWARD] {
            let margin = Margin { exits: exits.clone(), guard, place: Place::End };
            margins.extend(self.level(point, &margin));
        }
        Ok(FreeRun { label: self.label(point)?, margins })
    }
}
