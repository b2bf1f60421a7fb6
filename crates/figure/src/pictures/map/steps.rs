//! Steps of the key of a map of switches.

/// The largest number of labels beside the key.
pub const MOST_NUMBERS: usize = 16;

/// A round even number, of which at most [`MOST_NUMBERS`] multiples are below `largest`.
pub fn even_step(largest: i32) -> i32 {
    let steps = (0..9).flat_map(|power| [2, 4, 10].map(|digit| digit * 10_i32.pow(power)));
    let fits = |step: &i32| largest / step < i32::try_from(MOST_NUMBERS).unwrap_or(i32::MAX);
    steps.filter(|step| *step > 0).find(fits).unwrap_or(largest)
}

#[cfg(test)]
mod tests {
    use super::even_step;

    #[test]
    fn steps_of_the_key_are_even_and_few() {
        for (largest, step) in
            [(17, 2), (34, 4), (164, 20), (218, 20), (1000, 100), (i32::MAX, 200_000_000)]
        {
            assert_eq!(even_step(largest), step, "{largest}");
        }
    }
}
