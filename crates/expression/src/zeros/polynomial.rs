//! Polynomials in what formulas read, and in functions of that.

use std::collections::BTreeMap;

use crate::graph::{Binary, Formula, FormulaNode, Graph, Unary};

/// A formula with more terms, or of more nodes, is not looked into.
const MOST_TERMS: usize = 200;
const MOST_NODES: usize = 2000;
const MOST_DEGREE: i32 = 8;

/// Sums of rounded products count as zero up to this part of their largest term.
const ROUNDING: f64 = 1e-14;

/// A product of powers, in ascending order of what is multiplied. Divisors are factors of their
/// own.
type Monomial = Vec<(Factor, u32)>;

/// What is multiplied.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Factor {
    formula: Formula,
    divides: bool,
}

/// A sum of monomials with coefficients other than 0, and the largest term that went into them.
#[derive(Clone, Debug, Default)]
pub(super) struct Polynomial {
    terms: BTreeMap<Monomial, f64>,
    largest: f64,
}

impl Polynomial {
    /// The polynomial that a formula is; `None` if that is too long.
    pub fn of(graph: &Graph, formula: Formula) -> Option<Self> {
        let needed = graph.needed(&[formula]);
        if needed.iter().filter(|needed| **needed).count() > MOST_NODES {
            return None;
        }
        let mut made: Vec<Option<Self>> = vec![None; needed.len()];
        for (place, node) in graph.nodes().iter().enumerate().filter(|(place, _)| needed[*place]) {
            let of = |operand: Formula| made[operand.index()].as_ref();
            // A node refers to nodes before it, and there are less than 2³².
            let itself = || Self::factor(Formula(u32::try_from(place).unwrap_or(u32::MAX)), false);
            let polynomial = match *node {
                FormulaNode::Constant(bits) => Self::number(f64::from_bits(bits)),
                FormulaNode::Unary(Unary::Neg, a) => of(a)?.times(&Self::number(-1.0))?,
                FormulaNode::Unary(Unary::Square, a) => of(a)?.times(of(a)?)?,
                FormulaNode::Binary(Binary::Add, a, b) => of(a)?.plus(of(b)?, 1.0)?,
                FormulaNode::Binary(Binary::Sub, a, b) => of(a)?.plus(of(b)?, -1.0)?,
                FormulaNode::Binary(Binary::Mul, a, b) => of(a)?.times(of(b)?)?,
                FormulaNode::Binary(Binary::Div, a, b) => match graph.value(b) {
                    Some(divisor) => of(a)?.times(&Self::number(1.0 / divisor))?,
                    None => of(a)?.times(&Self::factor(b, true))?,
                },
                FormulaNode::Power(a, n @ 2..=MOST_DEGREE) => {
                    let mut power = of(a)?.clone();
                    for _ in 1..n {
                        power = power.times(of(a)?)?;
                    }
                    power
                }
                _ => itself(),
            };
            made[place] = Some(polynomial);
        }
        made.swap_remove(formula.index())
    }

    fn number(value: f64) -> Self {
        let terms = (value != 0.0).then_some((Vec::new(), value)).into_iter().collect();
        Self { terms, largest: value.abs() }
    }

    fn factor(formula: Formula, divides: bool) -> Self {
        let terms = [(vec![(Factor { formula, divides }, 1)], 1.0)].into();
        Self { terms, largest: 1.0 }
    }

    pub fn is_zero(&self) -> bool {
        self.terms.is_empty()
    }

    /// The sum with a multiple of another one.
    fn plus(&self, other: &Self, factor: f64) -> Option<Self> {
        let mut sum = self.clone();
        sum.largest = sum.largest.max((factor * other.largest).abs());
        for (monomial, coefficient) in &other.terms {
            *sum.terms.entry(monomial.clone()).or_insert(0.0) += factor * coefficient;
        }
        sum.settled()
    }

