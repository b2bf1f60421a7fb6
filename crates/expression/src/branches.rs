//! Branches of equations as events, which no observer is notified of.
//!
//! Where equations jump, by an `if` on what moves or by `floor`, a step that runs over the place is
//! wrong, and one that does not see it misses it. So a run remembers on which side of each
//! condition it is, in further components that only events change: the equations read those, and
//! are smooth between events, and rules change them where a condition changes. These rules do not
//! appear in results. So the engine finds jumps as it finds every event, and derivatives go through
//! them. Where sides would change without end, since both push towards the condition, equations
//! choose as they are written. In a plane of parameters systems are not rewritten, since boundaries
//! are changes of the sequence of rules.

use crate::graph::{Binary, Formula, FormulaNode, Graph, Unary, Variable};
use crate::system::{Component, Rule, System, Trigger};
use crate::zeros::vanishes_with;

use stickslip_solver::Direction;

/// A system with more branches runs as it is.
const MOST: usize = 16;

/// How equations branch.
#[derive(Clone, Copy, PartialEq)]
enum Branch {
    /// By the sign of a formula.
    Side(Formula),
    /// By a formula, rounded down.
    Level(Formula),
}

/// A system whose branches are events.
pub(crate) struct Branched {
    /// The system, with a further component for each branch, and further rules behind those of
    /// each mode.
    pub system: System,
    /// What these components are at the start, as formulas of the state of the system itself.
    pub starts: Vec<Formula>,
}

impl System {
    /// Whether equations jump within a mode: by an `if` on what moves, by `sign`, or by `floor`.
    #[must_use]
    pub fn branches(&self) -> bool {
        !collected(&mut self.graph.clone(), self).is_empty()
    }

    /// The system with its branches as events; `None` if there are none, if there are too many, or
    /// if guards start from zeros.
    pub(crate) fn branched(&self) -> Option<Branched> {
        let mut system = self.clone();
        let branches = collected(&mut system.graph, self);
        if branches.is_empty() || branches.len() > MOST {
            return None;
        }
        // A guard that starts from zero may do so only where its mode begins.
        if self.zero_orders().iter().flatten().any(|order| *order > 0) {
            return None;
        }
        let n = self.components.len();
        let graph = &mut system.graph;
        let starts: Vec<Formula> = branches.iter().map(|branch| branch.value(graph)).collect();
        let at_start: Vec<Formula> = self.components.iter().map(|it| it.start).collect();
        let time = self.start.unwrap_or_else(|| graph.constant(0.0));
        for (k, &value) in starts.iter().enumerate() {
            let value = system.graph.substituted(value, &at_start);
            let start = system.graph.at_time(value, time);
            let name = format!("branch {k}");
            system.components.push(Component { name, start, discrete: true });
        }
        let zero = system.graph.constant(0.0);
        let mut uses = Vec::with_capacity(self.modes.len());
        for mode in &mut system.modes {
            let (graph, written) = (&mut system.graph, mode.slopes.clone());
            let mut own = Vec::new();
            // From the outermost one, since conditions are what they are in the graph.
            for (k, branch) in branches.iter().enumerate().rev() {
                let place = graph.component_at(n + k);
                let mut replaced = |slopes: &[Formula]| -> Vec<Formula> {
                    slopes.iter().map(|&it| branch.replaced(graph, it, place)).collect()
                };
                // Branches of conditions are used too.
                if replaced(&written) != written {
                    own.push(k);
                    mode.slopes = replaced(&mode.slopes);
                }
            }
            mode.slopes.extend(vec![zero; branches.len()]);
            uses.push(own);
        }
        for place in 0..system.modes.len() {
            let mut rules = std::mem::take(&mut system.modes[place].rules);
            for rule in &mut rules {
                let graph = &mut system.graph;
                entered(graph, (place, rule), &uses, (&starts, n));
            }
            for &k in &uses[place] {
                let graph = &mut system.graph;
                let own = graph.component_at(n + k);
                for (guard, value) in branches[k].changes(graph, own) {
                    let guard = smooth(graph, guard, &branches, (k, n));
                    // Other branches may be by conditions that branch here.
                    let mut changes = vec![(n + k, value)];
                    for &other in uses[place].iter().filter(|other| **other != k) {
                        let here = branches[k].replaced(graph, starts[other], value);
                        if here != starts[other] {
                            changes.push((n + other, smooth(graph, here, &branches, (other, n))));
                        }
                    }
                    let rule = Rule::new(Trigger::When(guard, Direction::Below));
                    rules.push(Rule { changes, ..rule });
                }
            }
            system.modes[place].rules = rules;
        }
        Some(Branched { system, starts })
    }
}

