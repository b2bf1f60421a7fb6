//! An impact as a JSON object, schema "stickslip.impact/1".

use std::io::{self, Write};

use serde::Serialize;
use stickslip_model::{EnergyAccount, ForceSwitch, Motion, Vector3};
use stickslip_solver::Statistics;

use super::{Comparison, Impact};
use crate::engine::Engine;
use crate::json::{Method, Work, side};
use crate::schema;

/// Writes `impact` as one JSON object and a line end.
///
/// # Errors
/// `out` cannot be written.
pub fn write(
    out: &mut impl Write,
    engine: &Engine,
    impact: &Impact,
    statistics: Option<&Statistics>,
) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut *out, &Object::new(engine, impact, statistics))?;
    writeln!(out)
}

#[derive(Serialize)]
struct Object<'a> {
    schema: &'static str,
    method: Method,
    parameters: Parameters,
    contact: Contact,
    eps_n: f64,
    eps_t: Option<f64>,
    contact_time_s: f64,
    switch_count: usize,
    reversals: usize,
    itinerary: String,
    spheres: Vec<Sphere>,
    impulse_n_s: [f64; 3],
    switches: Vec<Switch>,
    energy_j: Energy,
    #[serde(with = "Observed")]
    observed: stickslip_model::Observed,
    comparison: &'a Comparison,
    statistics: Work,
}

#[derive(Serialize)]
struct Parameters {
    kappa: f64,
    psi: f64,
    damping: f64,
    alpha: f64,
    effective_mass_kg: f64,
    effective_radius_m: f64,
    elastic_constant_n_per_m1_5: f64,
    time_unit_s: f64,
    length_unit_m: f64,
    force_unit_n: f64,
}

#[derive(Serialize)]
struct Contact {
    point_m: [f64; 3],
    normal: [f64; 3],
    tangent: Option<[f64; 3]>,
    normal_m_per_s: f64,
    tangential_m_per_s: f64,
}

#[derive(Serialize)]
struct Sphere {
    velocity_m_per_s: [f64; 3],
    spin_rad_per_s: [f64; 3],
}

#[derive(Serialize)]
struct Switch {
    time_s: f64,
    time_left_s: f64,
    to: String,
    side: i8,
    spring_m: f64,
    velocity_m_per_s: f64,
    normal_force_n: f64,
    tangential_force_n: f64,
}

#[derive(Serialize)]
struct Energy {
    kinetic_before: f64,
    kinetic_after: f64,
    work_of_wall: f64,
    sliding: f64,
    damping: f64,
    spring_left: f64,
    compression_left: f64,
    unbalanced: f64,
}

#[derive(Serialize)]
#[serde(remote = "stickslip_model::Observed")]
struct Observed {
    beta: Option<f64>,
    patch_psi_1: f64,
    patch_psi_2: f64,
    patch_impact_angle_rad: f64,
    patch_rebound_angle_rad: f64,
    centre_e_t: Option<f64>,
    centre_impact_angle_rad: f64,
    centre_rebound_angle_rad: f64,
    impulse_ratio: f64,
}

impl<'a> Object<'a> {
    fn new(engine: &Engine, impact: &'a Impact<'_>, statistics: Option<&Statistics>) -> Self {
        let Impact { encounter, outcome, comparison, .. } = impact;
        let (scaled, pair) = (&encounter.impact, &encounter.impact.pair);
        let contact = encounter.contact();
        Self {
            schema: schema::IMPACT,
            method: Method::from(engine),
            parameters: Parameters {
                kappa: contact.kappa(),
                psi: impact.psi(),
                damping: contact.damping(),
                alpha: pair.alpha,
                effective_mass_kg: pair.effective_mass_kg,
                effective_radius_m: pair.effective_radius_m,
                elastic_constant_n_per_m1_5: pair.elastic_constant,
                time_unit_s: scaled.time_unit_s,
                length_unit_m: scaled.length_unit_m(),
                force_unit_n: scaled.force_unit_n(),
            },
            contact: Contact {
                point_m: components(&encounter.contact_point_m),
                normal: components(&encounter.normal),
                tangent: encounter.tangent.as_ref().map(components),
                normal_m_per_s: encounter.normal_m_per_s,
                tangential_m_per_s: encounter.tangential_m_per_s,
            },
            eps_n: outcome.eps_n,
            eps_t: outcome.eps_t,
            contact_time_s: outcome.contact_time_s,
            switch_count: outcome.switches.len(),
            reversals: impact.reversals(),
            itinerary: impact.itinerary(),
            spheres: impact.spheres().iter().map(Sphere::from).collect(),
            impulse_n_s: components(&outcome.impulse_n_s),
            switches: outcome.switches.iter().map(Switch::from).collect(),
            energy_j: Energy::from(&outcome.energy),
            observed: outcome.observed,
            comparison,
            statistics: Work::new(statistics),
        }
    }
}

impl From<&Motion> for Sphere {
    fn from(motion: &Motion) -> Self {
        Self {
            velocity_m_per_s: components(&motion.velocity_m_per_s),
            spin_rad_per_s: components(&motion.spin_rad_per_s),
        }
    }
}

impl From<&ForceSwitch> for Switch {
    fn from(switch: &ForceSwitch) -> Self {
        Self {
            time_s: switch.time_s,
            time_left_s: switch.time_left_s,
            to: switch.to.to_string(),
            side: side(switch.side),
            spring_m: switch.spring_m,
            velocity_m_per_s: switch.velocity_m_per_s,
            normal_force_n: switch.normal_force_n,
            tangential_force_n: switch.tangential_force_n,
        }
    }
}

impl From<&EnergyAccount> for Energy {
    fn from(account: &EnergyAccount) -> Self {
        Self {
            kinetic_before: account.kinetic_before_j,
            kinetic_after: account.kinetic_after_j,
            work_of_wall: account.work_of_wall_j,
            sliding: account.sliding_j,
            damping: account.damping_j,
            spring_left: account.spring_left_j,
            compression_left: account.compression_left_j,
            unbalanced: account.unbalanced_j(),
        }
    }
}

fn components(vector: &Vector3<f64>) -> [f64; 3] {
    (*vector).into()
}
