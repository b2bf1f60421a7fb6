//! From a graph to instructions: products join sums, constants become immediate, and registers are
//! used again.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use super::{Body, Code, Inputs, Instruction, Op, Program};
use crate::graph::{Binary, Formula, FormulaNode, Graph, Variable};

/// What an instruction reads.
#[derive(Clone, Copy, PartialEq)]
enum Operand {
    None,
    /// The value of a node.
    Value(usize),
    /// An entry of the pool.
    Pool(u32),
}

/// An instruction before registers are chosen: the node that it computes, and its operands.
struct Draft {
    op: Op,
    node: usize,
    operands: [Operand; 3],
}

struct Compiler<'a> {
    graph: &'a Graph,
    inputs: Inputs,
    /// What is made of fixed parameters alone, by its place among what is prepared.
    prepared: HashMap<usize, u32>,
    /// Where the parameters begin in the pool, once all constants are there.
    parameters: usize,
    /// Whether a node is a product that belongs to the sum which uses it.
    joined: Vec<bool>,
    pool: Vec<f64>,
    pooled: HashMap<u64, u32>,
    drafts: Vec<Draft>,
}

impl Program {
    /// Compiles formulas of `graph`. Fixed parameters are 0 until [`Self::with`] sets them.
    ///
    /// # Panics
    /// If a formula reads a component or a parameter beyond `inputs`.
    #[must_use]
    pub fn compile(graph: &Graph, formulas: &[Formula], inputs: Inputs) -> Self {
        let needed = graph.needed(formulas);
        let prepared = if inputs.fixed { prepared(graph, formulas, &needed) } else { Vec::new() };
        let places = prepared.iter().enumerate().map(|(i, formula)| (formula.index(), index(i)));
        let places: HashMap<usize, u32> = places.collect();
        let needed = graph.needed_above(&prepared, formulas);
        let mut compiler = Compiler {
            graph,
            inputs,
            joined: joined(graph, formulas, &needed, &places),
            prepared: places,
            parameters: 0,
            pool: Vec::new(),
            pooled: HashMap::new(),
            drafts: Vec::new(),
        };
        for index in (0..needed.len()).filter(|&index| needed[index]) {
            if let FormulaNode::Constant(bits) = node(graph, index) {
                compiler.pooled(f64::from_bits(bits));
            } else if let FormulaNode::Power(_, n) = node(graph, index) {
                compiler.pooled(f64::from(n));
            } else if let FormulaNode::RealPower(_, n) = node(graph, index) {
                compiler.pooled(f64::from_bits(n));
            }
        }
        // Parameters change, so that each has a place of its own.
        let first = compiler.pool.len();
        compiler.parameters = first;
        let parameters = first..first + if inputs.fixed { inputs.parameters } else { 0 };
        compiler.pool.resize(parameters.end + prepared.len(), 0.0);
        for index in (0..needed.len()).filter(|&index| needed[index]) {
            if !compiler.joined[index] && !compiler.prepared.contains_key(&index) {
                compiler.draft(index);
            }
        }
        let preparation = (!prepared.is_empty()).then(|| {
            let inputs = Inputs { components: 0, fixed: false, ..inputs };
            Self::compile(graph, &prepared, inputs)
        });
        compiler.finish(formulas, &needed, (parameters, preparation))
    }
}

fn node(graph: &Graph, index: usize) -> FormulaNode {
    graph.nodes()[index]
}

/// What is made of parameters alone and used by something that is not, or asked for.
fn prepared(graph: &Graph, formulas: &[Formula], needed: &[bool]) -> Vec<Formula> {
    let mut still = vec![false; needed.len()];
    for index in (0..needed.len()).filter(|&index| needed[index]) {
        still[index] = match node(graph, index) {
            FormulaNode::Constant(_) | FormulaNode::Variable(Variable::Parameter(_)) => true,
            FormulaNode::Variable(_) => false,
            node => node.operands().into_iter().all(|operand| still[operand.index()]),
        };
    }
    let is_made = |formula: &Formula| {
        still[formula.index()]
            && !matches!(graph.node(*formula), FormulaNode::Constant(_) | FormulaNode::Variable(_))
    };
    let moving = (0..needed.len()).filter(|&index| needed[index] && !still[index]);
    let read = moving.flat_map(|index| node(graph, index).operands());
    let mut prepared: Vec<_> = read.chain(formulas.iter().copied()).filter(is_made).collect();
    prepared.sort_unstable();
    prepared.dedup();
    prepared
}

