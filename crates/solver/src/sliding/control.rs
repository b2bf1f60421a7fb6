//! The equivalent control: the multipliers with which a field leads along surfaces.

use crate::sliding::{MOST, Sides, SurfaceSide};
use stickslip_number::Number;

pub(super) type Row<T> = [T; MOST];
pub(super) type Square<T> = [[T; MOST]; MOST];

/// A switched system in one of its own modes, in numbers of one kind.
pub(super) trait View<T: Number> {
    /// Writes the field with these signs, one for each surface.
    fn field(&self, signs: &[T], s: T, y: &[T], slope: &mut [T]);
    /// The surfaces' functions.
    fn surfaces(&self, s: T, y: &[T]) -> Row<T>;
    /// The rates at which the surfaces' functions change where the state changes with this slope.
    fn rates(&self, s: T, y: &[T], slope: &[T]) -> Row<T>;
}

/// The determinant of the rows and columns with these bits, as many of each and at least one.
fn determinant<T: Number>(a: &Square<T>, rows: usize, columns: usize) -> T {
    let (row, rest) = (rows.trailing_zeros() as usize, rows & (rows - 1));
    let mut sum: Option<T> = None;
    let mut adds = true;
    for column in (0..MOST).filter(|column| columns >> column & 1 == 1) {
        let entry = a[row][column];
        let term = match rest {
            0 => entry,
            _ => entry * determinant(a, rest, columns & !(1 << column)),
        };
        sum = Some(match sum {
            None => term,
            Some(sum) if adds => sum + term,
            Some(sum) => sum - term,
        });
        adds = !adds;
    }
    sum.unwrap_or_else(|| T::from(1.0))
}

/// The principal minor of −a with these bits, at least one.
pub(super) fn minor<T: Number>(a: &Square<T>, rows: usize) -> T {
    let determinant = determinant(a, rows, rows);
    if rows.count_ones() % 2 == 1 { -determinant } else { determinant }
}

/// Solves a x = b by Cramer's rule, which needs no comparisons. With `size` 1 it is a quotient.
pub(super) fn solved<T: Number>(a: &Square<T>, b: &Row<T>, size: usize) -> Row<T> {
    let rows = (1 << size) - 1;
    let all = determinant(a, rows, rows);
    let mut x = [T::from(0.0); MOST];
    for j in 0..size {
        let mut replaced = *a;
        for i in 0..size {
            replaced[i][j] = b[i];
        }
        x[j] = determinant(&replaced, rows, rows) / all;
    }
    x
}

/// The shares of the fields above sliding surfaces.
struct Controlled<T> {
    /// The share of the field above each sliding surface, in order: (1 + λ)/2.
    shares: Row<T>,
    count: usize,
    /// The rates of the surfaces' functions above each surface, less those below all.
    rates: Square<T>,
}

/// The shares with which the state slides. `fields` has room for one field more than there are
/// sliding surfaces. It then holds the field below all of them, and those above one each.
///
/// Nothing else but +1 and −1 is ever passed to a field, so that it may be two formulas.
fn shares<T: Number>(
    view: &impl View<T>,
    sides: &Sides,
    (s, y): (T, &[T]),
    fields: &mut [T],
) -> Controlled<T> {
    let n = y.len();
    let (below, above) = fields.split_at_mut(n);
    let mut signs: Row<T> =
        sides.sides.map(|side| T::from(if side == SurfaceSide::Above { 1.0 } else { -1.0 }));
    view.field(&signs[..sides.count], s, y, below);
    let base = view.rates(s, y, below);
    let (mut a, mut b) = ([[T::from(0.0); MOST]; MOST], [T::from(0.0); MOST]);
    let mut count = 0;
    for (j, surface) in sides.sliding().enumerate() {
        let field = &mut above[j * n..(j + 1) * n];
        signs[surface] = T::from(1.0);
        view.field(&signs[..sides.count], s, y, field);
        signs[surface] = T::from(-1.0);
        let rates = view.rates(s, y, field);
        for (i, row) in sides.sliding().enumerate() {
            a[i][j] = rates[row] - base[row];
        }
        b[j] = -base[surface];
        count = j + 1;
    }
    let shares = if count == 0 { b } else { solved(&a, &b, count) };
    Controlled { shares, count, rates: a }
}

/// Writes the field of a mode to `slope`. `fields` is room as in [`shares`]. The field is NaN where
/// the solution is not attracted to the surfaces that it slides along: it is not unique there.
pub(super) fn field<T: Number>(
    view: &impl View<T>,
    sides: &Sides,
    (s, y): (T, &[T]),
    fields: &mut [T],
    slope: &mut [T],
) {
    if sides.refusal.is_some() {
        slope.fill(T::from(f64::NAN));
        return;
    }
    if sides.sliding().next().is_none() {
        let signs = sides.sides.map(|side| T::from(side.sign()));
        view.field(&signs[..sides.count], s, y, slope);
        return;
    }
    let Controlled { shares, count, rates } = shares(view, sides, (s, y), fields);
    let n = y.len();
    for (k, slope) in slope.iter_mut().enumerate() {
        let below = fields[k];
        *slope =
            (0..count).fold(below, |sum, j| sum + shares[j] * (fields[(j + 1) * n + k] - below));
    }
    for rows in 1..1 << count {
        let attracts = minor(&rates, rows);
        for slope in slope.iter_mut() {
            *slope = attracts.select(*slope, T::from(f64::NAN));
        }
    }
}

/// The two guards of each surface: on a side, how far it is from the surface; while it slides,
/// 1 − λ and 1 + λ with the multiplier λ.
pub(super) fn guards<T: Number>(
    view: &impl View<T>,
    sides: &Sides,
    (s, y): (T, &[T]),
    fields: &mut [T],
) -> [[T; 2]; MOST] {
    let values = view.surfaces(s, y);
    let mut sliding = sides.sliding().peekable();
    let shares = sliding.peek().is_some().then(|| shares(view, sides, (s, y), fields).shares);
    let mut next = 0;
    std::array::from_fn(|i| match (sides.sides[i], &shares) {
        (SurfaceSide::Sliding, Some(shares)) => {
            let share = shares[next];
            next += 1;
            [(-share + 1.0) * 2.0, share * 2.0]
        }
        (SurfaceSide::Below, _) => [-values[i], T::from(1.0)],
        _ => [values[i], T::from(1.0)],
    })
}
