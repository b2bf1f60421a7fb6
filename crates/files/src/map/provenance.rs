//! What a map says about itself: everything besides its axes on which its results depend.

use stickslip_model::{Engine, Law};
use stickslip_plane::{Coordinates, Grid};

/// Facts with their names, in the order of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Provenance(pub Vec<(&'static str, Fact)>);

/// A value that all points of a map have in common.
#[derive(Clone, Debug, PartialEq)]
pub enum Fact {
    /// A number.
    Number(f64),
    /// A text.
    Text(String),
}

impl Provenance {
    /// The facts about a map of `grid` that `engine` computes in this `program`.
    pub fn new(grid: &Grid, engine: &Engine, program: &str) -> Self {
        let mut numbers = match grid.coordinates {
            Coordinates::Psi { damping } => vec![("damping", damping)],
            Coordinates::Ratio { reduction, damping } => {
                vec![("mu", reduction.mu), ("alpha", reduction.alpha), ("damping", damping)]
            }
            // The scaled damping differs from column to column, and is one of the quantities.
            Coordinates::Velocities { pair } => vec![
                ("mu", pair.surface.friction),
                ("alpha", pair.alpha),
                ("effective_mass_kg", pair.effective_mass_kg),
                ("elastic_constant_n_per_m1_5", pair.elastic_constant),
                ("tangential_stiffness_kg_per_s2", pair.surface.tangential_stiffness_kg_per_s2),
                pair.damping_constant(),
            ],
        };
        let law = (grid.law != Law::PAPER).then_some(grid.law);
        if law.is_some() {
            numbers.push(("tangential_damping", grid.tangential_damping));
        }
        if let Some(tolerances) = engine.tolerances() {
            numbers.extend([("rtol", tolerances.rtol), ("atol", tolerances.atol)]);
        }
        let numbers = numbers.into_iter().map(|(name, value)| (name, Fact::Number(value)));
        let texts = [("method", engine.name().to_owned()), ("version", program.to_owned())];
        // A law has nothing that JSON lacks.
        let law = law.map(|law| ("law", serde_json::to_string(&law).unwrap_or_default()));
        let texts = law.into_iter().chain(texts).map(|(name, text)| (name, Fact::Text(text)));
        Self(numbers.chain(texts).collect())
    }
}