/// Products that are used once, by a sum or a difference.
fn joined(
    graph: &Graph,
    formulas: &[Formula],
    needed: &[bool],
    prepared: &HashMap<usize, u32>,
) -> Vec<bool> {
    let mut uses = vec![0_u32; needed.len()];
    for formula in formulas {
        uses[formula.index()] += 2;
    }
    let indices = || (0..needed.len()).filter(|&index| needed[index]);
    for operand in indices().flat_map(|index| node(graph, index).operands()) {
        uses[operand.index()] = uses[operand.index()].saturating_add(1);
    }
    let constant = |formula: Formula| {
        matches!(
            graph.node(formula),
            FormulaNode::Constant(_) | FormulaNode::Variable(Variable::Parameter(_))
        ) || prepared.contains_key(&formula.index())
    };
    let mut joined = vec![false; needed.len()];
    for index in indices() {
        let FormulaNode::Binary(sum @ (Binary::Add | Binary::Sub), a, b) = node(graph, index)
        else {
            continue;
        };
        let fits = |product: Formula, other: Formula| {
            let FormulaNode::Binary(Binary::Mul, p, q) = graph.node(product) else { return false };
            let unfit = sum == Binary::Sub && (constant(p) || constant(q));
            uses[product.index()] == 1 && !constant(product) && !constant(other) && !unfit
        };
        if fits(a, b) {
            joined[a.index()] = true;
        } else if fits(b, a) {
            joined[b.index()] = true;
        }
    }
    joined
}

