//! Strips of a slab between two graphs, each with a polynomial.

use stickslip_model::{Collision, Contact, Engine};
use stickslip_plane::CollisionPlane;

use super::chebyshev::{
    ACROSS, ALONG, coefficients, double_coefficients, double_powers, double_value, extrema, nodes,
    powers, rounded, value,
};
use super::slab::{Graph, Slab};
use super::stretch::Stretch;
use super::{TableError, TablePlace};

/// What strips must hold to.
#[derive(Clone, Copy)]
pub struct Demand {
    pub plane: CollisionPlane,
    /// The largest error at the places where a strip is looked at.
    pub bound: f64,
    /// The places after the decimal point to which coefficients are rounded.
    pub grid: i32,
    /// As many for graphs.
    pub graph_grid: i32,
}

/// The strip between two graphs.
pub struct Strip {
    pub low: Graph,
    /// How y is stretched.
    pub stretch: Stretch,
    /// One to eight rows of coefficients.
    pub rows: Vec<[f64; ACROSS]>,
}

/// A part of the way from one boundary to the next.
#[derive(Clone, Copy)]
struct Part {
    from: f64,
    to: f64,
    stretch: Stretch,
}

/// Most strips between two boundaries.
const MOST_STRIPS: usize = 512;
/// The part of the bound that rows which are left out may sum up to.
const SMALL: f64 = 0.25;
/// How many times as large as the bound the last coefficients may be.
const TAIL: f64 = 16.0;

/// The space between two neighbouring boundaries of a slab.
pub struct Gap<'a> {
    pub slab: &'a Slab,
    pub low: &'a Graph,
    pub high: &'a Graph,
    pub demand: Demand,
}

/// Why a gap has no strips.
pub enum Refusal {
    /// The slab has to be divided: at this y on its middle, the error is this large.
    Wide { y: f64, error: f64 },
    /// A collision cannot be computed.
    Failed(TableError),
}

impl From<TableError> for Refusal {
    fn from(error: TableError) -> Self {
        Self::Failed(error)
    }
}

