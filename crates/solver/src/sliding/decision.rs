//! How a solution goes on from a state on surfaces.
//!
//! With signs λ, the rates of the surfaces on which the state lies are b + A λ. The solution goes
//! on with those λ for which each surface is left upwards (λ = 1, rate > 0), left downwards
//! (λ = −1, rate < 0) or slid along (|λ| < 1, rate 0). There is exactly one such λ for every b if
//! and only if −A is a P-matrix: all its principal minors are positive (Lootsma, van der Schaft and
//! Çamlıbel, *Automatica* 35 (1999) 467). With one surface this is A < 0. At most 3⁴ = 81
//! combinations are tried, and surfaces are slid along only where their part of −A is a P-matrix,
//! so that the solution is attracted to them.
//!
//! All surfaces are decided together. One after the other, the answers could contradict each other:
//! where a solution spirals into the line in which two surfaces meet, each transition would undo
//! the one before.

use crate::sliding::control::{self, Row, Square, View, minor, solved};
use crate::sliding::{MOST, Refusal, Sides, SurfaceSide};

/// A number that is smaller than this, relative to its scale, has an uncertain sign.
const SMALL: f64 = 1e-12;

/// Why the continuation of the solution has to be decided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cause<'a> {
    /// The run starts, and keeps these sides where it could go on in several ways.
    Start(&'a [Option<SurfaceSide>]),
    /// The state has arrived at this surface from a side.
    Arrived(usize),
    /// The multiplier of this surface has reached the sign of a side.
    Released(usize, SurfaceSide),
    /// The system itself has changed its mode or the state. The surfaces' functions had these
    /// values before.
    Moved(Row<f64>),
}

/// Decides how the solution goes on from `y`, where it came from the `old` sides. Where it begins
/// or ends to slide, the state is moved onto the surfaces, along the differences of the fields:
/// what the signs do not act on stays what it is, bit for bit.
pub(super) fn decide(
    view: &impl View<f64>,
    old: &Sides,
    cause: Cause<'_>,
    s: f64,
    y: &mut [f64],
) -> Sides {
    let from = came_from(view, old, cause, s, y);
    let on = surfaces_at(view, &from, cause, s, y);
    let decided = Problem::new(view, &from, on, s, y)
        .and_then(|problem| Ok((problem.decided(view, &from, cause, s, y)?, problem)));
    match decided {
        Ok((decided, problem)) => {
            if !matches!(cause, Cause::Start(_)) {
                problem.move_onto(view, &from, &decided, s, y);
            }
            decided
        }
        Err(refusal) => from.refused(refusal),
    }
}

/// A number that vanishes where [`decide`] changes its mind; NaN if nothing is to be decided.
///
/// Where the state arrives at a surface, it is the rate of the surface's function behind it, and
/// positive where the solution slides. Where other surfaces may begin or cease to be slid along at
/// the same place, it is the smallest of several such numbers, and changes its sign with each.
pub(super) fn condition(
    view: &impl View<f64>,
    old: &Sides,
    cause: Cause<'_>,
    s: f64,
    y: &[f64],
) -> f64 {
    let from = came_from(view, old, cause, s, y);
    let arrived = match cause {
        Cause::Arrived(surface) => Some(surface),
        Cause::Moved(_) => None,
        Cause::Start(_) | Cause::Released(..) => return f64::NAN,
    };
    let on = surfaces_at(view, &from, cause, s, y);
    let Ok(problem) = Problem::new(view, &from, on, s, y) else { return f64::NAN };
    let Ok(decided) = problem.decided(view, &from, cause, s, y) else { return f64::NAN };
    let (mut least, mut positive) = (f64::NAN, true);
    for (i, &surface) in problem.on().iter().enumerate() {
        let (was, is) = (from.sides[surface], decided.sides[surface]);
        let distance = if arrived == Some(surface) {
            // Behind the surface, with all others as they were.
            let mut behind = problem.of(&from);
            behind[i] =
                if was == SurfaceSide::Below { SurfaceSide::Above } else { SurfaceSide::Below };
            positive ^= is != SurfaceSide::Sliding;
            problem.outcome(behind).map_or(f64::NAN, |at| was.sign() * at.rates[i])
        } else {
            positive ^= is != was;
            let mut sliding = problem.of(&decided);
            sliding[i] = SurfaceSide::Sliding;
            let slides = was == SurfaceSide::Sliding || is == SurfaceSide::Sliding;
            if !slides {
                continue;
            }
            problem.outcome(sliding).map_or(f64::NAN, |at| 1.0 - at.multipliers[i].abs())
        };
        least = if distance.abs() >= least { least } else { distance.abs() };
    }
    if positive { least } else { -least }
}

