//! Formulas as a graph, in which equal formulas are one node.
//!
//! A node only refers to nodes before it, so that whatever walks over a graph is a loop over
//! numbers: no formula is nested too deep for a stack.

mod slope;
mod table;

use std::collections::HashMap;

use stickslip_number::Number;

/// A formula of a [`Graph`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Formula(pub(crate) u32);

impl Formula {
    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }

    /// The place of the formula among the nodes of its graph.
    #[must_use]
    pub fn number(self) -> u32 {
        self.0
    }
}

/// What a formula reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Variable {
    /// The independent variable.
    Time,
    /// A component of the state.
    Component(u32),
    /// A parameter.
    Parameter(u32),
}

/// A function of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "these are the functions of `Number` and `Square` is x·x")]
#[rustfmt::skip]
pub enum Unary {
    Neg, Abs, Floor, Square, Sqrt, Exp, ExpM1, Ln, Ln1p, Sin, Cos, Tan, Asin, Acos, Atan,
    Sinh, Cosh, Tanh, Asinh, Acosh, Atanh, Erf,
}

/// A function of two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "these are the functions of `Number`")]
#[rustfmt::skip]
pub enum Binary {
    Add, Sub, Mul, Div, Min, Max, Atan2,
}

impl Unary {
    /// The value at `x`.
    #[inline(always)]
    pub fn of<T: Number>(self, x: T) -> T {
        match self {
            Self::Neg => -x,
            Self::Abs => x.abs(),
            Self::Floor => x.floor(),
            Self::Square => x.powi(2),
            Self::Sqrt => x.sqrt(),
            Self::Exp => x.exp(),
            Self::ExpM1 => x.exp_m1(),
            Self::Ln => x.ln(),
            Self::Ln1p => x.ln_1p(),
            Self::Sin => x.sin(),
            Self::Cos => x.cos(),
            Self::Tan => x.tan(),
            Self::Asin => x.asin(),
            Self::Acos => x.acos(),
            Self::Atan => x.atan(),
            Self::Sinh => x.sinh(),
            Self::Cosh => x.cosh(),
            Self::Tanh => x.tanh(),
            Self::Asinh => x.asinh(),
            Self::Acosh => x.acosh(),
            Self::Atanh => x.atanh(),
            Self::Erf => x.erf(),
        }
    }
}

impl Binary {
    /// The value at `x` and `y`.
    #[inline(always)]
    pub fn of<T: Number>(self, x: T, y: T) -> T {
        match self {
            Self::Add => x + y,
            Self::Sub => x - y,
            Self::Mul => x * y,
            Self::Div => x / y,
            Self::Min => x.min(y),
            Self::Max => x.max(y),
            Self::Atan2 => x.atan2(y),
        }
    }
}

/// What a formula is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FormulaNode {
    /// A number, by its bits.
    Constant(u64),
    /// Something that the formula reads.
    Variable(Variable),
    /// A function of one number.
    Unary(Unary, Formula),
    /// A function of two numbers.
    Binary(Binary, Formula, Formula),
    /// A power with an integer exponent.
    Power(Formula, i32),
    /// A power of a number ≥ 0 with another constant exponent, by its bits.
    RealPower(Formula, u64),
    /// The second formula where the first one is ≥ 0, and the third where it is below 0.
    Select(Formula, Formula, Formula),
}

impl FormulaNode {
    /// The formulas that a node refers to.
    #[must_use = "an iterator does nothing by itself"]
    pub fn operands(self) -> impl DoubleEndedIterator<Item = Formula> {
        let operands = match self {
            Self::Constant(_) | Self::Variable(_) => [None; 3],
            Self::Unary(_, a) | Self::Power(a, _) | Self::RealPower(a, _) => [Some(a), None, None],
            Self::Binary(_, a, b) => [Some(a), Some(b), None],
            Self::Select(a, b, c) => [Some(a), Some(b), Some(c)],
        };
        operands.into_iter().flatten()
    }

    /// The value of a [`Self::RealPower`]. Of a double, that with the exponent 3/2 or −3/2 takes a
    /// square root and a fifth of the time; other numbers know more of a power at 0.
    #[inline(always)]
    pub fn power_of<T: Number>(x: T, exponent: f64) -> T {
        // Of all numbers, doubles alone are as small.
        let is_double = size_of::<T>() == size_of::<f64>();
        if is_double && exponent == 1.5 {
            x * x.sqrt()
        } else if is_double && exponent == -1.5 {
            T::from(1.0) / (x * x.sqrt())
        } else {
            x.powf(exponent)
        }
    }
}

