//! Manual pages, made from what the help texts are made from.

use std::io::{self, Write};

use clap::{Command, CommandFactory};
use clap_mangen::Man;
use clap_mangen::roff::{Roff, roman};

use crate::args::{Arguments, ManArguments};
use crate::error::Failure;
use crate::output::study;

/// Prints one page with all commands, or writes a page for each of them.
///
/// # Errors
/// They cannot be written.
pub fn run(arguments: &ManArguments) -> Result<(), Failure> {
    let mut program = Arguments::command().disable_help_subcommand(true);
    program.build();
    let Some(directory) = &arguments.out else {
        let page = all_commands(&program).map_err(Failure::Stdout)?;
        return Failure::unless_written(io::stdout().lock().write_all(page.as_bytes()));
    };
    study::prepare(directory)?;
    for command in [&program].into_iter().chain(program.get_subcommands()) {
        let path = directory.join(Man::new(command.clone()).get_filename());
        let page = page(command, true).map_err(|error| Failure::output(&path, error))?;
        study::write(&path, page.as_bytes())?;
    }
    Ok(())
}

/// The program, with each command as a section.
fn all_commands(program: &Command) -> io::Result<String> {
    let mut text = page(program, false)?;
    for command in program.get_subcommands() {
        let mut title = Roff::default();
        title.control("SH", [command.get_name().to_uppercase().as_str()]);
        text += &title.to_roff();
        let sections = sections(command)?;
        text += &sections.replace("\n.SH ", "\n.SS ").replacen(".SH ", ".SS ", 1);
    }
    Ok(text)
}

/// A command as a page of its own, with a list of its commands if `listed`.
fn page(command: &Command, listed: bool) -> io::Result<String> {
    let manual = Man::new(command.clone());
    let name = command.get_display_name().unwrap_or(command.get_name());
    // Without a date, which would change from build to build; `Man` would leave out the empty
    // quotes.
    let title = format!(".TH {name} 1 \"\" \"{} {}\"\n", crate::NAME, env!("CARGO_PKG_VERSION"));
    let mut page = title.into_bytes();
    manual.render_name_section(&mut page)?;
    let mut text = text(page)? + &sections(command)?;
    if listed && command.has_subcommands() {
        let mut list = Vec::new();
        manual.render_subcommands_section(&mut list)?;
        text += &self::text(list)?;
    }
    Ok(text)
}

/// How a command is used and what it does.
fn sections(command: &Command) -> io::Result<String> {
    let manual = Man::new(command.clone());
    let mut page = Vec::new();
    manual.render_synopsis_section(&mut page)?;
    manual.render_description_section(&mut page)?;
    manual.render_options_section(&mut page)?;
    if let Some(notes) = command.get_after_long_help().or_else(|| command.get_after_help()) {
        let mut roff = Roff::default();
        // As they stand: files, tables and commands, a line each.
        roff.control("SH", ["NOTES"]).control("nf", []);
        for line in notes.to_string().lines() {
            roff.text([roman(line)]);
        }
        roff.control("fi", []).to_writer(&mut page)?;
    }
    text(page)
}

fn text(page: Vec<u8>) -> io::Result<String> {
    String::from_utf8(page).map_err(io::Error::other)
}
