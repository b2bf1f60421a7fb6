//! What Python passes.

use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use stickslip_solver::sliding::SurfaceSide;
use stickslip_solver::{Direction, EmbeddedPair, Guard, InvalidValue, Options, Schedule, Times};

use crate::failure::bad_input;

/// What is called: a function of C (its address and that of its parameters, and the object that
/// keeps both alive), or any callable.
#[derive(FromPyObject)]
pub enum Callee {
    Compiled(usize, usize, Py<PyAny>),
    Python(Py<PyAny>),
}

/// A function, with what messages call it.
#[derive(FromPyObject)]
pub struct FunctionArguments(pub String, pub Callee);

/// What follows when a guard fires: a mode, if it is known before; the function that returns the
/// state after, or the mode and the state; which of both; and the function that returns the
/// variables after.
#[derive(FromPyObject)]
pub struct ChangeArguments(
    pub Option<usize>,
    pub Option<FunctionArguments>,
    pub bool,
    pub Option<FunctionArguments>,
);

/// The times of a clock: its period and its phase, or a list.
#[derive(FromPyObject)]
pub enum ClockArguments {
    Every(f64, f64),
    At(Vec<f64>),
}

/// The times of a clock.
pub enum Clock {
    Every(f64, f64),
    At(Times),
}

impl Clock {
    pub fn new(arguments: ClockArguments) -> PyResult<Self> {
        Ok(match arguments {
            ClockArguments::Every(period, phase) => Self::Every(period, phase),
            ClockArguments::At(times) => Self::At(Times::new(times).map_err(bad_input)?),
        })
    }

    pub fn schedule(&self) -> Schedule<'_> {
        match self {
            Self::Every(period, phase) => Schedule::every(*period, *phase),
            Self::At(times) => Schedule::at(times),
        }
    }
}

/// A guard: what messages call it, direction, order of the zero from which it starts (`None` if
/// that is to be found out), count after which it ends the run, priority, whether it is smooth,
/// what follows, the condition of a transition that branches, whether it sees jumps, what follows
/// an accumulation, and the times of a clock.
#[derive(FromPyObject)]
pub struct GuardArguments(
    pub String,
    String,
    pub Option<u32>,
    u32,
    i8,
    bool,
    pub ChangeArguments,
    pub Option<FunctionArguments>,
    bool,
    pub Option<ChangeArguments>,
    pub Option<ClockArguments>,
);

/// A function that returns the values of guards, and their places.
#[derive(FromPyObject)]
pub struct SourceArguments(pub FunctionArguments, pub Vec<usize>);

/// A mode: right-hand side, guards, and where their values come from.
#[derive(FromPyObject)]
pub struct ModeArguments(pub FunctionArguments, pub Vec<GuardArguments>, pub Vec<SourceArguments>);

/// What callables get besides time and state, if anything: a callable that names the values of
/// variables, and those at the start; and one that names signs of surfaces.
#[derive(FromPyObject)]
pub struct NamesArguments(pub Option<(Py<PyAny>, Vec<f64>)>, pub Option<Py<PyAny>>);

/// A system: its modes, the functions whose zeros are surfaces, and names.
#[derive(FromPyObject)]
pub struct SystemArguments(pub Vec<ModeArguments>, pub Vec<FunctionArguments>, pub NamesArguments);

impl GuardArguments {
    /// The guard that the solver knows.
    pub fn guard(&self) -> PyResult<Guard> {
        let Self(_, direction, zero_order, terminal, priority, smooth, _, _, sees_jumps, ..) = self;
        let direction = match direction.as_str() {
            "below" => Direction::Below,
            "falling" => Direction::Falling,
            "rising" => Direction::Rising,
            "either" => Direction::Either,
            "clock" => Direction::Clock,
            "off" => Direction::Off,
            other => return Err(bad_input(format!("direction = {other:?}"))),
        };
        let guard =
            Guard::new(direction).from_zero(zero_order.unwrap_or(0)).terminal_after(*terminal);
        let guard = guard.priority(*priority);
        let guard = if *sees_jumps { guard.sees_jumps() } else { guard };
        Ok(if *smooth { guard.smooth() } else { guard })
    }
}

/// The mode, the time and the state at the start, and the signs of surfaces on which the run stays
/// where it could go on in several ways.
#[derive(FromPyObject)]
pub struct StartArguments<'py>(usize, f64, PyReadonlyArray1<'py, f64>, Vec<i8>);

/// Where a run starts.
pub struct Start {
    pub mode: usize,
    pub s: f64,
    pub state: Vec<f64>,
    pub sides: Vec<SurfaceSide>,
}

impl StartArguments<'_> {
    pub fn owned(&self) -> Start {
        let side = |sign: &i8| match sign {
            0 => SurfaceSide::Sliding,
            1.. => SurfaceSide::Above,
            _ => SurfaceSide::Below,
        };
        let sides = self.3.iter().map(side).collect();
        Start { mode: self.0, s: self.1, state: self.2.as_array().to_vec(), sides }
    }
}

/// Times at which the state is wanted, or `None` for all steps, and whether dense output is kept.
#[derive(FromPyObject)]
pub struct Output<'py>(Option<PyReadonlyArray1<'py, f64>>, bool);

impl Output<'_> {
    pub fn owned(&self) -> (Option<Vec<f64>>, bool) {
        (self.0.as_ref().map(|times| times.as_array().to_vec()), self.1)
    }
}

/// The method and the options of a run.
#[derive(FromPyObject)]
pub struct Settings {
    #[pyo3(item)]
    method: String,
    #[pyo3(item)]
    rtol: f64,
    #[pyo3(item)]
    atol: f64,
    #[pyo3(item)]
    max_step: f64,
    #[pyo3(item)]
    first_step: Option<f64>,
    #[pyo3(item)]
    max_switches: usize,
    #[pyo3(item)]
    max_steps: usize,
    /// Those of components, if these have their own.
    #[pyo3(item)]
    pub tolerances: Vec<(f64, f64)>,
    #[pyo3(item)]
    guard_scale: Option<f64>,
}

impl Settings {
    pub fn checked(&self) -> PyResult<(EmbeddedPair, Options)> {
        let pair = self.method.parse().map_err(|error: InvalidValue| bad_input(error))?;
        let options = Options {
            rtol: self.rtol,
            atol: self.atol,
            max_step: self.max_step,
            first_step: self.first_step,
            max_switches: self.max_switches,
            max_steps: self.max_steps,
            guard_scale: self.guard_scale,
            ..Options::default()
        };
        options.validate().map_err(bad_input)?;
        for &(rtol, atol) in &self.tolerances {
            Options { rtol, atol, ..options }.validate().map_err(bad_input)?;
        }
        Ok((pair, options))
    }
}
