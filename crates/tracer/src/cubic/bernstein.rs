//! Roots of polynomials in the Bernstein basis, isolated by sign changes.

/// Calls `found` with every root in (0, 1) of Σ `coefficients[i]` Bᵢ(t), in ascending order.
///
/// The number of sign changes in the coefficients bounds the number of roots. The interval is
/// halved until this number is 0 or 1 (Farouki and Rajan 1987). Roots within an interval shorter
/// than 2⁻⁴⁰ are not separated: `found` is called once, with the middle of the interval.
pub(crate) fn each_root<const N: usize>(coefficients: &[f64; N], found: &mut impl FnMut(f64)) {
    isolate(coefficients, 0.0, 1.0, found);
}

fn isolate<const N: usize>(c: &[f64; N], from: f64, to: f64, found: &mut impl FnMut(f64)) {
    const FINEST: f64 = 1.0 / (1_u64 << 40) as f64;
    match sign_changes(c) {
        0 => {}
        1 => found(from + (to - from) * single_root(c)),
        _ if to - from < FINEST => found(0.5 * (from + to)),
        _ => {
            let (low, high) = halves(c);
            let middle = 0.5 * (from + to);
            isolate(&low, from, middle, found);
            // A root at the middle is an end of both halves and lies inside neither.
            if high[0] == 0.0 {
                found(middle);
            }
            isolate(&high, middle, to, found);
        }
    }
}

fn sign_changes<const N: usize>(c: &[f64; N]) -> usize {
    let mut changes = 0;
    let mut last = 0.0_f64;
    for &value in c {
        if value != 0.0 {
            changes += usize::from(last != 0.0 && (last < 0.0) != (value < 0.0));
            last = value;
        }
    }
    changes
}

/// The single root in (0, 1), by Newton's method inside a bracket.
fn single_root<const N: usize>(c: &[f64; N]) -> f64 {
    // The first coefficient that is not zero has the sign of the polynomial just above 0.
    let rising = c.iter().find(|&&value| value != 0.0).is_some_and(|&value| value < 0.0);
    let (mut low, mut high, mut t) = (0.0, 1.0, 0.5);
    for _ in 0..100 {
        let (value, slope) = value_and_slope(c, t);
        if value == 0.0 {
            return t;
        }
        if (value < 0.0) == rising {
            low = t;
        } else {
            high = t;
        }
        let newton = t - value / slope;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - t).abs() <= f64::EPSILON {
            return next;
        }
        t = next;
    }
    t
}

fn value_and_slope<const N: usize>(c: &[f64; N], t: f64) -> (f64, f64) {
    let mut row = *c;
    let mut slope = 0.0;
    for length in (1..N).rev() {
        if length == 1 {
            slope = (N - 1) as f64 * (row[1] - row[0]);
        }
        for i in 0..length {
            row[i] += t * (row[i + 1] - row[i]);
        }
    }
    (row[0], slope)
}

fn halves<const N: usize>(c: &[f64; N]) -> ([f64; N], [f64; N]) {
    let (mut low, mut high) = (*c, *c);
    for (level, value) in low.iter_mut().enumerate().skip(1) {
        for i in 0..N - level {
            high[i] = 0.5 * (high[i] + high[i + 1]);
        }
        *value = high[0];
    }
    (low, high)
}

#[cfg(test)]
mod tests {
    use super::each_root;

    fn roots<const N: usize>(coefficients: &[f64; N]) -> Vec<f64> {
        let mut found = Vec::new();
        each_root(coefficients, &mut |t| found.push(t));
        found
    }

    #[test]
    fn planted_roots_are_found() {
        // (t − 1/4)(t − 3/4) and (t − 1/2)² − 1e-12 in the Bernstein basis of degree 2.
        let [first, second] = roots(&[0.1875, -0.3125, 0.1875])[..] else { panic!("two roots") };
        assert!((first - 0.25).abs() < 1e-15 && (second - 0.75).abs() < 1e-15);
        let [first, second] = roots(&[0.25 - 1e-12, -0.25 - 1e-12, 0.25 - 1e-12])[..] else {
            panic!("two roots")
        };
        assert!((first - 0.5 + 1e-6).abs() < 1e-10 && (second - 0.5 - 1e-6).abs() < 1e-10);
        assert!(roots(&[0.25 + 1e-12, -0.25 + 1e-12, 0.25 + 1e-12]).is_empty());
        // A linear function, raised to degree 5, has a single root.
        let [root] = roots(&[-0.3, -0.1, 0.1, 0.3, 0.5, 0.7])[..] else { panic!("one root") };
        assert!((root - 0.3).abs() < 1e-15);
    }
}
