//! The syntax of numbers: `18`, `1.5e3`, `2/7`.

/// How numbers are written, for messages.
pub const SYNTAX: &str = "written like 18, 1.5e3 or 2/7";

/// Reads the value of an option whose range is checked later, by what it is for.
///
/// # Errors
/// What is wrong, and what is expected.
pub fn parse_option(text: &str) -> Result<f64, String> {
    parse(text).map_err(|problem| format!("{problem}; expected a finite number, {SYNTAX}"))
}

/// Reads a finite number: a decimal number, with or without an exponent, or a quotient of two of
/// them.
///
/// Blanks around a number are ignored.
///
/// # Errors
/// [`NotANumber`] says what is wrong.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers_decimals_exponents_and_quotients_are_numbers() {
        for (text, expected) in [
            ("18", 18.0),
            ("1.5e3", 1500.0),
            ("2/7", 2.0 / 7.0),
            (" 1e-3 / 4 ", 0.00025),
            ("-2/7", -2.0 / 7.0),
            ("+.5", 0.5),
            ("0.1", 0.1),
        ] {
            assert_eq!(parse(text), Ok(expected), "{text}");
        }
    }

    #[test]
    fn everything_else_is_refused() {
        for (text, expected) in [
            ("", NotANumber::Empty),
            ("  ", NotANumber::Empty),
            ("/7", NotANumber::Empty),
            ("2/", NotANumber::Empty),
            ("abc", NotANumber::Syntax),
            ("1,5", NotANumber::Syntax),
            ("1/2/3", NotANumber::Syntax),
            ("0x10", NotANumber::Syntax),
            ("nan", NotANumber::Syntax),
            ("NaN/1", NotANumber::Syntax),
            ("inf", NotANumber::Infinite),
            ("1e400", NotANumber::Infinite),
            ("1e300/1e-300", NotANumber::Infinite),
            ("1/inf", NotANumber::Infinite),
            ("2/0", NotANumber::ZeroDenominator),
        ] {
            assert_eq!(parse(text), Err(expected), "{text}");
        }
    }
}
