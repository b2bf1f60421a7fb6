//! Each collision as `collide` computes it, with its errors.

use serde::Serialize;
use serde_json::{Value, json};
use stickslip_model::{Collision, CollisionError, CollisionFailure, Engine, Tolerances};
use stickslip_solver::EmbeddedPair;

use super::measure::Approximation;

/// The errors of both pairs at their usual tolerances, in one collision.
#[derive(Clone, Debug)]
pub struct Accuracy {
    /// The collision as it should be.
    pub reference: Collision,
    /// The errors of the pairs, in the order of [`EmbeddedPair::ALL`].
    pub pairs: [PairAccuracy; 2],
}

/// The errors of one pair.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct PairAccuracy {
    /// The error of ε_t.
    #[serde(rename = "eps_t_error")]
    pub eps_t: f64,
    /// The error of the final velocity.
    #[serde(rename = "velocity_error")]
    pub velocity: f64,
    /// The largest error of a switch time; `None` if the switches are others.
    #[serde(rename = "switch_time_error")]
    pub switch_time: Option<f64>,
    /// Evaluations of the right-hand side.
    pub right_hand_sides: usize,
}

impl Accuracy {
    pub(super) fn new(reference: &Collision) -> Result<Self, CollisionFailure> {
        let accuracy = |pair| {
            PairAccuracy::new(pair, reference)
                .map_err(|source| CollisionFailure::new(&reference.contact, source))
        };
        let [dopri5, dop853] = EmbeddedPair::ALL.map(accuracy);
        Ok(Self { reference: reference.clone(), pairs: [dopri5?, dop853?] })
    }

    pub(super) fn json(&self) -> Value {
        let Self { reference, pairs } = self;
        let contact = &reference.contact;
        json!({
            "kappa": contact.kappa(),
            "psi": contact.psi(),
            "damping": contact.damping(),
            "eps_t": reference.eps_t(),
            "switch_count": reference.switches.len(),
            "itinerary": reference.itinerary(),
            (EmbeddedPair::ALL[0].name()): pairs[0],
            (EmbeddedPair::ALL[1].name()): pairs[1],
        })
    }
}

/// The engine of a pair, at its usual tolerances.
pub fn engine(pair: EmbeddedPair) -> Engine {
    match pair {
        EmbeddedPair::Dopri5 => Engine::Dopri5(Tolerances::DOPRI5),
        EmbeddedPair::Dop853 => Engine::Dop853(Tolerances::DOP853),
    }
}

impl PairAccuracy {
    fn new(pair: EmbeddedPair, reference: &Collision) -> Result<Self, CollisionError> {
        let (collision, statistics) = engine(pair).collide(reference.contact)?;
        let statistics = statistics.unwrap_or_default();
        let switches = collision.switches.iter().map(|s| (s.time, s.to, s.side)).collect();
        let final_velocity = collision.final_velocity;
        let approximation = Approximation { final_velocity, switches, statistics };
        let deviation = approximation.deviation(reference);
        let largest = |times: Vec<f64>| times.into_iter().fold(0.0, f64::max);
        Ok(Self {
            eps_t: deviation.velocity / reference.contact.psi(),
            velocity: deviation.velocity,
            switch_time: deviation.switch_times.map(largest),
            right_hand_sides: statistics.field,
        })
    }
}
