//! A system of one's own and two of its parameters, for commands that compute over a plane.

use std::path::PathBuf;

use stickslip_files::input::number;
use stickslip_plane::Range;

use super::method::{atol, rtol};
use super::run::{setting, time};

/// The runs of a system over two of its parameters.
#[derive(Debug, clap::Args)]
pub struct PlaneArguments {
    /// A system of your own instead of collisions: a text as docs/systems.md describes it; - is
    /// standard input
    #[arg(value_name = "SYSTEM.slip", requires_all = ["x", "y"])]
    pub system: Option<PathBuf>,

    /// The parameter on the horizontal axis, and its interval
    #[arg(long, value_name = "NAME=LO:HI", value_parser = axis, requires = "system")]
    #[arg(help_heading = "System of your own")]
    pub x: Option<Axis>,

    /// The parameter on the vertical axis, and its interval
    #[arg(long, value_name = "NAME=LO:HI", value_parser = axis, requires = "system")]
    #[arg(help_heading = "System of your own")]
    pub y: Option<Axis>,

    /// What else differs from the text.
    #[command(flatten)]
    pub given: GivenArguments,

    /// Events after which a run is not told apart from others; where events accumulate, there are
    /// boundaries without end unless this is a small number [default: 10000000]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    #[arg(allow_hyphen_values = true, requires = "system", help_heading = "System of your own")]
    pub max_events: Option<u32>,

    /// Relative tolerance of a step of a system; 1e-15 to 0.1 [default: 1e-13]
    #[arg(long = "system-rtol", value_name = "R", value_parser = rtol, requires = "system")]
    #[arg(allow_hyphen_values = true, help_heading = "System of your own")]
    pub system_rtol: Option<f64>,

    /// Absolute tolerance of a step of a system; above 0 [default: 1e-13]
    #[arg(long = "system-atol", value_name = "T", value_parser = atol, requires = "system")]
    #[arg(allow_hyphen_values = true, help_heading = "System of your own")]
    pub system_atol: Option<f64>,
}

/// What differs from the text of a system.
#[derive(Debug, clap::Args)]
pub struct GivenArguments {
    /// The value of a parameter; may be repeated
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting, requires = "system")]
    #[arg(help_heading = "System of your own")]
    pub set: Vec<(String, f64)>,

    /// Where runs end, instead of the end that the system says
    #[arg(long, value_name = "T", value_parser = time, allow_hyphen_values = true)]
    #[arg(requires = "system", help_heading = "System of your own")]
    pub end: Option<f64>,
}

/// A parameter on an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Its name.
    pub name: String,
    /// Its interval.
    pub range: Range,
}

/// A parameter that differs between atlases.
#[derive(Clone, Debug, PartialEq)]
pub struct Over {
    /// Its name.
    pub name: String,
    /// Its values, in ascending order.
    pub values: Vec<f64>,
}

/// Reads `name=value,value,…`.
pub(super) fn over(text: &str) -> Result<Over, String> {
    const EXPECTED: &str =
        "expected NAME=V,V,… with two values or more in ascending order, such as mu=0.1,0.3,0.5";
    let (name, values) = text.split_once('=').ok_or(EXPECTED)?;
    let value = |text| number::parse(text).map_err(|problem| format!("{problem}; {EXPECTED}"));
    let values = values.split(',').map(value).collect::<Result<Vec<f64>, _>>()?;
    let ascend = values.windows(2).all(|pair| pair[0] < pair[1]);
    if values.len() < 2 || !ascend || !values.iter().all(|value| value.is_finite()) {
        return Err(format!("{values:?}; {EXPECTED}"));
    }
    Ok(Over { name: name.trim().to_owned(), values })
}

/// Reads `name=lo:hi`.
fn axis(text: &str) -> Result<Axis, String> {
    const EXPECTED: &str = "expected NAME=LO:HI with LO below HI, such as mu=0.1:0.5";
    let (name, range) = text.split_once('=').ok_or(EXPECTED)?;
    let (low, high) = range.split_once(':').ok_or(EXPECTED)?;
    let end = |text| number::parse(text).map_err(|problem| format!("{problem}; {EXPECTED}"));
    let (low, high) = (end(low)?, end(high)?);
    if !(low.is_finite() && high.is_finite() && low < high) {
        return Err(format!("{low} to {high}; {EXPECTED}"));
    }
    Ok(Axis { name: name.trim().to_owned(), range: Range { low, high } })
}
