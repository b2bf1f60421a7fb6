//! Where an orbit exists and is stable over two parameters: an atlas.
//!
//! The equations of an orbit with its itinerary have solutions over a surface above the plane of
//! the parameters, which folds over itself. `cover` follows orbits along the lines of a grid, with
//! all that is special on the way, and finds every orbit above a point from the lines around it.
//! `pieces` follows the curves of what is special, and makes regions of them. The regions are those
//! of the tracer, which compares them with the orbits at random points.

mod cover;
mod pieces;

use stickslip_expression::InvalidValue;
use stickslip_tracer::{
    Atlas, AtlasOptions, Names, Vertex, Window,
    regions::VerifyOptions,
    tracing::{Network, TraceStatistics, Unresolved},
};

use crate::branch::{BranchOptions, SpecialKind};
use crate::error::OrbitError;
use crate::find::Orbits;
use crate::orbit::Orbit;
use cover::Cover;

/// The orbits of one itinerary that the system follows at a point of a plane of parameters: how
/// many multipliers of each are outside the unit circle, in ascending order. A stable one has 0.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(transparent))]
pub struct FollowedOrbits(pub Vec<usize>);

impl FollowedOrbits {
    /// Whether one of them is stable.
    #[must_use]
    pub fn has_stable(&self) -> bool {
        self.0.first() == Some(&0)
    }

    /// The orbits in words.
    #[must_use]
    pub fn text(&self) -> String {
        let own = |unstable: &usize| match unstable {
            0 => "stable".to_owned(),
            1 => "unstable".to_owned(),
            more => format!("unstable in {more} directions"),
        };
        let all: Vec<String> = self.0.iter().map(own).collect();
        if all.is_empty() { "none".to_owned() } else { all.join(" and ") }
    }
}

/// What changes on a boundary of the regions of an orbit.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct OrbitBoundary {
    /// What is special there.
    pub kind: SpecialKind,
    /// The segment at which it happens, if it happens at one.
    pub segment: Option<usize>,
    /// The name of the rule.
    pub rule: Option<String>,
}

/// The regions of an orbit.
pub type OrbitAtlas = Atlas<FollowedOrbits, OrbitBoundary>;

/// The names in an atlas of an orbit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OrbitNames {
    /// The names of the two parameters.
    pub axes: [String; 2],
}

impl Names<FollowedOrbits, OrbitBoundary> for OrbitNames {
    fn axes(&self) -> [&str; 2] {
        self.axes.each_ref().map(String::as_str)
    }

    fn text(&self, label: &FollowedOrbits) -> String {
        label.text()
    }

    fn kind(&self, margin: &OrbitBoundary) -> &'static str {
        margin.kind.name()
    }

    fn unresolved(&self, what: &Unresolved<FollowedOrbits>, _: &[Vertex<OrbitBoundary>]) -> String {
        let point = match what {
            Unresolved::Change { between, .. } => &between[0],
            Unresolved::NoLength { point, .. }
            | Unresolved::TooManyNodes { point }
            | Unresolved::TooManyCurves { point } => point,
            Unresolved::Stalled { .. } => return "a boundary ends".to_owned(),
        };
        format!("what changes at {} is not followed", self.place(point))
    }
}

/// How the regions of an orbit are found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegionOptions {
    /// The number of parts into which lines divide each side of the window.
    pub cells: usize,
    /// The accuracy of the boundaries, in parts of the longer side of the window.
    pub tolerance: f64,
    /// Where the regions are compared with orbits. Distances are in parts of the longer side too.
    pub verify: VerifyOptions,
    /// How branches and curves are followed.
    pub branch: BranchOptions,
}

impl Default for RegionOptions {
    fn default() -> Self {
        let verify = VerifyOptions { random_points: 200, near_points: 2, ..Default::default() };
        let verify = VerifyOptions { nearest: 1e-6, ..verify };
        Self { cells: 5, tolerance: 1e-7, verify, branch: BranchOptions::default() }
    }
}

impl RegionOptions {
    /// Checks every field.
    ///
    /// # Errors
    /// [`InvalidValue`] names the first field that is out of its range.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        let Self { cells, tolerance, .. } = *self;
        InvalidValue::check("cells", cells, "1 to 100", (1..=100).contains(&cells))?;
        let accepted = (1e-12..=1e-3).contains(&tolerance);
        InvalidValue::check("tolerance", tolerance, "1e-12 to 1e-3", accepted)?;
        self.branch.validate()
    }

    /// The options of the tracer in a window.
    #[must_use]
    pub fn of_atlas(&self, window: &Window) -> AtlasOptions {
        let size = window.extent().max();
        let VerifyOptions { nearest, farthest, .. } = self.verify;
        let (nearest, farthest) = (nearest * size, farthest * size);
        let verify = VerifyOptions { nearest, farthest, ..self.verify };
        let tolerance = self.tolerance * size;
        AtlasOptions { tolerance, verify, rounds: 1, ..AtlasOptions::default() }
    }
}

impl Orbits {
    /// The regions of an orbit over two parameters: where orbits of its itinerary exist that the
    /// system follows, and whether they are stable. Those are meant that are connected with it
    /// through the window. Each region has a label, and each boundary its kind. What is not
    /// explained makes regions doubtful, as in every [`Atlas`].
    ///
    /// # Errors
    /// [`OrbitError`]: values cannot be used, or the orbit cannot be followed at all.
    pub fn regions(
        &self,
        orbit: &Orbit,
        parameters: [usize; 2],
        [across, up]: [[f64; 2]; 2],
        options: &RegionOptions,
    ) -> Result<OrbitAtlas, OrbitError> {
        options.validate()?;
        self.compiled.with(&orbit.parameters)?;
        let [one, other] = parameters;
        let expected = "the places of two parameters";
        InvalidValue::check("the parameters", one, expected, one != other)?;
        self.require_range(orbit, one, across)?;
        self.require_range(orbit, other, up)?;
        let window = Window { low: [across[0], up[0]].into(), high: [across[1], up[1]].into() };
        let cover = Cover::new(self, orbit, parameters, [across, up], options)?;
        let drawn = pieces::draw(&cover, &window, options)?;
        let statistics = TraceStatistics { nodes: drawn.nodes, ..TraceStatistics::default() };
        let pieces::Drawn { curves, vertices, unresolved, .. } = drawn;
        let network = Network { window, curves, vertices, statistics, unresolved };
        let labels = |points: &[_]| cover.labels(points);
        let atlas = Atlas::verified(network, &options.of_atlas(&window), labels);
        atlas.map_err(|error| OrbitError::Regions(error.to_string()))
    }
}
