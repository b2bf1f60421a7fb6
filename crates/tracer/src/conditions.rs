//! Points at which as many conditions hold as there are unknowns.
//!
//! Every special point is of this kind: two margins vanish, or the gradient of one does, or two
//! boundaries touch; with a third parameter, three conditions hold where such points meet. What the
//! conditions are and how their derivatives are obtained is said beside each kind of point. How
//! their common zero is approached, how it is known to be one, and why there may be none, is here.

use nalgebra::allocator::Allocator;
use nalgebra::{DefaultAllocator, Dim, OMatrix, OVector};

use crate::inverse;

/// What has to vanish at a place, and its derivatives, a row for each value: none where nothing
/// determines them, or if they were not asked for.
pub type Local<D> = (OVector<f64, D>, Option<OMatrix<f64, D, D>>);

/// How a zero is searched for. Lengths are in the unknowns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// The greatest distance of the zero from the start.
    pub reach: f64,
    /// The longest update: a longer one is only a direction.
    pub stride: f64,
    /// An update no longer than this ends the search.
    pub tolerance: f64,
    /// An update no longer than this ends the search if it is not much shorter than the update
    /// before: what is left are errors of the values.
    pub stalled: f64,
    /// The error of a value. Ten times the error of the place that it causes counts as `stalled`
    /// if that is longer.
    pub noise: f64,
    /// An update no longer than this ends the search if it is shorter than a tenth of the update
    /// before. Updates then shrink as their square, and the next one is beyond the digits.
    pub square: f64,
    /// Derivatives are used again if an update is no longer than this part of the one before.
    pub reuse: f64,
    /// Where the values do not exist, half of the update is taken back, unless it is no longer than
    /// this.
    pub retreat: f64,
    /// The greatest number of places.
    pub rounds: usize,
}

impl Limits {
    /// A search up to a distance that ends with an update of the length `tolerance`. Derivatives
    /// are computed for every update, and the values must exist at every place.
    #[must_use]
    pub const fn new(reach: f64, tolerance: f64) -> Self {
        let (stride, retreat) = (f64::INFINITY, f64::INFINITY);
        let (stalled, noise, square, reuse) = (0.0, 0.0, 0.0, 0.0);
        Self { reach, stride, tolerance, stalled, noise, square, reuse, retreat, rounds: 40 }
    }
}

/// A zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Zero<D: Dim>
where
    DefaultAllocator: Allocator<D> + Allocator<D, D>,
{
    /// The place.
    pub at: OVector<f64, D>,
    /// The largest error of the place, as far as the tolerance and the noise say it.
    pub error: f64,
    /// The derivatives close to the place.
    pub slopes: OMatrix<f64, D, D>,
}

/// Why no zero was found.
#[derive(Clone, Debug, PartialEq)]
pub enum Unsolved<D: Dim>
where
    DefaultAllocator: Allocator<D>,
{
    /// The search leads away, farther than allowed.
    Leaves,
    /// The derivatives do not determine an update.
    Dependent,
    /// The values do not exist at this place, nor on the way back from it.
    Ceases {
        /// The place.
        at: OVector<f64, D>,
        /// The length of the update that led away from where they exist, infinite at the start.
        update: f64,
    },
    /// The updates did not become short.
    Slow {
        /// The last place.
        at: OVector<f64, D>,
        /// The length of the last update.
        update: f64,
    },
}

/// The zero of conditions near a place, by Newton's method.
///
/// `conditions` are as many as there are unknowns, which should be of similar size. They are given
/// a place and whether derivatives are asked for. They may move the place to the nearest one that
/// is allowed, and return `None` where one of them does not exist.
///
/// ```
/// use std::convert::Infallible;
/// use nalgebra::{Matrix2, Vector2};
/// use stickslip_tracer::conditions::{Limits, solve};
///
/// // The circle of radius 5 and the hyperbola xy = 12 cross at (3, 4).
/// let crossing = |at: &mut Vector2<f64>, _: bool| {
///     let values = Vector2::new(at.norm_squared() - 25.0, at.x * at.y - 12.0);
///     let slopes = Matrix2::new(2.0 * at.x, 2.0 * at.y, at.y, at.x);
///     Ok::<_, Infallible>(Some((values, Some(slopes))))
/// };
/// let zero = solve(&Vector2::new(2.5, 4.2), &Limits::new(1.0, 1e-12), crossing)?;
/// let zero = zero.expect("they cross");
/// assert!((zero.at - Vector2::new(3.0, 4.0)).norm() <= zero.error);
/// // From here it is farther away than the search may lead.
/// assert!(solve(&Vector2::new(2.0, 4.2), &Limits::new(0.1, 1e-12), crossing)?.is_err());
/// # Ok::<(), Infallible>(())
/// ```
///
/// # Errors
/// The conditions cannot be computed at a place.
pub fn solve<D: Dim, E>(
    start: &OVector<f64, D>,
    limits: &Limits,
    mut conditions: impl FnMut(&mut OVector<f64, D>, bool) -> Result<Option<Local<D>>, E>,
) -> Result<Result<Zero<D>, Unsolved<D>>, E>
where
    DefaultAllocator: Allocator<D> + Allocator<D, D>,
{
    let mut before = start.clone();
    let mut at = start.clone();
    let mut update = start.clone();
    update.fill(0.0);
    let mut size = f64::INFINITY;
    let mut linear = None;
    for _ in 0..limits.rounds {
        let free = at.clone();
        let found = conditions(&mut at, linear.is_none())?;
        if at != free {
            update = &before - &at;
            if at == before {
                return Ok(Err(Unsolved::Leaves));
            }
        }
        let Some((values, slopes)) = found else {
            if update.norm() <= limits.retreat {
                return Ok(Err(Unsolved::Ceases { at, update: size }));
            }
            update *= 0.5;
            at += &update;
            continue;
        };
        if linear.is_none() {
            linear = slopes.and_then(|slopes| Some((inverse::of(&slopes)?, slopes)));
        }
        let Some((inverse, slopes)) = &linear else { return Ok(Err(Unsolved::Dependent)) };
        update = inverse * values;
        let last = std::mem::replace(&mut size, update.norm());
        if !size.is_finite() {
            return Ok(Err(Unsolved::Dependent));
        }
        update *= (limits.stride / size).min(1.0);
        before.copy_from(&at);
        at -= &update;
        let within = (&at - start).norm() <= limits.reach;
        if !within {
            return Ok(Err(Unsolved::Leaves));
        }
        let noise = 10.0 * (limits.noise * inverse.norm());
        let is_noise = size <= limits.stalled.max(noise) && size >= 0.5 * last;
        let is_square = size <= limits.square && size < 0.1 * last && last.is_finite();
        if size <= limits.tolerance || is_noise || is_square {
            let error = noise.max(10.0 * limits.tolerance);
            return Ok(Ok(Zero { at, error, slopes: slopes.clone() }));
        }
        let is_fast = size <= limits.reuse * last;
        if !is_fast {
            linear = None;
        }
    }
    Ok(Err(Unsolved::Slow { at, update: size }))
}

/// The slope of a value of one unknown by the secant through the place before, if there is one.
pub(crate) fn secant(before: &mut Option<[f64; 2]>, at: f64, value: f64) -> Option<f64> {
    before.replace([at, value]).map(|[place, other]| (value - other) / (at - place))
}
