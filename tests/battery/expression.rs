//! Formulas of a case, read from JSON and computed by programs in any number.

use serde_json::Value;
use stickslip::solver::Number;
use stickslip_expression::{Binary, Formula, Graph, Inputs, Program, Unary, Variable};

/// A formula in time and state.
#[derive(Clone, Debug)]
pub struct Expression(Program);

impl Expression {
    /// Reads a formula in prefix form: a number, `"t"`, `"y0"` or `["+", a, b]`.
    pub fn read(value: &Value) -> Option<Self> {
        let mut graph = Graph::default();
        let formula = formula(&mut graph, value)?;
        let places = graph.reads(&[formula]).into_iter().filter_map(|variable| match variable {
            Variable::Component(place) => Some(place as usize + 1),
            _ => None,
        });
        let inputs = Inputs { components: places.max().unwrap_or(0), parameters: 0, fixed: true };
        Some(Self(Program::compile(&graph, &[formula], inputs)))
    }

    /// The formula's value at a time and state.
    pub fn value<T: Number>(&self, time: T, y: &[T]) -> T {
        let mut value = [T::from(f64::NAN)];
        self.0.run(time, y, &mut value);
        value[0]
    }
}

/// Reads a formula in prefix form.
pub fn formula(graph: &mut Graph, value: &Value) -> Option<Formula> {
    match value {
        Value::Number(number) => Some(graph.constant(number.as_f64()?)),
        Value::String(name) if name == "t" => Some(graph.time()),
        Value::String(name) => Some(graph.component(name.strip_prefix('y')?.parse().ok()?)),
        Value::Array(parts) => {
            let (name, arguments) = parts.split_first()?;
            let read = |argument| formula(&mut *graph, argument);
            let arguments = arguments.iter().map(read).collect::<Option<Vec<_>>>()?;
            call(graph, name.as_str()?, &arguments)
        }
        _ => None,
    }
}

fn call(graph: &mut Graph, name: &str, arguments: &[Formula]) -> Option<Formula> {
    let unary = match name {
        "neg" => Unary::Neg,
        "sin" => Unary::Sin,
        "cos" => Unary::Cos,
        "tan" => Unary::Tan,
        "tanh" => Unary::Tanh,
        "exp" => Unary::Exp,
        "ln" => Unary::Ln,
        "sqrt" => Unary::Sqrt,
        "abs" => Unary::Abs,
        "floor" => Unary::Floor,
        _ => return call_of_more(graph, name, arguments),
    };
    let &[a] = arguments else { return None };
    Some(graph.unary(unary, a))
}

fn call_of_more(graph: &mut Graph, name: &str, arguments: &[Formula]) -> Option<Formula> {
    let binary = match (name, arguments) {
        ("powi", &[a, n]) => return Some(graph.power(a, n)),
        ("select", &[a, b, c]) => return Some(graph.select(a, b, c)),
        ("+", _) => Binary::Add,
        ("-", _) => Binary::Sub,
        ("*", _) => Binary::Mul,
        ("/", _) => Binary::Div,
        ("min", _) => Binary::Min,
        ("max", _) => Binary::Max,
        _ => return None,
    };
    let &[a, b] = arguments else { return None };
    Some(graph.binary(binary, a, b))
}
