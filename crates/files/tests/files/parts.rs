//! Parts of a map.

use proptest::prelude::*;
use stickslip_files::input::part::MapPart;

#[test]
fn parts_read_back_as_typed() {
    assert_eq!(MapPart::parse("3/64"), Ok(MapPart { number: 3, count: 64 }));
    assert_eq!(MapPart::parse(" 1 / 1 "), Ok(MapPart { number: 1, count: 1 }));
    assert_eq!(MapPart::parse("7/1000000").unwrap().to_string(), "7/1000000");
    for text in ["", "3", "/", "/64", "3/", "a/b", "1/2/3", "-1/3", "1.5/2", "3:64"] {
        assert!(MapPart::parse(text).unwrap_err().starts_with("not a part"), "{text}");
    }
    for text in ["0/3", "4/3", "1/0", "0/0", "1/1000001", "18446744073709551615/3"] {
        assert!(MapPart::parse(text).unwrap_err().starts_with("out of range"), "{text}");
    }
}

proptest! {
    #[test]
    fn parts_cover_each_thing_once_and_are_even(
        things in prop_oneof![0_usize..5000, 0_usize..=10_000_000_000],
        count in prop_oneof![1_usize..200, 1_usize..=20_000],
    ) {
        let mut end = 0;
        for number in 1..=count {
            let share = MapPart { number, count }.share(things);
            prop_assert_eq!(share.start, end);
            prop_assert!(share.len() == things / count || share.len() == things.div_ceil(count));
            end = share.end;
        }
        prop_assert_eq!(end, things);
    }
}

#[test]
fn the_most_parts_of_the_most_points() {
    let count = MapPart::MOST;
    let last = MapPart { number: count, count }.share(9_999_999_999);
    assert_eq!(last, 9_999_989_999..9_999_999_999);
}
