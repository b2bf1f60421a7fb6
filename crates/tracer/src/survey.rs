//! Tracing and verifying in turn: where runs disagree with the regions, the tracer looks again.
//!
//! A window with a doubt is traced by margins, and then with the other options of its draft: beyond
//! an edge of the window boundaries may be easier to distinguish, or harder, and nothing says so
//! beforehand. For collisions these have room beyond the edges, and without it. In a narrow window
//! they also have a smaller error of the margins: in a window of 1e-6, the usual 1e-13 moves a zero
//! by 3e-6 of the window, but an error that is too small may invent vertices where boundaries
//! touch. A result counts if it leaves no doubt; nothing that was right is traced anew.

use stickslip_solver::InvalidValue;

use crate::atlas::{Atlas, AtlasOf, AtlasOptions};
use crate::draft::{Draft, Own};
use crate::effort::Effort;
use crate::executor::{Executor, Serial};
use crate::family::Family;
use crate::options::{TraceError, TraceOptions};
use crate::regions::finding::SubdivisionError;
use crate::tracing::extrema::Extremum;
use crate::tracing::margins::Lines;
use crate::tracing::network::NetworkOf;
use crate::tracing::tracer::Tracer;
use crate::tracing::tracer::state::State;
use crate::watch::{Progress, Watch};
use crate::window::{Point, Window};

/// Makes atlases on the threads of the caller, who sees the progress and can cancel.
///
/// ```
/// use std::convert::Infallible;
/// use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
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
/// // This one shows each curve as soon as it has been followed.
/// let shown = AtomicUsize::new(0);
/// let show = |points: &[Point]| {
///     shown.fetch_add(usize::from(points.len() > 1), Relaxed);
/// };
/// let watch = Watch::SILENT.showing(&show);
/// Surveyor { watch, ..Surveyor::default() }.atlas(&Parabola, &window)?;
/// assert!(shown.load(Relaxed) >= atlas.plane.curves().len());
///
/// // This one is cancelled at once, and says so.
/// let watch = Watch::SILENT.cancelled_by(&|| true);
/// let begun = Surveyor { watch, ..Surveyor::default() }.atlas(&Parabola, &window)?;
/// assert!(!begun.is_finished() && !begun.agrees());
/// // It goes on to the same atlas.
/// let finished = surveyor.resume(&Parabola, begun)?;
/// assert_eq!(finished.plane.curves(), atlas.plane.curves());
/// # Ok::<(), stickslip_tracer::TraceError<Infallible>>(())
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

/// How far a survey has come.
struct Survey<T> {
    /// The result of the last verified round. `None` if the survey was cancelled and the tracer has
    /// found something since.
    result: Option<T>,
    /// The number of the round, from 1.
    round: usize,
    /// Whether the end was reached.
    finished: bool,
}

impl<T> Survey<T> {
    /// A survey that begins.
    const BEGINNING: Self = Self { result: None, round: 1, finished: false };
}

/// The atlas of a draft.
pub type DraftedOf<D> = Atlas<<D as Draft>::Label, <D as Draft>::Margin>;

/// An atlas, with the zero sets if it was traced by margins.
type Finished<'f, D> = (DraftedOf<D>, Option<Lines<'f, <D as Draft>::Family>>);

/// Why there is no atlas of a draft.
type DraftError<D> = TraceError<<<D as Draft>::Family as Family>::Error>;

impl<Label: Clone + Ord, Margin: Clone> Atlas<Label, Margin> {
    /// The atlas that a [`Surveyor`] with these options makes on this thread.
    ///
    /// # Errors
    /// The options or the window are not possible, or a run of the tracer fails.
    pub fn of<F>(
        family: &F,
        window: &Window,
        options: &AtlasOptions,
    ) -> Result<Self, TraceError<F::Error>>
    where
        F: Family<Label = Label, Margin = Margin>,
    {
        Surveyor { options: *options, ..Surveyor::default() }.atlas(family, window)
    }
}