/// The branches of a system's equations.
fn collected(graph: &mut Graph, system: &System) -> Vec<Branch> {
    let slopes: Vec<Formula> = system.modes.iter().flat_map(|mode| &mode.slopes).copied().collect();
    let discrete: Vec<bool> = system.components.iter().map(|it| it.discrete).collect();
    let mut branches = Vec::new();
    let needed = graph.needed(&slopes);
    let nodes: Vec<FormulaNode> = graph.nodes().to_vec();
    for (node, _) in nodes.iter().zip(needed).filter(|(_, needed)| *needed) {
        let branch = match *node {
            FormulaNode::Select(condition, above, below) if moves(graph, condition, &discrete) => {
                let opposite = graph.unary(Unary::Neg, condition);
                let difference = graph.binary(Binary::Sub, above, below);
                // A corner is no jump.
                if branches.contains(&Branch::Side(opposite))
                    || vanishes_with(graph, difference, condition)
                {
                    continue;
                }
                Branch::Side(condition)
            }
            FormulaNode::Unary(Unary::Floor, inner) if moves(graph, inner, &discrete) => {
                Branch::Level(inner)
            }
            _ => continue,
        };
        if !branches.contains(&branch) {
            branches.push(branch);
        }
    }
    branches
}

/// Lets a rule set the branches of the modes to which it leads.
fn entered(
    graph: &mut Graph,
    (place, rule): (usize, &mut Rule),
    uses: &[Vec<usize>],
    (starts, n): (&[Formula], usize),
) {
    let changes = |graph: &mut Graph, own: &[(usize, Formula)], modes: &[usize]| {
        let state = graph.state(n, own);
        let mut used: Vec<usize> = modes.iter().flat_map(|&mode| &uses[mode]).copied().collect();
        used.sort_unstable();
        used.dedup();
        let value = |k: usize| (n + k, graph.substituted(starts[k], &state));
        used.into_iter().map(value).collect::<Vec<_>>()
    };
    if !rule.stays_as_it_is() {
        let modes: Vec<usize> = rule.next.modes(place).collect();
        let more = changes(graph, &rule.changes, &modes);
        rule.changes.extend(more);
    }
    if let Some(rest) = &mut rule.rest {
        let more = changes(graph, &rest.changes, &[rest.next]);
        rest.changes.extend(more);
    }
}

impl Branch {
    /// The value of its component on the state.
    fn value(self, graph: &mut Graph) -> Formula {
        match self {
            Self::Side(condition) => {
                let [above, below] = [1.0, -1.0].map(|x| graph.constant(x));
                graph.select(condition, above, below)
            }
            Self::Level(inner) => graph.unary(Unary::Floor, inner),
        }
    }

    /// A formula that reads the component instead.
    fn replaced(self, graph: &mut Graph, formula: Formula, own: Formula) -> Formula {
        match self {
            Self::Side(condition) => graph.with_condition(formula, condition, own),
            Self::Level(inner) => {
                let node = graph.unary(Unary::Floor, inner);
                let node = graph.node(node);
                graph.replaced(formula, node, own)
            }
        }
    }

    /// What becomes negative where its component changes, and to what.
    fn changes(self, graph: &mut Graph, own: Formula) -> Vec<(Formula, Formula)> {
        match self {
            Self::Side(condition) => {
                let guard = graph.binary(Binary::Mul, own, condition);
                vec![(guard, graph.unary(Unary::Neg, own))]
            }
            Self::Level(inner) => {
                let one = graph.constant(1.0);
                let above = graph.binary(Binary::Add, own, one);
                let below = graph.binary(Binary::Sub, own, one);
                let rises = graph.binary(Binary::Sub, above, inner);
                let falls = graph.binary(Binary::Sub, inner, own);
                vec![(rises, above), (falls, below)]
            }
        }
    }
}

/// A formula that reads the components of all branches but its own, in the place `k`.
fn smooth(
    graph: &mut Graph,
    formula: Formula,
    branches: &[Branch],
    (k, n): (usize, usize),
) -> Formula {
    let mut smooth = formula;
    for (place, branch) in branches.iter().enumerate().rev().filter(|(place, _)| *place != k) {
        let own = graph.component_at(n + place);
        smooth = branch.replaced(graph, smooth, own);
    }
    smooth
}

/// Whether a formula changes between events.
fn moves(graph: &Graph, formula: Formula, discrete: &[bool]) -> bool {
    graph.reads(&[formula]).iter().any(|it| match it {
        Variable::Time => true,
        Variable::Component(place) => !discrete.get(*place as usize).copied().unwrap_or(false),
        Variable::Parameter(_) => false,
    })
}