/// The sides from which the solution goes on, before its continuation is decided.
fn came_from(view: &impl View<f64>, old: &Sides, cause: Cause<'_>, s: f64, y: &[f64]) -> Sides {
    let mut from = Sides { zeros: [[0; 2]; MOST], unique: true, refusal: None, ..*old };
    if let Cause::Moved(was) = cause {
        let is = view.surfaces(s, y);
        let known = rounding(view, s, y, &is);
        for i in 0..from.count {
            let stays = match from.sides[i] {
                SurfaceSide::Sliding => is[i].abs() <= was[i].abs() + known[i],
                // A guard beyond its zero, as in a run with a prescribed itinerary, stays there.
                side => [side, SurfaceSide::of(was[i])].contains(&SurfaceSide::of(is[i])),
            };
            if !stays {
                from.sides[i] = SurfaceSide::of(is[i]);
            }
        }
    }
    from
}

/// How much rounding of time and state by a few units in the last place changes the functions.
fn rounding(view: &impl View<f64>, s: f64, y: &[f64], values: &Row<f64>) -> Row<f64> {
    const SLIGHT: f64 = 1e-12;
    let change = |moved: Row<f64>| -> Row<f64> {
        std::array::from_fn(|i| (moved[i] - values[i]).abs() * (4.0 * f64::EPSILON / SLIGHT))
    };
    let mut sum = change(view.surfaces(s + SLIGHT * s.abs(), y));
    let mut moved = y.to_vec();
    for k in 0..y.len() {
        moved[k] += SLIGHT * y[k].abs();
        let change = change(view.surfaces(s, &moved));
        sum.iter_mut().zip(change).for_each(|(sum, change)| *sum += change);
        moved[k] = y[k];
    }
    sum
}

/// Which surfaces the state lies on, one bit each: surfaces that it slides along, the surface at
/// which it has arrived, and surfaces from which rounding of state or time may have moved it away.
fn surfaces_at(view: &impl View<f64>, from: &Sides, cause: Cause<'_>, s: f64, y: &[f64]) -> usize {
    let values = view.surfaces(s, y);
    let known = rounding(view, s, y, &values);
    let n = y.len();
    let (mut slope, mut fields) = (vec![0.0; n], vec![0.0; (MOST + 1) * n]);
    control::field(view, from, (s, y), &mut fields, &mut slope);
    let rates = view.rates(s, y, &slope);
    let mut on = 0;
    for i in 0..from.count {
        let soon = 4.0 * f64::EPSILON * s.abs() * rates[i].abs();
        let is_on = from.sides[i] == SurfaceSide::Sliding
            || matches!(cause, Cause::Arrived(surface) if surface == i)
            || values[i].abs() <= known[i] + if soon.is_finite() { soon } else { 0.0 };
        on |= usize::from(is_on) << i;
    }
    on
}

/// The surfaces on which a state lies, with the rates b + A λ of their functions.
struct Problem {
    on: [usize; MOST],
    size: usize,
    b: Row<f64>,
    a: Square<f64>,
    /// A with rows and columns divided by positive scales.
    scaled: Square<f64>,
    /// The field below all these surfaces, and the fields above one of them each.
    fields: Vec<f64>,
}

/// What follows from a choice of sides.
struct Outcome {
    multipliers: Row<f64>,
    rates: Row<f64>,
}

