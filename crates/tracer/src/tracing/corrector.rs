//! From a guess to a zero of a margin, of two margins, or of the gradient of a margin.
//!
//! Gradients are differences. A gradient takes four runs and is good to 5e-10; a run with three
//! derivatives would take five times as long as a run, and cubics are checked by values of the
//! margin, to 1e-10.

use nalgebra::Matrix2;

use crate::conditions::{Limits, Unsolved, Zero, solve};
use crate::family::Family;
use crate::lengths::angle;
use crate::options::TraceOptions;
use crate::tracing::runs::{Runs, Traced};
use crate::window::Point;

/// A place on a boundary, with the number of evaluations of the margin on the way.
pub(crate) struct Corrected {
    pub point: Point,
    pub evaluations: usize,
}

/// The zero of a margin on the line through `guess` along `gradient`, at most `reach` away, by the
/// secant method.
///
/// `gradient` is the gradient at a place nearby, and its length is the first slope. The margin is
/// not evaluated after the last update. The remaining error is this update times the relative error
/// of the slope, which is at most the contraction of the update before.
pub(crate) fn correct<F: Family>(
    runs: &Runs<'_, F>,
    margin: &F::Margin,
    guess: &Point,
    gradient: &Point,
    reach: f64,
) -> Traced<Option<Corrected>, F> {
    let mut slope = gradient.norm();
    let normal = gradient / slope;
    if !normal.iter().all(|part| part.is_finite()) {
        return Ok(None);
    }
    let mut point = *guess;
    let Some(mut value) = runs.margin(&point, margin)? else { return Ok(None) };
    let mut contraction: f64 = 0.1;
    for evaluations in 1..=10 {
        let update = -value / slope;
        let next = point + normal * update;
        let within = (next - guess).norm() <= reach;
        if !within {
            return Ok(None);
        }
        if update.abs() * contraction <= 0.2 * runs.resolution(slope) {
            return Ok(Some(Corrected { point: next, evaluations }));
        }
        let Some(next_value) = runs.margin(&next, margin)? else { return Ok(None) };
        contraction = (next_value / value).abs();
        // A smaller difference of two values is noise, and the slope so far is better.
        let fall = next_value - value;
        if fall.abs() > 1e3 * runs.options.noise {
            let secant = fall / update;
            let alike = secant > 0.05 * slope && secant < 20.0 * slope;
            if !alike {
                return Ok(None);
            }
            slope = secant;
            contraction += runs.options.noise / fall.abs();
        }
        (point, value) = (next, next_value);
    }
    Ok(None)
}

/// The zero of a margin on the edge of a window through `guess`, along which `axis` is constant; at
/// most `reach` away. Where the boundary nearly runs along the edge, the result is the place of the
/// edge next to a zero beside `guess`.
pub(crate) fn correct_on_edge<F: Family>(
    runs: &Runs<'_, F>,
    margin: &F::Margin,
    guess: &Point,
    gradient: &Point,
    axis: usize,
    reach: f64,
) -> Traced<Option<Point>, F> {
    let mut along = *gradient;
    along[axis] = 0.0;
    let crosses = along.norm() > 1e-3 * gradient.norm();
    let direction = if crosses { &along } else { gradient };
    let found = correct(runs, margin, guess, direction, reach)?;
    Ok(found.map(|Corrected { mut point, .. }| {
        point[axis] = guess[axis];
        point
    }))
}

/// The place near `guess` where two margins vanish together, and its largest error. The error is
/// large if the boundaries almost touch. Gradients are differences along `direction` and across it.
///
/// If one margin ceases to exist at the boundary of the other, the place is approached from the
/// side on which both exist.
pub(crate) fn crossing<F: Family>(
    runs: &Runs<'_, F>,
    margins: [&F::Margin; 2],
    guess: &Point,
    direction: &Point,
    radius: f64,
    reach: f64,
) -> Traced<Option<(Point, f64)>, F> {
    let TraceOptions { tolerance, noise, .. } = runs.options;
    let last = runs.lengths.half;
    let stalled = 10.0 * tolerance;
    let limits = Limits::new(reach, tolerance);
    let limits = Limits { stalled, noise, reuse: 0.01, retreat: last, ..limits };
    let mut sine = 0.0;
    let found: Traced<_, F> = solve(guess, &limits, |at, steep| {
        let values = margins.map(|margin| runs.margin(at, margin));
        let [Some(one), Some(two)] = both(values)? else {
            // Between boundaries that nearly touch, no way leads back.
            let apart = sine >= angle::TRANSVERSAL;
            return Ok((!apart).then(|| (Point::repeat(f64::NAN), None)));
        };
        let values = Point::new(one, two);
        if !steep {
            return Ok(Some((values, None)));
        }
        let gradients = margins.map(|margin| runs.gradient(at, margin, direction, radius));
        let [Some(one), Some(two)] = both(gradients)? else { return Ok(Some((values, None))) };
        sine = one.perp(&two).abs() / (one.norm() * two.norm());
        let slopes = Matrix2::from_rows(&[one.transpose(), two.transpose()]);
        Ok(Some((values, Some(slopes).filter(|_| sine > angle::DEPENDENT))))
    });
    Ok(match found? {
        Ok(Zero { at, error, .. }) => Some((at, error)),
        Err(Unsolved::Ceases { at, update }) if update <= last => {
            Some((at, update.max(10.0 * tolerance)))
        }
        Err(_) => None,
    })
}

/// Both of two results.
fn both<T, E>([one, two]: [Result<T, E>; 2]) -> Result<[T; 2], E> {
    Ok([one?, two?])
}

/// The place near `guess` where the gradient of a margin vanishes.
///
/// The step of the differences follows the updates. So a singular second derivative only slows the
/// method down: at a cusp each round halves the distance.
pub(crate) fn stationary<F: Family>(
    runs: &Runs<'_, F>,
    margin: &F::Margin,
    guess: &Point,
    spread: f64,
    reach: f64,
) -> Traced<Option<Point>, F> {
    let (mut h, mut last) = (spread, None);
    let limits = Limits { rounds: 60, ..Limits::new(reach, runs.options.tolerance) };
    let zero: Traced<_, F> = solve(guess, &limits, |at, _| {
        if let Some(last) = last.replace(*at) {
            h = (0.1 * (*at - last).norm()).min(h);
        }
        let found = derivatives(runs, margin, at, h)?;
        Ok(found.map(|(gradient, second)| (gradient, Some(second))))
    });
    Ok(zero?.ok().map(|zero| zero.at))
}

/// The gradient and the second derivatives of a margin by differences with step `h`.
pub(crate) fn derivatives<F: Family>(
    runs: &Runs<'_, F>,
    margin: &F::Margin,
    point: &Point,
    h: f64,
) -> Traced<Option<(Point, Matrix2<f64>)>, F> {
    let mut values = [[0.0; 3]; 3];
    for (i, row) in values.iter_mut().enumerate() {
        for (j, value) in row.iter_mut().enumerate() {
            let place = point + Point::new(i as f64 - 1.0, j as f64 - 1.0) * h;
            let Some(found) = runs.margin(&place, margin)? else { return Ok(None) };
            *value = found;
        }
    }
    let [[aa, ab, ac], [ba, bb, bc], [ca, cb, cc]] = values;
    let gradient = Point::new(cb - ab, bc - ba) / (2.0 * h);
    let mixed = (cc - ca - ac + aa) / 4.0;
    let second = Matrix2::new(cb - 2.0 * bb + ab, mixed, mixed, bc - 2.0 * bb + ba) / (h * h);
    Ok(Some((gradient, second)))
}
