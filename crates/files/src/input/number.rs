//! The syntax of numbers: `18`, `1.5e3`, `2/7`.

/// How numbers are written, for messages.
pub const SYNTAX: &str = "written like 18, 1.5e3 or 2/7";

/// Reads the value of an option whose range is checked later, by what it is for.
pub fn parse_option(text: &str) -> Result<f64, String> {
    parse(text).map_err(|problem| format!("{problem}; expected a finite number, {SYNTAX}"))
}

/// Reads a finite number: a decimal number, with or without an exponent, or a quotient of two of
/// them.
///
/// Blanks around a number are ignored.
pub fn parse(text: &str) -> Result<f64, NotANumber> {
    let value = match text.split_once('/') {
        None => decimal(text)?,
        Some((numerator, denominator)) => {
            let (numerator, denominator) = (decimal(numerator)?, decimal(denominator)?);
            if denominator == 0.0 {
                return Err(NotANumber::ZeroDenominator);
            }
            numerator / denominator
        }
    };
    if value.is_finite() { Ok(value) } else { Err(NotANumber::Infinite) }
}

/// The reason why a text is not a finite number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NotANumber {
    /// The text, or a part of a quotient, is empty.
    #[error("empty")]
    Empty,
    /// The text is not written like a number.
    #[error("not a number")]
    Syntax,
    /// The denominator of a quotient is zero.
    #[error("division by 0")]
    ZeroDenominator,
    /// The number is infinite, or above the largest double.
    #[error("not finite")]
    Infinite,
}

fn decimal(text: &str) -> Result<f64, NotANumber> {
    let text = text.trim();
    if text.is_empty() {
        return Err(NotANumber::Empty);
    }
    let value: f64 = text.parse().map_err(|_| NotANumber::Syntax)?;
    if value.is_nan() {
        return Err(NotANumber::Syntax);
    }
    if value.is_infinite() { Err(NotANumber::Infinite) } else { Ok(value) }
}
