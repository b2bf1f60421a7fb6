//! A family as Python describes it.

use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyTuple;
use stickslip_solver::{Guard, Options};

use crate::failure::bad_input;
use crate::hybrid::arguments::{ChangeArguments, ModeArguments, Settings, Start};
use crate::hybrid::function::{Caller, Code, Function};
use crate::hybrid::modes::{Change, Mode};
use crate::hybrid::system::{At, System};
use crate::hybrid::trouble::Trouble;

/// Everything about a family, for its runs on all threads.
pub struct Blueprint {
    modes: Arc<Vec<Mode>>,
    /// For each mode, the place of each of its guards among those of the family.
    pub places: Vec<Vec<usize>>,
    /// For each mode, the guards of the family, of which those that the mode does not list are off.
    pub guards: Vec<Vec<Guard>>,
    /// What follows the two parameters as arguments of Python functions.
    args: Vec<Py<PyAny>>,
    /// The parameters of compiled functions, with room for those of the point, which come first in
    /// each part.
    parameters: Vec<f64>,
    /// Where the parts begin.
    parts: Vec<usize>,
    /// The mode, the time and the state at the start.
    pub start: (usize, f64, Vec<f64>),
    /// What changes mode and state at the start.
    pub first: Change,
    pub end: f64,
    pub options: Options,
}

impl Blueprint {
    pub fn new(
        py: Python<'_>,
        (modes, places): (Vec<ModeArguments>, Vec<Vec<usize>>),
        args: &Bound<'_, PyTuple>,
        (start, first): (Start<'_>, ChangeArguments),
        end: f64,
        settings: &Settings,
    ) -> PyResult<Self> {
        let (_, options) = settings.checked()?;
        let mut modes = modes.into_iter().map(Mode::new).collect::<PyResult<Vec<_>>>()?;
        let mut first = Change::new(first)?;
        let (mut parameters, mut parts) = (vec![0.0; 2], vec![0]);
        let functions = modes.iter_mut().flat_map(Mode::functions_mut);
        for Function { code, .. } in functions.chain(first.function_mut()) {
            let Code::Compiled(compiled) = code else { continue };
            let own = compiled.place_in_family(py, parameters.len())?;
            if own.is_empty() {
                // They share the first part.
                compiled.place_in_family(py, 0)?;
            } else {
                parts.push(parameters.len());
                parameters.extend([0.0; 2]);
                parameters.extend(own);
            }
        }
        let fits = modes.len() == places.len()
            && modes.iter().zip(&places).all(|(mode, own)| mode.guards.len() == own.len());
        if !fits {
            return Err(bad_input("guards and places differ"));
        }
        let count = places.iter().flatten().map(|place| place + 1).max().unwrap_or(0);
        let with_gaps = |(mode, own): (&Mode, &Vec<usize>)| {
            let mut guards = vec![Guard::OFF; count];
            for (&place, guard) in own.iter().zip(&mode.guards) {
                guards[place] = *guard;
            }
            guards
        };
        let guards = modes.iter().zip(&places).map(with_gaps).collect();
        Ok(Self {
            modes: Arc::new(modes),
            places,
            guards,
            args: args.iter().map(Bound::unbind).collect(),
            parameters,
            parts,
            start: start.owned(),
            first,
            end,
            options,
        })
    }

    /// Whether no function needs the interpreter.
    pub fn is_compiled(&self) -> bool {
        self.modes.iter().all(Mode::is_compiled)
            && self.first.function().is_none_or(Function::is_compiled)
    }

    /// The system at a point.
    pub fn system(&self, point: [f64; 2], trouble: Arc<Trouble>) -> System {
        let args = if self.is_compiled() { Vec::new() } else { self.arguments(point) };
        let mut parameters = self.parameters.clone();
        for &part in &self.parts {
            parameters[part..part + 2].copy_from_slice(&point);
        }
        let at = At { point, parameters };
        System::new(self.modes.clone(), Caller::new(args), trouble, Some(at))
    }

    /// What Python functions get after time and state.
    fn arguments(&self, point: [f64; 2]) -> Vec<Py<PyAny>> {
        Python::attach(|py| {
            let point = point.map(|one| pyo3::types::PyFloat::new(py, one).into_any().unbind());
            point.into_iter().chain(self.args.iter().map(|one| one.clone_ref(py))).collect()
        })
    }
}
