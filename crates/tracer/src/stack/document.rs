//! The file of a stack of any family.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use stickslip_solver::margin::Margin;

use crate::atlas::AtlasOptions;
use crate::hybrid::Itinerary;
use crate::names::{Names, RunNames};
use crate::stack::change::Change;
use crate::stack::{Layer, Stack, StackOptions};
use crate::window::Window;

/// The name of the layout, with its version.
pub const SCHEMA: &str = "stickslip.family-stack/1";

/// A stack in the layout of its file: the contents of its atlases, and the changes between them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StackDocument<Label> {
    /// The name of the layout, `stickslip.family-stack/1`.
    pub schema: String,
    /// What was traced, in words of the caller.
    pub family: String,
    /// The names of the two coordinates and of the third parameter, with their units.
    pub axes: [String; 3],
    /// The names of the guards that the labels of a hybrid system count; empty if they have none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub guards: Vec<String>,
    /// The window; `None` if there is no atlas.
    pub window: Option<Window>,
    /// The options of every atlas.
    pub options: AtlasOptions,
    /// The width of the bracket of a change.
    pub width: f64,
    /// The number of atlases that were traced.
    pub atlases: usize,
    /// What speaks against the stack; `None` if nothing does.
    pub objection: Option<String>,
    /// The atlases at the given values.
    pub layers: Vec<LayerDocument<Label>>,
    /// The changes between the atlases, in the order of the third parameter.
    pub changes: Vec<Change<Label>>,
}

/// An atlas in the file of a stack.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LayerDocument<Label> {
    /// The value of the third parameter.
    pub value: f64,
    /// The number of curves.
    pub curves: usize,
    /// The number of vertices.
    pub vertices: usize,
    /// Each label with the number of regions that have it, in order. Regions without a label are
    /// in doubt.
    pub regions: Vec<(Option<Label>, usize)>,
    /// Whether nothing speaks against the atlas.
    pub agrees: bool,
}

impl<Label: Clone + Ord + std::fmt::Debug> StackDocument<Label> {
    /// The document of a stack that was made with `options`.
    pub fn new<M: Clone + PartialEq>(
        stack: &Stack<Label, M>,
        options: &StackOptions,
        family: &str,
        axes: [&str; 3],
    ) -> Self {
        Self {
            schema: SCHEMA.to_owned(),
            family: family.to_owned(),
            axes: axes.map(str::to_owned),
            guards: Vec::new(),
            window: stack.layers.first().map(|layer| *layer.atlas.plane.window()),
            options: options.atlas,
            width: options.width,
            atlases: stack.atlases,
            objection: stack.objection(),
            layers: stack.layers.iter().map(LayerDocument::new).collect(),
            changes: stack.changes.clone(),
        }
    }
}

impl StackDocument<Itinerary> {
    /// The document of a stack of a hybrid system over its parameter `over`.
    #[must_use]
    pub fn of_runs(
        stack: &Stack<Itinerary, Margin>,
        options: &StackOptions,
        names: &RunNames,
        over: &str,
    ) -> Self {
        let ([x, y], guards) = (names.axes(), names.guards.clone());
        Self { guards, ..Self::new(stack, options, &names.family, [x, y, over]) }
    }
}

impl<Label: Clone + Ord> LayerDocument<Label> {
    fn new<M: Clone>(layer: &Layer<Label, M>) -> Self {
        let plane = &layer.atlas.plane;
        let mut regions = BTreeMap::new();
        for region in plane.regions() {
            *regions.entry(region.label.clone()).or_insert(0) += 1;
        }
        Self {
            value: layer.value,
            curves: plane.curves().len(),
            vertices: plane.vertices().len(),
            regions: regions.into_iter().collect(),
            agrees: layer.atlas.agrees(),
        }
    }
}
