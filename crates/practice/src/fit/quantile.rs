//! Quantiles that turn misfits into intervals.

use std::f64::consts::PI;

/// The t with P(|T| ≤ t) = `level` for Student's distribution with `freedom` degrees of freedom, at
/// least 1. t² is the quantile of Fisher's F with one degree in the numerator.
///
/// Source: Abramowitz and Stegun, Handbook of Mathematical Functions, 26.7.3 and 26.7.4.
pub fn student(level: f64, freedom: usize) -> f64 {
    // With the angle θ, t = √ν tan θ.
    let probability = |angle: f64| {
        let (sine, cosine) = angle.sin_cos();
        let odd = freedom % 2 == 1;
        let (mut term, mut sum) = if odd { (cosine, 0.0) } else { (1.0, 0.0) };
        let mut k = if odd { 2.0 } else { 1.0 };
        for _ in 0..(freedom / 2) {
            sum += term;
            term *= k / (k + 1.0) * cosine * cosine;
            k += 2.0;
        }
        if odd { 2.0 / PI * (angle + sine * sum) } else { sine * sum }
    };
    let angle = bisected(level, 0.5 * PI, probability);
    (freedom as f64).sqrt() * angle.tan()
}

/// The z with P(|Z| ≤ z) = `level` for the normal distribution. z² is the quantile of χ² with one
/// degree of freedom.
pub fn normal(level: f64) -> f64 {
    // erf(z/√2) = √(2/π) exp(−z²/2) (z + z³/3 + z⁵/15 + …), all terms positive.
    let probability = |z: f64| {
        let (mut term, mut sum, mut k) = (z, 0.0, 1.0);
        while term > 1e-17 * sum {
            sum += term;
            k += 2.0;
            term *= z * z / k;
        }
        (2.0 / PI).sqrt() * (-0.5 * z * z).exp() * sum
    };
    bisected(level, 10.0, probability)
}

/// The place from 0 to `high` at which a growing function reaches `level`.
fn bisected(level: f64, high: f64, function: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, high);
    loop {
        let middle = f64::midpoint(low, high);
        if !(low < middle && middle < high) {
            return middle;
        }
        if function(middle) < level { low = middle } else { high = middle }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tables in every book, and closed forms: tan(πp/2) for ν = 1, p √(2/(1 − p²)) for ν = 2.
    #[test]
    fn quantiles_of_books() {
        for (freedom, t) in [(3, 3.182446), (4, 2.776445), (6, 2.446912), (7, 2.364624)] {
            assert!((student(0.95, freedom) - t).abs() < 1e-6, "{freedom}");
        }
        assert!((student(0.99, 30) - 2.749996).abs() < 1e-6);
        assert!((student(0.9, 1) - (0.45 * PI).tan()).abs() < 1e-12);
        assert!((student(0.9, 2) - 0.9 * (2.0_f64 / 0.19).sqrt()).abs() < 1e-12);
        for (level, z) in [(0.6826894921370859, 1.0), (0.95, 1.959963984540054)] {
            assert!((normal(level) - z).abs() < 1e-12, "{level}");
        }
        assert!((normal(0.9999) - 3.890591886413).abs() < 1e-9);
        assert!((student(0.95, 1_000_001) - normal(0.95)).abs() < 1e-5);
    }
}
