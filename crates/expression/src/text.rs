//! Systems as text: read, written and formatted.
//!
//! `tokens` divides a text into words and signs, and `reader` goes through them. `formula` reads
//! formulas, `condition` what is true or not, `rules` what happens when, and `statements` the rest.
//! `print` writes a system, under names that are `readable`, and `format` a text in its usual form.

mod condition;
mod format;
mod formula;
mod names;
mod print;
mod readable;
mod reader;
mod rules;
mod statements;
mod tokens;

use std::fmt;

pub use format::format;

/// Why a text is not a system: where, and what was expected.
///
/// ```
/// use stickslip_expression::System;
///
/// let error = System::parse("state x = 1\nx' = -x\nwhen x < limit -> end").unwrap_err();
/// assert_eq!((error.line, error.column), (3, 10));
/// assert!(error.to_string().starts_with("line 3, column 10: `limit` is not known"));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextError {
    /// The line, from 1.
    pub line: usize,
    /// The column, from 1, in characters.
    pub column: usize,
    /// What is wrong.
    pub message: String,
    /// The line itself.
    pub source: String,
}

impl TextError {
    fn at(text: &str, offset: usize, message: String) -> Self {
        let before = &text[..offset.min(text.len())];
        let start = before.rfind('\n').map_or(0, |end| end + 1);
        let source = text[start..].lines().next().unwrap_or("");
        Self {
            line: before.matches('\n').count() + 1,
            column: before[start..].chars().count() + 1,
            message,
            source: source.to_owned(),
        }
    }
}

impl fmt::Display for TextError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { line, column, message, source } = self;
        writeln!(f, "line {line}, column {column}: {message}")?;
        // What is in front of a very long line's error is left out.
        let skipped = column.saturating_sub(61);
        let shown: String = source.chars().skip(skipped).take(100).collect();
        let shown = shown.replace(|c: char| c.is_control(), " ");
        writeln!(f, "    {shown}")?;
        write!(f, "    {}^", " ".repeat(column - 1 - skipped))
    }
}

impl std::error::Error for TextError {}
