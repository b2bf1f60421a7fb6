//! The file of the lines on which |ε_t| is 1.

use serde::Serialize;

use super::{Gaining, Line};
use crate::atlas::WindowFields;

/// The name of the layout, with its version.
pub const SCHEMA: &str = "stickslip.gaining/1";

/// Where |ε_t| is above 1, in the layout of its file.
#[derive(Clone, Debug, Serialize)]
pub struct Document {
    /// The name of the layout, [`SCHEMA`].
    pub schema: &'static str,
    /// The window.
    pub window: WindowFields,
    /// The accuracy of the lines in ψ.
    pub tolerance: f64,
    /// Whether nothing speaks against the lines.
    pub agrees: bool,
    /// What speaks against them, in sentences.
    pub objections: Vec<String>,
    /// The lines.
    pub lines: Vec<Line>,
}

impl From<&Gaining> for Document {
    fn from(gaining: &Gaining) -> Self {
        Self {
            schema: SCHEMA,
            window: WindowFields::new(&gaining.frame),
            tolerance: gaining.tolerance,
            agrees: gaining.agrees(),
            objections: gaining.objections(),
            lines: gaining.lines(),
        }
    }
}
