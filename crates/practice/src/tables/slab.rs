//! Slabs: intervals of the first axis x in which no boundary begins, ends or turns back, so that
//! boundaries have an order.

use stickslip_model::Collision;
use stickslip_plane::{CollisionPlane, Range};

use super::boundaries::Boundaries;
use super::chain::Chain;
use super::chebyshev::{ALONG, coefficients, nodes, powers, rounded, value};
use super::stretch::Stretch;

/// A boundary, or an edge of the window, over the stretched coordinate of a slab.
pub type Graph = [f64; ALONG];

/// The boundaries over an interval of x, upwards.
pub struct Stack<'a> {
    pub chains: Vec<&'a Chain>,
    pub plane: CollisionPlane,
    /// The largest relative error of graphs, in y or in x.
    pub bound: f64,
    /// The places after the decimal point to which coefficients are rounded.
    pub grid: i32,
}

/// A slab.
#[derive(Clone, Copy)]
pub struct Slab {
    pub low: f64,
    pub high: f64,
    pub stretch: Stretch,
}

/// The narrowest slab, as a part of x. Traced boundaries are not finer.
const NARROWEST: f64 = 1e-11;
/// Places at which the error of a graph is looked at, and one more.
const PLACES: u32 = 18;
/// The part of the distance to the next boundary within which a boundary is looked for.
const APART: f64 = 0.4;

impl Slab {
    /// Both halves of the interval between two walls. At walls boundaries may turn back.
    pub fn between([low, high]: [f64; 2]) -> [Self; 2] {
        let middle = f64::midpoint(low, high);
        [
            Self { low, high: middle, stretch: Stretch::Low },
            Self { low: middle, high, stretch: Stretch::High },
        ]
    }

    /// x at a stretched coordinate.
    pub fn x(&self, along: f64) -> f64 {
        let x = self.low + (self.high - self.low) * self.stretch.inverse(along);
        x.clamp(self.low, self.high)
    }

    /// Both halves of the slab.
    pub fn halves(&self) -> [Self; 2] {
        let (part, [first, second]) = self.stretch.halves();
        let middle = self.low + (self.high - self.low) * part;
        [
            Self { low: self.low, high: middle, stretch: first },
            Self { low: middle, high: self.high, stretch: second },
        ]
    }

    /// Whether the slab is as narrow as the accuracy of boundaries in x.
    pub fn is_narrow(&self) -> bool {
        self.high - self.low <= NARROWEST * self.high
    }
}

impl<'a> Stack<'a> {
    /// The boundaries of a plane at `x`.
    pub fn at(boundaries: &'a Boundaries, plane: &CollisionPlane, x: f64) -> Self {
        let chains = boundaries.chains.iter().filter(|chain| chain.covers(x));
        let mut chains: Vec<&Chain> = chains.collect();
        chains.sort_by(|one, other| one.y_at(x).total_cmp(&other.y_at(x)));
        Self { chains, plane: *plane, bound: 0.0, grid: 0 }
    }

    /// The graphs of a slab, upwards. The first and the last are the edges of the window. `None` if
    /// the slab has to be divided for them.
    pub fn graphs(&self, slab: &Slab) -> Option<Vec<Graph>> {
        let Range { low, high } = self.plane.sheet().sides[1];
        let edge = |y: f64| std::array::from_fn(|i| if i == 0 { y } else { 0.0 });
        let at_nodes = nodes::<ALONG>().map(|along| self.heights(slab.x(along)));
        let graph = |chain: usize| {
            let c = powers(&coefficients(&at_nodes.each_ref().map(|heights| heights[chain])));
            c.map(|c| rounded(c, self.grid))
        };
        let mut graphs: Vec<Graph> = vec![edge(low)];
        graphs.extend((0..self.chains.len()).map(graph));
        let is_close = |k: u32| {
            let along = f64::from(k) / f64::from(PLACES);
            let x = slab.x(along);
            let heights = self.heights(x).into_iter().zip(&self.chains);
            let mut pairs = heights.zip(&graphs[1..]);
            pairs.all(|((y, chain), graph)| {
                let error = (value(graph, along) - y).abs();
                error <= self.bound * y || error <= chain.rise(x, self.bound * x)
            })
        };
        if !slab.is_narrow() && !(0..=PLACES).all(is_close) {
            return None;
        }
        graphs.push(edge(high));
        Some(graphs)
    }

    /// y of all chains at `x`, to the last digits where they are apart.
    fn heights(&self, x: f64) -> Vec<f64> {
        let Range { low, high } = self.plane.sheet().sides[1];
        let coarse = self.chains.iter().map(|chain| chain.y_at(x).clamp(low, high));
        let coarse: Vec<f64> = coarse.collect();
        let Ok(contact) = self.plane.contact_at([x, low]) else { return coarse };
        let mut collision = Collision::before(contact);
        let refined = self.chains.iter().zip(&coarse).enumerate().map(|(k, (chain, &y))| {
            let below = if k == 0 { low } else { coarse[k - 1] };
            let above = coarse.get(k + 1).copied().unwrap_or(high);
            let reach = APART * (y - below).min(above - y);
            chain.refined(x, y, reach, &mut collision)
        });
        refined.collect()
    }
}
