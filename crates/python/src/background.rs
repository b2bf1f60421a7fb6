//! Long work on threads of its own, while the thread of Python looks for Ctrl-C and says how far
//! the work is.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex};
use std::time::Instant;

use pyo3::prelude::*;
use stickslip_orbits::OrbitWatch;
use stickslip_plane::progress::{Progress, Report};

use crate::failure::failed;
use crate::hybrid::trouble::lock;
use crate::parallel::{PAUSE, Threads};

/// A look for Ctrl-C now and then, from a run on the thread of Python, which says how far it is.
pub struct Signals {
    steps: AtomicUsize,
    looked: Mutex<Instant>,
    raised: Mutex<Option<PyErr>>,
    /// What is called with the thousandths of the time that are done.
    progress: Option<Py<PyAny>>,
    /// The span of the run.
    span: [f64; 2],
}

impl Signals {
    /// Steps between two looks at the clock, which take longer than a short step.
    const STEPS: usize = 32;

    /// For a run over a span, of which `progress` is told.
    pub fn new(progress: Option<Py<PyAny>>, span: [f64; 2]) -> Self {
        let looked = Mutex::new(Instant::now());
        Self { steps: AtomicUsize::new(0), looked, raised: Mutex::new(None), progress, span }
    }

    /// Whether Ctrl-C was pressed, or `progress` has failed. It is asked after every step, with the
    /// time that the run has reached.
    pub fn stop(&self, s: f64) -> bool {
        if !self.steps.fetch_add(1, Ordering::Relaxed).is_multiple_of(Self::STEPS) {
            return false;
        }
        let mut looked = lock(&self.looked);
        if looked.elapsed() >= PAUSE {
            *looked = Instant::now();
            let looked = Python::attach(|py| py.check_signals().and_then(|()| self.tell(py, s)));
            *lock(&self.raised) = looked.err();
        }
        lock(&self.raised).is_some()
    }

    fn tell(&self, py: Python<'_>, s: f64) -> PyResult<()> {
        /// Steps of a whole run.
        const STEPS: u32 = 1000;
        let Some(progress) = &self.progress else { return Ok(()) };
        let [start, end] = self.span;
        // An infinite span is never done.
        let part = f64::from(STEPS) * (s - start) / (end - start);
        let done = (1..=STEPS).take_while(|&step| f64::from(step) <= part).count();
        progress.call1(py, (done, STEPS)).map(drop)
    }

    /// The exception of Ctrl-C or of `progress`, if there is one.
    pub fn raised(&self) -> Option<PyErr> {
        lock(&self.raised).take()
    }
}

/// How far the work is, and whether nobody waits for it any more.
#[derive(Default)]
struct State {
    watch: Arc<OrbitWatch>,
    /// What is done now, in words.
    doing: Mutex<&'static str>,
}

/// With this the threads of abandoned work unwind.
struct Abandoned;

impl State {
    /// Takes a report of the work. It does not return if the work is abandoned.
    fn take(&self, progress: Progress) {
        match progress {
            Progress::Begin { steps } => self.watch.begin(steps),
            Progress::Advance { steps } => self.watch.advance(steps),
            Progress::Now { what } => *lock(&self.doing) = what,
        }
        if self.watch.is_stopped() {
            resume_unwind(Box::new(Abandoned));
        }
    }

    /// Calls `function` with the steps that are done and with all that have begun.
    fn tell(&self, py: Python<'_>, function: Option<&Py<PyAny>>) -> PyResult<()> {
        let Some(function) = function else { return Ok(()) };
        tell(py, function, self.watch.progress(), *lock(&self.doing))
    }
}

/// Calls `function` with the steps that are done, with all that have begun, and with what is done
/// now, if the work says it.
pub fn tell(
    py: Python<'_>,
    function: &Py<PyAny>,
    (done, steps): (usize, usize),
    doing: &str,
) -> PyResult<()> {
    let told = if doing.is_empty() {
        function.call1(py, (done, steps))
    } else {
        function.call1(py, (done, steps, doing))
    };
    told.map(drop)
}

/// What `work` makes on so many threads, or on one for each core if the number is 0.
///
/// `progress` is called now and then with the steps that are done and with all that have begun. Its
/// exception, or Ctrl-C, ends the call at once, and the threads end with their next report.
pub fn watched<T: Send + 'static>(
    py: Python<'_>,
    threads: usize,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(Report<'_>) -> T + Send + 'static,
) -> PyResult<T> {
    abandonable(py, threads, progress, |report, _| work(report))
}

/// As [`watched`], for work that looks itself whether anybody waits for it.
pub fn abandonable<T: Send + 'static>(
    py: Python<'_>,
    threads: usize,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(Report<'_>, &Arc<OrbitWatch>) -> T + Send + 'static,
) -> PyResult<T> {
    let pool = Threads::pool(threads)?;
    let state = Arc::new(State::default());
    let (sender, receiver) = channel::<Result<T, Box<dyn Any + Send>>>();
    let theirs = Arc::clone(&state);
    let thread = move || {
        let report = |progress| theirs.take(progress);
        let made = catch_unwind(AssertUnwindSafe(|| pool.install(|| work(&report, &theirs.watch))));
        // Nobody waits any more if the work is abandoned.
        let _ = sender.send(made);
    };
    std::thread::Builder::new().spawn(thread).map_err(failed)?;
    let receiver = Mutex::new(receiver);
    loop {
        match py.detach(|| lock(&receiver).recv_timeout(PAUSE)) {
            Ok(Ok(made)) => {
                state.tell(py, progress)?;
                return Ok(made);
            }
            Ok(Err(panic)) => resume_unwind(panic),
            Err(RecvTimeoutError::Disconnected) => return Err(failed("the work has no end")),
            Err(RecvTimeoutError::Timeout) => {
                let looked = py.check_signals().and_then(|()| state.tell(py, progress));
                if let Err(error) = looked {
                    state.watch.stop();
                    return Err(error);
                }
            }
        }
    }
}