    fn times(&self, other: &Self) -> Option<Self> {
        if self.terms.len() * other.terms.len() > MOST_TERMS * MOST_TERMS {
            return None;
        }
        let mut product = Self { largest: self.largest * other.largest, ..Self::default() };
        for (one, a) in &self.terms {
            for (two, b) in &other.terms {
                *product.terms.entry(multiplied(one, two)).or_insert(0.0) += a * b;
            }
        }
        product.settled()
    }

    /// Without terms that are rounding; `None` if something is no number, or if it is too long.
    fn settled(mut self) -> Option<Self> {
        let noise = ROUNDING * self.largest;
        self.terms.retain(|_, coefficient| coefficient.is_nan() || coefficient.abs() > noise);
        let finite = self.terms.values().all(|coefficient| coefficient.is_finite());
        (finite && self.terms.len() <= MOST_TERMS).then_some(self)
    }

    /// Whether another polynomial, which is not zero, divides this one: by division of the leading
    /// terms, those of the highest degree in the last factor first.
    pub fn is_multiple_of(&self, divisor: &Self) -> bool {
        let lead = |it: &Self| {
            it.terms.iter().max_by(|one, other| order(one.0, other.0)).map(|(m, c)| (m.clone(), *c))
        };
        let Some((by, coefficient)) = lead(divisor) else { return false };
        let mut rest = self.clone();
        for _ in 0..MOST_TERMS {
            let Some((monomial, first)) = lead(&rest) else { return true };
            let Some(quotient) = divided(&monomial, &by) else { return false };
            let terms = [(quotient, first / coefficient)].into();
            let multiple = Self { terms, largest: (first / coefficient).abs() };
            let Some(multiple) = multiple.times(divisor) else { return false };
            let Some(mut less) = rest.plus(&multiple, -1.0) else { return false };
            // The leading terms cancel by construction.
            less.terms.remove(&monomial);
            rest = less;
        }
        false
    }
}

/// A lexicographic order of monomials, which products keep: the higher power of the greatest factor
/// comes last.
fn order(one: &Monomial, other: &Monomial) -> std::cmp::Ordering {
    let (mut one, mut other) = (one.iter().rev(), other.iter().rev());
    loop {
        match (one.next(), other.next()) {
            (None, None) => return std::cmp::Ordering::Equal,
            (a, b) if a == b => {}
            // An absent factor is less than any.
            (a, b) => return a.cmp(&b),
        }
    }
}

fn multiplied(one: &Monomial, other: &Monomial) -> Monomial {
    let mut powers: BTreeMap<Factor, u32> = one.iter().copied().collect();
    for (factor, power) in other {
        *powers.entry(*factor).or_insert(0) += power;
    }
    powers.into_iter().collect()
}

fn divided(one: &Monomial, by: &Monomial) -> Option<Monomial> {
    let mut powers: BTreeMap<Factor, u32> = one.iter().copied().collect();
    for (factor, power) in by {
        let left = powers.get_mut(factor)?;
        *left = left.checked_sub(*power)?;
    }
    Some(powers.into_iter().filter(|(_, power)| *power > 0).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn multiples_are_found_and_others_are_not() {
        let mut graph = Graph::default();
        let [x, y] = [0, 1].map(|place| graph.component(place));
        let two = graph.constant(2.0);
        // (2x − y)·(x + y) = 2x² + xy − y²
        let doubled = graph.binary(Binary::Mul, two, x);
        let [one, other] =
            [(Binary::Sub, doubled), (Binary::Add, x)].map(|(it, a)| graph.binary(it, a, y));
        let product = graph.binary(Binary::Mul, one, other);
        let beside = graph.binary(Binary::Add, product, x);
        let of = |formula| Polynomial::of(&graph, formula).unwrap();
        assert!(of(product).is_multiple_of(&of(one)) && of(product).is_multiple_of(&of(other)));
        assert!(!of(beside).is_multiple_of(&of(one)) && !of(one).is_multiple_of(&of(other)));
        assert!(of(product).plus(&of(product), -1.0).unwrap().is_zero());
    }
}
