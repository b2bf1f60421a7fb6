//! How far a search is, and whether anybody waits for it.

use std::cell::Cell;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// How far work on orbits is, and whether anybody still waits for it. Each piece of work has its
/// own.
#[derive(Debug, Default)]
pub struct OrbitWatch {
    stopped: AtomicBool,
    done: AtomicUsize,
    steps: AtomicUsize,
}

impl OrbitWatch {
    /// Nobody waits any more: the work ends soon, with an error or incomplete.
    pub fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }

    /// Whether nobody waits.
    pub fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    /// The steps that are done, and all that have begun.
    pub fn progress(&self) -> (usize, usize) {
        (self.done.load(Ordering::Relaxed), self.steps.load(Ordering::Relaxed))
    }

    /// Steps begin.
    pub fn begin(&self, steps: usize) {
        self.steps.fetch_add(steps, Ordering::Relaxed);
    }

    /// Steps are done.
    pub fn advance(&self, steps: usize) {
        self.done.fetch_add(steps, Ordering::Relaxed);
    }

    /// One step of work of unknown length is done.
    pub(crate) fn count(&self) {
        self.begin(1);
        self.advance(1);
    }
}

/// A run, which ends if nobody waits for it, and may say how far it is.
pub(crate) struct Watched<'a> {
    watch: &'a OrbitWatch,
    /// The start and the end, if it says how far it is.
    span: Option<[f64; 2]>,
    /// The next step.
    next: Cell<u32>,
}

impl<'a> Watched<'a> {
    /// Steps of a run.
    const STEPS: u32 = 1000;

    /// A run that says how far it is.
    pub fn over(watch: &'a OrbitWatch, span: [f64; 2]) -> Self {
        watch.begin(Self::STEPS as usize);
        Self { watch, span: Some(span), next: Cell::new(1) }
    }

    /// A run that is one of many.
    pub fn one(watch: &'a OrbitWatch) -> Self {
        Self { watch, span: None, next: Cell::new(1) }
    }

    /// Whether the run ends at once. It has come to a time.
    pub fn stops(&self, s: f64) -> bool {
        if let Some([start, end]) = self.span {
            let at = |step: u32| start + (end - start) * f64::from(step) / f64::from(Self::STEPS);
            while self.next.get() <= Self::STEPS && s >= at(self.next.get()) {
                self.next.set(self.next.get() + 1);
                self.watch.advance(1);
            }
        }
        self.watch.is_stopped()
    }
}

impl Drop for Watched<'_> {
    /// However it has ended, the run is over.
    fn drop(&mut self) {
        if self.span.is_some() {
            self.watch.advance((Self::STEPS + 1 - self.next.get()) as usize);
        }
    }
}
