//! The contact laws that have names.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;
use stickslip_files::input::law;
use stickslip_files::output::directory::prepare;
use stickslip_files::output::file::write;
use stickslip_files::output::json;
use stickslip_files::output::study::write_study;
use stickslip_model::presets::{self, Preset};
use stickslip_studies::contact_laws::{self, Settings};

use crate::args::{Format, LawsArguments};
use crate::error::Failure;
use crate::output::console::{print, say};
use crate::output::progress::Bar;
use crate::output::text;
use crate::plan::StudyPlan;
use crate::{page, threads};

/// A law as `--format json` lists it.
#[derive(Serialize)]
struct Entry<'a> {
    #[serde(flatten)]
    preset: &'a Preset,
    equations: String,
}

/// Prints all laws, or one; or computes what they do, and writes a page that shows it.
///
/// # Errors
/// No law has this name, options contradict each other, a collision cannot be computed, or an
/// output cannot be written.
pub fn run(arguments: &LawsArguments) -> Result<(), Failure> {
    if let Some(plan) = StudyPlan::contact_laws(arguments)? {
        prepare(&plan.out)?;
        let pool = threads::pool(plan.threads)?;
        let page = pool.install(|| write_page(&plan.settings, &plan.out))?;
        say(format_args!("everything is on {}", page.display()));
        return Ok(());
    }
    let preset = arguments.name.as_deref().map(law::named).transpose()?;
    print(|out| match (preset, arguments.format) {
        (Some(preset), Format::Json) => json::lines(out, &preset.law),
        (Some(preset), Format::Table) => one(out, &preset),
        (None, Format::Json) => {
            let entry =
                |preset: &'static Preset| Entry { equations: preset.law.equations(), preset };
            let entries: Vec<Entry<'_>> = presets::ALL.iter().map(entry).collect();
            json::lines(out, &entries)
        }
        (None, Format::Table) => all(out),
    })
}

/// Computes what the laws do, and writes the page and its data into `directory`. The path of the
/// page is returned.
///
/// # Errors
/// A collision cannot be computed, or a file cannot be written.
pub fn write_page(settings: &Settings, directory: &Path) -> Result<PathBuf, Failure> {
    let bar = Bar::steps();
    let study = contact_laws::run(settings, &|progress| bar.report(progress));
    drop(bar);
    let study = study?;
    write_study(&study, directory)?;
    let path = directory.join("laws.html");
    write(&path, page::laws(study).as_bytes())?;
    Ok(path)
}

fn one(out: &mut dyn Write, preset: &Preset) -> io::Result<()> {
    writeln!(out, "{}\n", preset.name)?;
    let dashpot = if preset.tangential_damping { "any" } else { "0 only" };
    text::pairs(
        out,
        &[
            ("code", preset.code.to_owned()),
            ("equations", preset.law.equations()),
            ("tangential damping", dashpot.to_owned()),
            ("source", preset.source.to_owned()),
            ("checked", preset.checked.to_owned()),
        ],
    )?;
    writeln!(out)?;
    json::lines(out, &preset.law)
}

fn all(out: &mut dyn Write) -> io::Result<()> {
    for (index, preset) in presets::ALL.iter().enumerate() {
        if index == 0 || presets::ALL[index - 1].code != preset.code {
            writeln!(out, "{}{}", if index == 0 { "" } else { "\n" }, preset.code)?;
        }
        writeln!(out, "  {:<46} {}", preset.name, preset.law.equations())?;
    }
    writeln!(out, "\n+limit_damping may be added to a name. `stickslip laws NAME` says more.")
}
