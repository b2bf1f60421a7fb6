//! What a system consists of: functions, and what they are for.

use pyo3::prelude::*;
use stickslip_solver::{Direction, Guard};

use crate::hybrid::arguments::{
    ChangeArguments, Clock, ModeArguments, SourceArguments, SystemArguments,
};
use crate::hybrid::function::{Function, Names};

/// The parts of a system.
pub struct Parts {
    pub modes: Vec<Mode>,
    /// The functions whose zeros are the surfaces.
    pub surfaces: Vec<Function>,
    pub names: Names,
    /// The values of the variables at the start.
    pub variables: Vec<f64>,
}

impl Parts {
    pub fn new(SystemArguments(modes, surfaces, names): SystemArguments) -> PyResult<Self> {
        let (variables, signs) = (names.0, names.1);
        let (variables, values) =
            variables.map_or((None, Vec::new()), |(name, values)| (Some(name), values));
        Ok(Self {
            modes: modes.into_iter().map(Mode::new).collect::<PyResult<_>>()?,
            surfaces: surfaces.into_iter().map(Function::new).collect::<PyResult<_>>()?,
            names: Names { variables, signs },
            variables: values,
        })
    }

    /// Whether no function needs the interpreter.
    pub fn is_compiled(&self) -> bool {
        self.surfaces.iter().all(Function::is_compiled) && self.modes.iter().all(Mode::is_compiled)
    }

    /// All functions.
    pub fn functions_mut(&mut self) -> impl Iterator<Item = &mut Function> {
        self.modes.iter_mut().flat_map(Mode::functions_mut).chain(&mut self.surfaces)
    }
}

pub struct Mode {
    pub field: Function,
    pub guards: Vec<Guard>,
    /// What messages call the guards.
    pub labels: Vec<String>,
    pub sources: Vec<Source>,
    pub changes: Vec<Change>,
    /// What follows where the events of a guard accumulate, and when a clock fires.
    pub rests: Vec<Option<Change>>,
    pub clocks: Vec<Option<Clock>>,
    /// The conditions of transitions that branch.
    pub conditions: Vec<Option<Function>>,
    /// The guards that may start from a zero whose order is to be found out.
    pub undeclared: Vec<usize>,
    /// Whether some of the guards have no values: they are off, or clocks.
    pub gaps: bool,
}

/// A function that returns the values of the guards with these places.
pub struct Source {
    pub function: Function,
    pub places: Vec<usize>,
}

/// What follows when a guard fires.
pub struct Change {
    pub after: After,
    /// The function that returns the variables after.
    pub sets: Option<Function>,
}

/// The mode and the state after.
pub enum After {
    /// The state goes on, in this mode or in another one.
    Mode(Option<usize>),
    /// The function returns the state after.
    Reset(Function, Option<usize>),
    /// The function returns the mode, or `None`, and the state, or `None`.
    Both(Function),
}

impl Mode {
    pub fn new(ModeArguments(field, guards, sources): ModeArguments) -> PyResult<Self> {
        let mut mode = Self {
            field: Function::new(field)?,
            guards: Vec::new(),
            labels: Vec::new(),
            sources: Vec::new(),
            changes: Vec::new(),
            rests: Vec::new(),
            clocks: Vec::new(),
            conditions: Vec::new(),
            undeclared: Vec::new(),
            gaps: false,
        };
        for arguments in guards {
            let guard = arguments.guard()?;
            mode.gaps |= matches!(guard.direction(), Direction::Off | Direction::Clock);
            if arguments.2.is_none() {
                mode.undeclared.push(mode.guards.len());
            }
            mode.guards.push(guard);
            mode.labels.push(arguments.0);
            mode.changes.push(Change::new(arguments.6)?);
            mode.conditions.push(arguments.7.map(Function::new).transpose()?);
            mode.rests.push(arguments.9.map(Change::new).transpose()?);
            mode.clocks.push(arguments.10.map(Clock::new).transpose()?);
        }
        for SourceArguments(function, places) in sources {
            mode.sources.push(Source { function: Function::new(function)?, places });
        }
        Ok(mode)
    }

    /// Whether no function needs the interpreter.
    pub fn is_compiled(&self) -> bool {
        let changes = self.changes.iter().chain(self.rests.iter().flatten());
        let changes = changes.flat_map(Change::functions);
        let conditions = self.conditions.iter().flatten();
        let sources = self.sources.iter().map(|source| &source.function);
        changes.chain(conditions).chain(sources).chain([&self.field]).all(Function::is_compiled)
    }

    /// All functions.
    pub fn functions_mut(&mut self) -> impl Iterator<Item = &mut Function> {
        let changes = self.changes.iter_mut().chain(self.rests.iter_mut().flatten());
        let changes = changes.flat_map(Change::functions_mut);
        let conditions = self.conditions.iter_mut().flatten();
        let sources = self.sources.iter_mut().map(|source| &mut source.function);
        changes.chain(conditions).chain(sources).chain([&mut self.field])
    }
}

impl Change {
    pub fn new(ChangeArguments(to, function, both, sets): ChangeArguments) -> PyResult<Self> {
        let after = match function {
            None => After::Mode(to),
            Some(function) if both => After::Both(Function::new(function)?),
            Some(function) => After::Reset(Function::new(function)?, to),
        };
        Ok(Self { after, sets: sets.map(Function::new).transpose()? })
    }

    pub fn functions(&self) -> impl Iterator<Item = &Function> {
        let after = match &self.after {
            After::Mode(_) => None,
            After::Reset(function, _) | After::Both(function) => Some(function),
        };
        after.into_iter().chain(&self.sets)
    }

    pub fn functions_mut(&mut self) -> impl Iterator<Item = &mut Function> {
        let after = match &mut self.after {
            After::Mode(_) => None,
            After::Reset(function, _) | After::Both(function) => Some(function),
        };
        after.into_iter().chain(&mut self.sets)
    }
}
