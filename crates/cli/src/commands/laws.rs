//! The contact laws that have names.

use std::io::{self, Write};

use serde::Serialize;
use stickslip_model::presets::{self, Preset};

use crate::args::{Format, LawsArguments};
use crate::error::Failure;
use crate::input::law;
use crate::output::console::print;
use crate::output::{json, text};

/// A law as `--format json` lists it.
#[derive(Serialize)]
struct Entry<'a> {
    #[serde(flatten)]
    preset: &'a Preset,
    equations: String,
}

/// Prints all laws, or one.
///
/// # Errors
/// No law has this name, or standard output cannot be written.
pub fn run(arguments: &LawsArguments) -> Result<(), Failure> {
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
