//! A part of the reproduction.

use std::sync::Arc;

use stickslip_plane::atlas::VerifiedAtlas;
use stickslip_plane::sweep::Failed;

use super::sweep::Sweep;
use crate::study::Study;

/// A study with what else belongs to it.
#[derive(Debug)]
pub struct Section {
    /// What was computed.
    pub study: Study,
    /// The names of its tables that a page shows.
    pub shown: Vec<&'static str>,
    /// Data beside those of the study.
    pub files: Vec<DataFile>,
    /// What speaks against its results.
    pub objections: Vec<Objection>,
}

/// Data for a file.
#[derive(Clone, Debug)]
pub struct DataFile {
    /// The file's name.
    pub name: String,
    /// What it holds.
    pub title: String,
    /// Its content.
    pub content: Content,
}

/// The content of a file.
#[derive(Clone, Debug)]
pub enum Content {
    /// A map.
    Map(Arc<Sweep>),
    /// An atlas.
    Atlas(Arc<VerifiedAtlas>),
}

/// Something that speaks against a result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Objection {
    /// Points of a map have no result.
    #[error("{file}: {} of {points} points could not be computed; the first, {failed}", failed.points)]
    Points {
        /// The file of the map.
        file: String,
        /// Its number of points.
        points: usize,
        /// The points without a result.
        failed: Failed,
    },
    /// An atlas may be wrong.
    #[error("{file}: the atlas is complete, but may be wrong: {reason}")]
    Doubtful {
        /// The file of the atlas.
        file: String,
        /// What its verification found.
        reason: String,
    },
}

impl From<Study> for Section {
    fn from(study: Study) -> Self {
        Self { study, shown: Vec::new(), files: Vec::new(), objections: Vec::new() }
    }
}

impl Section {
    /// The names of all files with data, and what they hold.
    #[must_use]
    pub fn data(&self) -> Vec<(String, &str)> {
        let tables = self.study.tables.iter();
        let tables = tables.map(|table| (format!("{}.csv", table.name), table.title.as_str()));
        let files = self.files.iter().map(|file| (file.name.clone(), file.title.as_str()));
        tables.chain(files).collect()
    }
}

impl DataFile {
    /// The file of an atlas, and what speaks against it.
    pub(super) fn atlas(
        name: &str,
        title: &str,
        atlas: &Arc<VerifiedAtlas>,
    ) -> (Self, Option<Objection>) {
        let (file, title) = (name.to_owned(), title.to_owned());
        let objection = atlas.report.objection();
        let objection = objection.map(|reason| Objection::Doubtful { file: file.clone(), reason });
        (Self { name: file, title, content: Content::Atlas(Arc::clone(atlas)) }, objection)
    }
}
