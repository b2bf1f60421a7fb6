//! The syntax of parts of a map: `3/64`.

use std::fmt;
use std::ops::Range;

/// One of the parts into which a map is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MapPart {
    /// The number of the part, from 1.
    pub number: usize,
    /// The number of all parts.
    pub count: usize,
}

impl MapPart {
    /// Most parts.
    pub const MOST: usize = 1_000_000;

    /// Reads `K/N`.
    ///
    /// # Errors
    /// What is wrong and what is expected.
    pub fn parse(text: &str) -> Result<Self, String> {
        let expected = format!(
            "expected K/N, two whole numbers with 1 <= K <= N <= {}, written like 3/64",
            Self::MOST
        );
        let part = text.split_once('/').and_then(|(number, count)| {
            Some(Self { number: number.trim().parse().ok()?, count: count.trim().parse().ok()? })
        });
        let Some(part) = part else { return Err(format!("not a part; {expected}")) };
        if part.count <= Self::MOST && (1..=part.count).contains(&part.number) {
            Ok(part)
        } else {
            Err(format!("out of range; {expected}"))
        }
    }

    /// Those of `things` successive things that belong to this part.
    ///
    /// The parts follow each other and have all things. Their sizes differ by at most 1.
    #[must_use]
    pub fn share(self, things: usize) -> Range<usize> {
        // ⌊k·things/N⌋ without the product of large numbers.
        let (each, rest) = (things / self.count, things % self.count);
        let start = |k: usize| k * each + k * rest / self.count;
        start(self.number - 1)..start(self.number)
    }
}

/// As it is typed.
impl fmt::Display for MapPart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.count)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

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
}
