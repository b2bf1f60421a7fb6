//! Tiles: the results of successive points of a map, and the bytes in which they are kept.

use twox_hash::XxHash3_128;

/// Tangential restitution and number of switches at successive points.
#[derive(Clone, Debug, PartialEq)]
pub struct Tile {
    /// Tangential restitution ε_t of each point; [`NO_EPS_T`] where it could not be computed.
    pub eps_t: Vec<f64>,
    /// Number of switches at each point; [`NO_COUNT`] where it could not be computed.
    pub switch_count: Vec<i32>,
}

/// Stands for ε_t where it could not be computed: a NaN that always has the same bits.
pub const NO_EPS_T: f64 = f64::NAN;
/// Stands for the number of switches where it could not be computed.
pub const NO_COUNT: i32 = -1;

impl Tile {
    /// The tile as bytes: `label`, all ε_t, all counts, and a checksum over everything before it.
    ///
    /// Numbers are little-endian. The label names the map and the place of the tile in it.
    #[must_use]
    pub fn to_bytes(&self, label: &str) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(Self::length(label, self.eps_t.len()));
        bytes.extend_from_slice(label.as_bytes());
        bytes.extend(self.eps_t.iter().flat_map(|value| value.to_le_bytes()));
        bytes.extend(self.switch_count.iter().flat_map(|count| count.to_le_bytes()));
        bytes.extend(XxHash3_128::oneshot(&bytes).to_le_bytes());
        bytes
    }

    /// The number of bytes that a tile of `points` points has with `label`.
    #[must_use]
    pub fn length(label: &str, points: usize) -> usize {
        label.len() + points * (8 + 4) + 16
    }

    /// Reads a tile of `points` points. It is `None` unless [`Self::to_bytes`] wrote `bytes` with
    /// the same label.
    #[must_use]
    pub fn from_bytes(bytes: &[u8], label: &str, points: usize) -> Option<Self> {
        if points > bytes.len() || bytes.len() != Self::length(label, points) {
            return None;
        }
        let (content, checksum) = bytes.split_last_chunk()?;
        if XxHash3_128::oneshot(content) != u128::from_le_bytes(*checksum) {
            return None;
        }
        let results = content.strip_prefix(label.as_bytes())?;
        let (eps_t, switch_count) = results.split_at_checked(8 * points)?;
        let eps_t = eps_t.as_chunks().0.iter().map(|bytes| f64::from_le_bytes(*bytes));
        let switch_count = switch_count.as_chunks().0.iter();
        Some(Self {
            eps_t: eps_t.collect(),
            switch_count: switch_count.map(|bytes| i32::from_le_bytes(*bytes)).collect(),
        })
    }
}
