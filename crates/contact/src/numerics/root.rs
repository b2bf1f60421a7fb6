//! Roots in a bracket, by Halley's method with bisection as a safeguard.

/// The value of a function with its first two derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Jet {
    /// The value f.
    pub value: f64,
    /// The first derivative f′.
    pub slope: f64,
    /// The second derivative f″.
    pub curvature: f64,
}

/// Most steps: more than twice the bisections from 1 to the smallest positive number.
const MOST_STEPS: usize = 2400;

/// The root between `positive`, where f > 0, and `negative`, where f < 0.
///
/// The caller knows the signs at the ends. f is not evaluated there: an end may be a zero of f or a
/// pole of its derivatives. Either end may be the larger one. The first value that is tried is
/// `guess`. If there is a single root between the ends, the result is that root to the rounding of
/// f.
pub fn bracketed(
    mut positive: f64,
    mut negative: f64,
    guess: f64,
    mut f: impl FnMut(f64) -> Jet,
) -> f64 {
    let inside = |x: f64, a: f64, b: f64| (a < x && x < b) || (b < x && x < a);
    let mut x = if inside(guess, positive, negative) { guess } else { 0.5 * (positive + negative) };
    let (mut last, mut before) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..MOST_STEPS {
        let jet = f(x);
        if jet.value > 0.0 {
            positive = x;
        } else if jet.value < 0.0 {
            negative = x;
        } else {
            return x;
        }
        let newton = -jet.value / jet.slope;
        let bend = 0.5 * newton * jet.curvature / jet.slope;
        // Halley's step. Where it would be more than twice Newton's, f is too curved for it.
        let mut step = newton / (1.0 + bend).max(0.5);
        // A step that leaves the bracket or shrinks too slowly is replaced by a bisection.
        if !(inside(x + step, positive, negative) && step.abs() < 0.5 * before) {
            if step.abs() <= f64::EPSILON * x.abs() {
                return x;
            }
            step = 0.5 * (positive + negative) - x;
            if !inside(x + step, positive, negative) {
                return x;
            }
        } else if step.abs() < 1e-8 * x.abs() && bend.abs() < 1e-4 {
            // The remaining error is of order bend² · step.
            return x + step;
        }
        x += step;
        before = last;
        last = step.abs();
    }
    x
}

/// The root between `positive`, where f > 0, and `negative`, where f ≤ 0, without derivatives: by
/// the secant through both ends, where the weight of an end that stays is halved (the Illinois
/// method), and by bisection where that is too slow.
pub fn crossing(mut positive: f64, mut negative: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (mut above, mut below) = (f(positive), f(negative));
    let mut moved = 0.0;
    for step in 0..MOST_STEPS {
        let secant = (positive * below - negative * above) / (below - above);
        let middle = 0.5 * (positive + negative);
        let inside = (secant - positive) * (secant - negative) < 0.0;
        let x = if inside && step % 4 != 3 { secant } else { middle };
        if (x - positive) * (x - negative) >= 0.0 {
            return x;
        }
        let value = f(x);
        if value > 0.0 {
            below = if moved > 0.0 { 0.5 * below } else { below };
            (positive, above) = (x, value);
        } else if value < 0.0 {
            above = if moved < 0.0 { 0.5 * above } else { above };
            (negative, below) = (x, value);
        } else {
            return x;
        }
        moved = value;
        if (positive - negative).abs() <= 4.0 * f64::EPSILON * x.abs() {
            return x;
        }
    }
    0.5 * (positive + negative)
}