/// Why multipliers do not exist.
enum Unsolved {
    /// The equations contradict each other.
    Never,
    /// Infinitely many multipliers solve the equations.
    Singular,
}

/// Whether a choice of sides goes on.
enum Verdict {
    No,
    Yes,
    /// Some multipliers are ±1 up to rounding: those of the surfaces with these bits.
    Nearly(usize),
}

impl Problem {
    fn new(
        view: &impl View<f64>,
        from: &Sides,
        on_bits: usize,
        s: f64,
        y: &[f64],
    ) -> Result<Self, Refusal> {
        let mut on = [0; MOST];
        let mut size = 0;
        for i in (0..from.count).filter(|i| on_bits >> i & 1 == 1) {
            on[size] = i;
            size += 1;
        }
        let n = y.len();
        let (mut a, mut b, mut fields) =
            ([[0.0; MOST]; MOST], [0.0; MOST], vec![0.0; (size + 1) * n]);
        if size == 0 {
            return Ok(Self { on, size, b, a, scaled: a, fields });
        }
        let signs = |corner: usize| {
            let mut signs = from.sides.map(SurfaceSide::sign);
            for (j, &surface) in on[..size].iter().enumerate() {
                signs[surface] = if corner >> j & 1 == 1 { 1.0 } else { -1.0 };
            }
            signs
        };
        let corner_of = |j: usize| if j == 0 { 0 } else { 1 << (j - 1) };
        let mut rates = [[0.0; MOST]; MOST + 1];
        for j in 0..=size {
            let field = &mut fields[j * n..(j + 1) * n];
            view.field(&signs(corner_of(j))[..from.count], s, y, field);
            rates[j] = view.rates(s, y, field);
        }
        for i in 0..size {
            b[i] = rates[0][on[i]];
            for j in 0..size {
                a[i][j] = 0.5 * (rates[j + 1][on[i]] - rates[0][on[i]]);
                b[i] += a[i][j];
            }
        }
        if b[..size]
            .iter()
            .chain(a[..size].iter().flat_map(|row| &row[..size]))
            .any(|x| !x.is_finite())
        {
            return Err(Refusal::NotFinite);
        }
        let problem = Self { on, size, b, a, scaled: scaled(&a, size), fields };
        let mut other = vec![0.0; n];
        for corner in (0_usize..1 << size).filter(|corner| corner.count_ones() > 1) {
            view.field(&signs(corner)[..from.count], s, y, &mut other);
            if !problem.explains(corner, &other) {
                return Err(Refusal::NotAffine);
            }
        }
        Ok(problem)
    }

    /// Whether the field above the surfaces of a `corner` is the sum of what each sign changes.
    fn explains(&self, corner: usize, field: &[f64]) -> bool {
        let n = field.len();
        let largest = self.fields.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        (0..n).all(|k| {
            let below = self.fields[k];
            let (mut sum, mut changes, mut size) = (below, 0.0, below.abs());
            for j in 0..self.size {
                let above = self.fields[(j + 1) * n + k];
                size = size.max(above.abs());
                changes += (above - below).abs();
                sum += if corner >> j & 1 == 1 { above - below } else { 0.0 };
            }
            // Rounding is far below these bounds, and a product of two signs far above them.
            (field[k] - sum).abs() <= 1e-6 * changes + 1e-12 * size + 1e-14 * largest
        })
    }

    fn on(&self) -> &[usize] {
        &self.on[..self.size]
    }

    /// The sides of these surfaces.
    fn of(&self, sides: &Sides) -> [SurfaceSide; MOST] {
        self.on.map(|surface| sides.sides[surface])
    }

