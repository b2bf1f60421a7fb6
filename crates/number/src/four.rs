//! Four intervals side by side, in the vector registers of the processor.

use wide::f64x4;

use crate::Interval;
use crate::interval::{HALF_UNIT, LEAST};

/// Four intervals. Their sums are those of [`Interval`], bit for bit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Four {
    lower: f64x4,
    upper: f64x4,
}

/// Numbers below `x`, mostly the next ones.
#[inline(always)]
fn down(x: f64x4) -> f64x4 {
    let x = x.fast_min(f64x4::MAX);
    x - (x.abs() * HALF_UNIT + LEAST)
}

/// Numbers above `x`, mostly the next ones.
#[inline(always)]
fn up(x: f64x4) -> f64x4 {
    -down(-x)
}

/// The rounding of a sum of up to four products, relative to the sum of their absolute values.
const SUM: f64 = 3.0 * f64::EPSILON;

/// The value, the slope and the second derivative of a product of two functions from theirs, each
/// rounded once. The result is `None` if bounds are infinite.
#[inline(always)]
pub(super) fn product_rule(a: [Interval; 3], b: [Interval; 3]) -> Option<[Interval; 3]> {
    let ([a, rise_a, bend_a], [b, rise_b, bend_b], zero) = (a, b, Interval::ZERO);
    let (a_left, b_left) = (Four::new([a, rise_a, bend_a, rise_a]), Four::new([b, b, b, rise_b]));
    let (a_right, b_right) =
        (Four::new([zero, a, a, rise_a]), Four::new([zero, rise_b, bend_b, rise_b]));
    let (left, sum_left) = a_left.unrounded_product(b_left);
    let (right, sum_right) = a_right.unrounded_product(b_right);
    // The last entry is part of the one before it.
    let gathered = |all: f64x4| {
        let [value, slope, bend, last] = all.to_array();
        f64x4::new([value, slope, bend + last, 0.0])
    };
    let exact = (a_left.zero() | b_left.zero()) & (a_right.zero() | b_right.zero());
    let least = !exact & f64x4::from(8.0 * LEAST);
    let below = gathered((left.lower.abs() + right.lower.abs()) * SUM + least);
    let above = gathered((left.upper.abs() + right.upper.abs()) * SUM + least);
    let rounded = Four {
        lower: gathered(left.lower + right.lower) - below,
        upper: gathered(left.upper + right.upper) + above,
    };
    // Infinities leave NaN or infinities in these sums.
    let sums = (sum_left + sum_right) + (rounded.lower + rounded.upper);
    let finite = sums.abs().simd_lt(f64x4::from(f64::INFINITY)).all();
    let [value, slope, bend, _] = rounded.all();
    finite.then_some([value, slope, bend])
}

impl Four {
    #[inline(always)]
    pub(super) fn new(all: [Interval; 4]) -> Self {
        Self {
            lower: f64x4::new(all.map(Interval::lower)),
            upper: f64x4::new(all.map(Interval::upper)),
        }
    }