impl Compiler<'_> {
    /// The place of a constant in the pool.
    fn pooled(&mut self, x: f64) -> u32 {
        let next = index(self.pool.len());
        let place = *self.pooled.entry(x.to_bits()).or_insert(next);
        if place == next {
            self.pool.push(x);
        }
        place
    }

    /// The place of a formula in the pool, if it is a constant or a fixed parameter.
    fn place(&self, formula: Formula) -> Option<u32> {
        if let Some(place) = self.prepared.get(&formula.index()) {
            return Some(index(self.parameters + self.inputs.parameters) + place);
        }
        match self.graph.node(formula) {
            FormulaNode::Constant(bits) => self.pooled.get(&bits).copied(),
            FormulaNode::Variable(Variable::Parameter(parameter)) if self.inputs.fixed => {
                Some(index(self.parameters) + parameter)
            }
            _ => None,
        }
    }

    fn push(&mut self, op: Op, node: usize, operands: [Operand; 3]) {
        self.drafts.push(Draft { op, node, operands });
    }

    /// Drafts the instruction for a node.
    fn draft(&mut self, index: usize) {
        use Operand::{None, Pool};
        let value = |formula: Formula| Operand::Value(formula.index());
        match node(self.graph, index) {
            FormulaNode::Constant(_) | FormulaNode::Variable(_) => {}
            FormulaNode::Unary(function, a) => {
                self.push(function.into(), index, [value(a), None, None]);
            }
            FormulaNode::Power(a, n) => {
                let n = self.pooled(f64::from(n));
                self.push(Op::Power, index, [value(a), Pool(n), None]);
            }
            FormulaNode::RealPower(a, n) => {
                let n = self.pooled(f64::from_bits(n));
                self.push(Op::RealPower, index, [value(a), Pool(n), None]);
            }
            FormulaNode::Select(a, b, c) => {
                self.push(Op::Select, index, [value(a), value(b), value(c)]);
            }
            FormulaNode::Binary(function, a, b) => self.draft_binary(index, function, a, b),
        }
    }

    fn draft_binary(&mut self, index: usize, function: Binary, a: Formula, b: Formula) {
        use Binary::{Add, Div, Mul, Sub};
        use Operand::{None, Pool};
        let value = |formula: Formula| Operand::Value(formula.index());
        if let (Add | Sub, Some((p, q, rest, first))) = (function, self.product_in(a, b)) {
            let (op, operands) = match (function, self.place(p), self.place(q)) {
                (Add, Some(k), _) => (Op::MulKAdd, [value(q), Pool(k), value(rest)]),
                (Add, _, Some(k)) => (Op::MulKAdd, [value(p), Pool(k), value(rest)]),
                (Add, ..) => (Op::MulAdd, [value(p), value(q), value(rest)]),
                _ if first => (Op::MulSub, [value(p), value(q), value(rest)]),
                _ => (Op::SubMul, [value(p), value(q), value(rest)]),
            };
            return self.push(op, index, operands);
        }
        let (op, operands) = match (function, self.place(a), self.place(b)) {
            (Add, _, Some(k)) => (Op::AddK, [value(a), Pool(k), None]),
            (Add, Some(k), _) => (Op::AddK, [value(b), Pool(k), None]),
            (Sub, _, Some(k)) => (Op::SubK, [value(a), Pool(k), None]),
            (Sub, Some(k), _) => (Op::KSub, [value(b), Pool(k), None]),
            (Mul, _, Some(k)) => (Op::MulK, [value(a), Pool(k), None]),
            (Mul, Some(k), _) => (Op::MulK, [value(b), Pool(k), None]),
            (Div, _, Some(k)) => (Op::DivK, [value(a), Pool(k), None]),
            (Div, Some(k), _) => (Op::KDiv, [value(b), Pool(k), None]),
            _ => (function.into(), [value(a), value(b), None]),
        };
        self.push(op, index, operands);
    }

    /// The factors of a product that was joined to a sum or difference of `a` and `b`, the other
    /// operand, and whether the product is `a`.
    fn product_in(&self, a: Formula, b: Formula) -> Option<(Formula, Formula, Formula, bool)> {
        [(a, b, true), (b, a, false)].into_iter().find_map(|(product, rest, first)| {
            match self.graph.node(product) {
                FormulaNode::Binary(Binary::Mul, p, q) if self.joined[product.index()] => {
                    Some((p, q, rest, first))
                }
                _ => None,
            }
        })
    }

    /// Chooses registers: a value keeps its register until the last instruction that reads it.
    fn finish(
        mut self,
        formulas: &[Formula],
        needed: &[bool],
        (parameters, preparation): (Range<usize>, Option<Program>),
    ) -> Program {
        let Inputs { components, fixed, .. } = self.inputs;
        let inputs = components + if fixed { 0 } else { self.inputs.parameters };
        let mut register = vec![u32::MAX; needed.len()];
        for node in (0..needed.len()).filter(|&node| needed[node]) {
            let FormulaNode::Variable(variable) = self.graph.nodes()[node] else { continue };
            register[node] = match variable {
                Variable::Time => index(inputs),
                Variable::Component(i) if (i as usize) < components => i,
                Variable::Parameter(i) if (i as usize) < self.inputs.parameters => {
                    if fixed {
                        continue;
                    }
                    index(components) + i
                }
                variable => panic!("{variable:?} is out of range"),
            };
        }
        let mut next = index(inputs) + 1;
        let mut loads = Vec::new();
        let read = self.drafts.iter().flat_map(|draft| draft.operands).filter_map(|operand| {
            if let Operand::Value(node) = operand { Some(node) } else { None }
        });
        let read: Vec<usize> = read.chain(formulas.iter().map(|it| it.index())).collect();
        for node in read {
            if register[node] == u32::MAX
                && let Some(place) = self.place(Formula(index(node)))
            {
                register[node] = next;
                loads.push((next, place));
                next += 1;
            }
        }
        let loaded = next;
        let mut last = vec![usize::MAX; needed.len()];
        for (place, draft) in self.drafts.iter().enumerate() {
            for operand in draft.operands {
                if let Operand::Value(node) = operand {
                    last[node] = place;
                }
            }
        }
        for formula in formulas {
            last[formula.index()] = usize::MAX;
        }
        let mut free = Vec::new();
        let mut code = Vec::with_capacity(self.drafts.len());
        for (place, draft) in std::mem::take(&mut self.drafts).into_iter().enumerate() {
            let [a, b, c] = draft.operands.map(|operand| match operand {
                Operand::None => 0,
                Operand::Value(node) => register[node],
                Operand::Pool(place) => place,
            });
            for (nth, operand) in draft.operands.iter().enumerate() {
                if let &Operand::Value(node) = operand
                    && last[node] == place
                    && register[node] >= loaded
                    && !draft.operands[..nth].contains(operand)
                {
                    free.push(register[node]);
                }
            }
            let to = free.pop().unwrap_or_else(|| {
                next += 1;
                next - 1
            });
            register[draft.node] = to;
            code.push(Instruction { op: draft.op, to, a, b, c });
        }
        let outputs = formulas.iter().map(|formula| register[formula.index()]).collect();
        let registers = next as usize;
        let code = match code.iter().map(short).collect() {
            Some(short) if registers <= 256 => Code::Short(short),
            _ => Code::Wide(code),
        };
        let body = Body { code, parameters, preparation, loads, outputs, inputs, registers };
        Program { pool: self.pool, body: Arc::new(body) }
    }
}

/// The instruction with small indices, if they are small.
fn short(long: &Instruction<u32>) -> Option<Instruction<u8>> {
    let small = |index: u32| u8::try_from(index).ok();
    let (to, a) = (small(long.to)?, small(long.a)?);
    Some(Instruction { op: long.op, to, a, b: small(long.b)?, c: small(long.c)? })
}

/// A place as it is kept. A graph has fewer than 2³² nodes.
fn index(place: usize) -> u32 {
    u32::try_from(place).unwrap_or(u32::MAX)
}
