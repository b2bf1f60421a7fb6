//! Random formulas: what a program computes, their derivatives, and their text.

use num_dual::Dual64;
use stickslip_expression::{
    Binary, Formula, FormulaNode, Graph, Inputs, Program, System, Unary, Variable,
};
use stickslip_number::{Enclosure, Interval, Number};

#[rustfmt::skip]
const UNARY: [Unary; 22] = [
    Unary::Neg, Unary::Abs, Unary::Floor, Unary::Square, Unary::Sqrt, Unary::Exp, Unary::ExpM1,
    Unary::Ln, Unary::Ln1p, Unary::Sin, Unary::Cos, Unary::Tan, Unary::Asin, Unary::Acos,
    Unary::Atan, Unary::Sinh, Unary::Cosh, Unary::Tanh, Unary::Asinh, Unary::Acosh, Unary::Atanh,
    Unary::Erf,
];
const BINARY: [Binary; 7] =
    [Binary::Add, Binary::Sub, Binary::Mul, Binary::Div, Binary::Min, Binary::Max, Binary::Atan2];

/// A graph of random formulas of three components, two parameters and the time.
fn random(numbers: &mut fastrand::Rng, size: usize) -> (Graph, Vec<Formula>) {
    let mut graph = Graph::default();
    let mut known: Vec<Formula> = (0..3).map(|i| graph.component(i)).collect();
    known.extend([graph.time(), graph.parameter(0), graph.parameter(1)]);
    known.extend([0.5, 2.0, -3.0, 1.0, 0.0].map(|x| graph.constant(x)));
    let narrow = numbers.bool();
    while graph.len() < size {
        let [mut a, mut b, c] = [(); 3].map(|()| known[numbers.usize(..known.len())]);
        if narrow {
            // A chain with many constants, whose places are beyond those of the registers.
            a = known[known.len() - 1];
            if numbers.bool() {
                b = graph.constant(2.0 * numbers.f64() - 1.0);
            }
        }
        let formula = match numbers.u8(..10) {
            // Their values stay finite.
            0..3 if narrow => {
                graph.unary([Unary::Sin, Unary::Tanh, Unary::Neg][numbers.usize(..3)], a)
            }
            3..10 if narrow => graph.binary(BINARY[numbers.usize(..3)], a, b),
            0..3 => graph.unary(UNARY[numbers.usize(..UNARY.len())], a),
            3..8 => graph.binary(BINARY[numbers.usize(..BINARY.len())], a, b),
            8 => graph.select(a, b, c),
            _ => {
                let exponent = [-2.0, 2.0, 3.0, 5.0, 0.5, 1.5][numbers.usize(..6)];
                let exponent = graph.constant(exponent);
                graph.power(a, exponent)
            }
        };
        known.push(formula);
        // What is made of constants alone adds no node.
        if known.len() > 20 * size {
            break;
        }
    }
    let outputs = (0..5).map(|_| known[numbers.usize(known.len() / 2..known.len())]).collect();
    (graph, outputs)
}

/// The values of all nodes, one by one.
fn values<T: Number>(graph: &Graph, t: T, y: &[T], p: &[T]) -> Vec<T> {
    let mut values: Vec<T> = Vec::new();
    for node in graph.nodes() {
        let at = |formula: Formula| values[index(graph, formula)];
        values.push(match *node {
            FormulaNode::Constant(bits) => T::from(f64::from_bits(bits)),
            FormulaNode::Variable(Variable::Time) => t,
            FormulaNode::Variable(Variable::Component(i)) => y[i as usize],
            FormulaNode::Variable(Variable::Parameter(i)) => p[i as usize],
            FormulaNode::Unary(function, a) => function.of(at(a)),
            FormulaNode::Binary(function, a, b) => function.of(at(a), at(b)),
            FormulaNode::Power(a, n) => at(a).powi(n),
            FormulaNode::RealPower(a, n) => FormulaNode::power_of(at(a), f64::from_bits(n)),
            FormulaNode::Select(a, b, c) => at(a).select(at(b), at(c)),
        });
    }
    values
}

