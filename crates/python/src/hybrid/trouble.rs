//! What goes wrong in functions of Python, and wishes to stop.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;

/// What has gone wrong in the runs that belong together.
///
/// The solver knows no failures. The first one is kept; from then on every value is NaN and nothing
/// is called any more, so that runs end at once.
#[derive(Default)]
pub struct Trouble {
    failed: AtomicBool,
    error: Mutex<Option<PyErr>>,
    /// Whether the first Ctrl-C only asks for an end, where nothing is lost by it.
    patient: bool,
    asked: AtomicBool,
    asks: Mutex<Option<PyErr>>,
}

impl Trouble {
    /// No trouble yet. The first Ctrl-C only asks for an end.
    pub fn patient() -> Self {
        Self { patient: true, ..Self::default() }
    }

    /// Whether a function has failed.
    pub fn has_failed(&self) -> bool {
        self.failed.load(Ordering::Relaxed)
    }

    /// Whether somebody asks for an end.
    pub fn is_asked(&self) -> bool {
        self.asked.load(Ordering::Relaxed)
    }

    /// Keeps the first failure.
    pub fn fail(&self, error: PyErr) {
        if !self.failed.swap(true, Ordering::Relaxed) {
            *lock(&self.error) = Some(error);
        }
    }

    /// Asks for an end, because of `error`, which comes out then.
    pub fn ask(&self, error: PyErr) {
        if !self.asked.swap(true, Ordering::Relaxed) {
            *lock(&self.asks) = Some(error);
        }
    }

    /// Takes an exception that only asks for an end, and returns every other one.
    pub fn postpone(&self, error: PyErr) -> Option<PyErr> {
        let interrupts =
            self.patient && Python::attach(|py| error.is_instance_of::<PyKeyboardInterrupt>(py));
        if !interrupts || self.is_asked() {
            return Some(error);
        }
        self.ask(error);
        None
    }

    /// The first failure.
    pub fn take_failure(&self) -> Option<PyErr> {
        lock(&self.error).take()
    }

    /// Why somebody asks for an end.
    pub fn take_wish(&self) -> Option<PyErr> {
        lock(&self.asks).take()
    }
}

/// The content of a mutex, whatever has happened to those who held it.
pub fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