    /// Multipliers and rates for a choice of sides.
    fn outcome(&self, choice: [SurfaceSide; MOST]) -> Result<Outcome, Unsolved> {
        let mut multipliers = choice.map(SurfaceSide::sign);
        let sliding: Vec<usize> =
            (0..self.size).filter(|&i| choice[i] == SurfaceSide::Sliding).collect();
        let rate = |i: usize, multipliers: &Row<f64>| {
            (0..self.size).fold(self.b[i], |sum, j| sum + self.a[i][j] * multipliers[j])
        };
        if !sliding.is_empty() {
            let (mut a, mut b) = ([[0.0; MOST]; MOST], [0.0; MOST]);
            for (row, &i) in sliding.iter().enumerate() {
                for (column, &j) in sliding.iter().enumerate() {
                    a[row][column] = self.a[i][j];
                }
                b[row] = -rate(i, &multipliers);
            }
            if minor(&self.scaled, bits(sliding.iter().copied())).abs() <= SMALL {
                return Err(singular(a, b, sliding.len()));
            }
            let solved = solved(&a, &b, sliding.len());
            for (row, &i) in sliding.iter().enumerate() {
                multipliers[i] = solved[row];
            }
        }
        let mut rates = [0.0; MOST];
        for i in (0..self.size).filter(|&i| choice[i] != SurfaceSide::Sliding) {
            rates[i] = rate(i, &multipliers);
        }
        Ok(Outcome { multipliers, rates })
    }

    /// Whether the solution is attracted to the surfaces that are slid along.
    fn attracts(&self, choice: [SurfaceSide; MOST]) -> bool {
        let slides = bits((0..self.size).filter(|&i| choice[i] == SurfaceSide::Sliding));
        (1..1 << self.size).all(|rows| rows & !slides != 0 || minor(&self.scaled, rows) > SMALL)
    }

    /// Whether the solution goes on with this choice of sides. Sides that are `given` are not
    /// checked.
    fn verdict(&self, choice: [SurfaceSide; MOST], given: usize) -> Result<Verdict, Refusal> {
        let at = match self.outcome(choice) {
            Ok(at) => at,
            Err(Unsolved::Never) => return Ok(Verdict::No),
            Err(Unsolved::Singular) => return Err(Refusal::Singular),
        };
        let mut near = 0;
        for i in (0..self.size).filter(|i| given >> i & 1 == 0) {
            let (inside, scale) = match choice[i] {
                SurfaceSide::Sliding => (1.0 - at.multipliers[i].abs(), 1.0),
                side => {
                    let row = self.a[i][..self.size].iter().map(|x| x.abs()).sum::<f64>();
                    (side.sign() * at.rates[i], row + self.b[i].abs())
                }
            };
            if inside < -SMALL * scale {
                return Ok(Verdict::No);
            }
            near |= usize::from(inside <= SMALL * scale) << i;
        }
        Ok(if !self.attracts(choice) {
            Verdict::No
        } else if near == 0 {
            Verdict::Yes
        } else {
            Verdict::Nearly(near)
        })
    }

