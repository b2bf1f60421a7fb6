//! Atlases over the damping, and where their regions are born, merge, split and die.
//!
//! Start reading in [`stack()`](fn@stack).

use std::collections::BTreeMap;

use rayon::prelude::*;
use stickslip_model::InvalidValue;
#[cfg(feature = "serde")]
use stickslip_tracer::stack::{Effect, StackMeeting};
use stickslip_tracer::{
    AtlasOptions, TraceError, Watch,
    stack::{Change, Stack, StackOptions},
};

use crate::atlas::{self, AtlasError, CollisionAtlas, Frame, itinerary};
use crate::family::CollisionPlane;
use crate::label::CollisionLabel;
use crate::progress::{InParallel, Progress, Report, SILENT};

/// The name of the layout of its file, with its version.
#[cfg(feature = "serde")]
pub const SCHEMA: &str = "stickslip.stack/1";

/// The atlases of a window at several dampings, and what changes between them.
#[derive(Clone, Debug)]
pub struct DampingStack {
    /// The collisions at the least damping above 0. The window is that of all.
    pub plane: CollisionPlane,
    /// The atlases, each traced and verified for itself, in the order of the damping.
    pub layers: Vec<DampingLayer>,
    /// What changes between the least damping above 0 and the greatest one, in this order, with
    /// itineraries as labels.
    pub changes: Vec<Change<String>>,
    /// The number of atlases that were traced to isolate the changes.
    pub atlases: usize,
}

/// An atlas at one damping.
#[derive(Clone, Debug)]
pub struct DampingLayer {
    /// The damping.
    pub damping: f64,
    /// The atlas, verified by integration.
    pub atlas: CollisionAtlas,
    /// Whether its regions are those that the changes leave; `None` without damping, and inside the
    /// bracket of a change.
    pub as_stacked: Option<bool>,
}

/// The atlases of `frame` at `dampings`, which ascend, with boundaries accurate to `tolerance` in
/// ψ, and what changes between them. The first damping may be 0: at every damping above it a
/// contact begins in stick, so that all regions are others, and nothing is followed from there.
///
/// Each atlas is traced as [`atlas::trace`] does it. The changes come from atlases of their own,
/// see [`stickslip_tracer::stack::Stack`]; `as_stacked` tells whether both agree. The atlases are
/// computed on the threads of the current rayon pool. `progress` is told about each of them.
///
/// ```
/// use stickslip_plane::atlas::Frame;
/// use stickslip_plane::{Range, atlas, progress, stack};
///
/// let frame = Frame::new(Range { low: 5.0, high: 20.0 }, Range { low: 0.2, high: 2.5 }, 0.0);
/// let tolerance = frame.tolerances().usual;
/// let stack = stack::stack(frame, &[0.05, 0.2], tolerance, progress::SILENT)?;
/// assert!(stack.layers.iter().all(|layer| layer.as_stacked == Some(true)));
/// assert!(stack.changes.iter().all(|change| !change.is_doubtful()));
/// # Ok::<(), atlas::AtlasError>(())
/// ```
///
/// # Errors
/// The dampings, the window or the tolerance are not possible, or a run fails.
pub fn stack(
    frame: Frame,
    dampings: &[f64],
    tolerance: f64,
    progress: Report<'_>,
) -> Result<DampingStack, AtlasError> {
    let damped = damped(dampings)?;
    let undamped = dampings.len() - damped.len();
    let at = |damping: f64| Frame { damping, ..frame };
    progress(Progress::Begin { steps: dampings.len() });
    let layer = |&damping: &f64| {
        let made = atlas::trace(at(damping), tolerance, SILENT);
        progress(Progress::Advance { steps: 1 });
        let layer = |atlas| DampingLayer { damping, atlas, as_stacked: None };
        made.map(layer).map_err(|source| at_damping(damping, source))
    };
    let (layers, followed) = rayon::join(
        || dampings.par_iter().map(layer).collect::<Result<Vec<_>, _>>(),
        || follow(&at, damped, tolerance, progress),
    );
    let (mut layers, Followed { plane, changes, labels, atlases }) = (layers?, followed?);
    for (layer, labels) in layers[undamped..].iter_mut().zip(labels) {
        layer.as_stacked = labels.map(|labels| labels == itineraries(&layer.atlas));
    }
    Ok(DampingStack { plane, layers, changes, atlases })
}

/// The dampings above 0, if `dampings` are those of a stack.
///
/// # Errors
/// [`AtlasError::Dampings`]: they do not ascend, or fewer than two are above 0.
pub fn damped(dampings: &[f64]) -> Result<&[f64], AtlasError> {
    let damped = &dampings[usize::from(dampings.first() == Some(&0.0))..];
    let ascend = dampings.windows(2).all(|pair| pair[0] < pair[1]);
    if damped.len() >= 2 && ascend && damped.iter().all(|&damping| damping > 0.0) {
        Ok(damped)
    } else {
        Err(AtlasError::Dampings { dampings: dampings.to_vec() })
    }
}

/// The error of an atlas at a damping.
fn at_damping(damping: f64, source: AtlasError) -> AtlasError {
    AtlasError::Layer { damping, source: Box::new(source) }
}

/// What the search for changes finds.
struct Followed {
    /// The collisions at the least damping.
    plane: CollisionPlane,
    changes: Vec<Change<String>>,
    /// The itineraries of all regions at each damping, in order.
    labels: Vec<Option<Vec<String>>>,
    atlases: usize,
}

