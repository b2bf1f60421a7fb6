//! A part of the reproduction with its data.
//!
//! The page, the text and the JSON of `reproduce` are made of sections alone. A new part is a new
//! [`Part`](super::Part): a title, and a function that returns a section.

use std::sync::Arc;

use stickslip_figure::pictures::studies::Picture;
use stickslip_model::Engine;
use stickslip_plane::atlas::CollisionAtlas;
use stickslip_plane::sweep::FailureCount;
use stickslip_studies::{Study, StudyColumn};

use super::sweep::Sweep;
use crate::statements::Audit;

/// A study with everything else that belongs to it.
#[derive(Debug)]
pub struct ReportSection {
    /// What was computed.
    pub study: Study,
    /// Its pictures.
    pub pictures: Vec<Picture>,
    /// The names of those of its tables that a page shows.
    pub shown: Vec<&'static str>,
    /// The statements of the paper with their verdicts, in the part that tests them.
    pub audit: Option<Audit>,
    /// Data beside those of the study.
    pub files: Vec<DataFile>,
    /// What speaks against its results.
    pub objections: Vec<String>,
}

/// Data for a file.
#[derive(Clone, Debug)]
pub struct DataFile {
    /// The name of the file.
    pub name: String,
    /// What the file holds.
    pub title: String,
    /// The content of the file.
    pub content: Content,
}

/// The content of a file.
#[derive(Clone, Debug)]
pub enum Content {
    /// A map.
    Map(Arc<Sweep>),
    /// An atlas.
    Atlas(Arc<CollisionAtlas>),
}

/// The main results of all `sections`, a sentence each: the opening of a page that shows them.
pub fn headlines(sections: &[ReportSection]) -> Vec<String> {
    sections.iter().flat_map(|section| &section.study.headlines).cloned().collect()
}

impl ReportSection {
    /// A study with its pictures, and nothing else.
    pub fn new(study: Study, pictures: Vec<Picture>) -> Self {
        let (shown, files, objections) = (Vec::new(), Vec::new(), Vec::new());
        Self { study, pictures, shown, audit: None, files, objections }
    }

    /// The names of all files with data, and what they hold.
    pub fn data(&self) -> Vec<(String, &str)> {
        let tables = self.study.tables.iter();
        let tables = tables.map(|table| (format!("{}.csv", table.name), table.title.as_str()));
        let files = self.files.iter().map(|file| (file.name.clone(), file.title.as_str()));
        tables.chain(files).collect()
    }

    /// The section with a map as `name`.npz, and with what speaks against the map.
    pub(super) fn with_map(mut self, name: &str, title: String, sweep: &Arc<Sweep>) -> Self {
        let name = format!("{name}.npz");
        let mut count = FailureCount::default();
        count.add(0, &sweep.results);
        if let Some(failed) = count.failed(&sweep.grid, Engine::Exact) {
            let (count, points) = (failed.points, sweep.grid.points());
            self.objections.push(format!(
                "{name}: {count} of {points} points could not be computed; the first, {failed}"
            ));
        }
        self.files.push(DataFile { name, title, content: Content::Map(Arc::clone(sweep)) });
        self
    }

    /// The section with an atlas as `name`, and with what speaks against the atlas.
    pub(super) fn with_atlas(
        mut self,
        name: &str,
        title: &str,
        atlas: &Arc<CollisionAtlas>,
    ) -> Self {
        let (name, title) = (name.to_owned(), title.to_owned());
        if let Some(reason) = atlas.objection() {
            let what = "the atlas is complete, but may be wrong";
            self.objections.push(format!("{name}: {what}: {reason}"));
        }
        self.files.push(DataFile { name, title, content: Content::Atlas(Arc::clone(atlas)) });
        self
    }
}

pub const AXIS: StudyColumn =
    StudyColumn::headed("axis", "axis", "the reading of the axis of stiffness");
pub const KAPPA: StudyColumn = StudyColumn::headed("kappa", "κ", "κ of (24)");
pub const RATIO: StudyColumn = StudyColumn::headed("ratio", "g_t/g_n", "impact ratio g_t/g_n");
pub const POINT: StudyColumn = StudyColumn::headed("point", "point", "point of Figure 4");
pub const SWITCHES: StudyColumn =
    StudyColumn::headed("switch_count", "switches", "number of switches");
pub const PHASES: StudyColumn =
    StudyColumn::headed("itinerary", "phases", "the phases, one character for each");
pub const EPS_T: StudyColumn = StudyColumn::headed("eps_t", "ε_t", "tangential restitution ε_t");

/// The course of a collision in time.
pub const COURSE: [StudyColumn; 4] = [
    StudyColumn::new("time", "scaled time"),
    StudyColumn::new("normal_force", "F_n in units of m β^{2/5} g_n^{6/5}"),
    StudyColumn::new("tangential_force", "F_t/μ in the same units"),
    StudyColumn::new("velocity", "w = (α/μ) g_t/g_n"),
];
