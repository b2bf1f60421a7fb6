//! The page with everything: one file that needs no other, no network and no scripts.
//!
//! It is well-formed XML as well, so that any tool can read it.

mod markup;
pub mod report;

use askama::Template;
use stickslip_figure::markup::plain;
use stickslip_figure::number;
use stickslip_figure::pictures::studies::Picture;
use stickslip_plane::Range;
use stickslip_reproduction::figures::{ReportSection, boundaries, figure2, headlines};
use stickslip_reproduction::statements::{Audit, StatementVerdict};
use stickslip_studies::{Cell, StudyColumn, StudyTable, contact_laws};

use markup::markup;

/// The title of the page and of the report.
pub const TITLE: &str = "Tangential restitution of viscoelastic spheres, computed anew";

/// What stands above everything.
pub const INTRODUCTION: [&str; 2] = [
    "The figures of T. Schwager, V. Becker and T. Pöschel, Coefficient of tangential restitution for \
     viscoelastic spheres, Eur. Phys. J. E 27, 107 (2008), computed anew with every switch between \
     sliding and sticking. Numbers in brackets are those of its equations.",
    "Lengths, times and forces are scaled as there. κ is the scaled stiffness of the tangential \
     spring (24), g_n and g_t are the normal and the tangential impact velocity, ψ = (α/μ) g_t/g_n, \
     a is the scaled damping. The axis that Figures 3 to 6 of the paper call κ can be read in two \
     ways, as κ of (24) and as ακ; both are shown.",
];

/// The most columns of a table that a narrow screen shows side by side.
const MOST_NARROW: usize = 7;

/// The section whose first picture opens the page.
const OPENING: &str = "boundaries";

#[derive(Template)]
#[template(path = "page.html")]
struct Page<'a> {
    title: &'a str,
    introduction: &'a [&'a str],
    /// The command that makes the page.
    command: &'a str,
    sections: &'a [ReportSection],
}

impl Page<'_> {
    /// Whether this is the page with everything.
    fn is_whole(&self) -> bool {
        self.command == "reproduce"
    }

    /// How many pictures of a section stand above its findings.
    fn key(&self) -> usize {
        usize::from(self.is_whole())
    }

    /// The picture at the top, with the section that it leads to: the whole plane.
    fn opening(&self) -> impl Iterator<Item = (&str, &Picture)> {
        let plane = self.sections.iter().filter(|section| section.study.name == OPENING);
        plane.filter_map(|section| section.pictures.first().map(|picture| (OPENING, picture)))
    }

    /// The audits among the parts, of which there is one.
    fn audits(&self) -> impl Iterator<Item = &Audit> {
        self.sections.iter().filter_map(|section| section.audit.as_ref())
    }
}

/// The page with everything.
pub fn html(sections: &[ReportSection]) -> String {
    let (title, introduction, command) = (TITLE, &INTRODUCTION[..], "reproduce");
    // Writing to memory fails only where a value cannot be displayed, and all can.
    Page { title, introduction, command, sections }.render().unwrap_or_default()
}

/// The page of the contact laws.
pub fn laws(mut section: ReportSection) -> String {
    section.shown.push(contact_laws::LAWS);
    let introduction = &[
        "What the contact laws of particle codes do with two spheres, beside the law of Schwager, \
         Becker and Pöschel, with every switch between sliding and sticking located.",
        "Quantities are scaled: x is the overlap, v its rate, w the tangential velocity, y or q the \
         history of the spring, κ its stiffness, ψ = (α/μ) g_t/g_n the impact ratio, a the damping, \
         b the tangential damping. ε_t is g_t after the contact over g_t before.",
    ][..];
    let (title, command, sections) = (contact_laws::TITLE, "laws", &[section][..]);
    // As above.
    Page { title, introduction, command, sections }.render().unwrap_or_default()
}

/// The view of the explorer that shows the plane of a section, as the end of a link.
fn explored(section: &str) -> Option<String> {
    // Braces and quotes of JSON, percent-encoded.
    let axis = |low: f64, high: f64, log: bool| {
        format!("%7B%22low%22:{low},%22high%22:{high},%22log%22:{log}%7D")
    };
    match section {
        "figure1" | "figure3" | "figure4" | "figure5" | "figure6" => {
            Some(format!("preset={section}"))
        }
        "figure2" => {
            let Range { low, high } = figure2::VELOCITY;
            let axis = axis(low, high, false);
            Some(format!("preset=figure2&x={axis}&y={axis}"))
        }
        "boundaries" => {
            let [kappa, psi] = [boundaries::KAPPA, boundaries::PSI];
            let x = axis(kappa.low, kappa.high, true);
            Some(format!("preset=plane&x={x}&y={}", axis(psi.low, psi.high, true)))
        }
        _ => None,
    }
}

/// The tables of a section that stand on the page; an audit is shown statement by statement
/// instead.
fn shown(section: &ReportSection) -> Vec<&StudyTable> {
    let tables = section.study.tables.iter().filter(|_| section.audit.is_none());
    tables.filter(|table| section.shown.contains(&table.name)).collect()
}

/// The columns of a table, each with the class of its first cell.
fn headings(table: &StudyTable) -> Vec<(&StudyColumn, &'static str)> {
    let first = table.rows.first().into_iter().flatten();
    table.columns.iter().zip(first.map(class)).collect()
}

/// The cells of a row, each with its column.
fn labelled<'a>(row: &'a [Cell], table: &'a StudyTable) -> Vec<(&'a Cell, &'a StudyColumn)> {
    row.iter().zip(&table.columns).collect()
}

/// The class of a verdict and a mark that tells it apart without its colour.
fn verdict(verdict: StatementVerdict) -> (&'static str, char) {
    match verdict {
        StatementVerdict::Holds => ("holds", '✓'),
        StatementVerdict::HoldsWithACondition => ("condition", '◐'),
        StatementVerdict::DoesNotHold => ("fails", '✗'),
        StatementVerdict::CannotBeDecided => ("open", '?'),
    }
}

fn content(cell: &Cell) -> String {
    match cell {
        Cell::Number(value) if value.is_nan() => String::new(),
        Cell::Number(value) => markup(&number(*value, 5)),
        Cell::Count(count) => count.to_string(),
        Cell::Text(text) => markup(text),
    }
}

fn class(cell: &Cell) -> &'static str {
    match cell {
        Cell::Number(_) | Cell::Count(_) => "number",
        Cell::Text(text) if !text.contains(' ') => "word",
        Cell::Text(_) => "words",
    }
}