impl Gap<'_> {
    /// The strips of the gap, upwards.
    ///
    /// Of all ways to stretch y, the one is taken with which a line across the middle of the slab
    /// needs the fewest strips.
    ///
    /// # Errors
    /// [`Refusal`]: the slab is too wide, or a collision cannot be computed.
    pub fn strips(&self) -> Result<Vec<Strip>, Refusal> {
        let whole = |stretch| vec![Part { from: 0.0, to: 1.0, stretch }];
        let candidates = [
            whole(Stretch::None),
            whole(Stretch::Low),
            whole(Stretch::High),
            vec![
                Part { from: 0.0, to: 0.5, stretch: Stretch::Low },
                Part { from: 0.5, to: 1.0, stretch: Stretch::High },
            ],
        ];
        let mut collision = Collision::before(
            Contact::new(1.0, 1.0, 0.0).map_err(|error| Refusal::Failed(error.into()))?,
        );
        let mut best: Vec<Part> = Vec::new();
        for candidate in candidates {
            let most = if best.is_empty() { MOST_STRIPS } else { best.len() - 1 };
            if let Some(parts) = self.on_line(candidate, most, &mut collision)? {
                best = parts;
            }
        }
        let mut strips = Vec::new();
        // Upwards: the last of these comes first.
        let mut open: Vec<Part> = best.into_iter().rev().collect();
        if open.is_empty() {
            return Err(self.wide(0.5, f64::INFINITY));
        }
        while let Some(part) = open.pop() {
            match self.strip(part, &mut collision)? {
                Ok(strip) => strips.push(strip),
                Err((error, tails)) => {
                    if tails[0] >= tails[1] || strips.len() + open.len() >= MOST_STRIPS {
                        return Err(self.wide(f64::midpoint(part.from, part.to), error));
                    }
                    open.extend(part.halves().into_iter().rev());
                }
            }
        }
        Ok(strips)
    }

    /// The refusal at a part of the way across.
    fn wide(&self, across: f64, error: f64) -> Refusal {
        let [_, y] = self.place(0.5, across);
        Refusal::Wide { y, error }
    }

    /// The parts into which a line across the middle is divided, if they are at most `most`.
    fn on_line(
        &self,
        mut open: Vec<Part>,
        most: usize,
        collision: &mut Collision,
    ) -> Result<Option<Vec<Part>>, TableError> {
        open.reverse();
        let mut done = Vec::new();
        while let Some(part) = open.pop() {
            if done.len() + open.len() >= most {
                return Ok(None);
            }
            let mut at = |across: f64| self.eps_t(0.5, part.inside(across), collision);
            let mut values = [0.0; ACROSS];
            for (value, across) in values.iter_mut().zip(nodes::<ACROSS>()) {
                *value = at(across)?;
            }
            let line = coefficients(&values);
            let mut fits = line[ACROSS - 1].abs() <= TAIL * self.demand.bound;
            if fits {
                let mut row = [[0.0; ACROSS]];
                row[0] = powers(&line);
                for across in extrema(ACROSS) {
                    let error = (double_value(&row, 0.5, across) - at(across)?).abs();
                    fits &= error <= self.demand.bound;
                }
            }
            if fits {
                done.push(part);
            } else {
                open.extend(part.halves().into_iter().rev());
            }
        }
        Ok(Some(done))
    }

    /// The polynomial on a part, or its error and the tails of its coefficients along x and across.
    fn strip(
        &self,
        part: Part,
        collision: &mut Collision,
    ) -> Result<Result<Strip, (f64, [f64; 2])>, TableError> {
        let mut values = [[0.0; ACROSS]; ALONG];
        for (row, along) in values.iter_mut().zip(nodes::<ALONG>()) {
            for (value, across) in row.iter_mut().zip(nodes::<ACROSS>()) {
                *value = self.eps_t(along, part.inside(across), collision)?;
            }
        }
        let terms = double_coefficients(&values);
        let tails = tails(&terms);
        let tail = tails[0].max(tails[1]);
        if !within(tail, TAIL * self.demand.bound) {
            return Ok(Err((tail, tails)));
        }
        let mut rows = double_powers(&terms, self.rows(&terms));
        for c in rows.iter_mut().flatten() {
            *c = rounded(*c, self.demand.grid);
        }
        let mut worst = 0.0;
        for along in extrema(ALONG) {
            for across in extrema(ACROSS) {
                let exact = self.eps_t(along, part.inside(across), collision)?;
                let error = (double_value(&rows, along, across) - exact).abs();
                if !within(error, worst) {
                    worst = error;
                }
            }
        }
        if !within(worst, self.demand.bound) {
            return Ok(Err((worst, tails)));
        }
        let low = std::array::from_fn(|i| {
            let c = self.low[i] + (self.high[i] - self.low[i]) * part.from;
            rounded(c, self.demand.graph_grid)
        });
        Ok(Ok(Strip { low, stretch: part.stretch, rows }))
    }

    /// The number of rows, without those whose terms are small.
    fn rows(&self, terms: &[[f64; ACROSS]; ALONG]) -> usize {
        let size = |rows: &[[f64; ACROSS]]| rows.iter().flatten().map(|c| c.abs()).sum::<f64>();
        let small = |&rows: &usize| size(&terms[rows..]) <= SMALL * self.demand.bound;
        (1..ALONG).find(small).unwrap_or(ALONG)
    }

    /// x and y at the stretched coordinate of the slab and a part of the way across.
    fn place(&self, along: f64, across: f64) -> [f64; 2] {
        let [low, high] = [self.low, self.high].map(|graph| value(graph, along));
        [self.slab.x(along), low + (high - low) * across]
    }

    fn eps_t(&self, along: f64, across: f64, collision: &mut Collision) -> Result<f64, TableError> {
        let place = self.place(along, across);
        restitution(&self.demand.plane, place, collision).map(|[eps_t, _]| eps_t)
    }
}

impl Part {
    /// The part of the way across at a stretched coordinate.
    fn inside(&self, across: f64) -> f64 {
        self.from + (self.to - self.from) * self.stretch.inverse(across)
    }

    fn halves(&self) -> [Self; 2] {
        let (place, [first, second]) = self.stretch.halves();
        let middle = self.from + (self.to - self.from) * place;
        [
            Self { from: self.from, to: middle, stretch: first },
            Self { from: middle, to: self.to, stretch: second },
        ]
    }
}

/// Whether an error is within a bound. What is not a number is not.
pub fn within(error: f64, bound: f64) -> bool {
    error <= bound
}

/// The sums of the sizes of the last coefficients along x and across.
fn tails(terms: &[[f64; ACROSS]; ALONG]) -> [f64; 2] {
    let along = terms[ALONG - 1].iter().map(|c| c.abs()).sum();
    [along, terms.iter().map(|row| row[ACROSS - 1].abs()).sum()]
}

/// ε_t and ε_n at a place of a plane, by the best engine, computed in `collision`.
///
/// # Errors
/// [`TableError::Engine`]: the collision cannot be computed.
pub fn restitution(
    plane: &CollisionPlane,
    place: [f64; 2],
    collision: &mut Collision,
) -> Result<[f64; 2], TableError> {
    let contact = plane.contact_at(place)?;
    let computed = Engine::Auto.collide_into(contact, collision);
    computed.map_err(|source| TableError::Engine {
        place: TablePlace::of(plane, place),
        source: Box::new(source),
    })?;
    Ok([collision.eps_t(), collision.eps_n])
}
