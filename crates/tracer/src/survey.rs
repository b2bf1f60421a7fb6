//! Tracing and verifying in turn: where runs disagree with the regions, the tracer looks again.

use crate::atlas::{Atlas, AtlasError, AtlasOf, AtlasOptions};
use crate::executor::{Executor, Serial};
use crate::family::Family;
use crate::options::TraceError;
use crate::tracing::network::NetworkOf;
use crate::tracing::tracer::Tracer;
use crate::watch::Watch;
use crate::window::{Point, Window};

/// Makes atlases on the threads of the caller, who sees the progress and can cancel.
///
/// ```
/// use std::convert::Infallible;
/// use stickslip_tracer::{Family, FreeRun, Point, Progress, Surveyor, Watch, Window};
///
/// /// A guard that fires above a parabola.
/// struct Parabola;
///
/// impl Family for Parabola {
///     type Label = bool;
///     type Margin = ();
///     type Error = Infallible;
///     fn label(&self, p: &Point) -> Result<bool, Infallible> {
///         Ok(p.y > p.x * p.x)
///     }
///     fn margin(&self, p: &Point, (): &()) -> Result<Option<f64>, Infallible> {
///         Ok(Some(p.x * p.x - p.y))
///     }
///     fn free_run(&self, p: &Point) -> Result<FreeRun<bool, ()>, Infallible> {
///         Ok(FreeRun { label: self.label(p)?, margins: vec![((), p.x * p.x - p.y)] })
///     }
/// }
///
/// let window = Window { low: Point::new(-1.0, -1.0), high: Point::new(1.0, 1.0) };
/// let report = |progress: Progress| eprintln!("{progress:?}");
/// let surveyor = Surveyor { watch: Watch::from(&report), ..Surveyor::default() };
/// let atlas = surveyor.atlas(&Parabola, &window)?;
/// assert!(atlas.agrees());
///
/// // This one is cancelled at once, and says so.
/// let watch = Watch::SILENT.cancelled_by(&|| true);
/// let begun = Surveyor { watch, ..Surveyor::default() }.atlas(&Parabola, &window)?;
/// assert!(!begun.is_finished() && !begun.agrees());
/// // It goes on to the same atlas.
/// let finished = surveyor.resume(&Parabola, begun)?;
/// assert_eq!(finished.plane.curves(), atlas.plane.curves());
/// # Ok::<(), stickslip_tracer::AtlasError<Infallible>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Surveyor<'w, E = Serial> {
    /// How atlases are traced and verified.
    pub options: AtlasOptions,
    /// Who computes the runs of the grid and of the verification.
    pub executor: E,
    /// Who sees the progress and can cancel.
    pub watch: Watch<'w>,
}

impl Default for Surveyor<'static> {
    fn default() -> Self {
        Self { options: AtlasOptions::default(), executor: Serial, watch: Watch::SILENT }
    }
}

/// What one round of a survey finds.
#[derive(Clone, Debug)]
pub struct Found<T> {
    /// The result, if no further round comes.
    pub result: T,
    /// Pairs of places between which something is missing, see
    /// [`Verification::brackets`](crate::Verification::brackets).
    pub brackets: Vec<[Point; 2]>,
}

/// How far a survey has come.
#[derive(Clone, Debug)]
pub struct Survey<T> {
    /// The result of the last verified round. `None` if the survey was cancelled and the tracer has
    /// found something since.
    pub result: Option<T>,
    /// The number of the round, from 1.
    pub round: usize,
    /// Whether the end was reached.
    pub finished: bool,
}

impl<T> Survey<T> {
    /// A survey that begins.
    pub const BEGINNING: Self = Self { result: None, round: 1, finished: false };
}

impl<Label: Clone + Ord, Margin: Clone> Atlas<Label, Margin> {
    /// The atlas that a [`Surveyor`] with these options makes on this thread.
    ///
    /// # Errors
    /// The options or the window are not possible, or a run of the tracer fails.
    pub fn of<F>(
        family: &F,
        window: &Window,
        options: &AtlasOptions,
    ) -> Result<Self, AtlasError<F::Error>>
    where
        F: Family<Label = Label, Margin = Margin>,
    {
        Surveyor { options: *options, ..Surveyor::default() }.atlas(family, window)
    }
}

