//! What must hold for a start to have a value.

use std::collections::BTreeSet;

use crate::graph::{Binary, Formula, FormulaNode, Graph, Unary};
use crate::system::{Condition, System};

/// Adds to what a system requires that its start, its end and its times have values: that what is
/// under a square root is not negative, and so on. So the region without a start has a name and a
/// boundary, whether the system says so or not.
pub(super) fn require_values(system: &mut System) {
    let count = system.fixed_formulas().len() - system.required.len();
    let roots = system.fixed_formulas()[..count].to_vec();
    for index in without_value(&system.graph, roots) {
        let node = system.graph.nodes()[index];
        for condition in of_node(&mut system.graph, node) {
            add(system, condition);
        }
    }
}

/// The nodes without whose values formulas have none: all but those that a choice may leave out.
fn without_value(graph: &Graph, roots: Vec<Formula>) -> BTreeSet<usize> {
    let (mut found, mut left) = (BTreeSet::new(), roots);
    while let Some(formula) = left.pop() {
        let node = graph.node(formula);
        if found.insert(formula.index()) && !matches!(node, FormulaNode::Select(..)) {
            left.extend(node.operands());
        }
    }
    found
}

/// Where a node has a value if its operands have one.
fn of_node(graph: &mut Graph, node: FormulaNode) -> Vec<Condition> {
    let one = graph.constant(1.0);
    let not_negative = |formula| Condition { formula, below: false };
    let (function, a) = match node {
        FormulaNode::RealPower(a, _) => return vec![not_negative(a)],
        FormulaNode::Unary(function, a) => (function, a),
        _ => return Vec::new(),
    };
    let mut difference = |a, b| graph.binary(Binary::Sub, a, b);
    match function {
        Unary::Sqrt => vec![not_negative(a)],
        Unary::Acosh => vec![not_negative(difference(a, one))],
        Unary::Asin | Unary::Acos | Unary::Atanh => {
            let below = difference(one, a);
            let above = graph.binary(Binary::Add, one, a);
            vec![not_negative(below), not_negative(above)]
        }
        Unary::Ln => vec![Condition { formula: graph.unary(Unary::Neg, a), below: true }],
        Unary::Ln1p => {
            let above = graph.binary(Binary::Add, one, a);
            vec![Condition { formula: graph.unary(Unary::Neg, above), below: true }]
        }
        _ => Vec::new(),
    }
}

/// Adds a condition, unless it always holds or there is one with the same limit.
fn add(system: &mut System, condition: Condition) {
    let graph = &mut system.graph;
    let positive = |graph: &Graph, formula| match graph.node(formula) {
        FormulaNode::Unary(Unary::Neg, inner) => inner,
        _ => formula,
    };
    let of = positive(graph, condition.formula);
    let known = system.required.iter().any(|known| positive(graph, known.formula) == of);
    if !known && !is_never_negative(graph, of) && !graph.reads(&[of]).is_empty() {
        system.required.push(condition);
    }
}

/// Whether a formula is seen to be 0 or above, so that its root has a value everywhere.
fn is_never_negative(graph: &Graph, formula: Formula) -> bool {
    match graph.node(formula) {
        FormulaNode::Constant(bits) => f64::from_bits(bits) >= 0.0,
        FormulaNode::Unary(Unary::Square | Unary::Abs | Unary::Exp | Unary::Sqrt, _) => true,
        FormulaNode::Power(_, n) => n % 2 == 0,
        FormulaNode::Binary(Binary::Add | Binary::Mul | Binary::Div, a, b) => {
            is_never_negative(graph, a) && is_never_negative(graph, b)
        }
        _ => false,
    }
}
