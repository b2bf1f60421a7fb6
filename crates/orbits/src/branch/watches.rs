//! Conditions of rules, as they are looked at along segments.

use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;

use stickslip_expression::{Compiled, Inputs, Program, Rule, System, Trigger};
use stickslip_solver::Direction;

use crate::equations::rate;

/// Conditions of rules by mode and place, compiled when they are first needed.
#[derive(Default)]
pub(crate) struct Watches(RefCell<HashMap<(usize, usize), SharedWatch>>);

/// What is compiled for a rule, unless it has no condition.
type SharedWatch = Option<Rc<Watched>>;

/// The condition of a rule.
pub(crate) struct Watched {
    pub direction: Direction,
    pub value: Program,
    /// The system with one rule in the mode, which acts at the extrema of the condition.
    pub extrema: Compiled,
}

impl Watches {
    pub fn of(&self, system: &System, mode: usize, rule: usize) -> Option<Rc<Watched>> {
        let mut known = self.0.borrow_mut();
        known.entry((mode, rule)).or_insert_with(|| Watched::new(system, mode, rule)).clone()
    }
}

impl Watched {
    fn new(system: &System, mode: usize, rule: usize) -> Option<Rc<Self>> {
        let Trigger::When(guard, direction) = system.modes[mode].rules[rule].trigger else {
            return None;
        };
        let components = system.components.len();
        let inputs = Inputs { components, parameters: system.parameters.len(), fixed: true };
        let value = Program::compile(&system.graph, &[guard], inputs);
        let mut alone = system.clone();
        let slopes = alone.modes[mode].slopes.clone();
        let rate = rate(&mut alone.graph, guard, &slopes);
        alone.modes[mode].rules = vec![Rule::new(Trigger::When(rate, Direction::Either))];
        let extrema = alone.compile().ok()?;
        Some(Rc::new(Self { direction, value, extrema }))
    }
}
