//! Formulas: read from tokens straight into a graph.

use std::f64::consts::FRAC_1_SQRT_2;

use super::reader::{RESERVED, Reader};
use super::tokens::Token;
use super::{TextError, names};
use crate::graph::{Binary, Formula, FormulaNode, Unary, Variable};

/// How deep parentheses, signs and branches may be nested.
const DEEPEST: usize = 200;

/// How many nodes a system may have.
const MOST_NODES: usize = 1_000_000;

/// How many derivatives of one thing may be taken: each is larger than the one before.
const MOST_PRIMES: usize = 10;

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

/// Functions of one number, by name.
const FUNCTIONS: [(&str, Unary); 21] = [
    ("abs", Unary::Abs),
    ("floor", Unary::Floor),
    ("sqrt", Unary::Sqrt),
    ("exp", Unary::Exp),
    ("expm1", Unary::ExpM1),
    ("log", Unary::Ln),
    ("ln", Unary::Ln),
    ("log1p", Unary::Ln1p),
    ("sin", Unary::Sin),
    ("cos", Unary::Cos),
    ("tan", Unary::Tan),
    ("asin", Unary::Asin),
    ("acos", Unary::Acos),
    ("atan", Unary::Atan),
    ("sinh", Unary::Sinh),
    ("cosh", Unary::Cosh),
    ("tanh", Unary::Tanh),
    ("asinh", Unary::Asinh),
    ("acosh", Unary::Acosh),
    ("atanh", Unary::Atanh),
    ("erf", Unary::Erf),
];

/// Other functions, with the number of their arguments.
const OTHERS: [(&str, usize, usize); 11] = [
    ("ceil", 1, 1),
    ("sign", 1, 1),
    ("log10", 1, 1),
    ("log2", 1, 1),
    ("atan2", 2, 2),
    ("hypot", 2, 2),
    ("mod", 2, 2),
    ("min", 2, usize::MAX),
    ("max", 2, usize::MAX),
    ("polygon", 3, usize::MAX),
    ("spline", 3, usize::MAX),
];

/// The name of a function of one number.
pub(super) fn name_of(function: Unary) -> &'static str {
    FUNCTIONS.iter().find(|(_, other)| *other == function).map_or("-", |(name, _)| name)
}

pub(super) fn is_function(name: &str) -> bool {
    FUNCTIONS.iter().any(|(it, _)| *it == name) || OTHERS.iter().any(|(it, ..)| *it == name)
}

