//! The runs of a family: they are counted, and their errors name the point.

use std::cell::Cell;

use crate::executor::FreeRunOf;
use crate::family::{Family, FreeRun};
use crate::lengths::Lengths;
use crate::options::{TraceError, TraceOptions};
use crate::watch::Watch;
use crate::window::{Point, Window};

/// The result of a computation of the tracer with a family.
pub(crate) type Traced<T, F> = Result<T, TraceError<<F as Family>::Error>>;

/// A place, with the free run there.
pub(crate) type Sampled<F> = (Point, FreeRun<<F as Family>::Label, <F as Family>::Margin>);

/// The slope of a margin, by differences.
struct Slope {
    value: f64,
    /// The change of the slope from one side to the other, relative to the slope.
    bend: f64,
}

/// The greatest bend of a margin within the differences that give its gradient. Their error is
/// about its square.
const BENT: f64 = 0.05;

/// A family in a window, with the options of a trace. It makes and counts all runs.
pub struct Runs<'a, F: Family> {
    family: &'a F,
    pub(crate) window: Window,
    pub(crate) options: TraceOptions,
    pub(crate) lengths: Lengths,
    /// Cancels between runs.
    pub(crate) watch: Watch<'a>,
    free: Cell<usize>,
    prescribed: Cell<usize>,
}

impl<'a, F: Family> Runs<'a, F> {
    /// The runs of a family in a window.
    ///
    /// # Errors
    /// An option is out of its range, or the window is not a rectangle.
    pub fn new(family: &'a F, window: Window, options: TraceOptions) -> Traced<Self, F> {
        options.validate()?;
        let extent = window.extent();
        if !extent.iter().all(|&length| length > 0.0 && length.is_finite()) {
            return Err(TraceError::Window { window });
        }
        let lengths = Lengths::of(extent.min());
        let (watch, free, prescribed) = (Watch::SILENT, Cell::new(0), Cell::new(0));
        Ok(Self { family, window, options, lengths, watch, free, prescribed })
    }

    /// The same runs, which end in [`TraceError::Cancelled`] when `watch` cancels.
    pub(crate) fn watched(self, watch: Watch<'a>) -> Self {
        Self { watch, ..self }
    }

    /// Counts a run that follows.
    fn count(&self, runs: &Cell<usize>) -> Traced<(), F> {
        self.go_on()?;
        runs.set(runs.get() + 1);
        Ok(())
    }

    /// Ends the search if the watch cancels it.
    pub(crate) fn go_on(&self) -> Traced<(), F> {
        if self.watch.is_cancelled() { Err(TraceError::Cancelled) } else { Ok(()) }
    }

    /// The same runs in a larger window, with lengths relative to this one.
    pub(crate) fn within(self, window: Window) -> Self {
        Self { window, ..self }
    }

    /// The numbers of free runs and of prescribed runs so far.
    #[must_use]
    pub fn counts(&self) -> [usize; 2] {
        [self.free.get(), self.prescribed.get()]
    }