impl<E> Surveyor<'_, E> {
    /// Traces, subdivides and verifies a family in a window, and looks again where the verification
    /// finds other labels, until it finds none or nothing new comes.
    ///
    /// What cannot be resolved is part of the result: [`Atlas::unresolved`] and
    /// [`Atlas::verification`] say what and where, and the regions that it touches are in doubt.
    /// When the watch cancels, the result is what was found so far, and
    /// [`Atlas::is_finished`] is `false`.
    ///
    /// # Errors
    /// The options or the window are not possible, the window has more curves than the options
    /// allow, or a run of the tracer fails.
    pub fn atlas<F: Family>(
        &self,
        family: &F,
        window: &Window,
    ) -> Result<AtlasOf<F>, AtlasError<F::Error>>
    where
        E: Executor<F>,
    {
        let mut tracer = Tracer::new(family, window, &self.options.trace)?;
        tracer.require_few(&self.executor, &self.watch)?;
        self.finish(family, &mut tracer, Survey::BEGINNING)
    }

    /// Goes on with an atlas that was cancelled, to the same result, bit for bit, as without the
    /// interruption. The family and the options must be the same; one that is finished is returned
    /// as it is.
    ///
    /// # Errors
    /// As [`Self::atlas`].
    pub fn resume<F: Family>(
        &self,
        family: &F,
        mut atlas: AtlasOf<F>,
    ) -> Result<AtlasOf<F>, AtlasError<F::Error>>
    where
        E: Executor<F>,
    {
        let Some(unfinished) = atlas.unfinished.take() else { return Ok(atlas) };
        let (round, window) = (atlas.rounds, *atlas.plane.window());
        let result = unfinished.brackets.is_some().then_some(atlas);
        let mut tracer = Tracer::resume(family, &window, &self.options.trace, *unfinished)?;
        self.finish(family, &mut tracer, Survey { result, round, finished: false })
    }

    /// The atlas of a tracer, which may have begun.
    fn finish<F: Family>(
        &self,
        family: &F,
        tracer: &mut Tracer<'_, F>,
        begun: Survey<AtlasOf<F>>,
    ) -> Result<AtlasOf<F>, AtlasError<F::Error>>
    where
        E: Executor<F>,
    {
        let rounds = self.options.rounds;
        let survey = self.survey(tracer, rounds, begun, |network, round| {
            let mut atlas = Atlas::unverified(network, &self.options, round)?;
            let labels = |portion: &[Point]| self.executor.labels(family, portion);
            let labels = |points: &[Point]| self.watch.in_portions(points, labels);
            if !atlas.verify(&self.options, labels)? {
                return Ok(None);
            }
            let brackets = atlas.verification.brackets();
            Ok::<_, AtlasError<F::Error>>(Some(Found { result: atlas, brackets }))
        })?;
        let mut atlas = match survey.result {
            Some(atlas) => atlas,
            None => Atlas::unverified(tracer.network(), &self.options, survey.round)?,
        };
        if !survey.finished {
            atlas.unfinished = Some(Box::new(tracer.state()));
        }
        Ok(atlas)
    }

    /// The rounds themselves, for results of any kind: the tracer explores, `assess` makes a result
    /// of the network and verifies it, and the tracer looks again where it finds that something is
    /// missing, in up to `rounds` rounds, as long as curves are found and this comes closer: where
    /// no margins tell what is missing, each look only leaves more places. `assess` returns `None`
    /// if it was cancelled.
    ///
    /// # Errors
    /// A run of the tracer fails, or `assess` does.
    pub fn survey<F: Family, T, X>(
        &self,
        tracer: &mut Tracer<'_, F>,
        rounds: usize,
        begun: Survey<T>,
        mut assess: impl FnMut(NetworkOf<F>, usize) -> Result<Option<Found<T>>, X>,
    ) -> Result<Survey<T>, X>
    where
        E: Executor<F>,
        X: From<TraceError<F::Error>>,
    {
        /// A look again comes closer if it leaves at most so many places, or so many times those of
        /// the round before.
        const GROWTH: [usize; 2] = [200, 2];
        let Survey { mut result, mut round, .. } = begun;
        let mut last = tracer.places_to_look().unwrap_or(usize::MAX / GROWTH[1]);
        loop {
            let (looks_again, before) = (tracer.looks_again(), tracer.curve_count());
            if !tracer.proceed(&self.executor, &self.watch)? {
                return Ok(Survey { result, round, finished: false });
            }
            if looks_again {
                if tracer.curve_count() == before {
                    return Ok(Survey { result, round, finished: true });
                }
                round += 1;
            }
            let Some(found) = assess(tracer.network(), round)? else {
                return Ok(Survey { result: None, round, finished: false });
            };
            result = Some(found.result);
            if round >= rounds {
                return Ok(Survey { result, round, finished: true });
            }
            let many = found.brackets.len();
            if many > GROWTH[0].max(GROWTH[1] * last) {
                return Ok(Survey { result, round, finished: true });
            }
            last = many;
            tracer.begin_again(found.brackets);
        }
    }
}
