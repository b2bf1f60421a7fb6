//! Conditions: comparisons and what joins them, as numbers whose signs a guard can watch.

use std::f64::consts::FRAC_1_SQRT_2;

use super::TextError;
use super::reader::Reader;
use crate::graph::{Binary, Formula, FormulaNode, Unary, Variable};

/// A number, or what is true or not.
#[derive(Clone, Copy)]
pub(super) enum Value {
    Number(Formula),
    Truth(Truth),
}

/// A condition, by a number with a sign.
#[derive(Clone, Copy)]
pub(super) enum Truth {
    /// It holds where the number is negative.
    Negative(Formula),
    /// It holds where the number is ≥ 0.
    NotNegative(Formula),
}

impl Reader<'_> {
    /// A condition.
    pub(super) fn truth(&mut self) -> Result<Truth, TextError> {
        let from = self.next;
        match self.value()? {
            Value::Truth(truth) => Ok(truth),
            Value::Number(_) => Err(self.error_at(
                from,
                "this is a number; expected a condition, such as x < 1".to_owned(),
            )),
        }
    }

    pub(super) fn alternatives(&mut self) -> Result<Value, TextError> {
        let mut value = self.conjunction()?;
        while self.takes_word("or") {
            let (left, at) = (self.truth_of(value)?, self.next);
            let right = self.conjunction()?;
            let right = self.truth_at(right, at)?;
            value = Value::Truth(self.joint(left, right, Binary::Min));
        }
        Ok(value)
    }

    fn conjunction(&mut self) -> Result<Value, TextError> {
        let mut value = self.negation()?;
        while self.takes_word("and") {
            let (left, at) = (self.truth_of(value)?, self.next);
            let right = self.negation()?;
            let right = self.truth_at(right, at)?;
            value = Value::Truth(self.joint(left, right, Binary::Max));
        }
        Ok(value)
    }

    fn truth_of(&mut self, value: Value) -> Result<Truth, TextError> {
        self.truth_at(value, self.next.saturating_sub(1))
    }

    fn truth_at(&mut self, value: Value, at: usize) -> Result<Truth, TextError> {
        match value {
            Value::Truth(truth) => Ok(truth),
            Value::Number(_) => {
                Err(self.error_at(at, "expected a condition on both sides of this".to_owned()))
            }
        }
    }

    /// Where both conditions hold, or one of them.
    fn joint(&mut self, one: Truth, other: Truth, function: Binary) -> Truth {
        let [one, other] = [one, other].map(|truth| self.off_limit(truth));
        if let (Truth::NotNegative(a), Truth::NotNegative(b)) = (one, other) {
            let opposite = if function == Binary::Max { Binary::Min } else { Binary::Max };
            return Truth::NotNegative(self.system.graph.binary(opposite, a, b));
        }
        let (a, b) = (self.negative(one), self.negative(other));
        Truth::Negative(self.system.graph.binary(function, a, b))
    }

    /// A number that is negative where the condition holds, and only there.
    fn negative(&mut self, truth: Truth) -> Formula {
        match truth {
            Truth::Negative(formula) => formula,
            Truth::NotNegative(formula) => {
                let graph = &mut self.system.graph;
                let [one, minus_one] = [1.0, -1.0].map(|x| graph.constant(x));
                graph.select(formula, minus_one, one)
            }
        }
    }

    /// The same condition of a rule on a number that is never 0, if it stands still in the mode or
    /// jumps from value to value, as what only rules change, or `floor(x)`: it may stay on the
    /// limit, where a guard decides nothing.
    fn off_limit(&mut self, truth: Truth) -> Truth {
        let (Truth::Negative(formula) | Truth::NotNegative(formula)) = truth;
        let graph = &self.system.graph;
        let is_off = |it: Formula| match graph.node(it) {
            FormulaNode::Select(_, below, inner) => {
                matches!(graph.node(inner), FormulaNode::Select(_, above, _) if above == below)
            }
            _ => false,
        };
        match graph.node(formula) {
            FormulaNode::Unary(Unary::Neg, inner) if is_off(inner) => return truth,
            _ if is_off(formula) => return truth,
            _ => {}
        }
        if !self.in_rule || !(self.stands(formula) || self.jumps_alone(formula)) {
            return truth;
        }
        let graph = &mut self.system.graph;
        // What rounding makes of a difference is 0.
        let parts = match graph.node(formula) {
            FormulaNode::Binary(Binary::Sub, a, b) => [a, b],
            _ => [formula, formula],
        };
        let [a, b] = parts.map(|part| graph.unary(Unary::Abs, part));
        let [one, slight, least] = [1.0, 1e-14, 1e-290].map(|x| graph.constant(x));
        let size = graph.binary(Binary::Add, a, b);
        let size = graph.binary(Binary::Mul, size, slight);
        let room = graph.binary(Binary::Add, size, least);
        let negative = graph.unary(Unary::Neg, formula);
        let [above, below] = [formula, negative].map(|it| graph.binary(Binary::Sub, it, room));
        let not_below = graph.select(above, formula, one);
        let formula = graph.select(below, formula, not_below);
        match truth {
            Truth::Negative(_) => Truth::Negative(formula),
            Truth::NotNegative(_) => Truth::NotNegative(formula),
        }
    }

    /// Whether a formula reads components, and only such as stand still.
    fn stands(&self, formula: Formula) -> bool {
        let reads = self.system.graph.reads(&[formula]);
        let stays = |it: &Variable| match *it {
            Variable::Time => false,
            Variable::Component(place) => {
                let slope = self.slopes[place as usize];
                slope.and_then(|slope| self.system.graph.value(slope)) == Some(0.0)
            }
            Variable::Parameter(_) => true,
        };
        reads.iter().all(stays) && reads.iter().any(|it| matches!(it, Variable::Component(_)))
    }

    /// Whether a formula changes in jumps, and in no other way.
    fn jumps_alone(&mut self, formula: Formula) -> bool {
        let graph = &self.system.graph;
        let mut nodes = graph.nodes().iter().zip(graph.needed(&[formula]));
        let jumps = |node: &FormulaNode| {
            matches!(node, FormulaNode::Unary(Unary::Floor, _) | FormulaNode::Select(..))
        };
        if !nodes.any(|(node, needed)| needed && jumps(node)) {
            return false;
        }
        let slope = self.system.graph.slope(formula, &mut |graph, variable| {
            // Rates that differ do not cancel.
            graph.constant(match variable {
                Variable::Time => 0.5,
                Variable::Component(place) => 1.0 + FRAC_1_SQRT_2 * f64::from(place),
                Variable::Parameter(_) => 0.0,
            })
        });
        self.system.graph.value(slope) == Some(0.0)
    }

    /// A number that becomes negative where the condition begins to hold.
    pub(super) fn guard_of(&mut self, truth: Truth) -> Formula {
        match self.off_limit(truth) {
            Truth::Negative(formula) => formula,
            Truth::NotNegative(formula) => self.system.graph.unary(Unary::Neg, formula),
        }
    }

    /// `yes` where the condition holds, and otherwise `no`.
    pub(super) fn choose(&mut self, truth: Truth, yes: Formula, no: Formula) -> Formula {
        match truth {
            Truth::Negative(formula) => self.system.graph.select(formula, no, yes),
            Truth::NotNegative(formula) => self.system.graph.select(formula, yes, no),
        }
    }

    fn negation(&mut self) -> Result<Value, TextError> {
        let mut turned = false;
        while self.takes_word("not") {
            turned = !turned;
        }
        let at = self.next;
        let value = self.comparison()?;
        if !turned {
            return Ok(value);
        }
        Ok(Value::Truth(match self.truth_at(value, at)? {
            Truth::Negative(formula) => Truth::NotNegative(formula),
            Truth::NotNegative(formula) => Truth::Negative(formula),
        }))
    }

    fn comparison(&mut self) -> Result<Value, TextError> {
        let left = self.sum()?;
        let Some(sign) = self.takes_one(&["<", ">", "<=", ">=", "==", "!="]) else {
            return Ok(left);
        };
        let at = self.next - 1;
        let left = self.number_of(left, at)?;
        let right = self.sum()?;
        let right = self.number_of(right, at)?;
        if let Some(other) = self.takes_one(&["<", ">", "<=", ">=", "==", "!="]) {
            let message = format!("expected one comparison: a {sign} b and b {other} c");
            return Err(self.error_at(self.next - 1, message));
        }
        let graph = &mut self.system.graph;
        let mut difference = |a, b| graph.binary(Binary::Sub, a, b);
        Ok(Value::Truth(match sign {
            "<" => Truth::Negative(difference(left, right)),
            ">" => Truth::Negative(difference(right, left)),
            "<=" => Truth::NotNegative(difference(right, left)),
            ">=" => Truth::NotNegative(difference(left, right)),
            _ => {
                let difference = difference(left, right);
                let size = graph.unary(Unary::Abs, difference);
                let size = graph.unary(Unary::Neg, size);
                let [one, minus_one] = [1.0, -1.0].map(|x| graph.constant(x));
                let equal = graph.select(size, minus_one, one);
                if sign == "==" {
                    Truth::Negative(equal)
                } else {
                    Truth::Negative(graph.unary(Unary::Neg, equal))
                }
            }
        }))
    }
}