impl Reader<'_> {
    /// A number.
    pub(super) fn number(&mut self) -> Result<Formula, TextError> {
        let from = self.next;
        match self.value()? {
            Value::Number(formula) => Ok(formula),
            Value::Truth(_) => {
                Err(self.error_at(from, "this is a condition; expected a number".to_owned()))
            }
        }
    }

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

    /// A number or a condition, with everything that belongs to it.
    fn value(&mut self) -> Result<Value, TextError> {
        self.depth += 1;
        if self.depth > DEEPEST {
            let message = format!("formulas are nested more than {DEEPEST} deep here");
            return Err(self.error(message));
        }
        let value = self.alternatives();
        self.depth -= 1;
        if self.system.graph.len() > MOST_NODES {
            return Err(self.error(format!("the system has more than {MOST_NODES} formulas")));
        }
        value
    }

    fn alternatives(&mut self) -> Result<Value, TextError> {
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
    fn choose(&mut self, truth: Truth, yes: Formula, no: Formula) -> Formula {
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

    fn number_of(&self, value: Value, at: usize) -> Result<Formula, TextError> {
        match value {
            Value::Number(formula) => Ok(formula),
            Value::Truth(_) => {
                Err(self.error_at(at, "expected numbers on both sides of this".to_owned()))
            }
        }
    }

    fn sum(&mut self) -> Result<Value, TextError> {
        let mut value = self.product()?;
        while let Some(sign) = self.takes_one(&["+", "-"]) {
            let at = self.next - 1;
            let left = self.number_of(value, at)?;
            let right = self.product()?;
            let right = self.number_of(right, at)?;
            let function = if sign == "+" { Binary::Add } else { Binary::Sub };
            value = Value::Number(self.system.graph.binary(function, left, right));
        }
        Ok(value)
    }

    fn product(&mut self) -> Result<Value, TextError> {
        let mut value = self.signed()?;
        while let Some(sign) = self.takes_one(&["*", "/", "%"]) {
            let at = self.next - 1;
            let left = self.number_of(value, at)?;
            let right = self.signed()?;
            let right = self.number_of(right, at)?;
            let graph = &mut self.system.graph;
            value = Value::Number(match sign {
                "*" => graph.binary(Binary::Mul, left, right),
                "/" => graph.binary(Binary::Div, left, right),
                _ => graph.modulo(left, right),
            });
        }
        Ok(value)
    }

    /// A power with signs in front: −x² is −(x²).
    fn signed(&mut self) -> Result<Value, TextError> {
        let mut negative = false;
        let first = self.next;
        while let Some(sign) = self.takes_one(&["+", "-"]) {
            negative ^= sign == "-";
        }
        let signed = self.next > first;
        let base = self.primed()?;
        let mut value = base;
        if let Some(sign) = self.takes_one(&["^", "**"]) {
            let at = self.next - 1;
            if sign == "**" {
                return Err(self.error_at(at, "expected ^ for a power".to_owned()));
            }
            let base = self.number_of(base, at)?;
            self.depth += 1;
            if self.depth > DEEPEST {
                let message = format!("formulas are nested more than {DEEPEST} deep here");
                return Err(self.error(message));
            }
            let exponent = self.signed()?;
            self.depth -= 1;
            let exponent = self.number_of(exponent, at)?;
            value = Value::Number(self.system.graph.power(base, exponent));
        }
        if signed {
            let number = self.number_of(value, first)?;
            value = Value::Number(if negative {
                self.system.graph.unary(Unary::Neg, number)
            } else {
                number
            });
        }
        Ok(value)
    }

    /// Something with primes behind it: its derivative along the flow of the mode.
    fn primed(&mut self) -> Result<Value, TextError> {
        let from = self.next;
        let mut value = self.primary()?;
        let first = self.next;
        while self.takes("'") {
            if self.next > first + MOST_PRIMES {
                let message = format!("expected at most {MOST_PRIMES} derivatives");
                return Err(self.error_at(self.next - 1, message));
            }
            let formula = self.number_of(value, from)?;
            value = Value::Number(self.along_flow(formula, self.next - 1)?);
        }
        Ok(value)
    }

    /// The derivative of a formula along the flow of the mode that is read.
    fn along_flow(&mut self, formula: Formula, at: usize) -> Result<Formula, TextError> {
        let one = self.system.graph.constant(1.0);
        let zero = self.system.graph.constant(0.0);
        let mut unknown = None;
        let slopes = &self.slopes;
        let slope = self.system.graph.slope(formula, &mut |_, variable| match variable {
            Variable::Time => one,
            Variable::Parameter(_) => zero,
            Variable::Component(component) => {
                slopes.get(component as usize).copied().flatten().unwrap_or_else(|| {
                    unknown = Some(component as usize);
                    zero
                })
            }
        });
        if self.system.graph.len() > MOST_NODES {
            return Err(self.error_at(at, format!("more than {MOST_NODES} formulas")));
        }
        match unknown {
            None => Ok(slope),
            Some(component) => {
                let name = &self.system.components[component].name;
                let message = format!(
                    "the derivative needs that of `{name}`; expected the equation {name}' = … above"
                );
                Err(self.error_at(at, message))
            }
        }
    }

    fn primary(&mut self) -> Result<Value, TextError> {
        let at = self.next;
        match self.peek().clone() {
            Token::Number(x) => {
                self.next += 1;
                Ok(Value::Number(self.system.graph.constant(x)))
            }
            Token::Sign("(") => {
                self.next += 1;
                let value = self.value()?;
                self.expect(")")?;
                Ok(value)
            }
            Token::Name("if") => {
                self.next += 1;
                let truth = self.truth()?;
                self.expect_word("then")?;
                let yes = self.number()?;
                self.expect_word("else")?;
                let no = self.number()?;
                Ok(Value::Number(self.choose(truth, yes, no)))
            }
            Token::Name("t") => {
                self.next += 1;
                Ok(Value::Number(self.system.graph.time()))
            }
            Token::Name("pi") => {
                self.next += 1;
                Ok(Value::Number(self.system.graph.constant(std::f64::consts::PI)))
            }
            Token::Name(name) => {
                self.next += 1;
                if *self.peek() == Token::Sign("(") && is_function(name) {
                    return self.call(name, at).map(Value::Number);
                }
                self.known(name, at).map(Value::Number)
            }
            _ => Err(self.error("expected a number, a name or (".to_owned())),
        }
    }

    fn call(&mut self, name: &str, at: usize) -> Result<Formula, TextError> {
        self.expect("(")?;
        if let "polygon" | "spline" = name {
            return self.table(name);
        }
        let mut arguments = vec![self.number()?];
        while self.takes(",") {
            arguments.push(self.number()?);
        }
        self.expect(")")?;
        let others = OTHERS.iter().find(|(it, ..)| *it == name);
        let (least, most) = others.map_or((1, 1), |&(_, least, most)| (least, most));
        if arguments.len() < least || arguments.len() > most {
            let number =
                if least == most { format!("{least}") } else { format!("{least} or more") };
            let found = arguments.len();
            return Err(
                self.error_at(at, format!("`{name}` has {found} arguments; expected {number}"))
            );
        }
        let graph = &mut self.system.graph;
        if let Some((_, function)) = FUNCTIONS.iter().find(|(it, _)| *it == name) {
            return Ok(graph.unary(*function, arguments[0]));
        }
        let first = arguments[0];
        Ok(match name {
            "ceil" => {
                let negated = graph.unary(Unary::Neg, first);
                let floor = graph.unary(Unary::Floor, negated);
                graph.unary(Unary::Neg, floor)
            }
            "sign" => graph.sign(first),
            "log10" | "log2" => {
                let base = if name == "log2" { 2.0_f64 } else { 10.0 };
                let (scale, logarithm) = (graph.constant(base.ln()), graph.unary(Unary::Ln, first));
                graph.binary(Binary::Div, logarithm, scale)
            }
            "atan2" => graph.binary(Binary::Atan2, first, arguments[1]),
            "hypot" => {
                let squares = [first, arguments[1]].map(|it| graph.unary(Unary::Square, it));
                let sum = graph.binary(Binary::Add, squares[0], squares[1]);
                graph.unary(Unary::Sqrt, sum)
            }
            "mod" => graph.modulo(first, arguments[1]),
            _ => {
                let function = if name == "min" { Binary::Min } else { Binary::Max };
                let rest = arguments[1..].iter();
                rest.fold(first, |least, &other| graph.binary(function, least, other))
            }
        })
    }

    /// `x, place: value, place: value, …)`: a function through points.
    fn table(&mut self, name: &str) -> Result<Formula, TextError> {
        let x = self.number()?;
        let (mut points, mut last): (Vec<(f64, Formula)>, _) = (Vec::new(), f64::NEG_INFINITY);
        while self.takes(",") {
            let at = self.next;
            let place = self.number()?;
            let place = self.constant(place, at)?;
            if place.is_nan() || place <= last {
                let message = format!("{place} is not above {last}; expected places that ascend");
                return Err(self.error_at(at, message));
            }
            last = place;
            self.expect(":")?;
            points.push((place, self.number()?));
        }
        let at = self.next;
        self.expect(")")?;
        let graph = &mut self.system.graph;
        let made =
            if name == "spline" { graph.spline(x, &points) } else { graph.polygon(x, &points) };
        made.ok_or_else(|| {
            let count = points.len();
            let message =
                format!("`{name}` has {count} points; expected two or more, place: value");
            self.error_at(at, message)
        })
    }

    /// What a name stands for.
    fn known(&mut self, name: &str, at: usize) -> Result<Formula, TextError> {
        if let Some(formula) = self.formulas.get(name) {
            return Ok(*formula);
        }
        if let Some(formula) = self.in_mode(name, at)? {
            return Ok(formula);
        }
        let message = if let Some(line) = self.defined_below(name, at) {
            format!("`{name}` is defined in line {line}; a formula uses what is above it")
        } else if is_function(name) {
            format!("`{name}` is a function; expected {name}(…)")
        } else if RESERVED.contains(&name) {
            format!("`{name}` has a meaning of its own; expected a number, a name or (")
        } else {
            let known = self.formulas.keys().copied();
            let functions = FUNCTIONS.iter().map(|it| it.0).chain(OTHERS.iter().map(|it| it.0));
            format!("`{name}` is not known{}", names::hint(name, known.chain(functions)))
        };
        Err(self.error_at(at, message))
    }

    /// A formula that differs from mode to mode, in the mode that is read.
    pub(super) fn in_mode(&mut self, name: &str, at: usize) -> Result<Option<Formula>, TextError> {
        let Some((&name, statement)) = self.by_mode.get_key_value(name) else { return Ok(None) };
        if let Some(formula) = self.formulas.get(name) {
            return Ok(Some(*formula));
        }
        if statement.start > at {
            return Ok(None);
        }
        let (place, start) = (self.next, statement.start);
        self.next = start + 2;
        let formula = self.number()?;
        self.expect_end()?;
        self.next = place;
        self.formulas.insert(name, formula);
        Ok(Some(formula))
    }
}
