//! The options that choose what computes a collision. They are the same for every command.

use clap::ValueEnum;
use stickslip_files::input::number;
use stickslip_model::{Engine, GivenValue, Law, Tolerances};
use stickslip_solver::{InvalidValue, Options};

use crate::error::Failure;

/// What computes a collision, and with which tolerances.
#[derive(Clone, Debug, clap::Args)]
pub struct MethodArguments {
    /// What computes a collision [default: auto]
    #[arg(long, value_enum, help_heading = "Method")]
    pub method: Option<Method>,

    /// Relative tolerance of a step; 1e-15 to 0.1
    #[arg(long, help = tolerance_help("Relative", "1e-15 to 0.1", |tolerances| tolerances.rtol))]
    #[arg(value_name = "R", help_heading = "Method", allow_hyphen_values = true)]
    #[arg(value_parser = rtol)]
    pub rtol: Option<f64>,

    /// Absolute tolerance of a step; above 0
    #[arg(long, help = tolerance_help("Absolute", "above 0", |tolerances| tolerances.atol))]
    #[arg(value_name = "T", help_heading = "Method", allow_hyphen_values = true)]
    #[arg(value_parser = atol)]
    pub atol: Option<f64>,
}

/// What computes a collision.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Method {
    /// Dormand–Prince 5(4); damping 0, or 1e-8 to 1e4
    Dopri5,
    /// Dormand–Prince 8(5,3); damping 0, or 1e-8 to 1e4
    Dop853,
    /// The exact solution; damping 0, or 1e-60 to 1e4
    Exact,
    /// The exact solution; dop853 for other laws than the paper's, or if a tolerance is given
    Auto,
}

impl MethodArguments {
    /// The engine that the options choose for collisions with a law and a tangential damping.
    pub fn engine(&self, law: (Law, f64)) -> Result<Engine, Failure> {
        let Self { method, rtol, atol } = *self;
        let method = method.unwrap_or(Method::Auto).to_possible_value();
        let name = method.as_ref().map_or("", |value| value.get_name());
        Engine::chosen_for(law, name, rtol, atol).map_err(|invalid| {
            Failure::Usage(match invalid.value {
                GivenValue::Phrase(_) => format!("--{invalid}"),
                _ => invalid.to_string(),
            })
        })
    }
}

fn tolerance_help(name: &str, range: &str, tolerance: fn(&Tolerances) -> f64) -> String {
    let [dop853, dopri5] = [&Tolerances::DOP853, &Tolerances::DOPRI5].map(tolerance);
    format!(
        "{name} tolerance of a step; {range} [default: {dop853:?} with dop853, {dopri5:?} with dopri5]"
    )
}

/// Reads a relative tolerance.
pub fn rtol(text: &str) -> Result<f64, String> {
    parse(text, |rtol| Options { rtol, ..Options::default() })
}

/// Reads an absolute tolerance.
pub fn atol(text: &str) -> Result<f64, String> {
    parse(text, |atol| Options { atol, ..Options::default() })
}

/// The number in `text`, if the solver accepts the options that `options` makes with it.
fn parse(text: &str, options: impl Fn(f64) -> Options) -> Result<f64, String> {
    let expected = |value: f64| match options(value).validate() {
        Ok(()) => None,
        Err(InvalidValue { expected, .. }) => Some(expected),
    };
    let range = expected(f64::NAN).unwrap_or("a number".into());
    let value = number::parse(text).map_err(|problem| format!("{problem}; expected {range}"))?;
    match expected(value) {
        None => Ok(value),
        Some(range) => Err(format!("out of range; expected {range}")),
    }
}
