//! The syntax of intervals and of sizes: `0:70`, `1000x800`.

use stickslip_plane::Range;

use crate::input::number;
use crate::input::parameter::Parameter;

/// Reads an interval `LO:HI` of `parameter`, both ends of which are in its range.
///
/// # Errors
/// The text says what is wrong and what is expected.
pub fn parse_for(parameter: Parameter, text: &str) -> Result<Range, String> {
    let Range { low, high } = parse(text)?;
    match (parameter.check(low), parameter.check(high)) {
        (Ok(low), Ok(high)) if low > 0.0 => Ok(Range { low, high }),
        _ => Err(ZERO.to_owned()),
    }
}

/// Reads an interval `LO:HI` above 0.
///
/// # Errors
/// The text says what is wrong and what is expected.
pub fn parse_above_0(text: &str) -> Result<Range, String> {
    let range = parse(text)?;
    if range.low > 0.0 { Ok(range) } else { Err(ZERO.to_owned()) }
}

/// One value of a parameter, or an interval of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OneOrRange {
    /// One value.
    One(f64),
    /// An interval.
    Range(Range),
}

impl OneOrRange {
    /// The value, or `count` values of the interval in equal ratios, of which the first and the
    /// last are its ends.
    pub fn values(self, count: usize) -> Vec<f64> {
        match self {
            Self::One(value) => vec![value],
            Self::Range(Range { low, high }) => (0..count)
                .map(|index| match index {
                    0 => low,
                    _ if index + 1 == count => high,
                    _ => {
                        let part = index as f64 / (count - 1) as f64;
                        (low.ln() * (1.0 - part) + high.ln() * part).exp()
                    }
                })
                .collect(),
        }
    }
}

/// Reads a value of `parameter`, or an interval `LO:HI` as [`parse_for`].
///
/// # Errors
/// What is wrong and what is expected.
pub fn parse_one_or_range(parameter: Parameter, text: &str) -> Result<OneOrRange, String> {
    if text.contains(':') {
        return parse_for(parameter, text).map(OneOrRange::Range);
    }
    let value = parameter.parse_positive(text).map(OneOrRange::One);
    value.map_err(|problem| format!("{problem}, or an interval LO:HI"))
}

/// Reads an interval `LO:HI`, which may begin at 0.
///
/// # Errors
/// The text says what is wrong and what is expected.
pub fn parse(text: &str) -> Result<Range, String> {
    let (low, high) = text.split_once(':').ok_or(format!("not a range; {EXPECTED}"))?;
    let end = |name, text| {
        number::parse(text).map_err(|problem| format!("the {name} end is {problem}; {EXPECTED}"))
    };
    let (low, high) = (end("lower", low)?, end("upper", high)?);
    // −0 and 0 are the same lower end.
    if low >= 0.0 && low < high {
        Ok(Range { low: low.abs(), high })
    } else {
        Err(format!("out of range; {EXPECTED}"))
    }
}

const EXPECTED: &str =
    "expected LO:HI with finite numbers 0 <= LO < HI, written like 0:70 or 2/7:1.5e3";
/// What is wrong where both ends have to be collisions.
const ZERO: &str = "boundaries near 0 have no end; expected LO:HI with LO > 0";

/// The numbers of columns and rows of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// The number of columns.
    pub columns: usize,
    /// The number of rows.
    pub rows: usize,
}

impl Size {
    /// Most points, 10¹⁰. The larger of the two arrays of results then takes 80 GB.
    pub const MOST: usize = 10_usize.saturating_pow(10);

    /// Reads `WxH`.
    ///
    /// # Errors
    /// What is wrong and what is expected.
    pub fn parse(text: &str) -> Result<Self, String> {
        let expected = format!(
            "expected WxH, two whole numbers from 1 whose product is at most {}, \
             written like 1000x800",
            Self::MOST
        );
        let size = text.split_once('x').and_then(|(columns, rows)| {
            Some(Self { columns: columns.trim().parse().ok()?, rows: rows.trim().parse().ok()? })
        });
        let Some(size) = size else { return Err(format!("not a size; {expected}")) };
        let points = size.columns.checked_mul(size.rows);
        if points.is_some_and(|points| (1..=Self::MOST).contains(&points)) {
            Ok(size)
        } else {
            Err(format!("out of range; {expected}"))
        }
    }
}
