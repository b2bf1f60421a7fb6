//! `reproduce`: everything computed anew, and a page that shows it; or statements of the paper.

mod statements;

use std::path::{Path, PathBuf};

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use stickslip_files::map::npz;
use stickslip_files::output::directory::prepare;
use stickslip_files::output::file::write;
use stickslip_files::output::json;
use stickslip_files::output::study::write_study;
use stickslip_model::Engine;
use stickslip_plane::atlas::AtlasDocument;
use stickslip_reproduction::figures::{Content, DataFile, ReportSection, Reproduction};
use stickslip_reproduction::statements::{COUNT, Spring};
use stickslip_studies::contact_laws;

use super::laws::write_page;
use crate::error::Failure;
use crate::output::console::say;
use crate::shared::threads::ThreadsArguments;
use crate::{page, version};

/// Compute the figures of the paper anew, and show everything on one page
#[derive(Debug, clap::Args)]
#[command(long_about = ABOUT, after_long_help = EXAMPLES)]
pub struct ReproduceArguments {
    /// Directory for the page, the pictures and the data; created if it is missing
    #[arg(long, value_name = "DIR", help_heading = "Output")]
    #[arg(required_unless_present = "statement", conflicts_with = "statement")]
    pub out: Option<PathBuf>,

    /// Numbers of statements of the paper, from 1 to 25, that are tested and printed instead
    #[arg(long, value_name = "N", help_heading = "Audit", num_args = 1..)]
    #[arg(allow_negative_numbers = true)]
    #[arg(value_parser = clap::value_parser!(u8).range(1..=i64::from(COUNT)))]
    pub statement: Vec<u8>,

    /// How the statements are printed
    #[arg(long, value_enum, default_value_t = AuditFormat::Text, help_heading = "Audit")]
    #[arg(conflicts_with = "out")]
    pub format: AuditFormat,

    /// Model of the spring
    #[arg(long, value_parser = spring(), default_value = "reset", hide = true)]
    pub model: Spring,

    /// The threads.
    #[command(flatten)]
    pub threads: ThreadsArguments,

    /// Number of columns and rows of each map, fewer for quick trials
    #[arg(long, value_name = "N", hide = true, default_value_t = 400)]
    #[arg(value_parser = clap::value_parser!(u16).range(2..=2000))]
    pub cells: u16,
}

/// How statements are printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum AuditFormat {
    /// For a terminal
    Text,
    /// One JSON object
    Json,
    /// Markdown
    Markdown,
}

/// Reads the model of the spring for which statements are tested.
fn spring() -> impl TypedValueParser<Value = Spring> {
    let reset = PossibleValue::new("reset")
        .help("Reset to its limit as long as the limit is active, as in the paper");
    let unreset = PossibleValue::new("unreset-spring").help("Never reset");
    let names = PossibleValuesParser::new([reset, unreset]);
    names.map(|name| if name == "reset" { Spring::Reset } else { Spring::Unreset })
}

/// Computes everything and shows it on a page, or tests statements alone and prints them.
///
/// # Errors
/// Files or standard output cannot be written, a part fails, or something speaks against a result.
/// In the last case the page is complete and says so.
pub fn run(arguments: &ReproduceArguments) -> Result<(), Failure> {
    let Some(out) = &arguments.out else { return statements::print_tested(arguments) };
    let tell = |index: usize, count: usize, title: &str| match index + 1 {
        number if number < count => say(format_args!("{number} of {}: {title}", count - 1)),
        _ => say(format_args!("beside it: {title}")),
    };
    let (cells, model) = (usize::from(arguments.cells), arguments.model);
    let pool = arguments.threads.pool()?;
    let written = pool.install(|| write_everything(out, cells, model, &tell));
    if matches!(written, Ok(()) | Err(Failure::Objection(_))) {
        say(format_args!("everything is on {}", out.join("index.html").display()));
    }
    written
}

/// Computes all parts, writes the files of each part as soon as it is done, and the page at the
/// end. Before each part, `tell` hears its index, their number and its title; the last one is not
/// of the paper.
///
/// # Errors
/// A file cannot be written, or a part of the page cannot be computed.
pub fn write_everything(
    out: &Path,
    cells: usize,
    model: Spring,
    tell: &(dyn Fn(usize, usize, &'static str) + Sync),
) -> Result<(), Failure> {
    prepare(out)?;
    let reproduction = Reproduction::new(cells, model);
    let parts = Reproduction::parts();
    let mut sections = Vec::with_capacity(parts.len());
    for (index, part) in parts.iter().enumerate() {
        tell(index, parts.len() + 1, part.title);
        let section = part.run(&reproduction)?;
        write_section(&section, out)?;
        sections.push(section);
    }
    let usual = contact_laws::ContactLawSettings::default();
    let laws = contact_laws::ContactLawSettings { cells: cells.min(usual.cells), ..usual };
    tell(parts.len(), parts.len() + 1, contact_laws::TITLE);
    write_page(&laws, out)?;
    let page = out.join("index.html");
    write(&out.join("report.json"), page::report::json(&sections).as_bytes())?;
    write(&out.join("report.md"), page::report::markdown(&sections).as_bytes())?;
    write(&out.join("explorer.html"), stickslip_page::PAGE.as_bytes())?;
    write(&page, page::html(&sections).as_bytes())?;
    let objection = sections.into_iter().flat_map(|section| section.objections).next();
    objection.map_or(Ok(()), |objection| Err(Failure::Objection(objection)))
}

/// Writes all files of a part into `directory`, each of them at once or not at all.
fn write_section(section: &ReportSection, directory: &Path) -> Result<(), Failure> {
    for DataFile { name, content, .. } in &section.files {
        let path = directory.join(name);
        let bytes = match content {
            Content::Map(sweep) => {
                npz::archive(&sweep.grid, &Engine::Exact, &sweep.results, &version::program())
            }
            Content::Atlas(atlas) => json::sealed_line(&AtlasDocument::new(atlas)),
        };
        write(&path, &bytes.map_err(|error| Failure::output(&path, error))?)?;
    }
    Ok(write_study(&section.study, &section.pictures, directory)?)
}

/// What `reproduce --help` says first.
const ABOUT: &str = "\
Compute the figures of Schwager, Becker and Pöschel, Eur. Phys. J. E 27, 107 (2008), anew. Compute \
all boundaries of the switching and the studies of convergence and of stiff springs, test the \
statements of the paper, and show everything on one page.

DIR/index.html is the page. It contains its pictures, needs no network, and can be printed. \
DIR/report.md and DIR/report.json say the same as text and for programs. Each picture is also a \
file, and so are its data.

With --statement, only these statements of the paper are tested, and printed. A verdict follows from \
the printed numbers: holds, holds with a condition, does not hold, or cannot be decided.";

/// What `reproduce --help` says last.
const EXAMPLES: &str = "\
Examples:
  stickslip reproduce --out out
  stickslip reproduce --statement 7
  stickslip reproduce --statement 3 4 5 --format json

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
