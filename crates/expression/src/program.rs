//! Formulas as a list of instructions on registers.
//!
//! A program computes its formulas in one pass over its instructions, in any kind of number, and
//! allocates nothing with up to 512 registers. `compile` makes it from a graph.

mod compile;

use std::ops::Range;
use std::sync::Arc;

use smallvec::SmallVec;
use stickslip_number::Number;

use crate::graph::{Binary, FormulaNode, Unary};

/// What an instruction does. `a`, `b`, `c` are registers and `k` is a constant of the pool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
#[rustfmt::skip]
enum Op {
    Add, Sub, Mul, Div, Min, Max, Atan2,
    /// a + k, a − k, k − a, a·k, a/k, k/a.
    AddK, SubK, KSub, MulK, DivK, KDiv,
    /// a·b + c, a·b − c, c − a·b, each rounded twice.
    MulAdd, MulSub, SubMul,
    /// a·k + c.
    MulKAdd,
    Select, Power, RealPower,
    Neg, Abs, Floor, Square, Sqrt, Exp, ExpM1, Ln, Ln1p, Sin, Cos, Tan, Asin, Acos, Atan,
    Sinh, Cosh, Tanh, Asinh, Acosh, Atanh, Erf,
}

/// An instruction, whose operands are indices of the type `I`.
#[derive(Clone, Copy, Debug)]
struct Instruction<I> {
    op: Op,
    to: I,
    a: I,
    b: I,
    c: I,
}

/// Instructions with small indices, and others.
#[derive(Clone, Debug)]
enum Code {
    /// At most 256 registers and constants.
    Short(Vec<Instruction<u8>>),
    Wide(Vec<Instruction<u32>>),
}

/// Formulas that are compiled together.
///
/// ```
/// use stickslip_expression::{Binary, Graph, Inputs, Program, Unary};
/// use stickslip_number::{Enclosure, Interval, Number};
///
/// // p·sin(y₀)
/// let mut graph = Graph::default();
/// let (angle, factor) = (graph.component(0), graph.parameter(0));
/// let sine = graph.unary(Unary::Sin, angle);
/// let torque = graph.binary(Binary::Mul, factor, sine);
/// let inputs = Inputs { components: 1, parameters: 1, fixed: true };
/// let program = Program::compile(&graph, &[torque], inputs).with(&[3.0]);
///
/// let mut found = [0.0];
/// program.run(0.0, &[0.5], &mut found);
/// assert_eq!(found[0], 3.0 * 0.5_f64.sin());
/// let mut bounds = [Enclosure::ENTIRE];
/// let angle = Enclosure::variable(Interval::new(0.0, 1.0));
/// program.run(Enclosure::from(0.0), &[angle], &mut bounds);
/// assert!(bounds[0].value.contains(found[0]) && bounds[0].slope.sign() == 1.0);
/// ```
#[derive(Clone, Debug)]
pub struct Program {
    /// Constants; after them the parameters, if these are fixed, and what is made of them alone.
    pool: Vec<f64>,
    body: Arc<Body>,
}

/// What programs have in common that differ in their parameters.
#[derive(Debug)]
struct Body {
    code: Code,
    /// The places of the parameters in the pool.
    parameters: Range<usize>,
    /// What computes the rest of the pool from them.
    preparation: Option<Program>,
    /// Registers that start with a number of the pool.
    loads: Vec<(u32, u32)>,
    outputs: Vec<u32>,
    /// How many registers start with components of the state, or with parameters.
    inputs: usize,
    registers: usize,
}

/// What a program reads besides the time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Inputs {
    /// The number of components of the state.
    pub components: usize,
    /// The number of parameters.
    pub parameters: usize,
    /// Whether parameters are fixed by [`Program::with`]; otherwise they are further components,
    /// so that they may be dual numbers.
    pub fixed: bool,
}

impl Program {
    /// The program with these parameters. Further ones are ignored; missing ones stay as they are.
    #[must_use]
    pub fn with(&self, parameters: &[f64]) -> Self {
        let (mut all, body) = (self.pool.clone(), &self.body);
        let (pool, made) = all.split_at_mut(body.parameters.end);
        let own = &mut pool[body.parameters.clone()];
        for (place, &value) in own.iter_mut().zip(parameters) {
            *place = value;
        }
        if let Some(preparation) = &body.preparation {
            preparation.run(f64::NAN, own, made);
        }
        Self { pool: all, body: body.clone() }
    }

    /// The number of instructions that a run of the program takes.
    #[must_use]
    pub fn len(&self) -> usize {
        match &self.body.code {
            Code::Short(code) => code.len(),
            Code::Wide(code) => code.len(),
        }
    }

    /// Whether the program only copies what it reads.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Computes the formulas at the time `t` and the components `y`. Surplus entries of `out` stay
    /// as they are.
    ///
    /// # Panics
    /// If there are fewer components than the program was compiled for.
    #[inline]
    pub fn run<T: Number>(&self, t: T, y: &[T], out: &mut [T]) {
        assert!(y.len() >= self.body.inputs, "the program reads {} components", self.body.inputs);
        match (&self.body.code, self.body.registers) {
            (Code::Short(code), ..=8) => self.run_in(code, &mut [t; 8], y, out),
            (Code::Short(code), ..=16) => self.run_in(code, &mut [t; 16], y, out),
            (Code::Short(code), ..=32) => self.run_in(code, &mut [t; 32], y, out),
            (Code::Short(code), ..=64) => self.run_in(code, &mut [t; 64], y, out),
            (Code::Short(code), _) => self.run_in(code, &mut [t; 256], y, out),
            (Code::Wide(code), _) => self.run_wide(code, t, y, out),
        }
    }

