//! `man`: manual pages. They have the same source as the help texts.

use std::io;
use std::path::PathBuf;

use clap::{Command, CommandFactory};
use clap_mangen::Man;
use clap_mangen::roff::{Roff, roman};
use stickslip_files::output::{directory, file};

use super::Arguments;
use crate::error::Failure;
use crate::output::console::print;
use crate::version::NAME;

/// Print a manual page with all commands, or write one page for each command
#[derive(Debug, clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct ManArguments {
    /// Directory for one page for each command; created if it is missing
    #[arg(long, value_name = "DIR", help_heading = "Output")]
    pub out: Option<PathBuf>,
}

/// Prints one page with all commands, or writes a page for each of them.
pub fn run(arguments: &ManArguments) -> Result<(), Failure> {
    let mut program = Arguments::command().disable_help_subcommand(true);
    program.build();
    let Some(out) = &arguments.out else {
        let page = all_commands(&program).map_err(Failure::Stdout)?;
        return print(|out| out.write_all(page.as_bytes()));
    };
    directory::prepare(out)?;
    for command in [&program].into_iter().chain(program.get_subcommands()) {
        let path = out.join(Man::new(command.clone()).get_filename());
        let page = page(command, true).map_err(|error| Failure::output(&path, error))?;
        file::write(&path, page.as_bytes())?;
    }
    Ok(())
}

/// One page for the program, with each command as a section.
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

/// A page for one command, with a list of its own commands if `listed`.
fn page(command: &Command, listed: bool) -> io::Result<String> {
    let manual = Man::new(command.clone());
    let name = command.get_display_name().unwrap_or(command.get_name());
    // There is no date, because it would change from build to build. `Man` would leave out the
    // empty quotes.
    let title = format!(".TH {name} 1 \"\" \"{NAME} {}\"\n", env!("CARGO_PKG_VERSION"));
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
        // The notes keep their lines, which are files, tables and commands.
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

/// What `man --help` says last.
const EXAMPLES: &str = "\
Examples:
  stickslip man | man -l -
  stickslip man --out ~/.local/share/man/man1

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