    /// Decides how the solution goes on.
    fn decided(
        &self,
        view: &impl View<f64>,
        from: &Sides,
        cause: Cause<'_>,
        s: f64,
        y: &[f64],
    ) -> Result<Sides, Refusal> {
        let were = self.of(from);
        let moved = matches!(cause, Cause::Moved(_));
        let mut given = if moved { 0 } else { self.held(were) };
        let mut target = were;
        if let Cause::Released(surface, side) = cause {
            if !self.attracts(were) {
                return Err(Refusal::NotUnique);
            }
            for (i, _) in self.on().iter().enumerate().filter(|(_, on)| **on == surface) {
                given |= 1 << i;
                target[i] = side;
            }
        }
        let (mut sure, mut near) = (Vec::new(), Vec::new());
        let mut singular = None;
        for choice in self.choices(target, given) {
            match self.verdict(choice, given) {
                Ok(Verdict::Yes) => sure.push((choice, 0)),
                Ok(Verdict::Nearly(bits)) => near.push((choice, bits)),
                Ok(Verdict::No) => {}
                Err(refusal) => singular = Some(refusal),
            }
        }
        if let Some(refusal) = singular {
            return Err(refusal);
        }
        if sure.is_empty() {
            near.retain(|(choice, bits)| self.goes_on(view, from, *choice, (*bits, given), s, y));
            sure = near;
        }
        let arrived = match cause {
            Cause::Arrived(surface) => Some(surface),
            _ => None,
        };
        // The solution keeps its sides, except at the surface at which it has arrived.
        let kept = |choice: [SurfaceSide; MOST]| {
            (0..self.size).all(|i| match cause {
                Cause::Start(given) => given[self.on[i]] == Some(choice[i]),
                _ => choice[i] == target[i] || arrived == Some(self.on[i]),
            })
        };
        let unique = sure.len() < 2;
        if !unique {
            sure.retain(|(choice, _)| kept(*choice));
        }
        let [(choice, bits)] = sure[..] else {
            return Err(if unique { Refusal::NoSolution } else { Refusal::NotUnique });
        };
        if arrived.is_some() && bits == 0 && choice[..self.size] == were[..self.size] {
            // A state cannot come from where it goes; in doubt, it has touched the surface.
            return Err(Refusal::NoSolution);
        }
        let mut decided = Sides { unique, ..*from };
        for (i, &surface) in self.on().iter().enumerate() {
            let near = bits >> i & 1 == 1;
            decided.sides[surface] = choice[i];
            decided.zeros[surface] = match choice[i] {
                SurfaceSide::Sliding => {
                    let at = self.outcome(choice).map_or(0.0, |at| at.multipliers[i]);
                    [u8::from(near && at > 0.0), u8::from(near && at < 0.0)]
                }
                // The function starts with a double zero where its rate does.
                _ => [1 + u8::from(near || given >> i & 1 == 1), 0],
            };
        }
        Ok(decided)
    }

    /// The surfaces that are slid along with multipliers beyond ±1, as in runs with a prescribed
    /// itinerary, which go on so until their exits.
    fn held(&self, were: [SurfaceSide; MOST]) -> usize {
        let Ok(at) = self.outcome(were) else { return 0 };
        let beyond = |&i: &usize| at.multipliers[i].abs() > 1.0 + SMALL;
        bits((0..self.size).filter(|&i| were[i] == SurfaceSide::Sliding).filter(beyond))
    }

    /// All choices of sides, with those that are `given` as in `target`.
    fn choices(&self, target: [SurfaceSide; MOST], given: usize) -> Vec<[SurfaceSide; MOST]> {
        let mut all = vec![target];
        for i in (0..self.size).filter(|i| given >> i & 1 == 0) {
            let sides = [SurfaceSide::Above, SurfaceSide::Below, SurfaceSide::Sliding];
            all = all
                .into_iter()
                .flat_map(|choice| {
                    sides.map(|side| {
                        let mut choice = choice;
                        choice[i] = side;
                        choice
                    })
                })
                .collect();
        }
        all
    }

    /// Whether multipliers that are ±1 move so that the solution goes on with this choice: inwards
    /// where it slides, and outwards where it does not. On the way they are compared with those a
    /// little later.
    fn goes_on(
        &self,
        view: &impl View<f64>,
        from: &Sides,
        choice: [SurfaceSide; MOST],
        (near, given): (usize, usize),
        s: f64,
        y: &[f64],
    ) -> bool {
        let Ok(at) = self.outcome(choice) else { return false };
        let n = y.len();
        let slope: Vec<f64> = (0..n)
            .map(|k| {
                let below = self.fields[k];
                (0..self.size).fold(below, |sum, j| {
                    sum + 0.5 * (1.0 + at.multipliers[j]) * (self.fields[(j + 1) * n + k] - below)
                })
            })
            .collect();
        let largest = |all: &[f64]| all.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let time = largest(y) / largest(&slope);
        let later = 1e-4 * if time.is_finite() && time > 0.0 { time } else { 1.0 };
        let moved: Vec<f64> = y.iter().zip(&slope).map(|(y, slope)| y + later * slope).collect();
        let on = bits(self.on().iter().copied());
        let Ok(then) = Self::new(view, from, on, s + later, &moved) else { return false };
        (0..self.size).filter(|i| near >> i & 1 == 1 && given >> i & 1 == 0).all(|i| {
            let mut sliding = choice;
            sliding[i] = SurfaceSide::Sliding;
            let (Ok(now), Ok(then)) = (self.outcome(sliding), then.outcome(sliding)) else {
                return false;
            };
            let (now, then) = (now.multipliers[i], then.multipliers[i]);
            match choice[i] {
                SurfaceSide::Sliding => then.abs() <= now.abs(),
                side => side.sign() * then > side.sign() * now,
            }
        })
    }

