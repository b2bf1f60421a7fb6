//! Surveys on several threads, cancelled anywhere, and resumed.

use std::convert::Infallible;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use stickslip_tracer::{
    AtlasOf, AtlasOptions, Effort, Executor, Family, FreeRun, FreeRunOf, LabelOf, Point, Progress,
    Surveyor, TraceOptions, Watch, Window, regions::VerifyOptions,
};

use crate::any::any;
use crate::guards::{Failed, Label, Margin};

/// A circle, a cubic, and a small disc, whose margin is only listed beside it: the grid does not
/// show it, but a verification does.
pub struct Shapes {
    /// The radius of a hole around (−0.6, 0.6) in which runs fail.
    pub hole: f64,
}

pub const WINDOW: Window = Window { low: Point::new(-1.0, -1.0), high: Point::new(1.0, 1.0) };

impl Shapes {
    fn values(point: &Point) -> [f64; 3] {
        let disc = point - Point::new(0.5, -0.5);
        [point.norm_squared() - 0.25, point.y - point.x.powi(3) - 0.1, disc.norm_squared() - 0.0064]
    }
}

impl Family for Shapes {
    type Label = Label;
    type Margin = Margin;
    type Error = Failed;

    fn label(&self, point: &Point) -> Result<Label, Failed> {
        if (point - Point::new(-0.6, 0.6)).norm() < self.hole {
            return Err(Failed);
        }
        Ok(Self::values(point).map(|value| value < 0.0).to_vec())
    }

