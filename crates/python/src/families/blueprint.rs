//! A family as Python describes it.

use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyTuple;
use stickslip_solver::Options;
use stickslip_solver::sliding::SlidingMode;
use stickslip_tracer::{
    Point,
    hybrid::{DynamicProblem, DynamicSetting},
};

use crate::hybrid::arguments::{
    ChangeArguments, FunctionArguments, Settings, Start, StartArguments, SystemArguments,
};
use crate::hybrid::function::{Caller, Code, Function};
use crate::hybrid::modes::{Change, Parts};
use crate::hybrid::system::{At, Sliding, System};
use crate::hybrid::trouble::Trouble;

/// Everything about a family, for its runs on all threads.
pub struct Blueprint {
    parts: Arc<Parts>,
    /// What follows the two parameters as arguments of Python functions.
    args: Vec<Py<PyAny>>,
    /// The parameters of compiled functions, with room for those of the point, which come first in
    /// each part.
    parameters: Vec<f64>,
    /// Where the parts begin.
    own: Vec<usize>,
    pub start: Start,
    /// What changes mode and state at the start.
    pub first: Change,
    /// What must not be negative at the start.
    pub required: Vec<Function>,
    pub end: f64,
    pub options: Options,
}

impl Blueprint {
    pub fn new(
        py: Python<'_>,
        system: SystemArguments,
        args: &Bound<'_, PyTuple>,
        (start, first, required): (StartArguments<'_>, ChangeArguments, Vec<FunctionArguments>),
        end: f64,
        settings: &Settings,
    ) -> PyResult<Self> {
        let (_, options) = settings.checked()?;
        let (mut parts, mut first) = (Parts::new(system)?, Change::new(first)?);
        let mut required = required.into_iter().map(Function::new).collect::<PyResult<Vec<_>>>()?;
        let (mut parameters, mut own_parameters) = (vec![0.0; 2], vec![0]);
        let at_start = first.functions_mut().chain(&mut required);
        for Function { code, .. } in parts.functions_mut().chain(at_start) {
            let Code::Compiled(compiled) = code else { continue };
            let own = compiled.place_in_family(py, parameters.len())?;
            if own.is_empty() {
                // They share the first part.
                compiled.place_in_family(py, 0)?;
            } else {
                own_parameters.push(parameters.len());
                parameters.extend([0.0; 2]);
                parameters.extend(own);
            }
        }
        Ok(Self {
            parts: Arc::new(parts),
            args: args.iter().map(Bound::unbind).collect(),
            parameters,
            own: own_parameters,
            start: start.owned(),
            first,
            required,
            end,
            options,
        })
    }

    /// Whether no function needs the interpreter.
    pub fn is_compiled(&self) -> bool {
        let mut at_start = self.first.functions().chain(&self.required);
        self.parts.is_compiled() && at_start.all(Function::is_compiled)
    }

    /// The system at a point.
    pub fn system(&self, point: [f64; 2], trouble: Arc<Trouble>) -> System {
        let args = if self.is_compiled() { Vec::new() } else { self.arguments(point) };
        let mut parameters = self.parameters.clone();
        for &part in &self.own {
            parameters[part..part + 2].copy_from_slice(&point);
        }
        let at = At { point, parameters };
        System::new(self.parts.clone(), Caller::new(args), trouble, Some(at))
    }

    /// What Python functions get after time and state.
    fn arguments(&self, point: [f64; 2]) -> Vec<Py<PyAny>> {
        Python::attach(|py| {
            let point = point.map(|one| pyo3::types::PyFloat::new(py, one).into_any().unbind());
            point.into_iter().chain(self.args.iter().map(|one| one.clone_ref(py))).collect()
        })
    }
}

/// The systems of a family.
pub struct Members {
    pub blueprint: Arc<Blueprint>,
    pub trouble: Arc<Trouble>,
}

impl DynamicProblem for Members {
    type System = Sliding;

    fn at(&self, point: &Point) -> Option<DynamicSetting<Sliding>> {
        let &Blueprint { ref start, ref first, end, .. } = &*self.blueprint;
        let system = self.blueprint.system([point.x, point.y], self.trouble.clone());
        let mut state = start.state.clone();
        let regime = system.change(system.first(start.mode), first, start.s, &mut state);
        let system = Sliding::new(system);
        let mode = system.mode_from(regime, &start.sides, start.s, &state);
        // A run from where the solution does not go on fails.
        let mode = mode.unwrap_or_else(|refusal| SlidingMode::refused(regime, refusal));
        Some(DynamicSetting { system, mode, s: start.s, state, end })
    }

    fn conditions(&self, point: &Point) -> Vec<f64> {
        let Blueprint { start, required, .. } = &*self.blueprint;
        if required.is_empty() {
            return Vec::new();
        }
        let system = self.blueprint.system([point.x, point.y], self.trouble.clone());
        let regime = system.first(start.mode);
        required.iter().map(|it| system.number(it, regime, start.s, &start.state)).collect()
    }
}
