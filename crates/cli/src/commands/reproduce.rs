//! Everything computed anew, and a page that shows it.

use std::path::Path;

use stickslip_files::map::npz;
use stickslip_files::output::directory::prepare;
use stickslip_files::output::file::write;
use stickslip_files::output::json;
use stickslip_files::output::study::write_study;
use stickslip_model::Engine;
use stickslip_plane::atlas::Document;
use stickslip_reproduction::figures::{Content, DataFile, Reproduction, Section};
use stickslip_studies::contact_laws;

use super::laws::write_page;
use crate::error::Failure;
use crate::output::console::say;
use crate::page;
use crate::plan::PagePlan;
use crate::{threads, version};

/// Computes all parts, writes the files of each part as soon as it is done, and the page at the
/// end.
///
/// # Errors
/// Files cannot be written, a part fails, or something speaks against a result. In the last case
/// the page is complete and says so.
pub fn run(plan: &PagePlan) -> Result<(), Failure> {
    prepare(&plan.out)?;
    let pool = threads::pool(plan.threads)?;
    let reproduction = Reproduction::new(plan.cells, plan.spring);
    let parts = Reproduction::parts();
    let mut sections = Vec::with_capacity(parts.len());
    for (index, part) in parts.iter().enumerate() {
        say(format_args!("{} of {}: {}", index + 1, parts.len(), part.title));
        let section = pool.install(|| part.run(&reproduction))?;
        write_section(&section, &plan.out)?;
        sections.push(section);
    }
    let usual = contact_laws::Settings::default();
    let laws = contact_laws::Settings { cells: plan.cells.min(usual.cells), ..usual };
    say(format_args!("beside it: {}", contact_laws::TITLE));
    pool.install(|| write_page(&laws, &plan.out))?;
    let page = plan.out.join("index.html");
    write(&plan.out.join("report.json"), page::report::json(&sections).as_bytes())?;
    write(&plan.out.join("report.md"), page::report::markdown(&sections).as_bytes())?;
    write(&page, page::html(&sections).as_bytes())?;
    say(format_args!("everything is on {}", page.display()));
    let objection = sections.into_iter().flat_map(|section| section.objections).next();
    objection.map_or(Ok(()), |objection| Err(Failure::Objection(Box::new(objection))))
}

/// Writes all files of a part into `directory`, each of them at once or not at all.
fn write_section(section: &Section, directory: &Path) -> Result<(), Failure> {
    for DataFile { name, content, .. } in &section.files {
        let path = directory.join(name);
        let bytes = match content {
            Content::Map(sweep) => {
                npz::archive(&sweep.grid, &Engine::Exact, &sweep.results, &version::program())
            }
            Content::Atlas(atlas) => json::line(&Document::new(atlas)),
        };
        write(&path, &bytes.map_err(|error| Failure::output(&path, error))?)?;
    }
    Ok(write_study(&section.study, directory)?)
}
