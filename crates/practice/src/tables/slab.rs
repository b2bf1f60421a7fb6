//! Slabs: intervals of κ in which no boundary begins, ends or turns back, so that boundaries have an
//! order.

use stickslip_model::{Collision, Contact};
use stickslip_plane::Range;

use super::boundaries::{Boundaries, Chain};
use super::chebyshev::{ALONG, coefficients, nodes, powers, value};
use super::stretch::Stretch;
use super::strip::rounded;

/// A boundary, or an edge of the window, over the stretched coordinate of a slab.
pub type Graph = [f64; ALONG];

/// The boundaries over an interval of κ, upwards.
pub struct Stack<'a> {
    pub chains: Vec<&'a Chain>,
    pub psi: Range,
    /// The largest relative error of graphs, in ψ or in κ.
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

/// The narrowest slab, as a part of κ. The boundaries of an atlas are not finer.
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

    /// κ at a stretched coordinate.
    pub fn kappa(&self, along: f64) -> f64 {
        let kappa = self.low + (self.high - self.low) * self.stretch.inverse(along);
        kappa.clamp(self.low, self.high)
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

    /// Whether the slab is as narrow as the accuracy of boundaries in κ.
    pub fn is_narrow(&self) -> bool {
        self.high - self.low <= NARROWEST * self.high
    }
}

impl<'a> Stack<'a> {
    /// The boundaries at `kappa`.
    pub fn at(boundaries: &'a Boundaries, kappa: f64, psi: Range) -> Self {
        let chains = boundaries.chains.iter().filter(|chain| chain.covers(kappa));
        let mut chains: Vec<&Chain> = chains.collect();
        chains.sort_by(|one, other| one.psi_at(kappa).total_cmp(&other.psi_at(kappa)));
        Self { chains, psi, bound: 0.0, grid: 0 }
    }

    /// The graphs of a slab, upwards, the first and the last of which are the edges of the window.
    /// `None` if the slab has to be divided for them.
    pub fn graphs(&self, slab: &Slab) -> Option<Vec<Graph>> {
        let edge = |psi: f64| std::array::from_fn(|i| if i == 0 { psi } else { 0.0 });
        let at_nodes = nodes::<ALONG>().map(|along| self.heights(slab.kappa(along)));
        let graph = |chain: usize| {
            let c = powers(&coefficients(&at_nodes.each_ref().map(|heights| heights[chain])));
            c.map(|c| rounded(c, self.grid))
        };
        let mut graphs: Vec<Graph> = vec![edge(self.psi.low)];
        graphs.extend((0..self.chains.len()).map(graph));
        let is_close = |k: u32| {
            let along = f64::from(k) / f64::from(PLACES);
            let kappa = slab.kappa(along);
            let heights = self.heights(kappa).into_iter().zip(&self.chains);
            let mut pairs = heights.zip(&graphs[1..]);
            pairs.all(|((psi, chain), graph)| {
                let error = (value(graph, along) - psi).abs();
                error <= self.bound * psi || error <= chain.rise(kappa, self.bound * kappa)
            })
        };
        if !slab.is_narrow() && !(0..=PLACES).all(is_close) {
            return None;
        }
        graphs.push(edge(self.psi.high));
        Some(graphs)
    }

    /// ψ of all chains at `kappa`, to the last digits where they are apart.
    fn heights(&self, kappa: f64) -> Vec<f64> {
        let Range { low, high } = self.psi;
        let coarse = self.chains.iter().map(|chain| chain.psi_at(kappa).clamp(low, high));
        let coarse: Vec<f64> = coarse.collect();
        let Ok(contact) = Contact::new(kappa, low, 0.0) else { return coarse };
        let mut collision = Collision::before(contact);
        let refined = self.chains.iter().zip(&coarse).enumerate().map(|(k, (chain, &psi))| {
            let below = if k == 0 { low } else { coarse[k - 1] };
            let above = coarse.get(k + 1).copied().unwrap_or(high);
            let reach = APART * (psi - below).min(above - psi);
            chain.refined(kappa, psi, reach, &mut collision)
        });
        refined.collect()
    }
}
