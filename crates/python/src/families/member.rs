//! One system of a family.

use std::cell::RefCell;
use std::sync::Arc;

use stickslip_solver::{DynamicSystem, Guard};
use stickslip_tracer::{DynamicBeginning, DynamicProblem, Point};

use crate::families::blueprint::Blueprint;
use crate::hybrid::system::System;
use crate::hybrid::trouble::Trouble;

/// The systems of a family.
pub struct Members {
    pub blueprint: Arc<Blueprint>,
    pub trouble: Arc<Trouble>,
}

/// One of them. The guards of each mode are those of the family.
pub struct Member {
    system: System,
    blueprint: Arc<Blueprint>,
    /// Room for the values of the guards that a mode lists.
    listed: RefCell<Vec<f64>>,
}

impl DynamicProblem for Members {
    type System = Member;

    fn at(&self, point: &Point) -> (Member, DynamicBeginning<Self>) {
        let system = self.blueprint.system([point.x, point.y], self.trouble.clone());
        let (mode, s, mut state) = self.blueprint.start.clone();
        let mode = system.change(mode, &self.blueprint.first, s, &mut state);
        let (blueprint, listed) = (self.blueprint.clone(), RefCell::default());
        (Member { system, blueprint, listed }, (mode, s, state))
    }
}

impl Member {
    /// The place among the guards that a mode lists.
    fn listed(&self, mode: usize, guard: usize) -> Option<usize> {
        self.blueprint.places[mode].iter().position(|&place| place == guard)
    }
}

impl DynamicSystem for Member {
    type Mode = usize;

    fn field(&self, mode: usize, s: f64, y: &[f64], slope: &mut [f64]) {
        self.system.field(mode, s, y, slope);
    }

    fn guards(&self, mode: usize) -> &[Guard] {
        &self.blueprint.guards[mode]
    }

    fn guard_values(&self, mode: usize, s: f64, y: &[f64], values: &mut [f64]) {
        let places = &self.blueprint.places[mode];
        let listed = &mut *self.listed.borrow_mut();
        listed.resize(places.len(), 1.0);
        self.system.guard_values(mode, s, y, listed);
        values.fill(1.0);
        for (&place, &value) in places.iter().zip(&*listed) {
            values[place] = value;
        }
    }

    fn transition(&self, mode: usize, guard: usize, s: f64, y: &mut [f64]) -> usize {
        self.listed(mode, guard).map_or(mode, |guard| self.system.transition(mode, guard, s, y))
    }

    fn transition_condition(&self, mode: usize, guard: usize, s: f64, y: &[f64]) -> f64 {
        let listed = self.listed(mode, guard);
        listed.map_or(f64::NAN, |guard| self.system.condition(mode, guard, s, y))
    }
}