    fn margin(&self, point: &Point, (margin, _): &Margin) -> Result<Option<f64>, Failed> {
        Ok(Some(Self::values(point)[*margin]))
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<Label, Margin>, Failed> {
        let values = Self::values(point).into_iter().enumerate();
        let listed = values.filter(|&(index, value)| index < 2 || value < 0.002);
        let margins = listed.map(|(index, value)| ((index, Vec::new()), value)).collect();
        Ok(FreeRun { label: self.label(point)?, margins })
    }
}

pub fn options() -> AtlasOptions {
    let trace = TraceOptions { cells: 4, ..TraceOptions::default() };
    let verify = VerifyOptions { random_points: 2500, ..VerifyOptions::default() };
    AtlasOptions { trace, verify, ..AtlasOptions::default() }
}

/// Asserts that two atlases have the same bits.
pub fn assert_same(one: &AtlasOf<Shapes>, other: &AtlasOf<Shapes>) {
    assert_eq!(one.plane.curves(), other.plane.curves());
    assert_eq!(one.plane.vertices(), other.plane.vertices());
    assert_eq!(one.plane.regions(), other.plane.regions());
    assert_eq!(one.unresolved, other.unresolved);
    assert_eq!(one.verification, other.verification);
    assert_eq!(one.statistics, other.statistics);
    assert_eq!(one.rounds, other.rounds);
    assert_eq!(one.is_finished(), other.is_finished());
}

/// So many threads, each with every so manieth point.
struct Threads(usize);

impl Threads {
    fn map<T: Send>(&self, points: &[Point], run: impl Fn(&Point) -> T + Sync) -> Vec<T> {
        let mut results: Vec<Option<T>> = points.iter().map(|_| None).collect();
        let size = points.len().div_ceil(self.0).max(1);
        thread::scope(|scope| {
            for (points, results) in points.chunks(size).zip(results.chunks_mut(size)) {
                scope.spawn(|| {
                    for (point, result) in points.iter().zip(results) {
                        *result = Some(run(point));
                    }
                });
            }
        });
        results.into_iter().flatten().collect()
    }
}

impl<F> Executor<F> for Threads
where
    F: Family<Label: Send, Margin: Send, Error: Send> + Sync,
{
    fn free_runs(&self, family: &F, points: &[Point]) -> Vec<FreeRunOf<F>> {
        self.map(points, |point| family.free_run(point))
    }

    fn labels(&self, family: &F, points: &[Point]) -> Vec<LabelOf<F>> {
        self.map(points, |point| family.label(point))
    }
}

#[test]
fn threads_do_not_change_a_bit() {
    let family = any(Shapes { hole: 0.0 });
    let serial = Surveyor { options: options(), ..Surveyor::default() };
    let atlas = serial.atlas(&family, &WINDOW).unwrap();
    assert!(atlas.agrees(), "{:?}", atlas.verification);
    let margins: Vec<_> = atlas.plane.curves().iter().map(|curve| &curve.margin).collect();
    assert!(atlas.rounds > 1, "the disc is found by a second look: {margins:?}");
    assert_eq!(atlas.plane.regions().len(), 5);
    for threads in [1, 4] {
        let options = options();
        let parallel = Surveyor { options, executor: Threads(threads), watch: Watch::SILENT };
        assert_same(&parallel.atlas(&family, &WINDOW).unwrap(), &atlas);
    }
}

/// A survey is cancelled between two of its runs, and resumed.
#[test]
fn a_survey_cancelled_anywhere_goes_on_to_the_same_bits() {
    cancelled_anywhere(options(), 120);
}

#[test]
fn a_survey_beyond_the_window_cancelled_anywhere_goes_on_to_the_same_bits() {
    let mut options = options();
    options.trace.beyond = 1e-3;
    cancelled_anywhere(options, 40);
}

/// Cancels a survey so many times, each time after some more of its runs.
fn cancelled_anywhere(options: AtlasOptions, times: usize) {
    let family = any(Shapes { hole: 0.0 });
    let asked = AtomicUsize::new(0);
    let count = || asked.fetch_add(1, Ordering::Relaxed) == usize::MAX;
    let surveyor = Surveyor { options, ..Surveyor::default() };
    let counting = Surveyor { watch: Watch::SILENT.cancelled_by(&count), ..surveyor };
    let whole = counting.atlas(&family, &WINDOW).unwrap();
    let all = asked.load(Ordering::Relaxed);
    assert!(all > 5_000, "{all}");
    let mut curves = vec![0; whole.plane.curves().len() + 1];
    // How often many runs at once ask depends on how long they take.
    for last in (0..all - all / 50).step_by(all / times) {
        let asked = AtomicUsize::new(0);
        let cancel = || asked.fetch_add(1, Ordering::Relaxed) >= last;
        let cancelled = Surveyor { watch: Watch::SILENT.cancelled_by(&cancel), ..surveyor };
        let begun = cancelled.atlas(&family, &WINDOW).unwrap();
        assert!(!begun.is_finished() && !begun.agrees(), "{last}");
        // Not −0, which is printed as such.
        assert_eq!(begun.sure_area().to_bits(), 0, "{last}");
        assert_eq!(begun.label(&Point::new(0.1, 0.0)), None, "{last}");
        curves[begun.plane.curves().len()] += 1;
        assert_same(&surveyor.resume(&family, begun).unwrap(), &whole);
    }
    // It was cancelled with nothing, and with parts.
    assert!(curves[0] > 0, "{curves:?}");
    assert!(curves.iter().filter(|&&count| count > 0).count() > 2, "{curves:?}");
}

/// A label that changes where no margin vanishes leaves a doubt in both ways of tracing.
struct Unexplained;

impl Family for Unexplained {
    type Label = bool;
    type Margin = ();
    type Error = Infallible;

