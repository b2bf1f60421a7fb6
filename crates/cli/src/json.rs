//! One collision as a JSON object, schema "stickslip.collision/1".

use std::io::{self, Write};

use serde::Serialize;
use stickslip_model::{Collision, EnergyLedger, Side};
use stickslip_solver::Statistics;

use crate::engine::Engine;
use crate::schema;

/// Writes `collision` as one JSON object and a line end.
///
/// # Errors
/// `out` cannot be written.
pub fn write(
    out: &mut impl Write,
    engine: &Engine,
    collision: &Collision,
    statistics: Option<&Statistics>,
) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut *out, &Object::new(engine, collision, statistics))?;
    writeln!(out)
}

#[derive(Serialize)]
struct Object {
    schema: &'static str,
    parameters: Parameters,
    method: Method,
    eps_n: f64,
    eps_t: f64,
    w_final: f64,
    contact_time: f64,
    switch_count: usize,
    reversals: usize,
    itinerary: String,
    switches: Vec<Switch>,
    energy: Energy,
    statistics: Work,
}

#[derive(Serialize)]
struct Parameters {
    kappa: f64,
    psi: f64,
    damping: f64,
}

/// What computed a collision.
#[derive(Serialize)]
pub struct Method {
    name: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    rtol: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    atol: Option<f64>,
}

#[derive(Serialize)]
struct Switch {
    time: f64,
    time_left: f64,
    to: String,
    side: i8,
    spring: f64,
    velocity: f64,
}

#[derive(Serialize)]
struct Energy {
    tangential_initial: f64,
    tangential_final: f64,
    sliding: f64,
    spring_left: f64,
    normal_initial: f64,
    normal_final: f64,
    damping: f64,
    compression_left: f64,
}

/// The integrator's work; an empty object for the exact solution.
#[derive(Serialize)]
#[serde(untagged)]
pub enum Work {
    Integrated {
        accepted: usize,
        rejected: usize,
        too_coarse: usize,
        field: usize,
        guards: usize,
        resteps: usize,
        isolations: usize,
        switches: usize,
        grazings: usize,
    },
    Exact {},
}

impl Object {
    fn new(engine: &Engine, collision: &Collision, statistics: Option<&Statistics>) -> Self {
        let contact = &collision.contact;
        Self {
            schema: schema::COLLISION,
            parameters: Parameters {
                kappa: contact.kappa(),
                psi: contact.psi(),
                damping: contact.damping(),
            },
            method: Method::from(engine),
            eps_n: collision.eps_n,
            eps_t: collision.eps_t(),
            w_final: collision.final_velocity,
            contact_time: collision.contact_time,
            switch_count: collision.switches.len(),
            reversals: collision.reversals,
            itinerary: collision.itinerary(),
            switches: collision.switches.iter().map(Switch::from).collect(),
            energy: Energy::from(&collision.energy),
            statistics: Work::new(statistics),
        }
    }
}

impl From<&Engine> for Method {
    fn from(engine: &Engine) -> Self {
        let tolerances = engine.tolerances();
        Self {
            name: engine.name(),
            rtol: tolerances.map(|tolerances| tolerances.rtol),
            atol: tolerances.map(|tolerances| tolerances.atol),
        }
    }
}

/// 1 or −1.
pub fn side(side: Side) -> i8 {
    match side {
        Side::Positive => 1,
        Side::Negative => -1,
    }
}

impl From<&stickslip_model::Switch> for Switch {
    fn from(switch: &stickslip_model::Switch) -> Self {
        Self {
            time: switch.time,
            time_left: switch.time_left,
            to: switch.to.to_string(),
            side: side(switch.side),
            spring: switch.spring,
            velocity: switch.velocity,
        }
    }
}

impl From<&EnergyLedger> for Energy {
    fn from(ledger: &EnergyLedger) -> Self {
        Self {
            tangential_initial: ledger.tangential_initial,
            tangential_final: ledger.tangential_final,
            sliding: ledger.sliding,
            spring_left: ledger.spring_left,
            normal_initial: ledger.normal_initial,
            normal_final: ledger.normal_final,
            damping: ledger.damping,
            compression_left: ledger.compression_left,
        }
    }
}

impl Work {
    /// The work behind a collision; the exact solution has no `statistics`.
    pub fn new(statistics: Option<&Statistics>) -> Self {
        let Some(statistics) = statistics else { return Self::Exact {} };
        Self::Integrated {
            accepted: statistics.accepted,
            rejected: statistics.rejected,
            too_coarse: statistics.too_coarse,
            field: statistics.field,
            guards: statistics.guards,
            resteps: statistics.resteps,
            isolations: statistics.isolations,
            switches: statistics.switches,
            grazings: statistics.grazings,
        }
    }
}
