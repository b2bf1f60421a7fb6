//! Texts of intervals, grids and sizes.

use stickslip_files::input::parameter::Parameter;
use stickslip_files::input::range::{Size, parse, parse_for, parse_one_or_range};
use stickslip_plane::Range;

#[test]
fn intervals() {
    assert_eq!(parse("0:70"), Ok(Range { low: 0.0, high: 70.0 }));
    assert_eq!(parse(" 2/7 : 1.5e3 "), Ok(Range { low: 2.0 / 7.0, high: 1500.0 }));
    assert!(parse("-0:1").unwrap().low.is_sign_positive());
    for (text, expected) in [
        ("", "not a range; "),
        ("70", "not a range; "),
        ("0-70", "not a range; "),
        (":70", "the lower end is empty; "),
        ("nan:70", "the lower end is not a number; "),
        ("0:", "the upper end is empty; "),
        ("0:1:2", "the upper end is not a number; "),
        ("0:inf", "the upper end is not finite; "),
        ("-1:70", "out of range; "),
        ("1:1", "out of range; "),
        ("2:1", "out of range; "),
    ] {
        let refused = parse(text).unwrap_err();
        assert!(refused.starts_with(expected) && refused.contains("expected LO:HI"), "{refused}");
    }
}

#[test]
fn intervals_of_a_parameter_do_not_begin_at_0() {
    let kappa = |text| parse_for(Parameter::Kappa, text);
    assert_eq!(kappa("2/7:70"), Ok(Range { low: 2.0 / 7.0, high: 70.0 }));
    for text in ["0:70", "-0:70"] {
        let refused = kappa(text).unwrap_err();
        assert!(refused.starts_with("boundaries near 0 have no end"), "{refused}");
    }
    assert!(kappa("2:1").unwrap_err().starts_with("out of range; "));
}

#[test]
fn one_value_or_a_grid() {
    let read = |text| parse_one_or_range(Parameter::Kappa, text);
    assert_eq!(read("18").map(|it| it.values(5)), Ok(vec![18.0]));
    let grid = read("1:16").map(|it| it.values(5)).unwrap();
    assert_eq!((grid.len(), grid[0], grid[4]), (5, 1.0, 16.0));
    assert!(grid.windows(2).all(|pair| (pair[1] / pair[0] - 2.0).abs() < 1e-12));
    let refused = read("0").unwrap_err();
    assert!(refused.contains("above 0, or an interval LO:HI"), "{refused}");
    assert!(read("0:1").is_err() && read("2:1").is_err() && read("1:2:3").is_err());
}

#[test]
fn sizes() {
    assert_eq!(Size::parse("3x2"), Ok(Size { columns: 3, rows: 2 }));
    assert_eq!(Size::parse("100000x100000"), Ok(Size { columns: 100_000, rows: 100_000 }));
    for text in ["", "10", "10x", "x10", "10X10", "1x2x3", "-1x5", "1.5x2", "nanx1"] {
        assert!(Size::parse(text).unwrap_err().starts_with("not a size"), "{text}");
    }
    let huge = "18446744073709551615x18446744073709551615";
    for text in ["0x5", "5x0", "100000x100001", huge] {
        assert!(Size::parse(text).unwrap_err().starts_with("out of range"), "{text}");
    }
}
