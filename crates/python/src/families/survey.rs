//! A trace that calls Python: on which threads, with progress, and with an end on request.
//!
//! The first Ctrl-C ends a trace between two of its tasks, so that it can go on later. The second
//! one ends the run that is under way.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use pyo3::prelude::*;
use stickslip_plane::progress::InParallel;
use stickslip_tracer::{
    AtlasOf, AtlasOptions, Executor, FreeRunOf, LabelOf, Point, Progress, Serial, Surveyor,
    TraceError, Watch,
};

use crate::background::tell;
use crate::failure::failed;
use crate::families::failure::{UserError, of_trace};
use crate::families::runner::Runner;
use crate::hybrid::trouble::{Trouble, lock};
use crate::parallel::{PAUSE, Threads};

/// Python functions that see the progress of a trace and may cancel it.
#[derive(FromPyObject)]
pub struct Callbacks(Option<Py<PyAny>>, Option<Py<PyAny>>);

/// The steps that are done, all that have begun, and when they were reported.
struct Meter {
    done: usize,
    steps: usize,
    /// What is done now, in words.
    doing: &'static str,
    told: Option<Instant>,
}

/// What a function that may cancel has said, and when it was asked.
struct Said {
    answer: AtomicBool,
    asked: Mutex<Option<Instant>>,
}

impl Said {
    /// The function is asked so often, at most: runs may be shorter than a call of Python.
    const PAUSE: Duration = Duration::from_millis(10);

    /// Whether it is time to ask again.
    fn is_due(&self) -> bool {
        let mut asked = lock(&self.asked);
        let due = asked.is_none_or(|asked| asked.elapsed() >= Self::PAUSE);
        if due {
            *asked = Some(Instant::now());
        }
        due
    }
}

/// Computes the runs on the threads of the current pool, or one after the other.
#[derive(Clone, Copy)]
pub struct Runs {
    pub parallel: bool,
}

impl Executor<Runner> for Runs {
    fn free_runs(&self, family: &Runner, points: &[Point]) -> Vec<FreeRunOf<Runner>> {
        if self.parallel {
            InParallel.free_runs(family, points)
        } else {
            Serial.free_runs(family, points)
        }
    }

    fn labels(&self, family: &Runner, points: &[Point]) -> Vec<LabelOf<Runner>> {
        if self.parallel {
            InParallel.labels(family, points)
        } else {
            Serial.labels(family, points)
        }
    }
}

/// The atlas that `work` makes, and an exception that has asked for an end.
///
/// With `threads` no run may need the interpreter. They run while this one waits for Ctrl-C.
pub fn survey(
    py: Python<'_>,
    runner: &Runner,
    options: AtlasOptions,
    threads: Option<usize>,
    callbacks: &Callbacks,
    work: impl Fn(&Surveyor<'_, Runs>, &Runner) -> Result<AtlasOf<Runner>, TraceError<UserError>>
    + Send
    + Sync,
) -> PyResult<(AtlasOf<Runner>, Option<PyErr>)> {
    let (made, wish) = watched(py, runner.trouble(), threads, callbacks, |executor, watch| {
        work(&Surveyor { options, executor, watch }, runner)
    })?;
    Ok((made.map_err(|error| of_trace(py, &error))?, wish))
}

/// What `work` makes, and an exception that has asked for an end.
pub fn watched<T: Send>(
    py: Python<'_>,
    trouble: &Arc<Trouble>,
    threads: Option<usize>,
    callbacks: &Callbacks,
    work: impl Fn(Runs, Watch<'_>) -> T + Send + Sync,
) -> PyResult<(T, Option<PyErr>)> {
    let meter = Mutex::new(Meter { done: 0, steps: 0, doing: "", told: None });
    let report = |progress: Progress| callbacks.tell(&meter, progress, trouble);
    let said = Said { answer: AtomicBool::new(false), asked: Mutex::new(None) };
    let cancelled = || callbacks.cancel(&said, trouble);
    let watch = Watch::from(&report).cancelled_by(&cancelled);
    let executor = Runs { parallel: threads.is_some() };
    let made = match threads {
        None => work(executor, watch),
        Some(threads) => {
            let pool = Threads::pool(threads)?;
            await_thread(py, trouble, || pool.install(|| work(executor, watch)))?
        }
    };
    if let Some(error) = trouble.take_failure() {
        return Err(error);
    }
    callbacks.tell_last(&meter, trouble);
    Ok((made, trouble.take_wish()))
}

/// Does `work` on another thread, and looks for Ctrl-C meanwhile.
fn await_thread<T: Send>(
    py: Python<'_>,
    trouble: &Arc<Trouble>,
    work: impl FnOnce() -> T + Send,
) -> PyResult<T> {
    let (sender, receiver) = channel();
    let receiver = Mutex::new(receiver);
    std::thread::scope(|scope| {
        let thread = scope.spawn(move || {
            let made = work();
            // Nobody waits any more if this one has panicked.
            let _ = sender.send(());
            made
        });
        let waits = || lock(&receiver).recv_timeout(PAUSE) == Err(RecvTimeoutError::Timeout);
        let look = || {
            if let Err(error) = py.check_signals()
                && let Some(error) = trouble.postpone(error)
            {
                trouble.fail(error);
            }
        };
        while py.detach(waits) {
            look();
        }
        look();
        py.detach(|| thread.join()).map_err(|_| failed("a thread of the trace has panicked"))
    })
}

impl Callbacks {
    /// A function that sees the progress, and none that cancels.
    pub fn telling(progress: Option<Py<PyAny>>) -> Self {
        Self(progress, None)
    }

    /// Reports progress, now and then.
    fn tell(&self, meter: &Mutex<Meter>, progress: Progress, trouble: &Trouble) {
        let Some(function) = &self.0 else { return };
        let (progress, doing) = {
            let mut meter = lock(meter);
            match progress {
                Progress::Begin { steps } => meter.steps += steps,
                Progress::Advance { steps } => meter.done += steps,
                Progress::Now { what } => meter.doing = what,
            }
            if meter.told.is_some_and(|told| told.elapsed() < PAUSE) {
                return;
            }
            meter.told = Some(Instant::now());
            ((meter.done, meter.steps), meter.doing)
        };
        Self::call(function, progress, doing, trouble);
    }

    /// Reports the last progress.
    fn tell_last(&self, meter: &Mutex<Meter>, trouble: &Trouble) {
        let Some(function) = &self.0 else { return };
        let (progress, doing) = {
            let meter = lock(meter);
            ((meter.done, meter.steps), meter.doing)
        };
        Self::call(function, progress, doing, trouble);
    }

    fn call(function: &Py<PyAny>, progress: (usize, usize), doing: &str, trouble: &Trouble) {
        if let Err(error) = Python::attach(|py| tell(py, function, progress, doing)) {
            trouble.ask(error);
        }
    }

    /// Whether the trace is to end. `said` keeps the answer of the function.
    fn cancel(&self, said: &Said, trouble: &Trouble) -> bool {
        if trouble.has_failed() || trouble.is_asked() || said.answer.load(Ordering::Relaxed) {
            return true;
        }
        let Some(function) = &self.1 else { return false };
        if !said.is_due() {
            return false;
        }
        let answer = Python::attach(|py| function.call0(py)?.is_truthy(py));
        match answer {
            Ok(answer) => said.answer.store(answer, Ordering::Relaxed),
            Err(error) => trouble.ask(error),
        }
        said.answer.load(Ordering::Relaxed) || trouble.is_asked()
    }
}
