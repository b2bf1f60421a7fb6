//! From a guess to a zero of a margin, of two margins, or of the gradient of a margin.
//!
//! Gradients are differences. A gradient takes four runs and is good to 5e-10; a run with three
//! derivatives would take five times as long as a run, and cubics are checked by values of the
//! margin, to 1e-10.

use nalgebra::{Matrix2, Vector2};

use crate::family::Family;
use crate::inverse;
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

/// The place near `guess` where two margins vanish together, by Newton's method, and its largest
/// error. The error is large if the boundaries almost touch. Gradients are differences along
/// `direction` and across it.
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
    /// An update to a place without one of the margins is trusted if it is shorter than this
    /// fraction of the window's shorter extent. Its error is of second order.
    const LAST: f64 = 1e-7;
    /// The least sine of the angle between the two boundaries for which such an update is trusted.
    const TRANSVERSAL: f64 = 0.03;
    let mut point = *guess;
    let mut update = Point::zeros();
    let mut sine = 0.0;
    let mut last = f64::INFINITY;
    let mut inverse: Option<Matrix2<f64>> = None;
    for _ in 0..40 {
        let (Some(first), Some(second)) =
            (runs.margin(&point, margins[0])?, runs.margin(&point, margins[1])?)
        else {
            if sine < TRANSVERSAL {
                return Ok(None);
            }
            if last <= LAST * runs.scale {
                return Ok(Some((point, last.max(10.0 * runs.options.tolerance))));
            }
            update *= 0.5;
            point += update;
            continue;
        };
        if inverse.is_none() {
            let (Some(one), Some(two)) = (
                runs.gradient(&point, margins[0], direction, radius)?,
                runs.gradient(&point, margins[1], direction, radius)?,
            ) else {
                return Ok(None);
            };
            sine = one.perp(&two).abs() / (one.norm() * two.norm());
            let independent = sine > 1e-7;
            if !independent {
                return Ok(None);
            }
            let gradients = Matrix2::from_rows(&[one.transpose(), two.transpose()]);
            inverse = inverse::of_two(&gradients);
        }
        let Some(solver) = inverse else { return Ok(None) };
        update = solver * Vector2::new(first, second);
        point -= update;
        let size = update.norm();
        let within = (point - guess).norm() <= reach;
        if !within {
            return Ok(None);
        }
        let resolution = runs.options.tolerance.max(runs.options.noise * solver.norm());
        if size <= runs.options.tolerance || (size <= 10.0 * resolution && size >= 0.5 * last) {
            return Ok(Some((point, 10.0 * resolution)));
        }
        // The gradients are used again as long as the updates shrink fast.
        if size > 0.01 * last {
            inverse = None;
        }
        last = size;
    }
    Ok(None)
}

/// The place near `guess` where the gradient of a margin vanishes, by Newton's method.
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
    let mut point = *guess;
    let mut h = spread;
    for _ in 0..60 {
        let Some((gradient, second)) = derivatives(runs, margin, &point, h)? else {
            return Ok(None);
        };
        let Some(inverse) = inverse::of_two(&second) else { return Ok(None) };
        let update = inverse * gradient;
        point -= update;
        let within = (point - guess).norm() <= reach;
        if !within {
            return Ok(None);
        }
        let size = update.norm();
        if size <= runs.options.tolerance {
            return Ok(Some(point));
        }
        h = (0.1 * size).min(h);
    }
    Ok(None)
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
