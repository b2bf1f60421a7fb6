//! States of the damped normal motion at fixed distances from both ends of contact, tabulated over
//! the damping.
//!
//! In r = √a the states are analytic functions for every damping: also the end of contact, where
//! U = √(a|V|), and what is counted back from it. On each interval of r they are polynomials
//! through a few trajectories, which are computed with twice the digits when the interval is used
//! for the first time. A new damping then takes the time of evaluating polynomials. The table is
//! not a file, since nobody could check its numbers by reading.

use std::sync::OnceLock;

use stickslip_contact::numerics::double_double::DoubleDouble;

use super::series::{State, Strengths, coefficients, evaluate};

/// Most nodes in one half of the contact.
pub const MOST_NODES: usize = 32;

/// Number of trajectories through which the polynomials of an interval go.
const POINTS: usize = 20;

/// Coefficients below this part of the largest one are left out.
const SIGNIFICANT: f64 = 1e-18;

/// Orders of the series with which trajectories are computed.
const ORDERS: usize = 28;

/// Number of intervals: from 0 to 1/4, then four in each octave up to 128.
const INTERVALS: usize = 37;

/// The units in which a trajectory is computed: S = c·s, U = c·u, T = c²·t with
/// c = max(1, a)^{1/3}.
///
/// In these units the motion has a limit for a → 0 and for a → ∞. As U′ = V and V′ = −2U²Q, only
/// Q = αU² + βV depends on the damping: (α, β) is (1, a) up to a = 1 and (a^{−5/3}, 1) from there.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    /// c.
    pub factor: f64,
    /// α and β.
    pub strengths: Strengths<f64>,
    /// Whether the units are those from a = 1 on.
    pub strong: bool,
}

impl Scale {
    /// The units for the damping `a` = `root`².
    pub fn new(root: f64, a: f64) -> Self {
        let strong = root >= 1.0;
        if !strong {
            return Self { factor: 1.0, strengths: Strengths { alpha: 1.0, beta: a }, strong };
        }
        let factor = a.cbrt();
        let alpha = 1.0 / (a * (factor * factor));
        Self { factor, strengths: Strengths { alpha, beta: 1.0 }, strong }
    }
}

/// α and β for the damping `root`², which must be a number without rounding, with twice the digits.
fn strengths(root: f64) -> Strengths<DoubleDouble> {
    let one = DoubleDouble(1.0, 0.0);
    let damping = DoubleDouble(root * root, 0.0);
    if root < 1.0 {
        return Strengths { alpha: one, beta: damping };
    }
    let rough = damping.0.cbrt();
    let cube = DoubleDouble::product(rough, rough).scaled(rough);
    let rest = damping.minus(cube).nearest() / (3.0 * rough * rough);
    let factor = DoubleDouble::sum(rough, rest);
    Strengths { alpha: one.over(damping.times(factor.times(factor))), beta: one }
}

/// The place S at which the halves of a contact meet, a node of the first: somewhere between 3/4
/// and 1/4 of V are left there, so that w keeps its relative accuracy while V vanishes.
pub fn middle(strong: bool) -> f64 {
    if strong { 1.0 } else { 1.2 }
}

/// Distances from an end of contact: multiples of a step, after `wide` steps of [`WIDE`].
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    wide: u8,
    step: f64,
}

/// The step where the motion is slow: with a strong damping, from S = [`SLOW`] on.
const WIDE: f64 = 0.5;
const SLOW: f64 = 3.5;

impl Grid {
    /// Nodes that are 0.2 apart, for a damping below 1.
    pub const WEAK: Self = Self { wide: 0, step: 0.2 };
    /// Nodes that are 1/4 apart, for a stronger one.
    const STRONG: Self = Self { wide: 0, step: 0.25 };

    /// The distance of node `index`.
    pub fn place(&self, index: usize) -> f64 {
        let wide = index.min(usize::from(self.wide));
        wide as f64 * WIDE + (index - wide) as f64 * self.step
    }

