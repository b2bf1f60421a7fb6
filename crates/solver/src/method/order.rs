//! Orders of convergence, fitted to measured errors.

/// An error of a quantity of size 1 that is larger than this never counts as rounding.
const ROUNDING: f64 = 1e-12;
/// Rounding affects errors up to this multiple of the errors of the finest steps.
const SHOWS: f64 = 10.0;
/// The largest difference between the slopes of the two halves, in standard errors of the whole
/// slope: twice the standard error of that difference. The difference has four times the standard
/// error of the whole slope, as each half has an eighth of the whole's sum of squares.
const STRAIGHT: f64 = 8.0;
/// The fewest points of a fit, and the number of finest steps that tell the level of rounding.
const FEW: usize = 5;

/// The order of convergence that [`fit_order`] finds: an error falls with this power of the step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Order {
    /// The power: the slope of ln error against ln step.
    pub order: f64,
    /// The standard error of the slope, from the scatter about the line.
    pub standard_error: f64,
    /// The slope over the finer half of the points minus the slope over the coarser half. It tells
    /// how far the slope still is from its limit for small steps, which the scatter does not show.
    pub drift: f64,
    /// The coarsest step of the fit.
    pub coarsest: f64,
    /// The finest step of the fit.
    pub finest: f64,
    /// The number of steps in the fit.
    pub points: usize,
}

/// The order of convergence of `errors`, by least squares over the asymptotic range.
///
/// Each entry of `errors` is a step (or a tolerance) and the error that it leaves, with the largest
/// step first. Errors are those of quantities of size 1. The result is `None` if the asymptotic
/// range does not span a factor of `span`. Three rules decide which steps belong to this range:
///
/// 1. *Rounding.* The root mean square of the last five errors is the level at which errors may
///    have stopped falling. The first error that is below ten times this level, and below 1e-12, is
///    left out together with all finer steps.
/// 2. *No error.* NaN or infinity stands for an approximation that cannot be compared, for example
///    because it has other switches. It is left out together with all coarser steps.
/// 3. *Asymptotic range.* A range begins at the finest step that remains, spans at least a factor
///    of `span` and has at least five points. Two kinds of ranges compete: the shortest one, and
///    those whose two halves have slopes that differ by at most twice the standard error of that
///    difference. The range whose slope has the smallest standard error is taken.
///
/// ```
/// use stickslip_solver::fit_order;
///
/// // An error of fourth order with a term of seventh order, and rounding.
/// let steps = (0..60).map(|i| 0.5_f64.powf(f64::from(i) / 4.0));
/// let error = |h: f64| (h.powi(4) + 9.0 * h.powi(7)).hypot(1e-15);
/// let errors: Vec<(f64, f64)> = steps.map(|h| (h, error(h))).collect();
/// let fit = fit_order(&errors, 4.0).ok_or("no range")?;
/// assert!((fit.order - 4.0).abs() < 0.01 && fit.coarsest < 0.1 && fit.finest > 3e-4, "{fit:?}");
/// # Ok::<(), &str>(())
/// ```
#[must_use]
pub fn fit_order(errors: &[(f64, f64)], span: f64) -> Option<Order> {
    let last = &errors[errors.len().saturating_sub(FEW)..];
    let level = (last.iter().map(|(_, error)| error * error).sum::<f64>() / FEW as f64).sqrt();
    let rounded = |&(_, error): &(f64, f64)| error < ROUNDING && error <= SHOWS * level;
    let above = errors.iter().position(rounded).unwrap_or(errors.len());
    let compared = errors[..above].iter().rposition(|(_, error)| !error.is_finite());
    let usable: Vec<(f64, f64)> = errors[compared.map_or(0, |none| none + 1)..above]
        .iter()
        .rev()
        .map(|(step, error)| (step.ln(), error.ln()))
        .collect();
    let wide = |points: &&[(f64, f64)]| {
        points[points.len() - 1].0 - points[0].0 >= span.ln() * (1.0 - 1e-9)
    };
    let ranges = (FEW..=usable.len()).map(|count| &usable[..count]).filter(wide);
    let fits: Vec<Order> = ranges.map(fit).filter(|fit| fit.order.is_finite()).collect();
    let straight = fits.iter().filter(|fit| fit.drift.abs() <= STRAIGHT * fit.standard_error);
    let competing = fits.first().into_iter().chain(straight);
    competing.min_by(|a, b| a.standard_error.total_cmp(&b.standard_error)).copied()
}

/// The order from points of ln step and ln error, with the finest step first.
fn fit(points: &[(f64, f64)]) -> Order {
    let (order, standard_error) = line(points);
    let half = points.len().div_ceil(2);
    let drift = line(&points[..half]).0 - line(&points[points.len() - half..]).0;
    let [finest, coarsest] = [points[0], points[points.len() - 1]].map(|point| point.0.exp());
    Order { order, standard_error, drift, coarsest, finest, points: points.len() }
}