fn index(graph: &Graph, formula: Formula) -> usize {
    let node = graph.node(formula);
    graph.nodes().iter().position(|other| *other == node).expect("a node of the graph")
}

fn same(a: f64, b: f64) -> bool {
    a == b || a.is_nan() && b.is_nan()
}

const INPUTS: Inputs = Inputs { components: 3, parameters: 2, fixed: true };

#[test]
fn programs_compute_what_the_nodes_say() {
    let mut numbers = fastrand::Rng::with_seed(1);
    let mut finite = 0;
    for round in 0..600 {
        let size = if round % 20 == 0 { 1200 } else { numbers.usize(12..160) };
        let (graph, outputs) = random(&mut numbers, size);
        let program = Program::compile(&graph, &outputs, INPUTS);
        let loose = Inputs { fixed: false, ..INPUTS };
        let loose = Program::compile(&graph, &outputs, loose);
        for _ in 0..4 {
            let [t, a, b, c, p, q] = [(); 6].map(|()| 4.0 * numbers.f64() - 2.0);
            let all = values(&graph, t, &[a, b, c], &[p, q]);
            let program = program.clone().with(&[p, q]);
            let mut found = [0.0; 5];
            program.run(t, &[a, b, c], &mut found);
            let mut other = [0.0; 5];
            loose.run(t, &[a, b, c, p, q], &mut other);
            for (nth, &output) in outputs.iter().enumerate() {
                let expected = all[index(&graph, output)];
                finite += usize::from(expected.is_finite());
                assert!(same(found[nth], expected), "{round}: {} {expected}", found[nth]);
                assert!(same(other[nth], expected), "{round}: {} {expected}", other[nth]);
            }
            // Bounds over a small box hold the values in it.
            let around = |x: f64| {
                Enclosure::from(0.0)
                    + Enclosure { value: Interval::around(x, 1e-3), ..Enclosure::from(0.0) }
            };
            let mut bounds = [Enclosure::ENTIRE; 5];
            program.run(around(t), &[a, b, c].map(around), &mut bounds);
            for (bound, value) in bounds.iter().zip(found) {
                assert!(
                    value.is_nan() || bound.value.contains(value),
                    "{round}: {bound:?} {value}"
                );
            }
        }
    }
    assert!(finite > 6000, "{finite}");
}

#[test]
fn slopes_are_those_of_dual_numbers() {
    let mut numbers = fastrand::Rng::with_seed(2);
    let mut compared = 0;
    for _ in 0..300 {
        let size = numbers.usize(12..40);
        let (mut graph, outputs) = random(&mut numbers, size);
        // Along the flow y′ = (y₁, y₂, 1).
        let [one, second, third] = [graph.constant(1.0), graph.component(1), graph.component(2)];
        let zero = graph.constant(0.0);
        let slopes: Vec<Formula> = outputs
            .iter()
            .map(|&output| {
                graph.slope(output, &mut |_, variable| match variable {
                    Variable::Time => one,
                    Variable::Component(i) => [second, third, one][i as usize],
                    Variable::Parameter(_) => zero,
                })
            })
            .collect();
        let program = Program::compile(&graph, &slopes, INPUTS);
        let whole = Program::compile(&graph, &outputs, INPUTS);
        let [t, a, b, c, p, q] = [(); 6].map(|()| 4.0 * numbers.f64() - 2.0);
        let mut found = [0.0; 5];
        program.with(&[p, q]).run(t, &[a, b, c], &mut found);
        let y = [Dual64::new(a, b), Dual64::new(b, c), Dual64::new(c, 1.0)];
        let mut expected = [Dual64::from(0.0); 5];
        whole.with(&[p, q]).run(Dual64::new(t, 1.0), &y, &mut expected);
        for (found, expected) in found.into_iter().zip(expected) {
            let usual = |x: f64| x.is_finite() && x.abs() < 1e6;
            if usual(expected.re) && usual(expected.eps) && found.is_finite() {
                compared += 1;
                let error = (found - expected.eps).abs() / (1.0 + expected.eps.abs());
                assert!(error < 1e-8, "{found} {expected}");
            }
        }
    }
    assert!(compared > 700, "{compared}");
}

