//! Atlases over the damping, and where their regions are born, merge, split and die.
//!
//! Start reading in [`stack()`](fn@stack).

use std::collections::BTreeMap;

use rayon::prelude::*;
use stickslip_model::InvalidValue;
use stickslip_tracer::{AtlasOptions, Effect, Stack, StackError, StackOptions, Watch};

use crate::atlas::{self, AtlasError, Frame, VerifiedAtlas, itinerary};
use crate::progress::{InParallel, Progress, Report, SILENT};

/// The name of the layout of a stack that is written, with its version.
pub const SCHEMA: &str = "stickslip.stack/1";

/// The atlases of a window at several dampings, and what changes between them.
#[derive(Clone, Debug)]
pub struct DampingStack {
    /// The window. Its damping has no meaning.
    pub frame: Frame,
    /// The atlases, each traced and verified for itself, in the order of the damping.
    pub layers: Vec<DampingLayer>,
    /// What changes between the least damping above 0 and the greatest one, in this order.
    pub changes: Vec<DampingChange>,
    /// The number of atlases that were traced to isolate the changes.
    pub atlases: usize,
}

/// An atlas at one damping.
#[derive(Clone, Debug)]
pub struct DampingLayer {
    /// The damping.
    pub damping: f64,
    /// The atlas, verified by integration.
    pub atlas: VerifiedAtlas,
    /// Whether its regions are those that the changes leave; `None` without damping, and inside the
    /// bracket of a change.
    pub as_stacked: Option<bool>,
}

/// A change of the regions with the damping.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct DampingChange {
    /// The dampings of two atlases between which the change lies.
    pub between: [f64; 2],
    /// The point where special points meet; none if the change is only enclosed.
    pub meeting: Option<DampingMeeting>,
    /// Whether several changes may lie there, since atlases between the two dampings are in doubt,
    /// or differ at dampings that are too close to each other; or whether nothing could be solved
    /// for. A region can be too small to be seen on one side of a change, which then lies beside
    /// the two.
    pub doubtful: bool,
    /// What becomes of regions as the damping grows. If there is nothing, only neighbours change.
    pub effects: Vec<RegionEffect>,
}

/// Where special points of atlases meet.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct DampingMeeting {
    /// What happens.
    pub kind: &'static str,
    /// The damping.
    pub damping: f64,
    /// κ of the place.
    pub kappa: f64,
    /// ψ of the place.
    pub psi: f64,
}

/// What becomes of a region.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct RegionEffect {
    /// `born`, `dies`, `merge` or `splits`.
    pub effect: &'static str,
    /// The switches of the region: one character per phase.
    pub itinerary: String,
}

/// Why there is no stack.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DampingStackError {
    /// The dampings are not possible.
    #[error(
        "{dampings:?}; expected two dampings above 0 or more, in ascending order, and 0 before \
         them or not"
    )]
    Dampings {
        /// The dampings.
        dampings: Vec<f64>,
    },
    /// An atlas failed.
    #[error("damping = {damping:?}: {source}")]
    Atlas {
        /// The damping.
        damping: f64,
        /// The error of the atlas.
        source: AtlasError,
    },
}

/// The atlases of `frame` at `dampings`, which ascend, with boundaries accurate to `tolerance` in
/// ψ, and what changes between them. The first damping may be 0: at every damping above it a
/// contact begins in stick, so that all regions are others, and nothing is followed from there.
///
/// Each atlas is traced as [`atlas::trace`] does it. The changes come from atlases of their own,
/// see [`stickslip_tracer::Stack`]; `as_stacked` tells whether both agree. The atlases are computed
/// on the threads of the current rayon pool. `progress` is told about each of them.
///
/// ```
/// use stickslip_plane::atlas::Frame;
/// use stickslip_plane::{Range, progress, stack};
///
/// let frame = Frame::new(Range { low: 5.0, high: 20.0 }, Range { low: 0.2, high: 2.5 }, 0.0);
/// let tolerance = frame.tolerances().usual;
/// let stack = stack::stack(frame, &[0.05, 0.2], tolerance, progress::SILENT)?;
/// assert!(stack.layers.iter().all(|layer| layer.as_stacked == Some(true)));
/// assert!(stack.changes.iter().all(|change| !change.doubtful));
/// # Ok::<(), stack::DampingStackError>(())
/// ```
///
/// # Errors
/// The dampings, the window or the tolerance are not possible, or a run fails.
pub fn stack(
    frame: Frame,
    dampings: &[f64],
    tolerance: f64,
    progress: Report<'_>,
) -> Result<DampingStack, DampingStackError> {
    let damped = damped(dampings)?;
    let undamped = dampings.len() - damped.len();
    let at = |damping: f64| Frame { damping, ..frame };
    progress(Progress::Begin { steps: dampings.len() });
    let layer = |&damping: &f64| {
        let made = atlas::trace(at(damping), tolerance, SILENT);
        progress(Progress::Advance { steps: 1 });
        let atlas = made.map_err(|source| DampingStackError::Atlas { damping, source })?;
        Ok(DampingLayer { damping, atlas, as_stacked: None })
    };
    let (layers, followed) = rayon::join(
        || dampings.par_iter().map(layer).collect::<Result<Vec<_>, _>>(),
        || follow(&at, damped, tolerance, progress),
    );
    let (mut layers, Followed { changes, labels, atlases }) = (layers?, followed?);
    for (layer, labels) in layers[undamped..].iter_mut().zip(labels) {
        layer.as_stacked = labels.map(|labels| labels == itineraries(&layer.atlas));
    }
    Ok(DampingStack { frame, layers, changes, atlases })
}