/// The slope of the line through `points` by least squares, and its standard error.
fn line(points: &[(f64, f64)]) -> (f64, f64) {
    let n = points.len() as f64;
    let sum = points.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.0, sum.1 + p.1));
    let centred = points.iter().map(|p| (p.0 - sum.0 / n, p.1 - sum.1 / n));
    let (mut xx, mut xy) = (0.0, 0.0);
    for (x, y) in centred.clone() {
        xx += x * x;
        xy += x * y;
    }
    let slope = xy / xx;
    let scatter: f64 = centred.map(|(x, y)| (y - slope * x).powi(2)).sum();
    (slope, (scatter / (n - 2.0) / xx).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps that fall from 1 by factors of 2^{1/4}, with their errors, which scatter by 1 %.
    fn errors(count: u32, error: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        let scatter = |i: u32| 1.0 + 0.01 * f64::from(7 * i % 5) - 0.02;
        let step = |i: u32| 0.5_f64.powf(f64::from(i) / 4.0);
        (0..count).map(|i| (step(i), scatter(i) * error(step(i)))).collect()
    }

    #[test]
    fn a_pure_power_is_fitted_over_its_whole_range() {
        let fit = fit_order(&errors(21, |h| 3.0 * h.powf(2.5)), 4.0).unwrap();
        assert!((fit.order - 2.5).abs() < 0.003 && fit.standard_error < 0.004, "{fit:?}");
        assert!(fit.drift.abs() < 0.02, "{fit:?}");
        assert!((fit.coarsest / fit.finest - 32.0).abs() < 1e-9 && fit.points == 21);
    }

    #[test]
    fn the_standard_error_agrees_with_the_textbook_formula() {
        // y = (0, 1, 3, 4, 5) at x = 0 … 4: the slope is 1.3, the residuals are 0.0, −0.3, 0.4,
        // 0.1 and −0.2, s² = 0.3/3, and Σ(x − x̄)² = 10.
        let points: Vec<_> = (0_u8..).map(f64::from).zip([0.0, 1.0, 3.0, 4.0, 5.0]).collect();
        let (slope, error) = line(&points);
        assert!((slope - 1.3).abs() < 1e-14 && (error - 0.1).abs() < 1e-14);
        let powers: Vec<_> = points.iter().rev().map(|p| (p.0.exp(), p.1.exp())).collect();
        let fit = fit_order(&powers, 2.0).unwrap();
        assert!((fit.order - 1.3).abs() < 1e-14 && (fit.standard_error - 0.1).abs() < 1e-14);
        // The finer half 0, 1, 3 has slope 1.5, the coarser half 3, 4, 5 has slope 1.
        assert!((fit.drift - 0.5).abs() < 1e-14 && fit.points == 5);
    }

    #[test]
    fn of_two_regimes_the_finer_one_is_fitted() {
        let fit = fit_order(&errors(41, |h| h.powi(5) + 1e-3 * h * h), 4.0).unwrap();
        assert!((fit.order - 2.0).abs() < 0.01, "{fit:?}");
        assert!(fit.coarsest < 0.05, "{fit:?}");
    }

    #[test]
    fn rounding_and_errors_that_cannot_be_compared_are_left_out() {
        let floor = |h: f64| (h.powi(8)).hypot(2e-16);
        let fit = fit_order(&errors(60, floor), 4.0).unwrap();
        assert!((fit.order - 8.0).abs() < 0.01 && fit.finest > 0.012, "{fit:?}");
        let mut others = errors(40, |h| h);
        others[20].1 = f64::NAN;
        others[3].1 = f64::INFINITY;
        let fit = fit_order(&others, 4.0).unwrap();
        assert_eq!(fit.points, 19);
        // A level of 1e-10 does not count as rounding.
        let stuck = fit_order(&errors(60, |h| h.powi(8).hypot(1e-10)), 4.0).unwrap();
        assert!(stuck.order.abs() < 0.1, "{stuck:?}");
    }

    #[test]
    fn too_few_errors_give_no_order() {
        assert_eq!(fit_order(&[], 4.0), None);
        assert_eq!(fit_order(&errors(8, |h| h), 4.0), None);
        assert!(fit_order(&errors(9, |h| h), 4.0).is_some());
        assert_eq!(fit_order(&errors(40, |_| f64::NAN), 4.0), None);
        assert_eq!(fit_order(&errors(40, |_| 0.0), 4.0), None);
        assert_eq!(fit_order(&errors(40, |_| f64::INFINITY), 4.0), None);
        assert_eq!(fit_order(&[(0.5, 0.1); 9], 1.0), None);
    }
}
