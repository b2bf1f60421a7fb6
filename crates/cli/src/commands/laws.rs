//! `laws`: the contact laws that have names, and a page that shows what they do.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;
use stickslip_figure::pictures::studies as pictures;
use stickslip_files::input::law;
use stickslip_files::input::parameter::Parameter;
use stickslip_files::output::directory::prepare;
use stickslip_files::output::file::write;
use stickslip_files::output::json;
use stickslip_files::output::study::write_study;
use stickslip_model::Damping;
use stickslip_model::presets::{self, Preset};
use stickslip_model::restitution::{self, Keyword, Restitution};
use stickslip_reproduction::ReproductionError;
use stickslip_reproduction::figures::ReportSection;
use stickslip_studies::contact_laws::{self, ContactLawSettings};

use crate::error::Failure;
use crate::output::console::{print, say};
use crate::output::progress::Bar;
use crate::output::text;
use crate::page;
use crate::shared::{Format, study, threads};

/// List the contact laws that have names, or print one of them
#[derive(Debug, clap::Args)]
#[command(long_about = ABOUT, after_long_help = EXAMPLES)]
pub struct LawsArguments {
    /// The law that is printed; +limit_damping may be added to its name [default: a list of all]
    #[arg(value_name = "NAME")]
    pub name: Option<String>,

    /// How it is printed; the JSON of one law is a file for --law
    #[arg(long, value_enum, default_value_t = Format::Table)]
    pub format: Format,

    /// Coefficient of normal restitution: prints which damping has it, and what the keywords of the
    /// codes make of it; above 0, at most 1
    #[arg(long, value_name = "E", conflicts_with = "out", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::NormalRestitution.parse(text))]
    pub e_n: Option<f64>,

    /// Directory for a page that shows what the laws do, DIR/laws.html, and its data; created if it
    /// is missing
    #[arg(long, value_name = "DIR", help_heading = "Page", conflicts_with_all = ["name", "format"])]
    pub out: Option<PathBuf>,

    /// Scaled damping of the maps, to which bodies that yield add 1; 0 or above [default: 0.2]
    #[arg(long, value_name = "A", help_heading = "Page", requires = "out")]
    #[arg(value_parser = |text: &str| Parameter::Damping.parse(text), allow_hyphen_values = true)]
    pub damping: Option<f64>,

    /// Tangential damping (γ_t/γ_n)/α of the maps; 0 or above [default: 0]
    #[arg(long, value_name = "B", help_heading = "Page", requires = "out")]
    #[arg(value_parser = |text: &str| Parameter::TangentialDamping.parse(text))]
    #[arg(allow_hyphen_values = true)]
    pub tangential_damping: Option<f64>,

    /// Columns and rows of each map; 1 to 1000 [default: 60]
    #[arg(long, value_name = "N", help_heading = "Page", requires = "out")]
    #[arg(value_parser = clap::value_parser!(u16).range(1..=1000), allow_hyphen_values = true)]
    pub cells: Option<u16>,

    /// Threads; 1 to 1024 [default: one for each core]; results do not depend on it
    #[arg(long, value_name = "N", help_heading = "Page", requires = "out")]
    #[arg(value_parser = threads::threads(), allow_hyphen_values = true)]
    pub threads: Option<u16>,
}

/// Prints all laws, or one; or computes what they do, and writes a page that shows it.
pub fn run(arguments: &LawsArguments) -> Result<(), Failure> {
    if let Some(out) = &arguments.out {
        let settings = settings(arguments);
        settings.validate().map_err(study::refused)?;
        prepare(out)?;
        let pool = threads::pool(arguments.threads)?;
        let page = pool.install(|| write_page(&settings, out))?;
        say(format_args!("everything is on {}", page.display()));
        return Ok(());
    }
    let preset = arguments.name.as_deref().map(law::named).transpose()?;
    if let Some(e_n) = arguments.e_n {
        return restitutions(arguments.name.as_deref(), e_n, arguments.format);
    }
    print(|out| match (preset, arguments.format) {
        (Some(preset), Format::Json) => json::lines(out, &preset.law),
        (Some(preset), Format::Table) => one(out, &preset),
        (None, Format::Json) => {
            let entry =
                |preset: &'static Preset| Entry { equations: preset.law.equations(), preset };
            let all = presets::ALL.iter().chain(presets::ADHESIVE);
            let entries: Vec<Entry<'_>> = all.map(entry).collect();
            json::lines(out, &entries)
        }
        (None, Format::Table) => all(out),
    })
}