    /// The node nearest to the distance `r`.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "r is at least 0 and below 20"
    )]
    pub fn nearest(&self, r: f64) -> usize {
        let edge = f64::from(self.wide) * WIDE;
        if r < edge {
            (r / WIDE + 0.5) as usize
        } else {
            usize::from(self.wide) + ((r - edge) / self.step + 0.5) as usize
        }
    }

    /// The number of nodes up to the distance `r`.
    pub fn within(&self, r: f64) -> usize {
        let nearest = self.nearest(r);
        nearest + usize::from(self.place(nearest) <= r)
    }
}

/// The nodes of one interval of r = √a.
#[derive(Debug)]
pub struct Nodes {
    /// Distances of the nodes from the start and from the end of contact.
    pub grids: [Grid; 2],
    /// Their numbers.
    pub counts: [usize; 2],
    /// Middle and half width of the interval.
    middle: f64,
    half_width: f64,
    /// The powers of the scaled root, highest first.
    powers: Vec<Power>,
}

/// A power of the scaled root in the polynomials: its coefficient for each node.
type Power = Vec<Row>;

/// Four numbers that are tabulated together. The first row has the end of contact S, its duration
/// T, 1 − V there and U there; a node has \[U, Q, |ΔV|, ΔT\], and the changes are those up to the
/// next node of its half.
pub type Row = [f64; 4];

/// A trajectory with twice the digits, in rows.
type Trajectory = Vec<[DoubleDouble; 4]>;

impl Nodes {
    /// The nodes for the damping `root`², with `root` below 128.
    pub fn of(root: f64) -> &'static Self {
        static TABLE: [OnceLock<Nodes>; INTERVALS] = [const { OnceLock::new() }; INTERVALS];
        let interval = interval(root);
        TABLE[interval].get_or_init(|| Self::build(interval))
    }

    fn build(interval: usize) -> Self {
        let (low, high) = bounds(interval);
        let (middle, half_width) = (0.5 * (low + high), 0.5 * (high - low));
        let strong = low >= 1.0;
        let first = if strong { Grid::STRONG } else { Grid::WEAK };
        // Chebyshev's points, rounded so that the damping there is exact.
        let points: Vec<f64> = (0..POINTS)
            .map(|i| ((i as f64 + 0.5) * std::f64::consts::PI / POINTS as f64).cos())
            .map(|x| (x * 1024.0 * 16.0).round() / (1024.0 * 16.0))
            .collect();
        let solved: Vec<_> =
            points.iter().map(|x| Solved::new(middle + half_width * x, first)).collect();
        let ends = || solved.iter().map(|solved| solved.end.0);
        // A little more than at the points, for what is between them.
        let longest = ends().fold(0.0, f64::max) + 0.01;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below 20")]
        let slow = |shortest: f64| ((shortest - SLOW).max(0.0) / WIDE) as u8;
        let wide = if strong { slow(ends().fold(f64::MAX, f64::min)) } else { 0 };
        let grids = [first, Grid { wide, ..first }];
        let middle_place = self::middle(strong);
        let lengths = [middle_place, longest - middle_place];
        let counts = [0, 1].map(|half| grids[half].nearest(lengths[half]) + 1);
        let trajectories: Vec<_> =
            solved.into_iter().map(|solved| solved.rows(grids, counts)).collect();
        let rows = 1 + counts[0] + counts[1];
        let mut powers = vec![vec![[0.0; 4]; rows]; POINTS];
        for row in 0..rows {
            for lane in 0..4 {
                let values = trajectories.iter().map(|rows| rows[row][lane]).collect();
                let coefficients = monomial(&points, values);
                let least = SIGNIFICANT * coefficients.iter().map(|c| c.abs()).fold(0.0, f64::max);
                for (power, coefficient) in powers.iter_mut().rev().zip(coefficients) {
                    power[row][lane] = if coefficient.abs() > least { coefficient } else { 0.0 };
                }
            }
        }
        let first = powers.iter().position(|power| power.iter().flatten().any(|&c| c != 0.0));
        powers.drain(..first.unwrap_or(0));
        Self { grids, counts, middle, half_width, powers }
    }

    /// The rows at the damping `root`².
    pub fn at(&self, root: f64) -> [Row; 2 * MOST_NODES + 1] {
        let x = (root - self.middle) / self.half_width;
        let mut rows = [[0.0; 4]; 2 * MOST_NODES + 1];
        for power in &self.powers {
            for (row, term) in rows.iter_mut().zip(power) {
                for (value, coefficient) in row.iter_mut().zip(term) {
                    *value = *value * x + coefficient;
                }
            }
        }
        rows
    }
}