    #[inline(always)]
    pub(super) fn all(self) -> [Interval; 4] {
        let (lower, upper) = (self.lower.to_array(), self.upper.to_array());
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| Interval::between(lower[i], upper[i]));
        [a, b, c, d]
    }

    /// Where the number 0 is the whole interval.
    #[inline(always)]
    fn zero(self) -> f64x4 {
        (self.lower.abs() + self.upper.abs()).simd_eq(f64x4::ZERO)
    }

    /// The sums.
    #[inline(always)]
    pub(super) fn plus(self, other: Self) -> Self {
        let exact = self.zero() | other.zero();
        let (lower, upper) = (self.lower + other.lower, self.upper + other.upper);
        let (below, above) = (down(lower), up(upper));
        // Infinite bounds of different signs have no sum.
        let known = below.simd_le(above);
        let infinity = f64x4::from(f64::INFINITY);
        let round = |bound: f64x4, rounded: f64x4, unknown: f64x4| {
            exact.select(bound, known.select(rounded, unknown))
        };
        Self { lower: round(lower, below, -infinity), upper: round(upper, above, infinity) }
    }

    /// The products before they are rounded outwards, and the sum of the products of their bounds.
    #[inline(always)]
    fn unrounded_product(self, other: Self) -> (Self, f64x4) {
        let (p, q) = (self.lower * other.lower, self.lower * other.upper);
        let (r, s) = (self.upper * other.lower, self.upper * other.upper);
        let least = p.fast_min(q).fast_min(r.fast_min(s));
        let most = p.fast_max(q).fast_max(r.fast_max(s));
        (Self { lower: least, upper: most }, (p + q) + (r + s))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers that are special, ordinary or infinite.
    fn number(random: &mut fastrand::Rng) -> f64 {
        let special = [0.0, LEAST, 1e-160, 1e-310, 1.0, 1e160, f64::MAX, f64::INFINITY];
        let size = match random.u8(0..4) {
            0 => special[random.usize(0..special.len())],
            _ => random.f64() * 10.0_f64.powi(random.i32(-20..20)),
        };
        if random.bool() { size } else { -size }
    }

    fn interval(random: &mut fastrand::Rng) -> Interval {
        let (a, b) = (number(random), number(random));
        let (a, b) = (a.min(b).min(f64::MAX), a.max(b).max(f64::MIN));
        if random.u8(0..4) == 0 { Interval::point(a.max(f64::MIN)) } else { Interval::new(a, b) }
    }

    /// Sums are those of single intervals, also of those with infinite bounds.
    #[test]
    fn four_sums_are_as_one() {
        let mut random = fastrand::Rng::with_seed(7);
        for _ in 0..100_000 {
            let mut four = || std::array::from_fn::<_, 4, _>(|_| interval(&mut random));
            let (a, b) = (four(), four());
            let sums = Four::new(a).plus(Four::new(b)).all();
            for i in 0..4 {
                assert_eq!(sums[i], a[i].plus(b[i]), "{:?} + {:?}", a[i], b[i]);
            }
        }
    }

    /// The product rule contains what exact products give, hardly more, and zero stays exact.
    #[test]
    fn the_product_rule_is_rounded_outwards() {
        let mut random = fastrand::Rng::with_seed(8);
        let mut refused = 0;
        for _ in 0..100_000 {
            let mut three = || std::array::from_fn::<_, 3, _>(|_| interval(&mut random));
            let (a, b) = (three(), three());
            let outer = |i: usize, j: usize| a[i].times(b[j]);
            let one = [
                outer(0, 0),
                outer(1, 0).plus(outer(0, 1)),
                outer(2, 0).plus(outer(1, 1).scaled(2.0)).plus(outer(0, 2)),
            ];
            let Some(found) = product_rule(a, b) else {
                refused += 1;
                let largest =
                    [a, b, one].concat().iter().fold(0.0, |most, part| part.magnitude().max(most));
                assert!(largest > 1e300, "{a:?} {b:?}");
                continue;
            };
            for i in 0..3 {
                // Both are wider than the exact result by less than this.
                let slack = 1e-14 * (one[i].magnitude() + found[i].magnitude()) + 1e-320;
                let near = |x: f64, y: f64| x == y || (x - y).abs() <= slack;
                assert!(
                    near(found[i].lower(), one[i].lower())
                        && near(found[i].upper(), one[i].upper()),
                    "{a:?} {b:?} {found:?} {one:?}"
                );
            }
            // Exact products of bounds, by an error-free transformation, are inside.
            for (x, y) in [(a[0].lower(), b[0].lower()), (a[0].upper(), b[0].lower())] {
                let product = x * y;
                let error = x.mul_add(y, -product);
                let inside = |bound: f64| (bound - product) - error;
                assert!(inside(found[0].lower()) <= 0.0 && inside(found[0].upper()) >= 0.0);
            }
            assert!(a[0] != Interval::ZERO || found[0] == Interval::ZERO);
        }
        assert!((1_000..50_000).contains(&refused), "{refused}");
    }
}