    fn label(&self, point: &Point) -> Result<bool, Infallible> {
        Ok(point.x + 0.3 * point.y > 0.1)
    }
    fn margin(&self, point: &Point, (): &()) -> Result<Option<f64>, Infallible> {
        Ok(Some(2.0 + point.y))
    }
    fn free_run(&self, point: &Point) -> Result<FreeRun<bool, ()>, Infallible> {
        Ok(FreeRun { label: self.label(point)?, margins: vec![((), 2.0 + point.y)] })
    }
}

#[test]
fn a_survey_with_a_doubt_cancelled_anywhere_goes_on_to_the_same_doubt() {
    let mut options = options();
    (options.trace.cells, options.verify.random_points, options.rounds) = (4, 200, 2);
    let surveyor = Surveyor { options, ..Surveyor::default() };
    let asked = AtomicUsize::new(0);
    let count = || asked.fetch_add(1, Ordering::Relaxed) == usize::MAX;
    let counting = Surveyor { watch: Watch::SILENT.cancelled_by(&count), ..surveyor };
    let whole = counting.atlas(&Unexplained, &WINDOW).unwrap();
    assert!(whole.is_finished() && !whole.agrees());
    let all = asked.into_inner();
    for last in (0..all - all / 50).step_by(all / 40) {
        let asked = AtomicUsize::new(0);
        let cancel = || asked.fetch_add(1, Ordering::Relaxed) >= last;
        let cancelled = Surveyor { watch: Watch::SILENT.cancelled_by(&cancel), ..surveyor };
        let begun = cancelled.atlas(&Unexplained, &WINDOW).unwrap();
        assert!(!begun.is_finished(), "{last} of {all}");
        let resumed = surveyor.resume(&Unexplained, begun).unwrap();
        assert!(resumed.is_finished());
        assert_eq!(resumed.unresolved, whole.unresolved, "{last} of {all}");
        assert_eq!(resumed.verification, whole.verification, "{last} of {all}");
        assert_eq!(resumed.rounds, whole.rounds);
    }
}

/// A screen does less, leaves what is in doubt as it is, and says so.
#[test]
fn effort_is_a_part_of_the_options() {
    let [screen, usual, certain] = Effort::ALL.map(|effort| {
        let options = effort.applied(AtlasOptions { rounds: 2, ..options() });
        let surveyor = Surveyor { options, ..Surveyor::default() };
        let atlas = surveyor.atlas(&Unexplained, &WINDOW).unwrap();
        assert!(!atlas.agrees() && atlas.is_finished() && options.effort == effort);
        (atlas.verification.tried.iter().sum::<usize>(), atlas.statistics, atlas.rounds)
    });
    assert!(10 * screen.0 < usual.0 && 4 * usual.0 < certain.0);
    assert!(screen.1.free_runs < usual.1.free_runs);
    assert_eq!(screen.2, 1);
}

#[test]
fn progress_tells_of_as_many_steps_as_it_announced() {
    let (announced, done) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let said = Mutex::new(Vec::new());
    let report = |progress| {
        let (counter, steps) = match progress {
            Progress::Begin { steps } => (&announced, steps),
            Progress::Advance { steps } => (&done, steps),
            Progress::Now { what } => {
                said.lock().expect("no panic").push(what);
                return;
            }
        };
        counter.fetch_add(steps, Ordering::Relaxed);
    };
    let watch = Watch::from(&report);
    let surveyor = Surveyor { options: options(), watch, ..Surveyor::default() };
    surveyor.atlas(&any(Shapes { hole: 0.0 }), &WINDOW).unwrap();
    assert!(done.load(Ordering::Relaxed) > 2000);
    assert_eq!(announced.into_inner(), done.into_inner());
    let said = said.into_inner().expect("no panic");
    assert_eq!(said[..2], ["counting boundaries", "searching along the edges of the window"]);
    assert!(said.contains(&"comparing regions with runs"), "{said:?}");
}

/// The tracer does not come to the hole, but the verification does.
#[test]
fn runs_that_fail_speak_against_an_atlas() {
    let family = any(Shapes { hole: 0.05 });
    let surveyor = Surveyor { options: options(), ..Surveyor::default() };
    let atlas = surveyor.atlas(&family, &WINDOW).unwrap();
    assert!(atlas.unresolved.is_empty() && atlas.verification.agrees());
    assert!(atlas.verification.failed().count() > 0);
    assert!(!atlas.agrees());
    // The region around the hole is in doubt, another one is not.
    assert_eq!(atlas.label(&Point::new(-0.6, 0.5)), None);
    assert_eq!(atlas.label(&Point::new(0.0, -0.1)), Some(&vec![true, true, false]));
}

/// Points on a curve, on the window's edge and outside.
#[test]
fn every_point_is_decided() {
    let family = any(Shapes { hole: 0.0 });
    let surveyor = Surveyor { options: options(), ..Surveyor::default() };
    let atlas = surveyor.atlas(&family, &WINDOW).unwrap();
    let on_circle = Point::new(0.3, 0.4);
    assert_eq!(atlas.label(&on_circle), None);
    for point in [on_circle, Point::new(-1.0, 0.3), Point::new(0.1, 0.0)] {
        let decided = atlas.decide(&family, &point).unwrap();
        assert_eq!(decided, Some(family.label(&point).unwrap()), "{point:?}");
    }
    assert_eq!(atlas.decide(&family, &Point::new(1.1, 0.0)).unwrap(), None);
}

#[test]
fn a_survey_of_no_rounds_is_refused() {
    let surveyor =
        Surveyor { options: AtlasOptions { rounds: 0, ..options() }, ..Surveyor::default() };
    let error = surveyor.atlas(&Shapes { hole: 0.0 }, &WINDOW).unwrap_err();
    assert_eq!(error.to_string(), "rounds = 0 is out of range; expected at least 1");
}
