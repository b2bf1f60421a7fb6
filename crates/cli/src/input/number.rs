//! The syntax of numbers: `18`, `1.5e3`, `2/7`.

/// Reads a finite number: decimal, with an exponent if need be, or a quotient of two such.
///
/// Blanks around the number and around the slash do not count.
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

/// Why a text is not a number that can be computed with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NotANumber {
    /// Nothing is written there.
    #[error("empty")]
    Empty,
    /// The syntax is another one.
    #[error("not a number")]
    Syntax,
    /// A quotient's denominator is zero.
    #[error("division by 0")]
    ZeroDenominator,
    /// Infinite, or above the largest double.
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
    fn reads_integers_decimals_exponents_and_quotients() {
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
    fn rejects_everything_else() {
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
