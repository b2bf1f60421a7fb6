//! The figures of the paper computed anew, and a page that shows everything.
//!
//! Start reading here; then, in this order: `section` (what a part hands out), `bench` (what parts
//! share), `reading` (the two meanings of κ), `figure1` to `figure6`, `boundaries` and `studies`
//! (the parts), `points` (where a…o are), `sweep` and `course` (what several figures need), `page`,
//! `report` and `markup` (what people and programs read).

mod bench;
mod boundaries;
mod course;
mod figure1;
mod figure2;
mod figure3;
mod figure4;
mod figure5;
mod figure6;
mod markup;
mod page;
mod points;
mod reading;
mod report;
mod section;
mod studies;
mod sweep;

use std::io::{self, Write};

use crate::error::Failure;
use crate::plan::PagePlan;
use crate::study;
use bench::Bench;
use section::Section;

/// A part of the report.
struct Part {
    /// What it is about.
    title: &'static str,
    /// Computes it.
    run: fn(&Bench) -> Result<Section, Failure>,
}

/// All parts, in the order of the page.
const PARTS: &[Part] = &[
    Part { title: figure1::TITLE, run: figure1::run },
    Part { title: figure2::TITLE, run: figure2::run },
    Part { title: figure3::TITLE, run: figure3::run },
    Part { title: figure4::TITLE, run: figure4::run },
    Part { title: figure5::TITLE, run: figure5::run },
    Part { title: figure6::TITLE, run: figure6::run },
    Part { title: boundaries::TITLE, run: boundaries::run },
    Part { title: studies::CONVERGENCE, run: studies::convergence },
    Part { title: studies::STIFF, run: studies::stiff },
    Part { title: studies::STATEMENTS, run: studies::statements },
];

/// Computes all parts, writes each when it is done, and the page at the end.
///
/// # Errors
/// Files cannot be written, a part fails, or something speaks against a result; in the last case
/// the page is complete and says so.
pub fn run(plan: &PagePlan) -> Result<(), Failure> {
    study::prepare(&plan.out)?;
    let bench = Bench::new(plan)?;
    let mut sections = Vec::with_capacity(PARTS.len());
    for (index, part) in PARTS.iter().enumerate() {
        say(&format!("{} of {}: {}", index + 1, PARTS.len(), part.title));
        let section = (part.run)(&bench)?;
        section.write(&plan.out)?;
        sections.push(section);
    }
    let page = plan.out.join("index.html");
    study::write(&plan.out.join("report.json"), report::json(&sections).as_bytes())?;
    study::write(&plan.out.join("report.md"), report::markdown(&sections).as_bytes())?;
    study::write(&page, page::html(&sections).as_bytes())?;
    say(&format!("everything is on {}", page.display()));
    sections.into_iter().flat_map(|section| section.objections).next().map_or(Ok(()), Err)
}

/// Tells on standard error how far the work is.
fn say(line: &str) {
    // If standard error is closed, nobody wants to know.
    let _ = writeln!(io::stderr(), "{line}");
}
