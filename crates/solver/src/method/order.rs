//! Orders of convergence, fitted to measured errors.

/// An error of a quantity of size 1 that is larger than this never counts as rounding.
const ROUNDING: f64 = 1e-12;
/// Rounding affects errors up to this multiple of the errors of the finest steps.
const SHOWS: f64 = 10.0;
/// The largest difference between the slopes of the two halves, in standard errors of the whole
/// slope: twice the standard error of that difference. The difference has four times the standard
/// error of the whole slope, as each half has an eighth of the whole's sum of squares.
const STRAIGHT: f64 = 8.0;
/// The fewest points of a fit, and the number of finest steps that show the level of rounding.
const FEW: usize = 5;

/// The order of convergence that [`fit_order`] finds: an error falls with this power of the step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Order {
    /// The power: the slope of ln error against ln step.
    pub order: f64,
    /// The standard error of the slope, from the scatter about the line.
    pub standard_error: f64,
    /// The slope over the finer half of the points minus the slope over the coarser half. It shows
    /// how far the slope still is from its limit for small steps, which the scatter does not.
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
/// step first. Errors are errors of quantities of size 1. The result is `None` if the asymptotic
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
/// use stickslip_solver::method::fit_order;
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
