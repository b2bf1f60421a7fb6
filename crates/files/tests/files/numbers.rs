//! Texts of numbers.

use stickslip_files::input::number::parse;

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
        ("", "empty"),
        ("  ", "empty"),
        ("/7", "empty"),
        ("2/", "empty"),
        ("abc", "not a number"),
        ("1,5", "not a number"),
        ("1/2/3", "not a number"),
        ("0x10", "not a number"),
        ("nan", "not a number"),
        ("NaN/1", "not a number"),
        ("inf", "not finite"),
        ("1e400", "not finite"),
        ("1e300/1e-300", "not finite"),
        ("1/inf", "not finite"),
        ("2/0", "division by 0"),
    ] {
        assert_eq!(parse(text), Err(expected), "{text}");
    }
}