    pub(crate) fn family(&self) -> &'a F {
        self.family
    }

    /// Counts from these numbers of free runs and of prescribed runs.
    pub(crate) fn count_from(&self, [free, prescribed]: [usize; 2]) {
        self.free.set(free);
        self.prescribed.set(prescribed);
    }

    /// The same runs, with counts of their own, which nobody cancels.
    pub(crate) fn aside(&self) -> Self {
        let &Self { family, window, options, lengths, .. } = self;
        let (watch, free, prescribed) = (Watch::SILENT, Cell::new(0), Cell::new(0));
        Self { family, window, options, lengths, watch, free, prescribed }
    }

    /// Counts free runs that were computed elsewhere.
    pub(crate) fn count_free(&self, count: usize) {
        self.free.set(self.free.get() + count);
    }

    pub(crate) fn label(&self, point: &Point) -> Traced<F::Label, F> {
        self.count(&self.free)?;
        self.family.label(point).map_err(|source| TraceError::Run { point: *point, source })
    }

    pub(crate) fn free(&self, point: &Point) -> Traced<FreeRun<F::Label, F::Margin>, F> {
        self.count(&self.free)?;
        checked::<F>(point, self.family.free_run(point))
    }

    pub(crate) fn margin(&self, point: &Point, margin: &F::Margin) -> Traced<Option<f64>, F> {
        // Newton's method may lead far away, where the family need not be defined.
        let beyond = self.window.extent() * Lengths::PARTS.beyond;
        let Window { low, high } = self.window;
        if !(Window { low: low - beyond, high: high + beyond }).contains(point) {
            return Ok(None);
        }
        self.count(&self.prescribed)?;
        let value = self
            .family
            .margin(point, margin)
            .map_err(|source| TraceError::Run { point: *point, source })?;
        if value.is_some_and(f64::is_nan) {
            return Err(TraceError::NotANumber { point: *point });
        }
        Ok(value)
    }

    pub(crate) fn is_sure(&self, margin: &F::Margin) -> bool {
        self.family.is_sure(margin)
    }

    pub(crate) fn cusps(&self, margin: &F::Margin) -> Vec<[F::Margin; 2]> {
        self.family.cusps(margin)
    }

    pub(crate) fn moved(&self, point: &Point, margin: &F::Margin) -> Traced<F::Margin, F> {
        self.family.moved(point, margin).map_err(|source| TraceError::Run { point: *point, source })
    }

    /// The gradient of a margin by differences along `direction`, a unit vector, and across it.
    ///
    /// If margins have an error ε and vary on a scale L, the error ε/h + h²/(6L²) of a central
    /// difference is least for h = (3εL²)^⅓. For ε = 1e-14 and L = 1 this is 3e-5, and the error is
    /// 5e-10. The scale is estimated by `radius`, the radius of curvature of the boundary.
    ///
    /// Beside a place where a margin is singular, for instance beside the boundary of a graze that
    /// comes before, it varies on a much shorter scale across its boundary. The slope then changes
    /// within the differences, and they are made shorter.
    ///
    /// If the margin exists on one side only, the difference is one-sided, of second order. If it
    /// exists on neither side, the step is reduced. The direction matters because boundaries end in
    /// wedges that are long along them and thin across.
    pub(crate) fn gradient(
        &self,
        point: &Point,
        margin: &F::Margin,
        direction: &Point,
        radius: f64,
    ) -> Traced<Option<Point>, F> {
        let ratio = (radius / self.lengths.scale).clamp(Lengths::PARTS.same, 1.0);
        let mut h = self.lengths.difference * ratio.powf(2.0 / 3.0);
        let across = Point::new(-direction.y, direction.x);
        let mut rise = self.slope(point, margin, &across, h)?;
        while let Some(Slope { bend, .. }) = rise
            && bend > BENT
            && h > self.lengths.touch
        {
            h *= (0.1 * BENT / bend).max(1e-2);
            rise = self.slope(point, margin, &across, h)?;
        }
        let (Some(rise), Some(along)) = (rise, self.slope(point, margin, direction, h)?) else {
            return Ok(None);
        };
        let (along, rise) = (along.value, rise.value);
        let gradient = direction * along + across * rise;
        // Where a margin is flat, its boundary has no direction.
        Ok(Some(gradient).filter(|gradient| gradient.norm() > 0.0))
    }

    /// Whether the slope of a margin across `direction` changes within the shortest differences, as
    /// beside the boundary of a graze that comes before. The value and the slope of the margin then
    /// do not show where it vanishes.
    pub(crate) fn is_singular(
        &self,
        point: &Point,
        margin: &F::Margin,
        direction: &Point,
    ) -> Traced<bool, F> {
        let across = Point::new(-direction.y, direction.x);
        let slope = self.slope(point, margin, &across, self.lengths.touch)?;
        Ok(slope.is_some_and(|slope| slope.bend > 4.0 * BENT))
    }

    /// The slope of a margin along `direction`, by differences with step `h` at most.
    fn slope(
        &self,
        point: &Point,
        margin: &F::Margin,
        direction: &Point,
        mut h: f64,
    ) -> Traced<Option<Slope>, F> {
        while h > self.lengths.same {
            let ahead = self.margin(&(point + direction * h), margin)?;
            let behind = self.margin(&(point - direction * h), margin)?;
            let (sign, near) = match (ahead, behind) {
                (Some(ahead), Some(behind)) => {
                    let change = ahead - behind;
                    let mut bend = ((ahead + behind) / change).abs();
                    if bend > BENT
                        && let Some(here) = self.margin(point, margin)?
                    {
                        bend = ((ahead + behind - 2.0 * here) / change).abs();
                    }
                    return Ok(Some(Slope { value: change / (2.0 * h), bend }));
                }
                (Some(ahead), None) => (1.0, ahead),
                (None, Some(behind)) => (-1.0, behind),
                (None, None) => {
                    h /= 16.0;
                    continue;
                }
            };
            let far = self.margin(&(point + direction * (2.0 * sign * h)), margin)?;
            if let (Some(here), Some(far)) = (self.margin(point, margin)?, far) {
                let value = sign * (4.0 * near - 3.0 * here - far) / (2.0 * h);
                let bend = ((far - 2.0 * near + here) / (far - here)).abs();
                return Ok(Some(Slope { value, bend }));
            }
            h /= 16.0;
        }
        Ok(None)
    }

    /// The accuracy of a zero of a margin whose gradient has the length `slope`.
    pub(crate) fn resolution(&self, slope: f64) -> f64 {
        self.options.tolerance.max(self.options.noise / slope)
    }
}

/// A free run with its place, if it has no error and its margins are numbers.
pub(crate) fn checked<F: Family>(
    point: &Point,
    run: FreeRunOf<F>,
) -> Traced<FreeRun<F::Label, F::Margin>, F> {
    let run = run.map_err(|source| TraceError::Run { point: *point, source })?;
    if run.margins.iter().any(|(_, value)| value.is_nan()) {
        return Err(TraceError::NotANumber { point: *point });
    }
    Ok(run)
}
