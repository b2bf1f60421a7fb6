//! Where equations jump: at the conditions of choices, and of rounding down.

use stickslip_solver::Direction;

use super::{Extended, SensitivityError};
use crate::graph::{Binary, Formula, Graph, Node, Unary, Variable};
use crate::recording::Recording;
use crate::system::{Mode, Rule, Trigger};
use crate::zeros::vanishes_with;

/// A way in which the equations of a mode jump.
struct Jump {
    /// What vanishes there, and in which direction.
    guard: Formula,
    direction: Direction,
    /// The slopes before and behind it.
    sides: [Vec<Formula>; 2],
}

impl Extended<'_> {
    /// Adds a rule for each way in which the equations of a mode jump.
    pub(super) fn jumps(&mut self, own: &Mode, mode: usize) {
        for Jump { guard, direction, sides: [before, behind] } in jumps(self.graph(), own) {
            let rule = Rule::new(Trigger::When(guard, direction));
            let by = 0..self.by.len();
            let shifts: Vec<Formula> = by.map(|k| self.shift(&rule, &before, k)).collect();
            let changes = self.jump(&[], (&before, &behind), &shifts);
            let label = Some(format!("jump {}", self.system.modes[mode].rules.len()));
            self.system.modes[mode].rules.push(Rule { label, changes, ..rule });
        }
    }

    /// Takes the rules of jumps out of a recording again.
    ///
    /// # Errors
    /// [`SensitivityError::Jump`]: derivatives do not hold behind one of the events.
    pub(super) fn forget_jumps(&self, found: &mut Recording) -> Result<(), SensitivityError> {
        let is_own = |mode: usize, guard: usize| guard < self.moves[mode].len();
        for (place, event) in found.events.iter().enumerate() {
            let refuse = |reason| Err(SensitivityError::Jump { s: event.s, reason });
            if event.jump {
                return refuse("a condition jumps over its limit");
            }
            let before = place.checked_sub(1).map_or(found.start(), |last| found.events[last].s);
            let behind = found.events.get(place + 1).map_or(f64::INFINITY, |next| next.s);
            let alone = before < event.s && event.s < behind;
            // A surface on which a mode begins, whatever the parameters are, changes nothing.
            if !is_own(event.from, event.guard) && !alone && event.before != event.after {
                return refuse("equations jump where something else happens");
            }
        }
        found.events.retain(|event| is_own(event.from, event.guard));
        found.touches.retain(|touch| is_own(touch.mode, touch.guard));
        found.poles.retain(|pole| is_own(pole.mode, pole.guard));
        found.preempted.retain(|it| is_own(it.mode, it.guard));
        Ok(())
    }
}

/// The ways in which the equations of a mode jump.
fn jumps(graph: &mut Graph, mode: &Mode) -> Vec<Jump> {
    let needed = graph.needed(&mode.slopes);
    let nodes: Vec<Node> = graph.nodes().to_vec();
    let mut surfaces: Vec<Formula> = Vec::new();
    let mut jumps = Vec::new();
    for (node, _) in nodes.iter().zip(needed).filter(|(_, needed)| *needed) {
        match *node {
            Node::Select(surface, above, below) if moves(graph, surface) => {
                let opposite = graph.unary(Unary::Neg, surface);
                let difference = graph.binary(Binary::Sub, above, below);
                if surfaces.contains(&surface)
                    || surfaces.contains(&opposite)
                    || vanishes_with(graph, difference, surface)
                {
                    continue;
                }
                surfaces.push(surface);
                let [above, below] = [true, false].map(|above| {
                    let side = |&slope: &Formula| graph.on_side(slope, surface, above);
                    mode.slopes.iter().map(side).collect::<Vec<_>>()
                });
                for (direction, sides) in [
                    (Direction::Falling, [above.clone(), below.clone()]),
                    (Direction::Rising, [below, above]),
                ] {
                    jumps.push(Jump { guard: surface, direction, sides });
                }
            }
            Node::Unary(Unary::Floor, inner) if moves(graph, inner) => {
                jumps.push(floor(graph, mode, (*node, inner)));
            }
            _ => {}
        }
    }
    jumps
}

/// The jump of ⌊a⌋ at whole numbers, where sin πa vanishes.
fn floor(graph: &mut Graph, mode: &Mode, (node, inner): (Node, Formula)) -> Jump {
    let [pi, half, one] = [std::f64::consts::PI, 0.5, 1.0].map(|x| graph.constant(x));
    let angle = graph.binary(Binary::Mul, pi, inner);
    let guard = graph.unary(Unary::Sin, angle);
    let rate = graph.slope(inner, &mut |graph, variable| match variable {
        Variable::Time => graph.constant(1.0),
        Variable::Component(place) => mode.slopes[place as usize],
        Variable::Parameter(_) => graph.constant(0.0),
    });
    let nearest = graph.binary(Binary::Add, inner, half);
    let upper = graph.unary(Unary::Floor, nearest);
    let lower = graph.binary(Binary::Sub, upper, one);
    let sides = [(lower, upper), (upper, lower)].map(|(rising, falling)| {
        let value = graph.select(rate, rising, falling);
        let side = |&slope: &Formula| graph.replaced(slope, node, value);
        mode.slopes.iter().map(side).collect()
    });
    Jump { guard, direction: Direction::Either, sides }
}

/// Whether a formula changes during a run.
fn moves(graph: &Graph, formula: Formula) -> bool {
    graph.reads(&[formula]).iter().any(|it| !matches!(it, Variable::Parameter(_)))
}
