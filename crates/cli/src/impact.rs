//! The impact of two bodies from a file, computed and printed.

mod json;
mod table;

use std::io::{self, BufWriter, Write};

use serde::Serialize;
use stickslip_model::{Collision, Encounter, Motion, Outcome, coulomb, normal};

use crate::args::{Format, ImpactArguments};
use crate::bodies;
use crate::engine::{self, Engine, EngineError};
use crate::error::Failure;

/// An impact and all that is printed of it.
struct Impact<'a> {
    encounter: &'a Encounter,
    collision: Collision,
    outcome: Outcome,
    comparison: Comparison,
}

/// What simpler laws say of the same impact.
#[derive(Serialize)]
struct Comparison {
    eps_n_series: f64,
    eps_n_pade: f64,
    /// Of pure Coulomb sliding with the integrated ε_n; none in a central impact.
    eps_t_coulomb: Option<f64>,
    mindlin_stiffness_kg_per_s2: f64,
    mindlin_kappa: f64,
    undamped_compression_m: f64,
    undamped_normal_force_n: f64,
}

/// Reads the bodies, computes their impact and prints it to standard output.
///
/// # Errors
/// The file cannot be used, the impact cannot be computed, or standard output cannot be written.
pub fn run(arguments: &ImpactArguments) -> Result<(), Failure> {
    let engine = arguments.method.engine(None)?;
    let encounter = bodies::read_encounter(&arguments.file)?;
    let damping_time_s = encounter.impact.pair.surface.damping_time_s;
    if engine == Engine::Exact && damping_time_s > 0.0 {
        return Err(Failure::Usage(format!(
            "surface.damping_time_s = {damping_time_s:?} cannot be used with --method exact, which \
             holds without damping; expected 0, or --method dop853 or dopri5"
        )));
    }
    let contact = encounter.contact();
    let failed = |source| Failure::computation(&contact, source);
    let (collision, statistics) = engine.collide(contact).map_err(failed)?;
    engine::require_finite(&collision).map_err(failed)?;
    let impact = Impact::new(&encounter, collision);
    impact.require_finite().map_err(failed)?;

    let mut out = BufWriter::new(io::stdout().lock());
    let written = match arguments.format {
        Format::Json => json::write(&mut out, &engine, &impact, statistics.as_ref()),
        Format::Table => table::write(&mut out, &engine, &impact, statistics.as_ref()),
    };
    Failure::unless_written(written.and_then(|()| out.flush()))
}

impl<'a> Impact<'a> {
    fn new(encounter: &'a Encounter, collision: Collision) -> Self {
        let outcome = encounter.outcome(&collision);
        let (impact, contact) = (&encounter.impact, encounter.contact());
        let eps_n = outcome.eps_n;
        let comparison = Comparison {
            eps_n_series: normal::series(contact.damping()),
            eps_n_pade: normal::pade(contact.damping()),
            eps_t_coulomb: outcome.eps_t.map(|_| coulomb::restitution(contact.psi(), eps_n)),
            mindlin_stiffness_kg_per_s2: impact.mindlin_stiffness_kg_per_s2(),
            mindlin_kappa: impact.pair.mindlin_kappa(),
            undamped_compression_m: impact.largest_compression_m(),
            undamped_normal_force_n: impact.largest_normal_force_n(),
        };
        Self { encounter, collision, outcome, comparison }
    }

    /// A central impact has no tangential motion, and stays on its spring.
    fn is_central(&self) -> bool {
        self.encounter.tangent.is_none()
    }

    /// ψ; 0 in a central impact.
    fn psi(&self) -> f64 {
        if self.is_central() { 0.0 } else { self.collision.contact.psi() }
    }

    fn reversals(&self) -> usize {
        if self.is_central() { 0 } else { self.collision.reversals }
    }

    fn itinerary(&self) -> String {
        if self.is_central() { "o".to_owned() } else { self.collision.itinerary() }
    }

    /// The motions of the spheres after the contact, in the order of the file.
    fn spheres(&self) -> &[Motion] {
        &self.outcome.motions[..self.encounter.spheres().count()]
    }

    fn require_finite(&self) -> Result<(), EngineError> {
        let Self { encounter, outcome, comparison, .. } = self;
        let vectors = self.spheres().iter().flat_map(|motion| {
            [("a velocity", motion.velocity_m_per_s), ("a spin", motion.spin_rad_per_s)]
        });
        let vectors = vectors.chain([("the impulse", outcome.impulse_n_s)]);
        let components = vectors.flat_map(|(name, v)| [(name, v.x), (name, v.y), (name, v.z)]);
        let energy = &outcome.energy;
        let impact = &encounter.impact;
        engine::all_finite(components.chain([
            ("eps_n_series", comparison.eps_n_series),
            ("mindlin_stiffness_kg_per_s2", comparison.mindlin_stiffness_kg_per_s2),
            ("mindlin_kappa", comparison.mindlin_kappa),
            ("undamped_compression_m", comparison.undamped_compression_m),
            ("undamped_normal_force_n", comparison.undamped_normal_force_n),
            ("time_unit_s", impact.time_unit_s),
            ("patch_psi_1", outcome.observed.patch_psi_1),
            ("kinetic_before_j", energy.kinetic_before_j),
            ("kinetic_after_j", energy.kinetic_after_j),
            ("sliding_j", energy.sliding_j),
            ("unbalanced_j", energy.unbalanced_j()),
        ]))
    }
}