    /// Moves the state onto the surfaces that are slid along before or after.
    fn move_onto(&self, view: &impl View<f64>, from: &Sides, to: &Sides, s: f64, y: &mut [f64]) {
        let slides = |i: &usize| {
            let surface = self.on[*i];
            from.sides[surface] == SurfaceSide::Sliding || to.sides[surface] == SurfaceSide::Sliding
        };
        let rows: Vec<usize> = (0..self.size).filter(slides).collect();
        if rows.is_empty() || minor(&self.scaled, bits(rows.iter().copied())).abs() <= SMALL {
            return;
        }
        let values = view.surfaces(s, y);
        let (mut a, mut b) = ([[0.0; MOST]; MOST], [0.0; MOST]);
        for (row, &i) in rows.iter().enumerate() {
            for (column, &j) in rows.iter().enumerate() {
                a[row][column] = self.a[i][j];
            }
            b[row] = values[self.on[i]];
        }
        let by = solved(&a, &b, rows.len());
        let n = y.len();
        for (k, y) in y.iter_mut().enumerate() {
            for (&j, by) in rows.iter().zip(by) {
                *y -= by * 0.5 * (self.fields[(j + 1) * n + k] - self.fields[k]);
            }
        }
    }
}

/// The numbers as bits.
fn bits(numbers: impl Iterator<Item = usize>) -> usize {
    numbers.fold(0, |bits, number| bits | 1 << number)
}

/// A with each row and then each column divided by its largest entry.
fn scaled(a: &Square<f64>, size: usize) -> Square<f64> {
    let mut scaled = *a;
    for row in &mut scaled[..size] {
        let most = row.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        for x in row.iter_mut() {
            *x /= if most > 0.0 { most } else { 1.0 };
        }
    }
    for j in 0..size {
        let most = scaled[..size].iter().fold(0.0_f64, |most, row| most.max(row[j].abs()));
        scaled[..size].iter_mut().for_each(|row| row[j] /= if most > 0.0 { most } else { 1.0 });
    }
    scaled
}

/// Whether singular equations a λ = b have solutions with |λ| ≤ 1, by elimination with the largest
/// pivots; a single row must exclude this size for the answer to be no.
fn singular(mut a: Square<f64>, mut b: Row<f64>, size: usize) -> Unsolved {
    let mut scales = [0.0; MOST];
    for i in 0..size {
        let sum = a[i][..size].iter().map(|x| x.abs()).sum::<f64>();
        scales[i] = sum.max(b[i].abs());
        if b[i].abs() > sum * (1.0 + SMALL) {
            return Unsolved::Never;
        }
        let by = if scales[i] > 0.0 { scales[i] } else { 1.0 };
        a[i].iter_mut().for_each(|x| *x /= by);
        b[i] /= by;
    }
    let mut rows: Vec<usize> = (0..size).collect();
    let mut columns = rows.clone();
    while let Some((row, column)) = rows
        .iter()
        .flat_map(|&i| columns.iter().map(move |&j| (i, j)))
        .max_by(|&(i, j), &(k, l)| a[i][j].abs().total_cmp(&a[k][l].abs()))
        .filter(|&(i, j)| a[i][j].abs() > SMALL)
    {
        rows.retain(|&i| i != row);
        columns.retain(|&j| j != column);
        for &i in &rows {
            let factor = a[i][column] / a[row][column];
            for &j in &columns {
                a[i][j] -= factor * a[row][j];
            }
            b[i] -= factor * b[row];
        }
    }
    let contradicts = rows.iter().any(|&i| b[i].abs() > 1e-9);
    if contradicts { Unsolved::Never } else { Unsolved::Singular }
}
