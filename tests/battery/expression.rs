//! Formulas of a case: trees that are read from JSON and evaluated in any number.

use serde_json::Value;
use stickslip::solver::Number;

/// A formula in time and state.
#[derive(Clone, Debug)]
pub enum Expression {
    /// A number.
    Constant(f64),
    /// The time.
    Time,
    /// A component of the state.
    Component(usize),
    /// A function of one number.
    One(One, Box<Expression>),
    /// A function of two numbers.
    Two(Two, Box<[Expression; 2]>),
    /// A power with an integer exponent.
    Power(Box<Expression>, i32),
    /// The second formula where the first one is ≥ 0, otherwise the third.
    Select(Box<[Expression; 3]>),
}

/// A function of one number.
#[derive(Clone, Copy, Debug)]
pub enum One {
    /// The number with the other sign.
    Negated,
    /// The sine.
    Sin,
    /// The cosine.
    Cos,
    /// The tangent.
    Tan,
    /// The hyperbolic tangent.
    Tanh,
    /// The exponential function.
    Exp,
    /// The natural logarithm.
    Ln,
    /// The square root.
    Sqrt,
    /// The absolute value.
    Abs,
    /// The largest integer that is not above the number.
    Floor,
}

/// A function of two numbers.
#[derive(Clone, Copy, Debug)]
pub enum Two {
    /// The sum.
    Plus,
    /// The difference.
    Minus,
    /// The product.
    Times,
    /// The quotient.
    Over,
    /// The smaller number.
    Min,
    /// The larger number.
    Max,
}

impl Expression {
    /// Reads a formula in prefix form: a number, `"t"`, `"y0"` or `["+", a, b]`.
    pub fn read(value: &Value) -> Option<Self> {
        match value {
            Value::Number(number) => number.as_f64().map(Self::Constant),
            Value::String(name) if name == "t" => Some(Self::Time),
            Value::String(name) => name.strip_prefix('y')?.parse().ok().map(Self::Component),
            Value::Array(parts) => {
                let (name, arguments) = parts.split_first()?;
                Self::call(name.as_str()?, arguments)
            }
            _ => None,
        }
    }

    fn call(name: &str, arguments: &[Value]) -> Option<Self> {
        let read = |k: usize| Self::read(arguments.get(k)?);
        let one = |function| Some(Self::One(function, Box::new(read(0)?)));
        let two = |function| Some(Self::Two(function, Box::new([read(0)?, read(1)?])));
        match (name, arguments.len()) {
            ("neg", 1) => one(One::Negated),
            ("sin", 1) => one(One::Sin),
            ("cos", 1) => one(One::Cos),
            ("tan", 1) => one(One::Tan),
            ("tanh", 1) => one(One::Tanh),
            ("exp", 1) => one(One::Exp),
            ("ln", 1) => one(One::Ln),
            ("sqrt", 1) => one(One::Sqrt),
            ("abs", 1) => one(One::Abs),
            ("floor", 1) => one(One::Floor),
            ("+", 2) => two(Two::Plus),
            ("-", 2) => two(Two::Minus),
            ("*", 2) => two(Two::Times),
            ("/", 2) => two(Two::Over),
            ("min", 2) => two(Two::Min),
            ("max", 2) => two(Two::Max),
            ("powi", 2) => {
                let exponent = arguments[1].as_i64()?.try_into().ok()?;
                Some(Self::Power(Box::new(read(0)?), exponent))
            }
            ("select", 3) => Some(Self::Select(Box::new([read(0)?, read(1)?, read(2)?]))),
            _ => None,
        }
    }

    /// The formula's value at a time and state.
    pub fn value<T: Number>(&self, time: T, y: &[T]) -> T {
        match self {
            Self::Constant(number) => T::from(*number),
            Self::Time => time,
            Self::Component(k) => y[*k],
            Self::One(function, argument) => {
                let a = argument.value(time, y);
                match function {
                    One::Negated => -a,
                    One::Sin => a.sin(),
                    One::Cos => a.cos(),
                    One::Tan => a.tan(),
                    One::Tanh => a.tanh(),
                    One::Exp => a.exp(),
                    One::Ln => a.ln(),
                    One::Sqrt => a.sqrt(),
                    One::Abs => a.abs(),
                    One::Floor => a.floor(),
                }
            }
            Self::Two(function, arguments) => {
                let [a, b] = [0, 1].map(|k| arguments[k].value(time, y));
                match function {
                    Two::Plus => a + b,
                    Two::Minus => a - b,
                    Two::Times => a * b,
                    Two::Over => a / b,
                    Two::Min => a.min(b),
                    Two::Max => a.max(b),
                }
            }
            Self::Power(base, exponent) => base.value(time, y).powi(*exponent),
            Self::Select(parts) => {
                let [a, b, c] = [0, 1, 2].map(|k| parts[k].value(time, y));
                a.select(b, c)
            }
        }
    }
}
