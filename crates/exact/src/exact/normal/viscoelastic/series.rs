//! The Taylor series of the damped normal motion.
//!
//! In s, with dt = 2U ds, the equations are polynomials: U′ = V, V′ = −2U²Q and T′ = 2U, with
//! Q = αU² + βV. The coefficients follow from one another by products of series.

use stickslip_contact::numerics::double_double::DoubleDouble;

/// A kind of number in which series are computed.
pub trait Number: Copy {
    /// The number `value`.
    fn new(value: f64) -> Self;
    /// The sum with `other`.
    fn plus(self, other: Self) -> Self;
    /// The product with `other`.
    fn times(self, other: Self) -> Self;
    /// A whole number of times less.
    fn over_whole(self, divisor: u8) -> Self;
}

impl Number for f64 {
    fn new(value: f64) -> Self {
        value
    }

    fn plus(self, other: Self) -> Self {
        self + other
    }

    fn times(self, other: Self) -> Self {
        self * other
    }

    fn over_whole(self, divisor: u8) -> Self {
        self * (1.0 / Self::from(divisor))
    }
}

impl Number for DoubleDouble {
    fn new(value: f64) -> Self {
        Self(value, 0.0)
    }

    fn plus(self, other: Self) -> Self {
        Self::plus(self, other)
    }

    fn times(self, other: Self) -> Self {
        Self::times(self, other)
    }

    fn over_whole(self, divisor: u8) -> Self {
        self.over(Self(f64::from(divisor), 0.0))
    }
}

/// The normal motion in one place, in the units of the trajectory.
#[derive(Clone, Copy, Debug)]
pub struct State<N> {
    /// √x.
    pub u: N,
    /// dx/dt.
    pub v: N,
    /// αU² + βV.
    pub q: N,
}

/// The strengths α of the spring and β of the damper.
#[derive(Clone, Copy, Debug)]
pub struct Strengths<N> {
    /// α.
    pub alpha: N,
    /// β.
    pub beta: N,
}

/// The coefficients of s, s², … in the changes of U, V, Q and T from a place.
pub fn coefficients<N: Number, const ORDERS: usize>(
    place: &State<N>,
    strengths: &Strengths<N>,
) -> [[N; 4]; ORDERS] {
    let zero = N::new(0.0);
    let mut changes = [[zero; 4]; ORDERS];
    // The coefficients of u, q, y = u² and p = y q. The coefficients of y and p are sums of
    // products, to which every product is added as soon as it is known.
    let [mut u, mut q, mut y, mut p] = [[zero; ORDERS]; 4];
    (u[0], q[0], y[0]) = (place.u, place.q, place.u.times(place.u));
    p[0] = y[0].times(q[0]);
    let (mut last_u, mut last_v) = (place.u, place.v);
    for n in 0..ORDERS {
        #[expect(clippy::cast_possible_truncation, reason = "there are fewer than 60 orders")]
        let whole = |x: N| x.over_whole(n as u8 + 1);
        let next_t = whole(last_u.plus(last_u));
        let next_u = whole(last_v);
        let next_v = whole(p[n].times(N::new(-2.0)));
        let m = n + 1;
        let twice = next_u.plus(next_u);
        // The last y has no place in the array.
        let mut next_y = if m < ORDERS { y[m] } else { middle_and_pairs(&u, m) };
        next_y = next_y.plus(twice.times(u[0]));
        let next_q = strengths.alpha.times(next_y).plus(strengths.beta.times(next_v));
        changes[n] = [next_u, next_v, next_q, next_t];
        (last_u, last_v) = (next_u, next_v);
        if m < ORDERS {
            (u[m], q[m], y[m]) = (next_u, next_q, next_y);
            let room = m.min(ORDERS - m);
            for (sum, &earlier) in y[m..m + room].iter_mut().zip(&u[..room]).skip(1) {
                *sum = sum.plus(twice.times(earlier));
            }
            if 2 * m < ORDERS {
                y[2 * m] = y[2 * m].plus(next_u.times(next_u));
                p[2 * m] = p[2 * m].plus(next_y.times(next_q));
            }
            for ((sum, &y), &q) in p[m..m + room].iter_mut().zip(&y[..room]).zip(&q[..room]) {
                *sum = sum.plus(next_y.times(q).plus(next_q.times(y)));
            }
        }
    }
    changes
}

/// The coefficient of order `m`, one more than are known, of u² without the terms of u₀.
fn middle_and_pairs<N: Number>(u: &[N], m: usize) -> N {
    (1..m).fold(N::new(0.0), |sum, j| sum.plus(u[j].times(u[m - j])))
}

/// The changes a distance `s` away, by Horner's rule.
pub fn evaluate<N: Number>(changes: &[[N; 4]], s: N) -> [N; 4] {
    let zero = [N::new(0.0); 4];
    let sum = changes.iter().rev().fold(zero, |sum, term| lanes(|i| sum[i].times(s).plus(term[i])));
    lanes(|i| sum[i].times(s))
}

fn lanes<N>(f: impl Fn(usize) -> N) -> [N; 4] {
    [f(0), f(1), f(2), f(3)]
}
