//! The options of `laws`.

use super::shared::Format;

/// Options of `laws`.
#[derive(Debug, clap::Args)]
pub struct LawsArguments {
    /// The law that is printed; +limit_damping may be added to its name [default: a list of all]
    #[arg(value_name = "NAME")]
    pub name: Option<String>,

    /// How it is printed; the JSON of one law is a file for --law
    #[arg(long, value_enum, default_value_t = Format::Table)]
    pub format: Format,
}

/// What `laws --help` says first.
pub const ABOUT: &str = "\
List the contact laws that have names, or print one of them: those of particle codes, by the codes' \
own keywords, with their equations, where these were read, and what was compared.

A law consists of seven terms, in JSON and here: normal (linear, hertz), damping (none, linear, \
viscoelastic, tsuji), tangential (constant, mindlin), history (displacement, force), rescaled, \
limit_damping (true, false), end (force, overlap). Every combination is a law.

Quantities are scaled: x overlap, v its rate, w tangential velocity, F normal and Q tangential force, \
y or q history; κ stiffness, a damping, b tangential damping. Hysteretic and adhesive laws have other \
terms and are not computed.";

/// What `laws --help` says last.
pub const EXAMPLES: &str = "\
Examples:
  stickslip laws
  stickslip laws gran/hertz/history
  stickslip laws granular/hertz/tsuji/mindlin+limit_damping --format json > law.json
  stickslip collide --kappa 3 --psi 0.4 --damping 0.3 --law law.json --tangential-damping 3.5

Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.";
