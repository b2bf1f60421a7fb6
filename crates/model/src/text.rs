//! Numbers in sentences, captions and pictures.

/// `value` with at most `digits` significant digits (1 to 17), with a superscript written as
/// `^{…}`.
///
/// Very large and very small numbers get a power of ten.
///
/// ```
/// use stickslip_model::text::number;
///
/// assert_eq!(number(-0.041652207, 4), "−0.04165");
/// assert_eq!(number(-2.5e7, 4), "−2.5×10^{7}");
/// ```
pub fn number(value: f64, digits: usize) -> String {
    let rounded = format!("{value:.*e}", digits.clamp(1, 17) - 1);
    let (mantissa, exponent) = rounded.split_once('e').unwrap_or((&rounded, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if value == 0.0 || (-4..6).contains(&exponent) {
        // Reading the rounded number back drops trailing zeros.
        // Adding 0 makes −0 a 0.
        return minus(&(rounded.parse().unwrap_or(value) + 0.0).to_string());
    }
    let mantissa: f64 = mantissa.parse().unwrap_or(value);
    minus(&format!("{mantissa}×10^{{{exponent}}}"))
}

/// `number` with minus signs, which are as wide as plus signs, for hyphens.
pub fn minus(number: &str) -> String {
    number.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_no_trailing_zeros_and_powers_where_they_are_long() {
        for (value, expected) in [
            (63.0, "63"),
            (0.5, "0.5"),
            (-0.041652207, "−0.04165"),
            (0.9999999999998, "1"),
            (1e4, "10000"),
            (1e-300, "1×10^{−300}"),
            (-2.5e7, "−2.5×10^{7}"),
            (0.0, "0"),
        ] {
            assert_eq!(number(value, 4), expected);
        }
    }
}
