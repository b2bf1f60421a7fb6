//! The file of a stack over the damping.

use std::collections::BTreeMap;

use serde::Serialize;
use stickslip_tracer::{Change, Effect, Meeting};

use super::DampingStack;
use crate::family::CollisionPlane;

/// The name of the layout, with its version.
pub const SCHEMA: &str = "stickslip.stack/1";

/// A stack in the layout of its file.
#[derive(Clone, Debug, Serialize)]
pub struct StackDocument {
    /// The name of the layout, [`SCHEMA`].
    pub schema: &'static str,
    /// Lower and upper end of the scaled stiffness κ.
    pub kappa: [f64; 2],
    /// Lower and upper end of the reduced impact ratio ψ.
    pub psi: [f64; 2],
    /// Accuracy of the boundaries in ψ.
    pub tolerance: f64,
    /// The number of atlases that were traced to isolate the changes.
    pub atlases: usize,
    /// Whether nothing speaks against the stack.
    pub agrees: bool,
    /// The atlases.
    pub layers: Vec<LayerFields>,
    /// What changes between them.
    pub changes: Vec<ChangeFields>,
}

/// An atlas in the file of a stack.
#[derive(Clone, Debug, Serialize)]
pub struct LayerFields {
    /// The damping.
    pub damping: f64,
    /// The number of boundaries.
    pub boundaries: usize,
    /// The number of vertices.
    pub vertices: usize,
    /// The number of regions with each itinerary.
    pub regions: BTreeMap<String, usize>,
    /// Whether nothing speaks against the atlas.
    pub agrees: bool,
    /// Whether its regions are those that the changes leave; `null` without damping and inside the
    /// bracket of a change.
    pub as_stacked: Option<bool>,
}

/// A change of the regions in the file of a stack.
#[derive(Clone, Debug, Serialize)]
pub struct ChangeFields {
    /// The dampings of two atlases between which the change lies.
    pub between: [f64; 2],
    /// The point where special points meet; none if the change is only enclosed.
    pub meeting: Option<MeetingFields>,
    /// Whether several changes may lie there, or nothing could be solved for.
    pub doubtful: bool,
    /// What becomes of regions as the damping grows.
    pub effects: Vec<EffectFields>,
}

/// Where special points of atlases meet, in the file of a stack.
#[derive(Clone, Debug, Serialize)]
pub struct MeetingFields {
    /// What happens.
    pub kind: &'static str,
    /// The damping.
    pub damping: f64,
    /// κ of the place.
    pub kappa: f64,
    /// ψ of the place.
    pub psi: f64,
}

/// What becomes of a region, in the file of a stack.
#[derive(Clone, Debug, Serialize)]
pub struct EffectFields {
    /// `born`, `dies`, `merge` or `splits`.
    pub effect: &'static str,
    /// The switches of the region: one character per phase.
    pub itinerary: String,
}

impl From<&DampingStack> for StackDocument {
    fn from(stack: &DampingStack) -> Self {
        let layers = stack.layers.iter().map(|layer| LayerFields {
            damping: layer.damping,
            boundaries: layer.atlas.regions.curves().len(),
            vertices: layer.atlas.regions.vertices().len(),
            regions: layer.region_counts(),
            agrees: layer.atlas.report.agrees,
            as_stacked: layer.as_stacked,
        });
        let [kappa, psi] = stack.plane.sheet().sides;
        let changes = stack.changes.iter().map(|change| ChangeFields::new(&stack.plane, change));
        Self {
            schema: SCHEMA,
            kappa: [kappa.low, kappa.high],
            psi: [psi.low, psi.high],
            tolerance: stack.layers.first().map_or(0.0, |layer| layer.atlas.tolerance),
            atlases: stack.atlases,
            agrees: stack.objection().is_none(),
            layers: layers.collect(),
            changes: changes.collect(),
        }
    }
}

impl ChangeFields {
    fn new(plane: &CollisionPlane, change: &Change<String>) -> Self {
        let meeting = |meeting: Meeting| {
            let [kappa, psi] = plane.sheet().snapped(&meeting.point);
            MeetingFields { kind: meeting.kind.name(), damping: meeting.value, kappa, psi }
        };
        let effect = |effect: &Effect<String>| EffectFields {
            effect: effect.name(),
            itinerary: effect.label().clone(),
        };
        Self {
            between: change.between,
            meeting: change.meeting.map(meeting),
            doubtful: change.is_doubtful(),
            effects: change.effects.iter().map(effect).collect(),
        }
    }
}
