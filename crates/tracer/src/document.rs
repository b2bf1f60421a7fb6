//! The file of an atlas of any family: how it is made, and how it is read back.

use serde::{Deserialize, Serialize};
use stickslip_solver::InvalidValue;
use stickslip_solver::margin::Margin;

use crate::atlas::{Atlas, AtlasOptions, doubtful};
use crate::curve::{Curve, Vertex};
use crate::hybrid::Itinerary;
use crate::names::{Names, RunNames};
use crate::regions::finding::SubdivisionError;
use crate::regions::region::Region;
use crate::regions::subdivision::Subdivision;
use crate::regions::verify::report::Verification;
use crate::tracing::network::{TraceStatistics, Unresolved};
use crate::tracing::tracer::stage::Stage;
use crate::tracing::tracer::state::State;
use crate::window::{Point, Window};

/// The name of the layout, with its version.
pub const SCHEMA: &str = "stickslip.family-atlas/1";

/// An atlas in the layout of its file, for every format that serde writes.
///
/// The file answers in which region a point lies without the code of the family. An atlas that was
/// cancelled is written with all that [`Surveyor::resume`](crate::Surveyor::resume) needs to go on.
/// Numbers must be written and read exactly; `serde_json` does so with its feature
/// `float_roundtrip`.
///
/// ```
/// use std::convert::Infallible;
/// use stickslip_tracer::document::FamilyAtlasDocument as Document;
/// use stickslip_tracer::{Family, FreeRun, Point, Surveyor, Watch, Window};
///
/// /// A guard that fires left of a sine.
/// struct Sine;
///
/// impl Family for Sine {
///     type Label = String;
///     type Margin = String;
///     type Error = Infallible;
///     fn label(&self, p: &Point) -> Result<String, Infallible> {
///         Ok(if p.x < p.y.sin() { "fires" } else { "rests" }.to_owned())
///     }
///     fn margin(&self, p: &Point, _: &String) -> Result<Option<f64>, Infallible> {
///         Ok(Some(p.x - p.y.sin()))
///     }
///     fn free_run(&self, p: &Point) -> Result<FreeRun<String, String>, Infallible> {
///         let margins = vec![("distance".to_owned(), p.x - p.y.sin())];
///         Ok(FreeRun { label: self.label(p)?, margins })
///     }
/// }
///
/// let window = Window { low: Point::new(-2.0, -2.0), high: Point::new(2.0, 2.0) };
/// let cancelled = Surveyor { watch: Watch::SILENT.cancelled_by(&|| true), ..Surveyor::default() };
/// let begun = cancelled.atlas(&Sine, &window)?;
/// let axes = ["position in m", "angle in rad"];
/// let text = serde_json::to_string(&Document::new(&begun, &cancelled.options, "sine", axes))?;
///
/// // Another program goes on.
/// let document: Document<String, String> = serde_json::from_str(&text)?;
/// assert_eq!(document.family, "sine");
/// let surveyor = Surveyor { options: document.options, ..Surveyor::default() };
/// let atlas = surveyor.resume(&Sine, document.atlas()?)?;
/// assert!(atlas.agrees());
///
/// // A third one has no family, and knows the regions all the same.
/// let text = serde_json::to_string(&Document::new(&atlas, &surveyor.options, "sine", axes))?;
/// let read = serde_json::from_str::<Document<String, String>>(&text)?.atlas()?;
/// assert_eq!(read.plane.curves(), atlas.plane.curves());
/// assert_eq!(read.label(&Point::new(0.5, 0.2)).unwrap(), "rests");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FamilyAtlasDocument<Label, Margin> {
    /// The name of the layout, [`SCHEMA`].
    pub schema: String,
    /// What was traced, in words of the caller.
    pub family: String,
    /// The names of the two coordinates, with their units.
    pub axes: [String; 2],
    /// The names of the guards that the labels of a hybrid system count; empty if they have none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub guards: Vec<String>,
    /// The window.
    pub window: Window,
    /// The options of the survey.
    pub options: AtlasOptions,
    /// The curves.
    pub curves: Vec<Curve<Label, Margin>>,
    /// The vertices.
    pub vertices: Vec<Vertex<Margin>>,
    /// The regions between the curves.
    pub regions: Vec<Region<Label>>,
    /// What the trace could not explain.
    pub unresolved: Vec<Unresolved<Label>>,
    /// What the comparison with runs found.
    pub verification: Verification<Label, String>,
    /// The work of the trace.
    pub statistics: TraceStatistics,
    /// The number of rounds.
    pub rounds: usize,
    /// Where the survey goes on; none if it is finished.
    #[serde(default = "Option::default", skip_serializing_if = "Option::is_none")]
    unfinished: Option<Box<State<Label, Margin>>>,
}

