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