fn follow(
    at: &impl Fn(f64) -> Frame,
    dampings: &[f64],
    tolerance: f64,
    progress: Report<'_>,
) -> Result<Followed, AtlasError> {
    let first = dampings[0];
    let plane = |damping| {
        at(damping).plane().map_err(|error: InvalidValue| at_damping(damping, error.into()))
    };
    let sample = plane(first)?;
    for &damping in dampings {
        atlas::require_traceable(&plane(damping)?, tolerance)
            .map_err(|source| at_damping(damping, source))?;
    }
    // Between two possible dampings all are possible.
    let family = |damping: f64| plane(damping).unwrap_or(sample).family();
    let options = StackOptions {
        atlas: AtlasOptions {
            trace: atlas::trace_options(&sample, tolerance),
            tolerance: sample.sheet().resolution(tolerance),
            ..AtlasOptions::default()
        },
        ..StackOptions::default()
    };
    let (window, watch) = (sample.window(), Watch::from(progress));
    let made = Stack::watched(family, &window, dampings, &options, InParallel, watch);
    let stack = made.map_err(|error| match error {
        TraceError::Layer { value, source } => at_damping(value, AtlasError::of(&sample, *source)),
        _ => AtlasError::Dampings { dampings: dampings.to_vec() },
    })?;
    let any = sample.contact_or_any(&sample.window().low);
    let text = |label: &CollisionLabel| itinerary(&any, label);
    let changes = stack.changes.iter().map(|change| change.map(text)).collect();
    let labels = dampings.iter().map(|&damping| {
        let labels = stack.labels(damping)?;
        let mut labels: Vec<String> = labels.iter().map(text).collect();
        labels.sort();
        Some(labels)
    });
    let (labels, atlases) = (labels.collect(), stack.atlases);
    Ok(Followed { plane: sample, changes, labels, atlases })
}

/// The itineraries of all regions of an atlas, in order.
fn itineraries(atlas: &CollisionAtlas) -> Vec<String> {
    let regions = 0..atlas.regions.regions().len();
    let mut all: Vec<String> = regions.map(|region| atlas.itinerary(region).to_owned()).collect();
    all.sort();
    all
}

impl DampingLayer {
    /// The numbers of regions with each itinerary.
    pub fn region_counts(&self) -> BTreeMap<String, usize> {
        let mut counts = BTreeMap::new();
        for itinerary in itineraries(&self.atlas) {
            *counts.entry(itinerary).or_insert(0) += 1;
        }
        counts
    }
}

impl DampingStack {
    /// Why something in the stack may be wrong: the first atlas against which something speaks or
    /// which does not fit the changes, or the first change in doubt.
    pub fn objection(&self) -> Option<String> {
        for layer in &self.layers {
            let at = format!("damping = {:?}", layer.damping);
            if let Some(reason) = layer.atlas.objection() {
                return Some(format!("{at}: {reason}"));
            }
            if layer.as_stacked == Some(false) {
                return Some(format!("{at}: the regions are not those that the changes leave"));
            }
            let beside = |[low, high]: [f64; 2]| (low..=high).contains(&layer.damping);
            let in_change = self.changes.iter().any(|change| beside(change.between));
            if layer.damping > 0.0 && layer.as_stacked.is_none() && !in_change {
                return Some(format!("{at}: changes on both sides are not known"));
            }
        }
        self.changes.iter().find_map(|change| change.objection("dampings"))
    }
}

#[cfg(feature = "serde")]
impl DampingStack {
    /// The stack in the layout of its file, [`SCHEMA`]. Without damping, and inside the bracket of
    /// a change, `as_stacked` is `null`.
    pub fn document(&self) -> serde_json::Value {
        use serde_json::json;

        let layer = |layer: &DampingLayer| {
            json!({
                "damping": layer.damping,
                "boundaries": layer.atlas.regions.curves().len(),
                "vertices": layer.atlas.regions.vertices().len(),
                "regions": layer.region_counts(),
                "agrees": layer.atlas.report.agrees,
                "as_stacked": layer.as_stacked,
            })
        };
        let meeting = |meeting: StackMeeting| {
            let [kappa, psi] = self.plane.sheet().snapped(&meeting.point);
            let kind = meeting.kind.name();
            json!({ "kind": kind, "damping": meeting.value, "kappa": kappa, "psi": psi })
        };
        let effect = |effect: &Effect<String>| {
            let (name, itinerary) = (effect.name(), effect.label());
            json!({ "effect": name, "itinerary": itinerary })
        };
        let change = |change: &Change<String>| {
            json!({
                "between": change.between,
                "meeting": change.meeting.map(meeting),
                "doubtful": change.is_doubtful(),
                "effects": change.effects.iter().map(effect).collect::<Vec<_>>(),
            })
        };
        let [kappa, psi] = self.plane.sheet().sides;
        json!({
            "schema": SCHEMA,
            "kappa": [kappa.low, kappa.high],
            "psi": [psi.low, psi.high],
            "tolerance": self.layers.first().map_or(0.0, |layer| layer.atlas.tolerance),
            "atlases": self.atlases,
            "agrees": self.objection().is_none(),
            "layers": self.layers.iter().map(layer).collect::<Vec<_>>(),
            "changes": self.changes.iter().map(change).collect::<Vec<_>>(),
        })
    }
}
