//! The upper limit of a probability that trials leave.

/// The probability p of a wrong point with which at most `wrong` of `tried` points are wrong with a
/// probability of 5 %.
pub fn upper_limit(tried: u64, wrong: u64) -> f64 {
    if wrong >= tried {
        return 1.0;
    }
    let (n, m) = (tried as f64, wrong as f64);
    let choose: f64 = (0..wrong).map(|i| ((n - i as f64) / (i as f64 + 1.0)).ln()).sum();
    let at_most = |p: f64| {
        let mut term = (choose + m * p.ln() + (n - m) * (-p).ln_1p()).exp();
        let mut sum = term;
        for k in (0..wrong).rev() {
            term *= (k as f64 + 1.0) * (1.0 - p) / ((n - k as f64) * p);
            sum += term;
        }
        sum
    };
    let (mut low, mut high) = (m / n, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if at_most(middle) > 0.05 {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::upper_limit;

    #[test]
    fn limits_are_those_of_tables() {
        assert_eq!(upper_limit(0, 0), 1.0);
        assert!((upper_limit(100, 0) - (1.0 - 0.05_f64.powf(0.01))).abs() < 1e-12);
        // One-sided 95 % limits for 1 of 10, and for n − 1 of n, where 1 − pⁿ = 0.05.
        assert!((upper_limit(10, 1) - 0.394163).abs() < 1e-6);
        assert!((upper_limit(10, 9) - 0.95_f64.powf(0.1)).abs() < 1e-12);
        assert!(upper_limit(100_000, 5_000) < 0.052);
    }
}