    #[inline(never)]
    fn run_in<T: Number, const R: usize>(
        &self,
        code: &[Instruction<u8>],
        registers: &mut [T; R],
        y: &[T],
        out: &mut [T],
    ) {
        // R is a power of two, so that no register is out of range.
        self.run_on(code, registers, y, out, usize::from, |index| index & (R - 1));
    }

    #[inline(never)]
    fn run_wide<T: Number>(&self, code: &[Instruction<u32>], t: T, y: &[T], out: &mut [T]) {
        let mut registers: SmallVec<[T; 512]> = SmallVec::from_elem(t, self.body.registers);
        self.run_on(code, &mut registers, y, out, |index| index as usize, |index| index);
    }

    #[inline(always)]
    fn run_on<T: Number, I: Copy>(
        &self,
        code: &[Instruction<I>],
        r: &mut [T],
        y: &[T],
        out: &mut [T],
        place: impl Fn(I) -> usize,
        register: impl Fn(usize) -> usize,
    ) {
        let at = |index: I| register(place(index));
        // A loop, since a call that copies a few numbers costs more than they do.
        for (register, &y) in r.iter_mut().zip(&y[..self.body.inputs]) {
            *register = y;
        }
        let pool = &self.pool[..];
        for &(to, from) in &self.body.loads {
            r[to as usize] = T::from(pool[from as usize]);
        }
        for instruction in code {
            macro_rules! a {
                () => {
                    r[at(instruction.a)]
                };
            }
            macro_rules! b {
                () => {
                    r[at(instruction.b)]
                };
            }
            macro_rules! c {
                () => {
                    r[at(instruction.c)]
                };
            }
            macro_rules! k {
                () => {
                    pool[place(instruction.b)]
                };
            }
            let x = match instruction.op {
                Op::Add => a!() + b!(),
                Op::Sub => a!() - b!(),
                Op::Mul => a!() * b!(),
                Op::Div => a!() / b!(),
                Op::Min => a!().min(b!()),
                Op::Max => a!().max(b!()),
                Op::Atan2 => a!().atan2(b!()),
                Op::AddK => a!() + k!(),
                Op::SubK => a!() - k!(),
                Op::KSub => -a!() + k!(),
                Op::MulK => a!() * k!(),
                Op::DivK => a!() / k!(),
                Op::KDiv => T::from(k!()) / a!(),
                Op::MulAdd => a!() * b!() + c!(),
                Op::MulSub => a!() * b!() - c!(),
                Op::SubMul => c!() - a!() * b!(),
                Op::MulKAdd => a!() * k!() + c!(),
                Op::Select => a!().select(b!(), c!()),
                // The constant is an integer in range.
                #[expect(clippy::cast_possible_truncation)]
                Op::Power => a!().powi(k!() as i32),
                Op::RealPower => FormulaNode::power_of(a!(), k!()),
                Op::Neg => -a!(),
                Op::Abs => a!().abs(),
                Op::Floor => a!().floor(),
                Op::Square => a!().powi(2),
                Op::Sqrt => a!().sqrt(),
                Op::Exp => a!().exp(),
                Op::ExpM1 => a!().exp_m1(),
                Op::Ln => a!().ln(),
                Op::Ln1p => a!().ln_1p(),
                Op::Sin => a!().sin(),
                Op::Cos => a!().cos(),
                Op::Tan => a!().tan(),
                Op::Asin => a!().asin(),
                Op::Acos => a!().acos(),
                Op::Atan => a!().atan(),
                Op::Sinh => a!().sinh(),
                Op::Cosh => a!().cosh(),
                Op::Tanh => a!().tanh(),
                Op::Asinh => a!().asinh(),
                Op::Acosh => a!().acosh(),
                Op::Atanh => a!().atanh(),
                Op::Erf => a!().erf(),
            };
            r[at(instruction.to)] = x;
        }
        for (out, &from) in out.iter_mut().zip(&self.body.outputs) {
            *out = r[from as usize];
        }
    }
}

impl From<Unary> for Op {
    fn from(function: Unary) -> Self {
        match function {
            Unary::Neg => Self::Neg,
            Unary::Abs => Self::Abs,
            Unary::Floor => Self::Floor,
            Unary::Square => Self::Square,
            Unary::Sqrt => Self::Sqrt,
            Unary::Exp => Self::Exp,
            Unary::ExpM1 => Self::ExpM1,
            Unary::Ln => Self::Ln,
            Unary::Ln1p => Self::Ln1p,
            Unary::Sin => Self::Sin,
            Unary::Cos => Self::Cos,
            Unary::Tan => Self::Tan,
            Unary::Asin => Self::Asin,
            Unary::Acos => Self::Acos,
            Unary::Atan => Self::Atan,
            Unary::Sinh => Self::Sinh,
            Unary::Cosh => Self::Cosh,
            Unary::Tanh => Self::Tanh,
            Unary::Asinh => Self::Asinh,
            Unary::Acosh => Self::Acosh,
            Unary::Atanh => Self::Atanh,
            Unary::Erf => Self::Erf,
        }
    }
}

impl From<Binary> for Op {
    fn from(function: Binary) -> Self {
        match function {
            Binary::Add => Self::Add,
            Binary::Sub => Self::Sub,
            Binary::Mul => Self::Mul,
            Binary::Div => Self::Div,
            Binary::Min => Self::Min,
            Binary::Max => Self::Max,
            Binary::Atan2 => Self::Atan2,
        }
    }
}