/// The reason why a document is not an atlas.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DocumentError {
    /// The document has another layout.
    #[error("schema = {found:?}: expected {SCHEMA:?}")]
    Schema {
        /// The name of its layout.
        found: String,
    },
    /// An option is out of its range.
    #[error("options: {0}")]
    Option(#[from] InvalidValue),
    /// The curves do not make regions.
    #[error(transparent)]
    Subdivision(#[from] SubdivisionError),
    /// The regions that the curves make are not those that the document lists.
    #[error("the curves make other regions than the document lists")]
    Regions,
    /// An index or a count in the document does not fit the rest of it.
    #[error("{list} = {index} does not fit the document, which has {count}")]
    Index {
        /// Where the index stands.
        list: &'static str,
        /// The index or count.
        index: usize,
        /// The number that it has to fit.
        count: usize,
    },
}

impl<Label: Clone + Ord, Margin: Clone> FamilyAtlasDocument<Label, Margin> {
    /// The document of an atlas that was made with `options`. `family` and `axes` say in words what
    /// was traced; the coordinates have units there.
    pub fn new(
        atlas: &Atlas<Label, Margin>,
        options: &AtlasOptions,
        family: &str,
        axes: [&str; 2],
    ) -> Self {
        Self {
            schema: SCHEMA.to_owned(),
            family: family.to_owned(),
            axes: axes.map(str::to_owned),
            guards: Vec::new(),
            window: *atlas.plane.window(),
            options: AtlasOptions { tolerance: atlas.plane.tolerance(), ..*options },
            curves: atlas.plane.curves().to_vec(),
            vertices: atlas.plane.vertices().to_vec(),
            regions: atlas.plane.regions().to_vec(),
            unresolved: atlas.unresolved.clone(),
            verification: atlas.verification.clone(),
            statistics: atlas.statistics,
            rounds: atlas.rounds,
            unfinished: atlas.unfinished.clone(),
        }
    }

    /// Whether the survey came to its end.
    #[must_use]
    pub fn is_finished(&self) -> bool {
        self.unfinished.is_none()
    }

    /// Reads the atlas back. The regions are made from the curves again, and what is in doubt is
    /// found again, so that a document cannot hide it.
    ///
    /// # Errors
    /// [`DocumentError`]: the document contradicts itself.
    pub fn atlas(self) -> Result<Atlas<Label, Margin>, DocumentError> {
        if self.schema != SCHEMA {
            return Err(DocumentError::Schema { found: self.schema });
        }
        self.options.trace.validate()?;
        let Self { window, curves, vertices, options, unresolved, verification, .. } = self;
        let mut plane = Subdivision::new(window, curves, vertices, options.tolerance)?;
        let known = |sample: &Point| self.regions.iter().find(|region| region.sample == *sample);
        plane.label_rest(|sample| known(sample)?.label.clone());
        if plane.regions() != self.regions {
            return Err(DocumentError::Regions);
        }
        for mismatch in &verification.mismatches {
            within("mismatches[..].region", mismatch.region, plane.regions().len())?;
        }
        require_vertices(&unresolved, plane.vertices().len())?;
        let unfinished = self.unfinished;
        if let Some(state) = &unfinished {
            require_state(state, &window, &options)?;
        }
        let doubtful = doubtful(&plane, &unresolved, &verification);
        let (statistics, rounds) = (self.statistics, self.rounds);
        within("rounds", 0, rounds)?;
        Ok(Atlas { plane, unresolved, verification, statistics, rounds, doubtful, unfinished })
    }
}

impl FamilyAtlasDocument<Itinerary, Margin> {
    /// The document of an atlas of a hybrid system that was made with `options`.
    #[must_use]
    pub fn of_runs(
        atlas: &Atlas<Itinerary, Margin>,
        options: &AtlasOptions,
        names: &RunNames,
    ) -> Self {
        let guards = names.guards.clone();
        Self { guards, ..Self::new(atlas, options, &names.family, names.axes()) }
    }

    /// The names in an atlas of a hybrid system.
    #[must_use]
    pub fn names(&self) -> RunNames {
        let Self { family, axes, guards, .. } = self;
        RunNames { family: family.clone(), axes: axes.clone(), guards: guards.clone() }
    }
}

/// Refuses an index that is not below `count`.
fn within(list: &'static str, index: usize, count: usize) -> Result<(), DocumentError> {
    if index < count { Ok(()) } else { Err(DocumentError::Index { list, index, count }) }
}

/// Refuses vertices that do not exist.
fn require_vertices<Label>(
    unresolved: &[Unresolved<Label>],
    count: usize,
) -> Result<(), DocumentError> {
    for what in unresolved {
        if let Unresolved::Stalled { vertex } = what {
            within("unresolved[..].vertex", *vertex, count)?;
        }
    }
    Ok(())
}

/// Refuses a state from which a tracer could not go on.
fn require_state<Label, Margin>(
    state: &State<Label, Margin>,
    window: &Window,
    options: &AtlasOptions,
) -> Result<(), DocumentError> {
    let State { network, uncertainties, suspects, probed, stage, .. } = state;
    let traced = window.with_room(options.trace.beyond);
    SubdivisionError::check(&traced, &network.curves, &network.vertices, options.tolerance)?;
    let [curves, vertices] = [network.curves.len(), network.vertices.len()];
    let (corners, theirs) = (traced.corners(), network.window.corners());
    within("unfinished.network.window", usize::from(corners != theirs), 1)?;
    require_vertices(&network.unresolved, vertices)?;
    if uncertainties.len() != vertices {
        let (list, index) = ("unfinished.uncertainties", uncertainties.len());
        return Err(DocumentError::Index { list, index, count: vertices });
    }
    for suspect in suspects {
        within("unfinished.suspects[..]", *suspect, curves)?;
    }
    within("unfinished.probed", *probed, vertices + 1)?;
    let cells = options.trace.cells;
    let (next, count) = match stage {
        Stage::Edges { next } => (*next, 8 * cells),
        Stage::Grid { next } => (*next, 2 * cells * cells),
        Stage::Islands { next, .. } => (*next, cells * cells + 1),
        Stage::Pairs { next, pairs } => (*next, pairs.len() + 1),
        Stage::CloseVertices { next } => (*next, vertices + 1),
        Stage::Settle | Stage::Polish | Stage::Done => (0, 1),
    };
    within("unfinished.stage.next", next, count)
}
