//! Formulas: read from tokens straight into a graph.

use super::condition::Value;
use super::reader::{RESERVED, Reader};
use super::tokens::Token;
use super::{TextError, names};
use crate::graph::{Binary, Formula, Unary, Variable};

/// How deep parentheses, signs and branches may be nested.
const DEEPEST: usize = 200;

/// How many nodes a system may have.
const MOST_NODES: usize = 1_000_000;

/// How many derivatives of one thing may be taken: each is larger than the one before.
const MOST_PRIMES: usize = 10;

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

    /// A number or a condition, with everything that belongs to it.
    pub(super) fn value(&mut self) -> Result<Value, TextError> {
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

    pub(super) fn number_of(&self, value: Value, at: usize) -> Result<Formula, TextError> {
        match value {
            Value::Number(formula) => Ok(formula),
            Value::Truth(_) => {
                Err(self.error_at(at, "expected numbers on both sides of this".to_owned()))
            }
        }
    }

    pub(super) fn sum(&mut self) -> Result<Value, TextError> {
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
