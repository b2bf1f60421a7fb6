//! How much of the work is done as one piece.

/// Largest number of rows that are computed as one piece of work.
const ROWS_AT_ONCE: usize = 128;

/// The number of rows in a piece of work, so that `threads` have several pieces each even where few
/// `rows` are computed together.
pub fn piece(rows: usize, threads: usize) -> usize {
    (rows / (4 * threads)).clamp(1, ROWS_AT_ONCE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_rows_are_several_pieces() {
        for (rows, threads, expected) in [(1, 8, 1), (110, 4, 6), (16_384, 2, 128), (40, 1, 10)] {
            assert_eq!(piece(rows, threads), expected);
        }
    }
}
