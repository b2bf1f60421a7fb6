//! Derivatives of formulas, as formulas.

use std::f64::consts::FRAC_2_SQRT_PI;

use super::{Binary, Formula, FormulaNode, Graph, Unary, Variable};

impl Graph {
    /// The derivative of a formula, where `rate` gives the derivatives of what it reads. At a kink
    /// it is the derivative of the piece that [`FormulaNode::Select`] and the like choose, and a
    /// jump is left out.
    pub fn slope(
        &mut self,
        formula: Formula,
        rate: &mut impl FnMut(&mut Self, Variable) -> Formula,
    ) -> Formula {
        let zero = self.constant(0.0);
        let needed = self.needed(&[formula]);
        let mut slopes = vec![zero; needed.len()];
        for index in (0..needed.len()).filter(|&index| needed[index]) {
            let node = self.nodes[index];
            let mut inner = node.operands().map(|operand| slopes[operand.index()]);
            let slope = [(); 3].map(|()| inner.next().unwrap_or(zero));
            slopes[index] = match node {
                FormulaNode::Constant(_) => zero,
                FormulaNode::Variable(variable) => rate(self, variable),
                _ if slope == [zero; 3] => zero,
                // A node of the graph refers to nodes before it, and there are less than 2³².
                #[expect(clippy::cast_possible_truncation)]
                _ => self.chain(Formula(index as u32), node, slope),
            };
        }
        slopes[formula.index()]
    }

    /// The rate of a formula while the components have these slopes.
    ///
    /// # Panics
    /// If it reads a component beyond them.
    pub(crate) fn rate(&mut self, formula: Formula, slopes: &[Formula]) -> Formula {
        self.slope(formula, &mut |graph, variable| match variable {
            Variable::Time => graph.constant(1.0),
            Variable::Component(place) => slopes[place as usize],
            Variable::Parameter(_) => graph.constant(0.0),
        })
    }

    /// The derivative of a function of formulas with these slopes.
    fn chain(&mut self, whole: Formula, node: FormulaNode, [u, v, w]: [Formula; 3]) -> Formula {
        use Binary::{Add, Div, Max, Min, Mul, Sub};
        match node {
            FormulaNode::Constant(_) | FormulaNode::Variable(_) => self.constant(0.0),
            FormulaNode::Unary(Unary::Neg, _) => self.unary(Unary::Neg, u),
            FormulaNode::Unary(function, a) => {
                let outer = self.derivative(function, a, whole);
                self.product(outer, u)
            }
            FormulaNode::Binary(Add, ..) => self.binary(Add, u, v),
            FormulaNode::Binary(Sub, ..) => self.binary(Sub, u, v),
            FormulaNode::Binary(Mul, a, b) => {
                let (left, right) = (self.product(u, b), self.product(a, v));
                self.binary(Add, left, right)
            }
            FormulaNode::Binary(Div, _, b) => {
                let part = self.product(whole, v);
                let rest = self.binary(Sub, u, part);
                self.binary(Div, rest, b)
            }
            FormulaNode::Binary(Min, a, b) => {
                let difference = self.binary(Sub, b, a);
                self.select(difference, u, v)
            }
            FormulaNode::Binary(Max, a, b) => {
                let difference = self.binary(Sub, a, b);
                self.select(difference, u, v)
            }
            FormulaNode::Binary(Binary::Atan2, y, x) => {
                let (left, right) = (self.product(x, u), self.product(y, v));
                let turned = self.binary(Sub, left, right);
                let (x, y) = (self.unary(Unary::Square, x), self.unary(Unary::Square, y));
                let square = self.binary(Add, x, y);
                self.binary(Div, turned, square)
            }
            FormulaNode::Power(a, n) => {
                let n = f64::from(n);
                let (factor, less) = (self.constant(n), self.constant(n - 1.0));
                self.power_slope(a, factor, less, u)
            }
            FormulaNode::RealPower(a, n) => {
                let n = f64::from_bits(n);
                let (factor, less) = (self.constant(n), self.constant(n - 1.0));
                self.power_slope(a, factor, less, u)
            }
            FormulaNode::Select(condition, ..) => self.select(condition, v, w),
        }
    }

    fn power_slope(&mut self, a: Formula, n: Formula, less: Formula, u: Formula) -> Formula {
        let power = self.power(a, less);
        let outer = self.binary(Binary::Mul, n, power);
        self.product(outer, u)
    }

    /// A product, in which a factor 0 counts as exactly 0.
    fn product(&mut self, a: Formula, b: Formula) -> Formula {
        if self.value(a) == Some(0.0) || self.value(b) == Some(0.0) {
            return self.constant(0.0);
        }
        self.binary(Binary::Mul, a, b)
    }

    /// The derivative of a function at `a`, where it is `whole`.
    fn derivative(&mut self, function: Unary, a: Formula, whole: Formula) -> Formula {
        use Binary::{Add, Div, Mul, Sub};
        let [one, two] = [1.0, 2.0].map(|x| self.constant(x));
        let square = |graph: &mut Self| graph.unary(Unary::Square, a);
        match function {
            Unary::Neg => self.constant(-1.0),
            Unary::Abs => {
                let minus_one = self.constant(-1.0);
                self.select(a, one, minus_one)
            }
            Unary::Floor => self.constant(0.0),
            Unary::Square => self.binary(Mul, two, a),
            Unary::Sqrt => {
                let double = self.binary(Mul, two, whole);
                self.binary(Div, one, double)
            }
            Unary::Exp => whole,
            Unary::ExpM1 => self.unary(Unary::Exp, a),
            Unary::Ln => self.binary(Div, one, a),
            Unary::Ln1p => {
                let sum = self.binary(Add, one, a);
                self.binary(Div, one, sum)
            }
            Unary::Sin => self.unary(Unary::Cos, a),
            Unary::Cos => {
                let sine = self.unary(Unary::Sin, a);
                self.unary(Unary::Neg, sine)
            }
            Unary::Tan => {
                let square = self.unary(Unary::Square, whole);
                self.binary(Add, one, square)
            }
            Unary::Sinh => self.unary(Unary::Cosh, a),
            Unary::Cosh => self.unary(Unary::Sinh, a),
            Unary::Tanh => {
                let cosh = self.unary(Unary::Cosh, a);
                let square = self.unary(Unary::Square, cosh);
                self.binary(Div, one, square)
            }
            Unary::Atan => {
                let square = square(self);
                let sum = self.binary(Add, one, square);
                self.binary(Div, one, sum)
            }
            Unary::Atanh => {
                let square = square(self);
                let rest = self.binary(Sub, one, square);
                self.binary(Div, one, rest)
            }
            Unary::Asin | Unary::Acos | Unary::Asinh | Unary::Acosh => {
                let square = square(self);
                let radicand = match function {
                    Unary::Asinh => self.binary(Add, one, square),
                    Unary::Acosh => self.binary(Sub, square, one),
                    _ => self.binary(Sub, one, square),
                };
                let root = self.unary(Unary::Sqrt, radicand);
                let sign = self.constant(if function == Unary::Acos { -1.0 } else { 1.0 });
                self.binary(Div, sign, root)
            }
            Unary::Erf => {
                let square = square(self);
                let exponent = self.unary(Unary::Neg, square);
                let bell = self.unary(Unary::Exp, exponent);
                let factor = self.constant(FRAC_2_SQRT_PI);
                self.binary(Mul, factor, bell)
            }
        }
    }
}
