//! The runs of a family for one call of Python: what the tracer sees.

use std::sync::{Arc, Mutex};
use std::time::Instant;

use pyo3::prelude::*;
use stickslip_solver::{Dop853, Margin};
use stickslip_tracer::{DynamicFamily, Family, FreeRun, Itinerary, Point};

use crate::failure::bad_input;
use crate::families::blueprint::{Blueprint, Members};
use crate::families::failure::UserError;
use crate::hybrid::system::PAUSE;
use crate::hybrid::trouble::{Trouble, lock};

/// The runs of a family, as the tracer knows them.
type Runs = DynamicFamily<Members, Dop853>;

/// The runs of a family, for one call of Python.
pub struct Runner {
    runs: Runs,
    trouble: Arc<Trouble>,
    /// When Ctrl-C was looked for, if the runs are on the thread that has to do it.
    looked: Option<Mutex<Instant>>,
}

impl Runner {
    /// The runs of the family that Python passes. It `looks` for Ctrl-C if they are on the thread
    /// that has to do it.
    pub fn new(blueprint: &Arc<Blueprint>, trouble: Arc<Trouble>, looks: bool) -> Self {
        let problem = Members { blueprint: blueprint.clone(), trouble: trouble.clone() };
        let runs = DynamicFamily { problem, method: Dop853, options: blueprint.options };
        Self { runs, trouble, looked: looks.then(|| Mutex::new(Instant::now())) }
    }

    /// Why a run has no result.
    pub fn why(&self, error: &UserError) -> PyErr {
        self.trouble.take_failure().unwrap_or_else(|| bad_input(error))
    }

    pub fn trouble(&self) -> &Arc<Trouble> {
        &self.trouble
    }

    /// The result of a run, unless a function has failed.
    fn checked<T>(
        &self,
        run: impl FnOnce(&Runs) -> Result<T, stickslip_tracer::FamilyError>,
    ) -> Result<T, UserError> {
        let result = run(&self.runs);
        if let Some(looked) = &self.looked {
            let mut looked = lock(looked);
            if looked.elapsed() >= PAUSE {
                *looked = Instant::now();
                drop(looked);
                let found = Python::attach(|py| {
                    py.detach(std::thread::yield_now);
                    py.check_signals()
                });
                if let Err(error) = found
                    && let Some(error) = self.trouble.postpone(error)
                {
                    self.trouble.fail(error);
                }
            }
        }
        if self.trouble.has_failed() {
            return Err(UserError::Function);
        }
        result.map_err(UserError::Family)
    }
}

impl Family for Runner {
    type Label = Itinerary;
    type Margin = Margin;
    type Error = UserError;

    fn label(&self, point: &Point) -> Result<Itinerary, UserError> {
        self.checked(|runs| runs.label(point))
    }

    fn margin(&self, point: &Point, margin: &Margin) -> Result<Option<f64>, UserError> {
        self.checked(|runs| runs.margin(point, margin))
    }

    fn moved(&self, point: &Point, margin: &Margin) -> Result<Margin, UserError> {
        self.checked(|runs| runs.moved(point, margin))
    }

    fn is_sure(&self, margin: &Margin) -> bool {
        self.runs.is_sure(margin)
    }

    fn cusps(&self, margin: &Margin) -> Vec<[Margin; 2]> {
        self.runs.cusps(margin)
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<Itinerary, Margin>, UserError> {
        self.checked(|runs| runs.free_run(point))
    }
}
