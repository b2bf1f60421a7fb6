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
/// The text says what is wrong.
pub fn parse(text: &str) -> Result<f64, &'static str> {
    let value = match text.split_once('/') {
        None => decimal(text)?,
        Some((numerator, denominator)) => {
            let (numerator, denominator) = (decimal(numerator)?, decimal(denominator)?);
            if denominator == 0.0 {
                return Err("division by 0");
            }
            numerator / denominator
        }
    };
    if value.is_finite() { Ok(value) } else { Err("not finite") }
}

fn decimal(text: &str) -> Result<f64, &'static str> {
    let text = text.trim();
    if text.is_empty() {
        return Err("empty");
    }
    let value: f64 = text.parse().map_err(|_| "not a number")?;
    if value.is_nan() {
        return Err("not a number");
    }
    if value.is_infinite() { Err("not finite") } else { Ok(value) }
}
