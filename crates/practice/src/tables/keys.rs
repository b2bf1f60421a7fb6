//! Keys: the first bits of numbers, which give their size roughly.

/// The first bits of numbers above 0, which give their size roughly.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Keys {
    /// How many bits are left out.
    pub shift: u32,
    /// The first bits of the least number.
    pub first: u64,
    /// The number of keys.
    pub count: usize,
}

impl Keys {
    /// At most `most` keys of the numbers from `low` to `high`.
    pub(super) fn new(low: f64, high: f64, most: u64) -> Self {
        let [first, last] = [low, high].map(f64::to_bits);
        let is_short = |&shift: &u32| (last >> shift) - (first >> shift) < most;
        Self::with_shift((0..u64::BITS).find(is_short).unwrap_or(0), low, high)
    }

    /// The keys that leave out `shift` bits.
    pub(super) fn with_shift(shift: u32, low: f64, high: f64) -> Self {
        let [first, last] = [low, high].map(|end| end.to_bits() >> shift);
        // There are few.
        #[allow(clippy::cast_possible_truncation)]
        Self { shift, first, count: (last - first + 1) as usize }
    }

    /// The key of a number.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation)]
    pub(super) fn of(self, value: f64) -> usize {
        ((value.to_bits() >> self.shift) - self.first) as usize
    }

    /// The least number of each key.
    pub(super) fn least(self) -> impl Iterator<Item = f64> {
        (self.first..).take(self.count).map(move |key| f64::from_bits(key << self.shift))
    }
}
