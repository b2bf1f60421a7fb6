//! What a map says of itself: everything that its results depend on besides its axes.

use stickslip_model::Engine;
use stickslip_plane::{Coordinates, Grid};

use crate::version;

/// Names with their values, in the order of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Provenance(pub Vec<(&'static str, Fact)>);

/// A value that all points of a map have in common.
#[derive(Clone, Debug, PartialEq)]
pub enum Fact {
    /// A number.
    Number(f64),
    /// Words.
    Text(String),
}

impl Provenance {
    /// What made a map of `grid` by `engine`.
    pub fn new(grid: &Grid, engine: &Engine) -> Self {
        let mut numbers = match grid.coordinates {
            Coordinates::Psi { damping } => vec![("damping", damping)],
            Coordinates::Ratio { reduction, damping } => {
                vec![("mu", reduction.mu), ("alpha", reduction.alpha), ("damping", damping)]
            }
            // Its scaled damping differs from column to column, and is an array of its own.
            Coordinates::Velocities { pair } => vec![
                ("mu", pair.surface.friction),
                ("alpha", pair.alpha),
                ("effective_mass_kg", pair.effective_mass_kg),
                ("elastic_constant_n_per_m1_5", pair.elastic_constant),
                ("tangential_stiffness_kg_per_s2", pair.surface.tangential_stiffness_kg_per_s2),
                ("damping_time_s", pair.surface.damping_time_s),
            ],
        };
        if let Some(tolerances) = engine.tolerances() {
            numbers.extend([("rtol", tolerances.rtol), ("atol", tolerances.atol)]);
        }
        let numbers = numbers.into_iter().map(|(name, value)| (name, Fact::Number(value)));
        let texts = [("method", engine.name().to_owned()), ("version", version::program())];
        let texts = texts.into_iter().map(|(name, text)| (name, Fact::Text(text)));
        Self(numbers.chain(texts).collect())
    }
}
