//! The modes of a system: functions, and what they are for.

use pyo3::prelude::*;
use stickslip_solver::{Direction, Guard};

use crate::hybrid::arguments::{ChangeArguments, Clock, ModeArguments, SourceArguments};
use crate::hybrid::function::Function;

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

/// A function that returns the values of `count` guards from `first` on.
pub struct Source {
    pub function: Function,
    pub first: usize,
    pub count: usize,
}

/// What follows when a guard fires.
pub enum Change {
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
        for SourceArguments(function, first, count) in sources {
            mode.sources.push(Source { function: Function::new(function)?, first, count });
        }
        Ok(mode)
    }

    /// Whether no function needs the interpreter.
    pub fn is_compiled(&self) -> bool {
        let changes = self.changes.iter().chain(self.rests.iter().flatten());
        let changes = changes.filter_map(Change::function);
        let conditions = self.conditions.iter().flatten();
        let sources = self.sources.iter().map(|source| &source.function);
        changes.chain(conditions).chain(sources).chain([&self.field]).all(Function::is_compiled)
    }

    /// All functions.
    pub fn functions_mut(&mut self) -> impl Iterator<Item = &mut Function> {
        let changes = self.changes.iter_mut().chain(self.rests.iter_mut().flatten());
        let changes = changes.filter_map(Change::function_mut);
        let conditions = self.conditions.iter_mut().flatten();
        let sources = self.sources.iter_mut().map(|source| &mut source.function);
        changes.chain(conditions).chain(sources).chain([&mut self.field])
    }
}

impl Change {
    pub fn new(ChangeArguments(to, function, both): ChangeArguments) -> PyResult<Self> {
        Ok(match function {
            None => Self::Mode(to),
            Some(function) if both => Self::Both(Function::new(function)?),
            Some(function) => Self::Reset(Function::new(function)?, to),
        })
    }

    pub fn function(&self) -> Option<&Function> {
        match self {
            Self::Mode(_) => None,
            Self::Reset(function, _) | Self::Both(function) => Some(function),
        }
    }

    pub fn function_mut(&mut self) -> Option<&mut Function> {
        match self {
            Self::Mode(_) => None,
            Self::Reset(function, _) | Self::Both(function) => Some(function),
        }
    }
}