/// The interval of `root`.
fn interval(root: f64) -> usize {
    // Four times the exponent, plus the first two binary digits after the leading one.
    let quarters = (root.to_bits() >> 50) & 0x1fff;
    let first = (0.25_f64.to_bits() >> 50) & 0x1fff;
    usize::try_from((quarters + 1).saturating_sub(first)).unwrap_or(0).min(INTERVALS - 1)
}

/// The ends of an interval.
fn bounds(interval: usize) -> (f64, f64) {
    let bound = |quarters: usize| {
        let octave = 0.25 * f64::from(1_u32 << (quarters / 4));
        octave * (1.0 + 0.25 * (quarters % 4) as f64)
    };
    interval.checked_sub(1).map_or((0.0, 0.25), |quarters| (bound(quarters), bound(quarters + 1)))
}

/// A trajectory that has been followed from the start of contact to its end.
struct Solved {
    strengths: Strengths<DoubleDouble>,
    strong: bool,
    /// States at the nodes of the first half's grid, with −V and T that have changed since the last
    /// one; the last node is the one before the end.
    forward: Vec<(State<DoubleDouble>, [DoubleDouble; 2])>,
    /// The end of contact, and the state there.
    end: DoubleDouble,
    at_end: State<DoubleDouble>,
    /// What has changed from the start to the end.
    whole: [DoubleDouble; 2],
}

const ZERO: DoubleDouble = DoubleDouble(0.0, 0.0);

impl Solved {
    fn new(root: f64, grid: Grid) -> Self {
        let strengths = strengths(root);
        let strong = root >= 1.0;
        let start = State { u: ZERO, v: DoubleDouble(1.0, 0.0), q: strengths.beta };
        let mut solved = Self {
            strengths,
            strong,
            forward: vec![(start, [ZERO; 2])],
            end: ZERO,
            at_end: start,
            whole: [ZERO; 2],
        };
        let mut node = 0;
        let (mut state, mut whole) = (start, [ZERO; 2]);
        loop {
            let width = grid.place(node + 1) - grid.place(node);
            let (next, changes) = solved.moved(&state, DoubleDouble(width, 0.0));
            // Beyond the end of contact the solution goes on; there U or Q is negative.
            if next.u.0 <= 0.0 || next.q.0 <= 0.0 {
                break;
            }
            (state, node) = (next, node + 1);
            whole = [whole[0].plus(changes[0]), whole[1].plus(changes[1])];
            solved.forward.push((next, changes));
        }
        let step = solved.until_end(&state);
        let (at_end, changes) = solved.moved(&state, step);
        solved.end = DoubleDouble(grid.place(node), 0.0).plus(step);
        solved.at_end = State { q: ZERO, ..at_end };
        solved.whole = [whole[0].plus(changes[0]), whole[1].plus(changes[1])];
        solved
    }

    /// The state a distance `step` away, and the changes of −V and T up to it.
    ///
    /// With a strong damping V is what remains of Q and U², so that Q keeps its relative accuracy
    /// while it decays.
    fn moved(
        &self,
        from: &State<DoubleDouble>,
        step: DoubleDouble,
    ) -> (State<DoubleDouble>, [DoubleDouble; 2]) {
        const PARTS: u8 = 2;
        let part = step.scaled(1.0 / f64::from(PARTS));
        let (mut state, mut fall, mut time) = (*from, ZERO, ZERO);
        for _ in 0..PARTS {
            let changes = coefficients::<_, ORDERS>(&state, &self.strengths);
            let [u, v, q, t] = evaluate(&changes, part);
            state = State { u: state.u.plus(u), v: state.v.plus(v), q: state.q.plus(q) };
            let spring = self.strengths.alpha.times(state.u.times(state.u));
            if self.strong {
                state.v = state.q.minus(spring);
            } else {
                state.q = spring.plus(self.strengths.beta.times(state.v));
            }
            (fall, time) = (fall.minus(v), time.plus(t));
        }
        (state, [fall, time])
    }

