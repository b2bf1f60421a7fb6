//! Functions that go through given points.

use super::{Binary, Formula, Graph};

impl Graph {
    /// The function of `x` that is linear between points, and constant beyond them: their places,
    /// which ascend, with the values there. `None` if there are fewer than two, or if places are
    /// not finite or do not ascend.
    ///
    /// ```
    /// use stickslip_expression::{Graph, Inputs, Program};
    ///
    /// let mut graph = Graph::default();
    /// let t = graph.time();
    /// let points = [(0.0, 1.0), (2.0, 5.0)].map(|(at, value)| (at, graph.constant(value)));
    /// let ramp = graph.polygon(t, &points).ok_or("places ascend")?;
    /// let inputs = Inputs { components: 0, parameters: 0, fixed: true };
    /// let program = Program::compile(&graph, &[ramp], inputs);
    /// let at = |t: f64| {
    ///     let mut value = [0.0];
    ///     program.run(t, &[], &mut value);
    ///     value[0]
    /// };
    /// assert_eq!([-1.0, 0.5, 9.0].map(at), [1.0, 2.0, 5.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn polygon(&mut self, x: Formula, points: &[(f64, Formula)]) -> Option<Formula> {
        let widths = widths(points)?;
        let mut pieces = vec![points[0].1];
        for (pair, width) in points.windows(2).zip(widths) {
            let slope = self.quotient(pair, width);
            pieces.push(self.polynomial(x, pair[0].0, &[pair[0].1, slope]));
        }
        pieces.push(points[points.len() - 1].1);
        Some(self.pieces(x, points, &pieces))
    }

    /// The natural cubic spline of `x` through points, which goes straight on beyond them: their
    /// places, which ascend, with the values there. It has two continuous derivatives. `None` if
    /// there are fewer than two points, or if places are not finite or do not ascend.
    pub fn spline(&mut self, x: Formula, points: &[(f64, Formula)]) -> Option<Formula> {
        let widths = widths(points)?;
        let slopes: Vec<Formula> = points
            .windows(2)
            .zip(&widths)
            .map(|(pair, &width)| self.quotient(pair, width))
            .collect();
        let bends = self.bends(&widths, &slopes);
        let last = widths.len() - 1;
        let mut pieces = Vec::with_capacity(points.len() + 1);
        for (piece, &width) in widths.iter().enumerate() {
            // With second derivatives m and n at its ends, the piece has the slope
            // (q − p)/h − h·(2m + n)/6 at its start; m/2 and (n − m)/(6h) are its further terms.
            let [m, n] = [bends[piece], bends[piece + 1]];
            let bent = self.combined(&[(2.0, m), (1.0, n)]);
            let slope = self.combined(&[(1.0, slopes[piece]), (-width / 6.0, bent)]);
            let second = self.combined(&[(0.5, m)]);
            let third = self.combined(&[(1.0 / (6.0 * width), n), (-1.0 / (6.0 * width), m)]);
            let (at, value) = points[piece];
            if piece == 0 {
                pieces.push(self.polynomial(x, at, &[value, slope]));
            }
            pieces.push(self.polynomial(x, at, &[value, slope, second, third]));
            if piece == last {
                // There n = 0, so that the slope at the end is (q − p)/h + h·m/6.
                let slope = self.combined(&[(1.0, slopes[piece]), (width / 6.0, m)]);
                let (at, value) = points[piece + 1];
                pieces.push(self.polynomial(x, at, &[value, slope]));
            }
        }
        Some(self.pieces(x, points, &pieces))
    }

    /// The second derivatives of a natural spline at its points, by elimination.
    fn bends(&mut self, widths: &[f64], slopes: &[Formula]) -> Vec<Formula> {
        let zero = self.constant(0.0);
        let (mut factors, mut rights) = (vec![0.0], vec![zero]);
        for (h, s) in widths.windows(2).zip(slopes.windows(2)) {
            // h₀·m₀ + 2(h₀ + h₁)·m₁ + h₁·m₂ = 6(s₁ − s₀)
            let last = factors.len() - 1;
            let pivot = 2.0 * (h[0] + h[1]) - h[0] * factors[last];
            let terms = [(6.0, s[1]), (-6.0, s[0]), (-h[0], rights[last])];
            let right = self.combined(&terms.map(|(factor, it)| (factor / pivot, it)));
            factors.push(h[1] / pivot);
            rights.push(right);
        }
        let mut bends = vec![zero; widths.len() + 1];
        for place in (1..widths.len()).rev() {
            let terms = [(1.0, rights[place]), (-factors[place], bends[place + 1])];
            bends[place] = self.combined(&terms);
        }
        bends
    }

    /// The slope between two points.
    fn quotient(&mut self, pair: &[(f64, Formula)], width: f64) -> Formula {
        let rise = self.binary(Binary::Sub, pair[1].1, pair[0].1);
        let width = self.constant(width);
        self.binary(Binary::Div, rise, width)
    }

    /// A sum of multiples.
    fn combined(&mut self, terms: &[(f64, Formula)]) -> Formula {
        let mut sum = self.constant(0.0);
        for &(factor, term) in terms.iter().filter(|(factor, _)| *factor != 0.0) {
            let factor = self.constant(factor);
            let term = self.binary(Binary::Mul, factor, term);
            sum = self.binary(Binary::Add, sum, term);
        }
        sum
    }

    /// A polynomial in the distance from a place, by Horner's rule.
    fn polynomial(&mut self, x: Formula, at: f64, coefficients: &[Formula]) -> Formula {
        let at = self.constant(at);
        let distance = self.binary(Binary::Sub, x, at);
        let mut rest = coefficients.iter().rev();
        let mut value = rest.next().map_or_else(|| self.constant(0.0), |&highest| highest);
        for &coefficient in rest {
            let product = self.binary(Binary::Mul, value, distance);
            value = self.binary(Binary::Add, coefficient, product);
        }
        value
    }

    /// The piece in which `x` lies: one below the first point, one from each point on. Pieces are
    /// halved, so that the choices are not nested deep.
    fn pieces(&mut self, x: Formula, points: &[(f64, Formula)], pieces: &[Formula]) -> Formula {
        if pieces.len() == 1 {
            return pieces[0];
        }
        let middle = pieces.len() / 2;
        // Piece `middle` begins at this point.
        let (at, _) = points[middle - 1];
        let below = self.pieces(x, &points[..middle - 1], &pieces[..middle]);
        let above = self.pieces(x, &points[middle..], &pieces[middle..]);
        let at = self.constant(at);
        let distance = self.binary(Binary::Sub, x, at);
        self.select(distance, above, below)
    }
}

/// The distances between places, if there are any and all are above 0.
fn widths(points: &[(f64, Formula)]) -> Option<Vec<f64>> {
    let widths: Vec<f64> = points.windows(2).map(|pair| pair[1].0 - pair[0].0).collect();
    let ascend = |width: &f64| *width > 0.0 && width.is_finite();
    (!widths.is_empty() && widths.iter().all(ascend)).then_some(widths)
}
