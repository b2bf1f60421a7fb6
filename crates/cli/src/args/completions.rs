//! The options of `completions`.

use clap_complete::Shell;

/// Options of `completions`.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct CompletionsArguments {
    /// The shell that reads the script
    #[arg(value_enum, value_name = "SHELL")]
    pub shell: Shell,
}

/// What `completions --help` says last.
pub const EXAMPLES: &str = "\
Examples:
  stickslip completions bash > ~/.local/share/bash-completion/completions/stickslip
  stickslip completions zsh > \"${fpath[1]}/_stickslip\"
  stickslip completions fish > ~/.config/fish/completions/stickslip.fish
  stickslip completions powershell >> $PROFILE
  stickslip completions elvish >> ~/.config/elvish/rc.elv

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