    /// The distance from `state`, the last one at a node before the end, to the end.
    ///
    /// With a weak damping Q vanishes at U = ±√(−βV/α): two zeros of Q that are close together. The
    /// first of them is the zero of U − √(−βV/α), whose slope is nearly V. With a strong damping Q
    /// decays, and Newton's steps approach its zero from the side on which they start. The last
    /// steps, with all digits, are for Q.
    fn until_end(&self, from: &State<DoubleDouble>) -> DoubleDouble {
        const MOST_STEPS: usize = 60;
        const LAST_STEPS: usize = 3;
        let (alpha, beta) = (self.strengths.alpha.0, self.strengths.beta.0);
        let mut step = ZERO;
        let mut last_steps = 0;
        for _ in 0..MOST_STEPS {
            let (state, _) = self.moved(from, step);
            let (u, v, q) = (state.u.0, state.v.0, state.q.0);
            let v_rate = -2.0 * u * u * q;
            let rough = if !self.strong && v < 0.0 && last_steps == 0 {
                let opposite = (beta * -v / alpha).sqrt();
                (opposite - u) / (v + 0.5 * (beta / alpha) * v_rate / opposite)
            } else {
                -state.q.nearest() / (2.0 * alpha * u * v + beta * v_rate)
            };
            step = step.plus(DoubleDouble(rough, 0.0));
            if last_steps == LAST_STEPS {
                break;
            }
            last_steps += usize::from(last_steps > 0 || rough.abs() < 1e-14);
        }
        step
    }

    /// The rows of the table.
    fn rows(self, grids: [Grid; 2], counts: [usize; 2]) -> Trajectory {
        let mut rows = vec![[self.end, self.whole[1], self.whole[0], self.at_end.u]];
        // A node has the changes up to the next one; the last one of a half needs none.
        let late = |changes: Option<[DoubleDouble; 2]>| changes.unwrap_or([ZERO; 2]);
        for node in 0..counts[0] {
            let (state, _) = self.forward[node];
            let [fall, time] = late(self.forward.get(node + 1).map(|&(_, changes)| changes));
            rows.push([state.u, state.q, fall, time]);
        }
        let mut state = self.at_end;
        for node in 0..counts[1] {
            let width = grids[1].place(node + 1) - grids[1].place(node);
            let (next, [fall, time]) = self.moved(&state, DoubleDouble(-width, 0.0));
            let minus = |x: DoubleDouble| ZERO.minus(x);
            rows.push([state.u, state.q, minus(fall), minus(time)]);
            state = next;
        }
        rows
    }
}

/// The coefficients of 1, x, x², … of the polynomial through `values` at `points`, by Newton's
/// divided differences.
fn monomial(points: &[f64], mut values: Vec<DoubleDouble>) -> Vec<f64> {
    let count = points.len();
    for order in 1..count {
        for i in (order..count).rev() {
            let width = DoubleDouble::sum(points[i], -points[i - order]);
            values[i] = values[i].minus(values[i - 1]).over(width);
        }
    }
    // Horner's rule for the polynomial itself.
    let mut coefficients = vec![ZERO; count];
    for i in (0..count).rev() {
        for j in (1..count).rev() {
            coefficients[j] = coefficients[j - 1].minus(coefficients[j].scaled(points[i]));
        }
        coefficients[0] = values[i].minus(coefficients[0].scaled(points[i]));
    }
    coefficients.into_iter().map(DoubleDouble::nearest).collect()
}

#[cfg(test)]
mod tests;
