//! `completions`: scripts that complete commands and options in a shell.

use clap::CommandFactory;
use clap_complete::Shell;

use super::Arguments;
use crate::error::Failure;
use crate::output::console::print;
use crate::version::NAME;

/// Print a script that completes commands and options in a shell
#[derive(Clone, Copy, Debug, clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct CompletionsArguments {
    /// The shell that reads the script
    #[arg(value_enum, value_name = "SHELL")]
    pub shell: Shell,
}

/// Prints the script for a shell.
pub fn run(arguments: CompletionsArguments) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), NAME, &mut script);
    print(|out| out.write_all(&script))
}

/// What `completions --help` says last.
const EXAMPLES: &str = "\
Examples:
  stickslip completions bash > ~/.local/share/bash-completion/completions/stickslip
  stickslip completions zsh > \"${fpath[1]}/_stickslip\"
  stickslip completions fish > ~/.config/fish/completions/stickslip.fish
  stickslip completions powershell >> $PROFILE
  stickslip completions elvish >> ~/.config/elvish/rc.elv

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
