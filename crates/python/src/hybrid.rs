//! Systems of one's own: modes, guards and transitions as functions of Python or of C.
//!
//! In reading order: `arguments` (what Python passes), `modes` (what becomes of it), `system` (what
//! the solver sees) and `regimes` (what it takes for modes), `function` (a call), `numbers` (what
//! comes back) and `trouble` (what goes wrong), `record` (what a run finds), `segments` (dense
//! output that is kept), `ending` (how a run ended).

pub mod arguments;
mod ending;
pub mod function;
pub mod modes;
mod numbers;
mod record;
mod regimes;
mod segments;
pub mod system;
pub mod trouble;

use std::cell::Cell;
use std::sync::Arc;

use pyo3::exceptions::PyRecursionError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use stickslip_solver::dynamic::{
    DynamicObserver, DynamicRun, DynamicStart, run_dynamic_backwards, run_dynamic_with,
};
use stickslip_solver::sliding::{Refusal, SlidingMode};
use stickslip_solver::{Dop853, Dopri5, EmbeddedPair, Options, Outcome, RunError, Statistics};

use crate::background::Signals;
use crate::failure::bad_input;
use arguments::{Output, Settings, Start, StartArguments, SystemArguments};
use ending::Ending;
use function::Caller;
use modes::Parts;
use record::Record;
pub use segments::evaluate_dense;
use system::{Sliding, System};

/// What the solver takes for a mode: a regime, and the sides of surfaces.
type Regime = SlidingMode<usize>;

/// Runs inside each other, at most: their stack is that of the thread, which may be small.
const DEEPEST: usize = 16;

thread_local! {
    /// Runs that are under way inside each other.
    static DEPTH: Cell<usize> = const { Cell::new(0) };
}

/// Counts a run that is under way, as long as it lives.
pub struct Level;

impl Level {
    pub fn enter() -> PyResult<Self> {
        let depth = DEPTH.get();
        if depth >= DEEPEST {
            return Err(PyRecursionError::new_err(format!("{DEEPEST} runs inside each other")));
        }
        DEPTH.set(depth + 1);
        Ok(Self)
    }
}

impl Drop for Level {
    fn drop(&mut self) {
        DEPTH.set(DEPTH.get() - 1);
    }
}

/// Runs a system from `start` to `end`. Returns what the run found, as columns.
///
/// The interpreter's lock is released if all functions are compiled.
#[pyfunction]
#[pyo3(signature = (system, args, start, end, settings, output, progress=None))]
#[expect(clippy::too_many_arguments, reason = "they are those of Python")]
pub fn run_hybrid<'py>(
    py: Python<'py>,
    system: SystemArguments,
    args: Bound<'py, PyTuple>,
    start: StartArguments<'py>,
    end: f64,
    settings: Settings,
    output: Output<'py>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let _level = Level::enter()?;
    let (pair, options) = settings.checked()?;
    let parts = Arc::new(Parts::new(system)?);
    let caller = Caller::new(args.iter().map(Bound::unbind).collect());
    let system = System::new(parts, caller, Arc::default(), None);
    let system = Sliding::new(system.with_tolerances(settings.tolerances));
    let (times, dense) = output.owned();
    let start = start.owned();
    let signals = Signals::new(progress, [start.s, end]);
    let job = Job { system, pair, options, start, end };
    // Dense output costs three evaluations a step, so it is made only if anybody reads it.
    if dense || times.as_ref().is_none_or(|times| !times.is_empty()) {
        let record = Record::<true>::new(&job, times, dense, signals);
        finish(py, job, record)
    } else {
        let record = Record::<false>::new(&job, times, dense, signals);
        finish(py, job, record)
    }
}

/// A run that is to be done.
struct Job {
    system: Sliding,
    pair: EmbeddedPair,
    options: Options,
    start: Start,
    end: f64,
}

/// Why a run has no result.
enum Failure {
    Run(RunError),
    /// It does not start.
    Start(Refusal),
}

impl Job {
    fn forwards(&self) -> bool {
        self.end > self.start.s
    }

    /// Whether the run ends where it starts.
    fn is_empty(&self) -> bool {
        !self.forwards() && self.end >= self.start.s
    }

    /// Runs the system. If a guard starts from a zero whose order is not known, the orders are
    /// tried.
    fn run<const SEGMENTS: bool>(
        &mut self,
        record: &mut Record<SEGMENTS>,
    ) -> Result<DynamicRun<Regime>, Failure> {
        let Start { mode, s, ref state, ref sides } = self.start;
        self.system.system.find_zeros(mode, s, state);
        let first = self.system.system.first(mode);
        let mode_at_start = match self.system.mode_from(first, sides, s, state) {
            Err(refusal) if self.system.system.trouble().has_failed() => {
                SlidingMode::refused(first, refusal)
            }
            found => found.map_err(Failure::Start)?,
        };
        record.begin(mode_at_start);
        loop {
            let run = self.run_once(mode_at_start, record);
            match run {
                Err(RunError::GuardUnresolved { guard, .. })
                    if record.is_empty() && self.system.system.raise_zero(mode, guard) => {}
                run => return run.map_err(Failure::Run),
            }
        }
    }

    fn run_once<const SEGMENTS: bool>(
        &self,
        mode: Regime,
        record: &mut Record<SEGMENTS>,
    ) -> Result<DynamicRun<Regime>, RunError> {
        let Start { s, ref state, .. } = self.start;
        let start = DynamicStart { mode, s, state };
        let (system, options, end) = (&self.system, &self.options, self.end);
        if self.is_empty() {
            record.on_end(mode, s, state);
            let (outcome, statistics) = (Outcome::ReachedEnd, Statistics::default());
            let (state, decided) = (state.clone(), true);
            return Ok(DynamicRun { outcome, s, mode, state, decided, statistics });
        }
        if self.forwards() {
            return run_dynamic_with(self.pair, system, start, end, options, record);
        }
        match self.pair {
            EmbeddedPair::Dopri5 => {
                run_dynamic_backwards(Dopri5, system, start, end, options, record)
            }
            EmbeddedPair::Dop853 => {
                run_dynamic_backwards(Dop853, system, start, end, options, record)
            }
        }
    }
}

/// Does the job, and turns what was recorded into columns.
fn finish<const SEGMENTS: bool>(
    py: Python<'_>,
    mut job: Job,
    mut record: Record<SEGMENTS>,
) -> PyResult<Bound<'_, PyDict>> {
    let compiled = job.system.system.is_compiled();
    let work = move || {
        let run = job.run(&mut record);
        (job, record, run)
    };
    let (job, mut record, run) = if compiled { py.detach(work) } else { work() };
    let system = &job.system.system;
    if let Some(error) = system.trouble().take_failure() {
        return Err(error);
    }
    let run = match run {
        Err(Failure::Start(refusal)) => {
            return Err(bad_input(format!("the run does not start on its surfaces: {refusal}")));
        }
        Err(Failure::Run(error)) => Err(error),
        Ok(run) => Ok(run),
    };
    let ending = Ending::new(system, &run, record.refusal());
    if run.is_err() && record.is_empty() {
        return Err(bad_input(ending.message));
    }
    record.close();
    let columns = record.columns(py, system)?;
    ending.describe(&columns, &run)?;
    columns.set_item("nfev", system.calls())?;
    Ok(columns)
}
