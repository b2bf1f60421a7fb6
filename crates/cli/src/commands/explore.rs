//! `explore`: the page that computes, written and opened.

use std::env;
use std::path::PathBuf;

use stickslip_files::output::file::write;
use stickslip_page::{showing, view_of_system};

use crate::error::Failure;
use crate::output::console::say;
use crate::shared::system::read;

/// Write the explorer, a page that computes, and open it in a browser
#[derive(Debug, clap::Args)]
#[command(long_about = ABOUT, after_long_help = EXAMPLES)]
pub struct ExploreArguments {
    /// A system that the page shows, a text as docs/systems.md describes it; - is standard input
    #[arg(value_name = "SYSTEM.slip", conflicts_with = "link")]
    pub system: Option<PathBuf>,

    /// A view that the page shows: a link that was copied from it, or the part behind its #
    #[arg(long, value_name = "LINK")]
    pub link: Option<String>,

    /// File for the page [default: stickslip-explorer.html in the folder for temporary files]
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub out: Option<PathBuf>,

    /// Write the page and do not open it
    #[arg(long, help_heading = "Output")]
    pub no_open: bool,
}

/// Writes the page, and opens it in the browser.
pub fn run(arguments: &ExploreArguments) -> Result<(), Failure> {
    let view = match (&arguments.system, &arguments.link) {
        (Some(system), _) => view_of_system(&read(system)?.1),
        (None, link) => link.clone().unwrap_or_default(),
    };
    let usual = || env::temp_dir().join("stickslip-explorer.html");
    let path = arguments.out.clone().unwrap_or_else(usual);
    write(&path, showing(&view).as_bytes())?;
    say(format_args!("the explorer is {}", path.display()));
    if arguments.no_open {
        return Ok(());
    }
    open::that_detached(&path).map_err(|error| Failure::Browser { path, error })
}

/// What `explore --help` says first.
const ABOUT: &str = "\
Write the explorer and open it in a browser: one page that computes collisions of two spheres over \
their plane of parameters, every boundary of their switches, and systems of your own. It needs no \
server and no network.";

/// What `explore --help` says last.
const EXAMPLES: &str = "\
Examples:
  stickslip explore
  stickslip explore examples/systems/belt.slip
  stickslip explore --link preset=figure3 --out explorer.html --no-open

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