impl<'w, E> Surveyor<'w, E> {
    /// Traces, subdivides and verifies a family in a window, and looks again where the verification
    /// finds other labels, until it finds none or nothing new comes. If something is in doubt then,
    /// the window is traced by its margins alone, which counts if it leaves no doubt.
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
    ) -> Result<AtlasOf<F>, TraceError<F::Error>>
    where
        E: Executor<F>,
    {
        let mut tracer = self.tracer(family, window)?;
        Ok(self.finish(&Own(family), &mut tracer, Survey::BEGINNING)?.0)
    }

    /// A tracer of a window with few enough curves.
    fn tracer<'f, F: Family>(
        &self,
        family: &'f F,
        window: &Window,
    ) -> Result<Tracer<'f, F>, TraceError<F::Error>>
    where
        E: Executor<F>,
        'w: 'f,
    {
        let rounds = self.options.rounds;
        InvalidValue::check("rounds", rounds, "at least 1", rounds >= 1)?;
        let tracer = Tracer::new(family, window, &self.options.trace)?.watched(self.watch);
        self.watch.report(Progress::Now { what: "counting boundaries" });
        tracer.require_few(&self.executor, &self.watch)?;
        Ok(tracer)
    }

    /// As [`Self::atlas`], for an atlas with other labels and margins than the family's, and other
    /// labels that verify it. If something is in doubt, the window is traced with the [other
    /// options](Draft::other_options) of the draft too. The result also has the places where curves
    /// are extremal in a coordinate. An atlas that was cancelled cannot go on.
    ///
    /// # Errors
    /// As [`Self::atlas`].
    pub fn draw<D: Draft>(
        &self,
        draft: &D,
        window: &Window,
    ) -> Result<(DraftedOf<D>, Vec<Extremum>), DraftError<D>>
    where
        E: Executor<D::Family> + Copy,
    {
        let traced = |trace: TraceOptions| {
            let surveyor = Surveyor { options: AtlasOptions { trace, ..self.options }, ..*self };
            let mut tracer = surveyor.tracer(draft.family(), window)?;
            let (atlas, lines) = surveyor.finish(draft, &mut tracer, Survey::BEGINNING)?;
            let extrema = match lines {
                Some(lines) => lines.extrema()?,
                None => tracer.extrema()?,
            };
            Ok((atlas, extrema))
        };
        let first: Result<_, DraftError<D>> = traced(self.options.trace);
        let first = first?;
        if first.0.agrees() || self.options.effort == Effort::Screen {
            return Ok(first);
        }
        for trace in draft.other_options(&self.options.trace) {
            if self.watch.is_cancelled() {
                break;
            }
            if let Ok(other) = traced(trace)
                && other.0.agrees()
            {
                return Ok(other);
            }
        }
        Ok(first)
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
    ) -> Result<AtlasOf<F>, TraceError<F::Error>>
    where
        E: Executor<F>,
    {
        let Some(unfinished) = atlas.unfinished.take() else { return Ok(atlas) };
        let (round, window) = (atlas.rounds, *atlas.plane.window());
        let finished = unfinished.surveyed;
        let result = (finished || unfinished.brackets.is_some()).then_some(atlas);
        let tracer = Tracer::resume(family, &window, &self.options.trace, *unfinished)?;
        let mut tracer = tracer.watched(self.watch);
        Ok(self.finish(&Own(family), &mut tracer, Survey { result, round, finished })?.0)
    }

    /// The atlas of a tracer, which may have begun: the tracer explores, the regions are verified,
    /// and the tracer looks again where this finds that something is missing, as long as curves are
    /// found and this comes closer: where no margins tell what is missing, each look only leaves
    /// more places.
    ///
    /// If something is in doubt then, the window is traced by margins. If nothing is in doubt after
    /// that, this is the result, with the lines of the margins, unless they may end in cusps that
    /// the family knows.
    fn finish<'f, D: Draft>(
        &self,
        draft: &'f D,
        tracer: &mut Tracer<'_, D::Family>,
        begun: Survey<DraftedOf<D>>,
    ) -> Result<Finished<'f, D>, DraftError<D>>
    where
        E: Executor<D::Family>,
        'w: 'f,
    {
        let begun = if begun.finished { begun } else { self.survey(draft, tracer, begun)? };
        let Survey { result, round, finished } = begun;
        let mut atlas = match result {
            Some(atlas) => atlas,
            None => self.unverified(draft, tracer.network(), round)?.0,
        };
        let mut surveyed = false;
        if finished && !atlas.agrees() && self.options.effort != Effort::Screen {
            match self.by_margins(draft, &tracer.window()) {
                Ok((other, Some(lines))) if other.agrees() && !lines.have_cusps() => {
                    return Ok((other, Some(lines)));
                }
                Err(TraceError::Cancelled) => surveyed = true,
                // Runs may fail where the first way had nothing to look for.
                Ok(_) | Err(_) => {}
            }
        }
        if surveyed || !finished {
            let state = tracer.state();
            let State { network, uncertainties, suspects, probed, stage, brackets, .. } = state;
            let network = draft.drawn(network);
            atlas.unfinished = Some(Box::new(State {
                network,
                uncertainties,
                suspects,
                probed,
                stage,
                brackets,
                surveyed,
            }));
        }
        Ok((atlas, None))
    }

    /// The atlas of the zero sets of margins, which are searched for again where the verification
    /// finds that one is missing.
    fn by_margins<'f, D: Draft>(
        &self,
        draft: &'f D,
        window: &Window,
    ) -> Result<Finished<'f, D>, DraftError<D>>
    where
        E: Executor<D::Family>,
        'w: 'f,
    {
        let mut lines = Lines::new(draft.family(), window, &self.options.trace, self.watch)?;
        lines.explore(&self.executor)?;
        let mut round = 1;
        loop {
            let (mut atlas, options) = self.unverified(draft, lines.network()?, round)?;
            if !self.verify(draft, &mut atlas, &options)? {
                return Err(TraceError::Cancelled);
            }
            let brackets = atlas.verification.brackets();
            if brackets.is_empty() || round >= self.options.rounds || !lines.look(&brackets)? {
                return Ok((atlas, Some(lines)));
            }
            round += 1;
        }
    }

    /// The regions of what was found, and the options that fit them.
    fn unverified<D: Draft>(
        &self,
        draft: &D,
        network: NetworkOf<D::Family>,
        round: usize,
    ) -> Result<(DraftedOf<D>, AtlasOptions), SubdivisionError> {
        let network = draft.drawn(network);
        let options = draft.fitted(&self.options, &network.curves);
        Ok((Atlas::unverified(network, &options, round)?, options))
    }

    /// Verifies an atlas. Returns `false` if the watch cancels.
    fn verify<D: Draft>(
        &self,
        draft: &D,
        atlas: &mut DraftedOf<D>,
        options: &AtlasOptions,
    ) -> Result<bool, SubdivisionError>
    where
        E: Executor<D::Family>,
    {
        self.watch.report(Progress::Now { what: "comparing regions with runs" });
        let labels = |portion: &[Point]| draft.checks(&self.executor, portion);
        atlas.verify(options, |points: &[Point]| self.watch.in_portions(points, labels))
    }

    /// The rounds themselves.
    fn survey<D: Draft>(
        &self,
        draft: &D,
        tracer: &mut Tracer<'_, D::Family>,
        begun: Survey<DraftedOf<D>>,
    ) -> Result<Survey<DraftedOf<D>>, DraftError<D>>
    where
        E: Executor<D::Family>,
    {
        /// A look again comes closer if it leaves at most so many places, or so many times those of
        /// the round before.
        const GROWTH: [usize; 2] = [200, 2];
        let Survey { mut result, mut round, .. } = begun;
        let mut last = tracer.places_to_look().unwrap_or(usize::MAX / GROWTH[1]);
        loop {
            let (looks_again, before) = (tracer.looks_again(), tracer.curve_count());
            if !tracer.proceed(&self.executor)? {
                return Ok(Survey { result, round, finished: false });
            }
            if looks_again {
                if tracer.curve_count() == before {
                    return Ok(Survey { result, round, finished: true });
                }
                round += 1;
            }
            let (mut atlas, options) = self.unverified(draft, tracer.network(), round)?;
            if !self.verify(draft, &mut atlas, &options)? {
                return Ok(Survey { result: None, round, finished: false });
            }
            let brackets = atlas.verification.brackets();
            result = Some(atlas);
            let many = brackets.len();
            if round >= self.options.rounds || many > GROWTH[0].max(GROWTH[1] * last) {
                return Ok(Survey { result, round, finished: true });
            }
            last = many;
            tracer.begin_again(brackets);
        }
    }
}