/// Formulas, in which equal ones are one node.
///
/// What is made of constants is folded, and so are neutral elements and double signs: rules that
/// keep every bit of a result except the sign of a zero.
///
/// ```
/// use stickslip_expression::{Binary, Graph, Unary};
///
/// let mut graph = Graph::default();
/// let x = graph.component(0);
/// let one = graph.constant(1.0);
/// let product = graph.binary(Binary::Mul, x, one);
/// assert_eq!(product, x);
/// let (sine, again) = (graph.unary(Unary::Sin, x), graph.unary(Unary::Sin, product));
/// assert_eq!(sine, again);
/// ```
#[derive(Clone, Debug, Default)]
pub struct Graph {
    nodes: Vec<FormulaNode>,
    known: HashMap<FormulaNode, Formula>,
}

impl Graph {
    /// What a formula is made of.
    ///
    /// # Panics
    /// If the formula is of a larger graph.
    #[must_use]
    pub fn node(&self, formula: Formula) -> FormulaNode {
        self.nodes[formula.index()]
    }

    /// All nodes, each after those that it refers to.
    #[must_use]
    pub fn nodes(&self) -> &[FormulaNode] {
        &self.nodes
    }

    /// The number that a formula is, if it is constant.
    #[must_use]
    pub fn value(&self, formula: Formula) -> Option<f64> {
        match self.node(formula) {
            FormulaNode::Constant(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    /// The formula at a place among the nodes.
    #[must_use]
    pub fn formula(&self, number: u32) -> Option<Formula> {
        ((number as usize) < self.len()).then_some(Formula(number))
    }

    /// The number of nodes.
    #[must_use]
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether there is no formula.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Which nodes some formulas need, themselves among them.
    #[must_use]
    pub(crate) fn needed(&self, formulas: &[Formula]) -> Vec<bool> {
        self.needed_above(&[], formulas)
    }

    /// Which nodes some formulas need if others, in ascending order, are known.
    pub(crate) fn needed_above(&self, known: &[Formula], formulas: &[Formula]) -> Vec<bool> {
        let mut needed = vec![false; self.len()];
        for formula in formulas {
            needed[formula.index()] = true;
        }
        let is_known =
            |index| known.binary_search_by_key(&index, |formula| formula.index()).is_ok();
        for index in (0..self.len()).rev() {
            if needed[index] && !is_known(index) {
                for operand in self.nodes[index].operands() {
                    needed[operand.index()] = true;
                }
            }
        }
        needed
    }

    /// The formula that reads other formulas in place of the components.
    ///
    /// # Panics
    /// If it reads a component beyond them.
    pub fn substituted(&mut self, formula: Formula, components: &[Formula]) -> Formula {
        self.rewritten(formula, &mut |_, node, _| match node {
            FormulaNode::Variable(Variable::Component(place)) => Some(components[place as usize]),
            _ => None,
        })
    }

    /// The formula where `surface` is positive, or else where it is negative: its sign, its
    /// absolute value, and choices by it are decided.
    pub(crate) fn on_side(&mut self, formula: Formula, surface: Formula, above: bool) -> Formula {
        let negative = self.unary(Unary::Neg, surface);
        let magnitude = if above { surface } else { negative };
        let node = self.unary(Unary::Abs, surface);
        let size = self.node(node);
        self.rewritten(formula, &mut |_, node, made| match node {
            FormulaNode::Select(condition, on_or_above, _) if condition == surface && above => {
                Some(made[on_or_above.index()])
            }
            FormulaNode::Select(condition, _, below) if condition == surface => {
                Some(made[below.index()])
            }
            FormulaNode::Select(condition, _, below) if condition == negative && above => {
                Some(made[below.index()])
            }
            FormulaNode::Select(condition, on_or_above, _) if condition == negative => {
                Some(made[on_or_above.index()])
            }
            node if node == size => Some(magnitude),
            _ => None,
        })
    }

    /// The formula with a number in place of the sign of `surface`.
    pub(crate) fn with_sign(
        &mut self,
        formula: Formula,
        surface: Formula,
        sign: Formula,
    ) -> Formula {
        let (above, zero) = (self.sign(surface), self.constant(0.0));
        let negative = self.unary(Unary::Neg, surface);
        let (below, opposite) = (self.sign(negative), self.unary(Unary::Neg, sign));
        let [above, below] = [above, below].map(|it| self.node(it));
        let size = self.unary(Unary::Abs, surface);
        let size = self.node(size);
        self.rewritten(formula, &mut |_, node, _| match node {
            node if node == above => Some(sign),
            node if node == below => Some(opposite),
            node if node == size => Some(zero),
            _ => None,
        })
    }

    /// The formula with another condition, of the same sign, in its choices by `old`.
    pub(crate) fn with_condition(
        &mut self,
        formula: Formula,
        old: Formula,
        new: Formula,
    ) -> Formula {
        let [not_old, not_new] = [old, new].map(|it| self.unary(Unary::Neg, it));
        self.rewritten(formula, &mut |graph, node, made| match node {
            FormulaNode::Select(condition, above, below)
                if condition == old || condition == not_old =>
            {
                let condition = if condition == old { new } else { not_new };
                Some(graph.select(condition, made[above.index()], made[below.index()]))
            }
            _ => None,
        })
    }

    /// The formula with another one in place of a node.
    pub(crate) fn replaced(&mut self, formula: Formula, old: FormulaNode, new: Formula) -> Formula {
        self.rewritten(formula, &mut |_, node, _| (node == old).then_some(new))
    }

    /// The formula at a given time.
    pub(crate) fn at_time(&mut self, formula: Formula, time: Formula) -> Formula {
        let is_time = |node| matches!(node, FormulaNode::Variable(Variable::Time));
        self.rewritten(formula, &mut |_, node, _| is_time(node).then_some(time))
    }

    /// The formula made anew, with other formulas in place of some nodes: `instead` gets a node,
    /// and what has been made of its operands.
    pub(crate) fn rewritten(
        &mut self,
        formula: Formula,
        instead: &mut impl FnMut(&mut Self, FormulaNode, &[Formula]) -> Option<Formula>,
    ) -> Formula {
        let needed = self.needed(&[formula]);
        let mut made: Vec<Formula> = vec![Formula(0); needed.len()];
        for index in (0..needed.len()).filter(|&index| needed[index]) {
            let node = self.nodes[index];
            if let Some(other) = instead(self, node, &made) {
                made[index] = other;
                continue;
            }
            let of = |operand: Formula| made[operand.index()];
            made[index] = match node {
                FormulaNode::Constant(bits) => self.constant(f64::from_bits(bits)),
                FormulaNode::Variable(variable) => self.variable(variable),
                FormulaNode::Unary(function, a) => self.unary(function, of(a)),
                FormulaNode::Binary(function, a, b) => self.binary(function, of(a), of(b)),
                FormulaNode::Power(a, n) => {
                    let (a, n) = (of(a), self.constant(f64::from(n)));
                    self.power(a, n)
                }
                FormulaNode::RealPower(a, bits) => {
                    let (a, exponent) = (of(a), self.constant(f64::from_bits(bits)));
                    self.power(a, exponent)
                }
                FormulaNode::Select(a, b, c) => self.select(of(a), of(b), of(c)),
            };
        }
        made[formula.index()]
    }

    /// What the formulas read.
    #[must_use]
    pub fn reads(&self, formulas: &[Formula]) -> Vec<Variable> {
        let needed = self.needed(formulas);
        let variables = self.nodes.iter().zip(needed).filter_map(|(node, needed)| match node {
            FormulaNode::Variable(variable) if needed => Some(*variable),
            _ => None,
        });
        variables.collect()
    }

    fn intern(&mut self, node: FormulaNode) -> Formula {
        // Four billion nodes would be 100 GB.
        let next = Formula(u32::try_from(self.nodes.len()).unwrap_or(u32::MAX));
        let formula = *self.known.entry(node).or_insert(next);
        if formula == next {
            self.nodes.push(node);
        }
        formula
    }

    /// A number.
    pub fn constant(&mut self, x: f64) -> Formula {
        self.intern(FormulaNode::Constant(x.to_bits()))
    }

    /// What a formula reads.
    pub fn variable(&mut self, variable: Variable) -> Formula {
        self.intern(FormulaNode::Variable(variable))
    }

    /// The independent variable.
    pub fn time(&mut self) -> Formula {
        self.variable(Variable::Time)
    }

    /// A component of the state.
    pub fn component(&mut self, index: u32) -> Formula {
        self.variable(Variable::Component(index))
    }

    /// The component at a place of a state. There are fewer than 2³².
    pub(crate) fn component_at(&mut self, place: usize) -> Formula {
        self.component(u32::try_from(place).unwrap_or(u32::MAX))
    }

    /// A state of `n` components behind changes of some.
    pub(crate) fn state(&mut self, n: usize, changes: &[(usize, Formula)]) -> Vec<Formula> {
        let mut state: Vec<Formula> = (0..n).map(|place| self.component_at(place)).collect();
        for &(place, formula) in changes {
            state[place] = formula;
        }
        state
    }

    /// A parameter.
    pub fn parameter(&mut self, index: u32) -> Formula {
        self.variable(Variable::Parameter(index))
    }

    /// A function of one formula.
    pub fn unary(&mut self, function: Unary, a: Formula) -> Formula {
        if let Some(x) = self.value(a) {
            return self.constant(function.of(x));
        }
        match (function, self.node(a)) {
            (Unary::Neg, FormulaNode::Unary(Unary::Neg, b)) => b,
            (Unary::Neg, FormulaNode::Binary(Binary::Sub, b, c)) => self.binary(Binary::Sub, c, b),
            (Unary::Abs | Unary::Square, FormulaNode::Unary(Unary::Neg, b)) => {
                self.unary(function, b)
            }
            (Unary::Abs, FormulaNode::Unary(Unary::Abs | Unary::Square | Unary::Sqrt, _)) => a,
            _ => self.intern(FormulaNode::Unary(function, a)),
        }
    }

    /// A function of two formulas.
    pub fn binary(&mut self, function: Binary, a: Formula, b: Formula) -> Formula {
        use Binary::{Add, Div, Max, Min, Mul, Sub};
        let constants = (self.value(a), self.value(b));
        match (function, constants.0, constants.1) {
            (_, Some(x), Some(y)) => return self.constant(function.of(x, y)),
            (Add, Some(0.0), _) | (Mul, Some(1.0), _) => return b,
            (Add | Sub, _, Some(0.0)) | (Mul | Div, _, Some(1.0)) => return a,
            (Sub, Some(0.0), _) | (Mul, Some(-1.0), _) => return self.unary(Unary::Neg, b),
            (Mul | Div, _, Some(-1.0)) => return self.unary(Unary::Neg, a),
            _ => {}
        }
        match (function, self.node(a), self.node(b)) {
            (Add, _, FormulaNode::Unary(Unary::Neg, c)) => return self.binary(Sub, a, c),
            (Sub, _, FormulaNode::Unary(Unary::Neg, c)) => return self.binary(Add, a, c),
            (Add, FormulaNode::Unary(Unary::Neg, c), _) => return self.binary(Sub, b, c),
            (Min | Max, ..) if a == b => return a,
            (Mul, ..) if a == b => return self.unary(Unary::Square, a),
            _ => {}
        }
        // Sums and products of two numbers do not depend on their order.
        let turned = matches!(function, Add | Mul) && b < a;
        let (a, b) = if turned { (b, a) } else { (a, b) };
        self.intern(FormulaNode::Binary(function, a, b))
    }

    /// The power `a`^`b`: with an integer exponent of any number, otherwise of numbers ≥ 0.
    pub fn power(&mut self, a: Formula, b: Formula) -> Formula {
        match (self.value(a), self.value(b)) {
            (Some(x), Some(n)) => self.constant(FormulaNode::power_of(x, n)),
            (_, Some(0.0)) => self.constant(1.0),
            (_, Some(1.0)) => a,
            (_, Some(2.0)) => self.unary(Unary::Square, a),
            (_, Some(0.5)) => self.unary(Unary::Sqrt, a),
            (_, Some(n)) if n.fract() == 0.0 && n.abs() <= f64::from(i32::MAX) => {
                // The value is an integer in range.
                #[expect(clippy::cast_possible_truncation)]
                self.intern(FormulaNode::Power(a, n as i32))
            }
            (_, Some(n)) => self.intern(FormulaNode::RealPower(a, n.to_bits())),
            (_, None) => {
                let logarithm = self.unary(Unary::Ln, a);
                let product = self.binary(Binary::Mul, b, logarithm);
                self.unary(Unary::Exp, product)
            }
        }
    }

    /// `on_or_above` where `condition` is ≥ 0, and `below` where it is below 0.
    pub fn select(&mut self, condition: Formula, on_or_above: Formula, below: Formula) -> Formula {
        match self.value(condition) {
            Some(x) if x >= 0.0 => on_or_above,
            Some(x) if x < 0.0 => below,
            _ if on_or_above == below => below,
            _ => self.intern(FormulaNode::Select(condition, on_or_above, below)),
        }
    }

    /// −1, 0 or 1: the sign of a formula, with a sign of 0 at 0.
    pub fn sign(&mut self, a: Formula) -> Formula {
        let [zero, one, minus_one] = [0.0, 1.0, -1.0].map(|x| self.constant(x));
        let negated = self.unary(Unary::Neg, a);
        let not_below = self.select(negated, zero, one);
        self.select(a, not_below, minus_one)
    }

    /// `a` − `b`·⌊`a`/`b`⌋, which has the sign of `b`.
    pub fn modulo(&mut self, a: Formula, b: Formula) -> Formula {
        if let (Some(x), Some(y)) = (self.value(a), self.value(b)) {
            return self.constant(x - y * (x / y).floor());
        }
        let quotient = self.binary(Binary::Div, a, b);
        let whole = self.unary(Unary::Floor, quotient);
        let multiple = self.binary(Binary::Mul, b, whole);
        self.binary(Binary::Sub, a, multiple)
    }
}
