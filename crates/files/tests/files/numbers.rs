//! Texts of numbers.

use stickslip_files::input::number::{NotANumber, parse};

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