/// Prints which damping has an ε_n, for one law or all that have damping.
fn restitutions(name: Option<&str>, e_n: f64, format: Format) -> Result<(), Failure> {
    let damped = presets::ALL.iter().filter(|preset| preset.law.damping != Damping::None);
    let names = name.map_or_else(|| damped.map(|preset| preset.name).collect(), |it| vec![it]);
    let mut found = Vec::new();
    for name in names {
        let (restitution, refused) = match restitution::of(name, e_n) {
            Ok(restitution) => (restitution, None),
            Err(error) => (None, Some(error.to_string())),
        };
        found.push(OfLaw { name, restitution, refused });
    }
    if let [OfLaw { name, refused: Some(error), .. }, others @ ..] = &found[..]
        && others.iter().all(|it| it.refused.is_some())
    {
        return Err(Failure::Usage(format!("--e-n with the law {name}: {error}")));
    }
    print(|out| match format {
        Format::Json if name.is_some() => json::lines(out, &found.first()),
        Format::Json => json::lines(out, &found),
        Format::Table => {
            let title = format!("e_n = {e_n}");
            writeln!(out, "{title:<46} {:>9} {:>9}  keyword: e_n reached", "damping a", "ratio ζ")?;
            for OfLaw { name, restitution, refused } in &found {
                let Some(restitution) = restitution else {
                    let reason = refused.as_deref().unwrap_or_default();
                    writeln!(out, "{name:<46} {:>9} {:>9}  {reason}", "", "")?;
                    continue;
                };
                let ratio = restitution.critical_damping_ratio;
                let ratio = ratio.map_or_else(String::new, |ratio| format!("{ratio:.6}"));
                let reached = |it: &Keyword| format!("{}: {:.4}", it.keyword, it.e_n);
                let reached: Vec<_> = restitution.keywords.iter().map(reached).collect();
                let (damping, reached) = (restitution.damping, reached.join("; "));
                let line = format!("{name:<46} {damping:>9.6} {ratio:>9}  {reached}");
                writeln!(out, "{}", line.trim_end())?;
            }
            Ok(())
        }
    })
}

/// The restitution of a law, as `--format json` prints it.
#[derive(Serialize)]
struct OfLaw<'a> {
    name: &'a str,
    #[serde(flatten)]
    restitution: Option<Restitution>,
    /// Why the law has no such damping.
    #[serde(skip_serializing_if = "Option::is_none")]
    refused: Option<String>,
}

/// The window and the dampings of the maps.
fn settings(arguments: &LawsArguments) -> ContactLawSettings {
    let LawsArguments { damping, tangential_damping, cells, .. } = *arguments;
    let usual = ContactLawSettings::default();
    ContactLawSettings {
        damping: damping.unwrap_or(usual.damping),
        tangential_damping: tangential_damping.unwrap_or(usual.tangential_damping),
        cells: cells.map_or(usual.cells, usize::from),
        ..usual
    }
}

/// A law as `--format json` lists it.
#[derive(Serialize)]
struct Entry<'a> {
    #[serde(flatten)]
    preset: &'a Preset,
    equations: String,
}

/// Computes what the laws do, and writes the page and its data into `directory`. The path of the
/// page is returned.
pub fn write_page(settings: &ContactLawSettings, directory: &Path) -> Result<PathBuf, Failure> {
    let bar = Bar::steps();
    let computed = contact_laws::run(settings, &|progress| bar.report(progress));
    drop(bar);
    let computed = computed?;
    let pictures = pictures::contact_laws::draw(&computed).map_err(ReproductionError::from)?;
    let section = ReportSection::new(computed.study(), pictures);
    write_study(&section.study, &section.pictures, directory)?;
    let path = directory.join("laws.html");
    write(&path, page::laws(section).as_bytes())?;
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
    writeln!(out, "\nLAMMPS, with adhesion: with --pull-off, or the surface energy of bodies")?;
    for preset in presets::ADHESIVE {
        writeln!(out, "  {:<48} {}", preset.name, preset.law.equations())?;
    }
    writeln!(out, "\n+limit_damping may be added to a name. `stickslip laws NAME` says more.")
}

/// What `laws --help` says first.
const ABOUT: &str = "\
List the contact laws that have names, or print one of them: those of particle codes, by the codes' \
own keywords, with their equations, where these were read, and what was compared.

A law consists of eight terms, in JSON and here: normal (linear, hertz, dmt, jkr), damping (none, linear, \
viscoelastic, tsuji, hysteretic, hardening, yielding), tangential (constant, mindlin), history (displacement, force, none), rescaled, \
limit_damping (true, false), end (force, overlap), coulomb_test (total, spring). Every combination \
is a law, but a hysteretic force goes with a spring of constant stiffness only, and one that yields is Hertz' and may have Mindlin's. Without history there is a dashpot alone, and κ has no effect; where the Coulomb test \
holds for the spring alone, the dashpot acts in stick only.

Quantities are scaled: x overlap, v its rate, w tangential velocity, F normal and Q tangential force, \
y or q history; κ stiffness, a damping, b tangential damping. With adhesion, dmt and jkr, F_po is the force \
that separates the bodies (pull_off in JSON), and r the contact radius. Torques of rolling and twisting are not \
computed.

With --out, maps of ε_t and the number of switches, the difference from the paper's law, the forces of a \
standard impact, and where a law creates energy, for all of them on one page.";

/// What `laws --help` says last.
const EXAMPLES: &str = "\
Examples:
  stickslip laws
  stickslip laws gran/hertz/history
  stickslip laws granular/hertz/tsuji/mindlin+limit_damping --format json > law.json
  stickslip collide --kappa 3 --psi 0.4 --damping 0.3 --law law.json --tangential-damping 3.5
  stickslip laws --e-n 0.8
  stickslip laws --out laws --damping 0.1

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