/// Random formulas as text read the same, to the last bit.
#[test]
fn text_of_random_formulas_reads_the_same() {
    let mut numbers = fastrand::Rng::with_seed(3);
    for round in 0..300 {
        let size = numbers.usize(12..80);
        let (graph, outputs) = random(&mut numbers, size);
        let text = "parameter p = 1, q = 2\nstate a = 0, b = 0, c = 0\na' = 1\nb' = 1\nc' = 1";
        let mut system = System::parse(text).expect("a system");
        system.modes[0].slopes = outputs[..3].to_vec();
        system.graph = graph;
        for component in &mut system.components {
            component.start = system.graph.constant(0.25);
        }
        let text = system.text();
        let again = System::parse(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let compile =
            |system: &System| Program::compile(&system.graph, &system.modes[0].slopes, INPUTS);
        let (one, other) = (compile(&system), compile(&again));
        for _ in 0..4 {
            let [t, a, b, c, p, q] = [(); 6].map(|()| 4.0 * numbers.f64() - 2.0);
            let (mut found, mut expected) = ([0.0; 3], [0.0; 3]);
            one.clone().with(&[p, q]).run(t, &[a, b, c], &mut expected);
            other.clone().with(&[p, q]).run(t, &[a, b, c], &mut found);
            for (found, expected) in found.into_iter().zip(expected) {
                assert!(same(found, expected), "{round}: {found} {expected}\n{text}");
            }
        }
        let printed = again.text();
        let once_more = System::parse(&printed).expect("a text that was written");
        assert_eq!(once_more.text(), printed);
    }
}

/// A sum of 100 000 terms, and 100 000 functions of each other, need no stack.
#[test]
fn deep_formulas_need_no_stack() {
    let mut graph = Graph::default();
    let x = graph.component(0);
    let mut deep = x;
    for _ in 0..100_000 {
        deep = graph.unary(Unary::Sin, deep);
    }
    let one = graph.constant(1.0);
    let zero = graph.constant(0.0);
    let slope = graph.slope(deep, &mut |_, variable| match variable {
        Variable::Component(_) => one,
        _ => zero,
    });
    let inputs = Inputs { components: 1, parameters: 0, fixed: true };
    let program = Program::compile(&graph, &[deep, slope], inputs);
    let mut values = [0.0; 2];
    program.run(0.0, &[1.0], &mut values);
    let expected = (0..100_000).fold(1.0_f64, |x, _| x.sin());
    assert!(values[0] == expected && values[1] > 0.0 && values[1] < 1.0);
}

/// Two registers and forty constants: places of constants are not those of registers.
#[test]
fn constants_are_found_whatever_their_number() {
    let mut graph = Graph::default();
    let x = graph.component(0);
    let mut sum = x;
    for k in 0..40 {
        let factor = graph.constant(0.5 + 0.01 * f64::from(k));
        sum = graph.binary(Binary::Mul, sum, factor);
        let shift = graph.constant(-1.0 - f64::from(k));
        sum = graph.binary(Binary::Add, sum, shift);
    }
    let inputs = Inputs { components: 1, parameters: 0, fixed: true };
    let mut found = [0.0];
    Program::compile(&graph, &[sum], inputs).run(0.0, &[3.0], &mut found);
    let expected =
        (0..40).fold(3.0, |sum, k| sum * (0.5 + 0.01 * f64::from(k)) + (-1.0 - f64::from(k)));
    assert_eq!(found[0], expected);
}
