//! The runs of a family for one call of Python: what the tracer sees.

use std::sync::{Arc, Mutex};
use std::time::Instant;

use pyo3::prelude::*;
use stickslip_expression::SystemFamily;
use stickslip_solver::margin::Margin;
use stickslip_solver::{Dop853, Options};
use stickslip_tracer::{
    Family, FreeRun, Point,
    hybrid::{DynamicFamily, Itinerary},
};

use crate::failure::bad_input;
use crate::families::blueprint::{Blueprint, Members};
use crate::families::failure::UserError;
use crate::hybrid::trouble::{Trouble, lock};
use crate::parallel::PAUSE;

/// What the runs of a family are made of.
#[derive(Clone)]
pub enum Made {
    /// Functions of Python, or compiled ones, and the events up to which runs are told apart.
    Functions(Arc<Blueprint>, usize),
    /// Formulas.
    Formulas(Arc<SystemFamily>),
}

impl Made {
    /// Whether no run needs the interpreter.
    pub fn is_compiled(&self) -> bool {
        match self {
            Self::Functions(blueprint, _) => blueprint.is_compiled(),
            Self::Formulas(_) => true,
        }
    }

    /// The same runs, told apart up to so many events.
    pub fn up_to(&self, events: usize) -> Self {
        match self {
            Self::Functions(blueprint, _) => Self::Functions(blueprint.clone(), events),
            Self::Formulas(family) => {
                Self::Formulas(Arc::new(SystemFamily::clone(family).up_to(events)))
            }
        }
    }
}

/// The runs of a family, as the tracer knows them.
enum Runs {
    Functions(DynamicFamily<Members, Dop853>),
    Formulas(Arc<SystemFamily>),
}

/// Calls a method of the family.
macro_rules! of_runs {
    ($runs:expr, $family:ident => $call:expr) => {
        match $runs {
            Runs::Functions($family) => $call,
            Runs::Formulas($family) => $call,
        }
    };
}

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
    pub fn new(made: &Made, trouble: Arc<Trouble>, looks: bool) -> Self {
        let runs = match made {
            Made::Functions(blueprint, max_switches) => {
                let problem = Members { blueprint: blueprint.clone(), trouble: trouble.clone() };
                let options = Options { max_switches: *max_switches, ..blueprint.options };
                Runs::Functions(DynamicFamily { problem, method: Dop853, options })
            }
            Made::Formulas(family) => Runs::Formulas(family.clone()),
        };
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
        run: impl FnOnce(&Runs) -> Result<T, stickslip_tracer::hybrid::FamilyError>,
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
        self.checked(|runs| of_runs!(runs, family => family.label(point)))
    }

    fn margin(&self, point: &Point, margin: &Margin) -> Result<Option<f64>, UserError> {
        self.checked(|runs| of_runs!(runs, family => family.margin(point, margin)))
    }

    fn moved(&self, point: &Point, margin: &Margin) -> Result<Margin, UserError> {
        self.checked(|runs| of_runs!(runs, family => family.moved(point, margin)))
    }

    fn is_sure(&self, margin: &Margin) -> bool {
        of_runs!(&self.runs, family => family.is_sure(margin))
    }

    fn cusps(&self, margin: &Margin) -> Vec<[Margin; 2]> {
        of_runs!(&self.runs, family => family.cusps(margin))
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<Itinerary, Margin>, UserError> {
        self.checked(|runs| of_runs!(runs, family => family.free_run(point)))
    }
}
