//! Number of sign changes of the tangential velocity, without a search for each.

/// Sign changes of w = w₀ cos ωt − ω y₀ sin ωt, the velocity on a spring with ω² = κ, from t = 0 to
/// `duration`, where w is `w1`.
///
/// The number follows from the angle that the phase passes through. Where rounding leaves it open,
/// the signs at both ends decide.
pub(crate) fn on_spring(kappa: f64, (y0, w0): (f64, f64), w1: f64, duration: f64) -> usize {
    let omega = kappa.sqrt();
    let from = (omega * y0).atan2(w0) - std::f64::consts::FRAC_PI_2;
    let turns = |angle: f64| angle / std::f64::consts::PI;
    let swept = turns(from + omega * duration).floor() - turns(from).floor();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let count = swept.max(0.0) as usize;
    if (count % 2 == 1) == changed(w0, w1) {
        return count;
    }
    // To rounding, an end is at a zero: the nearer neighbour of the count has the right parity.
    let exact = turns(from + omega * duration) - turns(from).floor() - 0.5;
    if exact > swept { count + 1 } else { count.saturating_sub(1) + usize::from(count == 0) }
}

/// Whether a velocity that is monotone between `w0` and `w1` changes its sign.
pub(crate) fn changed(w0: f64, w1: f64) -> bool {
    (w0 < 0.0) != (w1 < 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_quarter_turns() {
        // w = cos t: zeros at π/2, 3π/2, …
        for (duration, expected) in [(1.0_f64, 0), (2.0, 1), (4.6, 1), (4.8, 2), (10.0, 3)] {
            assert_eq!(on_spring(1.0, (0.0, 1.0), duration.cos(), duration), expected);
        }
    }

    #[test]
    fn an_end_on_a_zero_follows_the_signs() {
        let quarter = std::f64::consts::FRAC_PI_2;
        assert_eq!(on_spring(1.0, (0.0, 1.0), -1e-17, quarter), 1);
        assert_eq!(on_spring(1.0, (0.0, 1.0), 1e-17, quarter), 0);
        assert_eq!(on_spring(1.0, (1.0, -1e-17), -0.5, 0.5), 0);
    }
}