/// The dampings above 0, if `dampings` are those of a stack.
///
/// # Errors
/// [`DampingStackError::Dampings`]: they do not ascend, or fewer than two are above 0.
pub fn damped(dampings: &[f64]) -> Result<&[f64], DampingStackError> {
    let damped = &dampings[usize::from(dampings.first() == Some(&0.0))..];
    let ascend = dampings.windows(2).all(|pair| pair[0] < pair[1]);
    if damped.len() >= 2 && ascend && damped.iter().all(|&damping| damping > 0.0) {
        Ok(damped)
    } else {
        Err(DampingStackError::Dampings { dampings: dampings.to_vec() })
    }
}

/// What the search for changes finds.
struct Followed {
    changes: Vec<DampingChange>,
    /// The itineraries of all regions at each damping, in order.
    labels: Vec<Option<Vec<String>>>,
    atlases: usize,
}

fn follow(
    at: &impl Fn(f64) -> Frame,
    dampings: &[f64],
    tolerance: f64,
    progress: Report<'_>,
) -> Result<Followed, DampingStackError> {
    let first = dampings[0];
    let failed = |damping, source| DampingStackError::Atlas { damping, source };
    let plane =
        |damping| at(damping).plane().map_err(|error: InvalidValue| failed(damping, error.into()));
    let sample = plane(first)?;
    for &damping in dampings {
        atlas::require_traceable(&plane(damping)?, tolerance)
            .map_err(|source| failed(damping, source))?;
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
        StackError::Atlas { value, source } => failed(value, AtlasError::of_atlas(&sample, source)),
        StackError::Values | StackError::Width(_) => {
            DampingStackError::Dampings { dampings: dampings.to_vec() }
        }
    })?;
    let any = sample.contact_or_any(&sample.window().low);
    let text = |label: &Vec<usize>| itinerary(&any, label);
    let effect = |effect: &Effect<Vec<usize>>| RegionEffect {
        effect: effect.name(),
        itinerary: text(effect.label()),
    };
    let changes = stack.changes.iter().map(|change| DampingChange {
        between: change.between,
        meeting: change.meeting.map(|meeting| {
            let [kappa, psi] = sample.sheet().snapped(&meeting.point);
            DampingMeeting { kind: meeting.kind.name(), damping: meeting.value, kappa, psi }
        }),
        doubtful: change.is_doubtful(),
        effects: change.effects.iter().map(effect).collect(),
    });
    let labels = dampings.iter().map(|&damping| {
        let labels = stack.labels(damping)?;
        let mut labels: Vec<String> = labels.iter().map(text).collect();
        labels.sort();
        Some(labels)
    });
    Ok(Followed { changes: changes.collect(), labels: labels.collect(), atlases: stack.atlases })
}

/// The itineraries of all regions of an atlas, in order.
fn itineraries(verified: &VerifiedAtlas) -> Vec<String> {
    let atlas = &verified.atlas;
    let regions = 0..atlas.regions.regions().len();
    let mut all: Vec<String> = regions.map(|region| atlas.itinerary(region).to_owned()).collect();
    all.sort();
    all
}

impl DampingLayer {
    /// The numbers of regions with each itinerary.
    #[must_use]
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
    #[must_use]
    pub fn objection(&self) -> Option<String> {
        for layer in &self.layers {
            let at = format!("damping = {:?}", layer.damping);
            if let Some(reason) = layer.atlas.report.objection() {
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
        let doubtful = self.changes.iter().find(|change| change.doubtful)?;
        let [low, high] = doubtful.between;
        Some(if doubtful.meeting.is_some() {
            format!("several changes may lie between the dampings {low:?} and {high:?}")
        } else {
            format!("what changes between the dampings {low:?} and {high:?} is not known")
        })
    }
}

/// A stack in the layout of its file.
#[cfg(feature = "serde")]
#[derive(Clone, Debug, serde::Serialize)]
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
    pub changes: Vec<DampingChange>,
}

/// An atlas in the file of a stack.
#[cfg(feature = "serde")]
#[derive(Clone, Debug, serde::Serialize)]
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

#[cfg(feature = "serde")]
impl From<&DampingStack> for StackDocument {
    fn from(stack: &DampingStack) -> Self {
        let layers = stack.layers.iter().map(|layer| LayerFields {
            damping: layer.damping,
            boundaries: layer.atlas.atlas.regions.curves().len(),
            vertices: layer.atlas.atlas.regions.vertices().len(),
            regions: layer.region_counts(),
            agrees: layer.atlas.report.agrees,
            as_stacked: layer.as_stacked,
        });
        let Frame { kappa, psi, .. } = stack.frame;
        Self {
            schema: SCHEMA,
            kappa: [kappa.low, kappa.high],
            psi: [psi.low, psi.high],
            tolerance: stack.layers.first().map_or(0.0, |layer| layer.atlas.atlas.tolerance),
            atlases: stack.atlases,
            agrees: stack.objection().is_none(),
            layers: layers.collect(),
            changes: stack.changes.clone(),
        }
    }
}
