//! What is audited: a model of the spring, and the collisions that it makes.

use std::sync::OnceLock;

use fastrand::Rng;
use rayon::prelude::*;
use stickslip_model::{Collider, Collision, Contact, exact, largest, unreset};

use super::line::{self, Line};
use super::statement::Stop;
use crate::engine::EngineError;
use crate::error::Failure;
use crate::recipe::{DEFAULT_ALPHA, DEFAULT_MU};

/// Friction μ of the paper's figures.
pub const MU: f64 = DEFAULT_MU;
/// α of homogeneous spheres.
pub const ALPHA: f64 = DEFAULT_ALPHA;
/// The stiffness of Figs. 4 and 5, read as κ of (24).
pub const PRINTED: f64 = 18.0;
/// The same, read as ακ.
pub const READ: f64 = PRINTED / ALPHA;

/// A model of the spring.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Model {
    /// The paper's: reset to the limit as long as that is active
    Reset,
    /// Never reset
    UnresetSpring,
}

/// What is audited.
pub struct Subject {
    pub model: Model,
    lines: [OnceLock<Result<Line, String>>; 2],
}

impl Model {
    /// As `--model` takes it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Reset => "reset",
            Self::UnresetSpring => "unreset-spring",
        }
    }
}

impl Subject {
    pub fn new(model: Model) -> Self {
        Self { model, lines: Default::default() }
    }

    /// The collision, by the exact solution where there is one.
    pub fn collide(&self, kappa: f64, psi: f64, damping: f64) -> Result<Collision, Failure> {
        match (self.model, damping > 0.0) {
            (Model::Reset, false) => {
                exact::collide(contact(kappa, psi, damping)?).map_err(|error| {
                    Failure::Computation { kappa, psi, damping, source: error.into() }
                })
            }
            _ => self.integrate(kappa, psi, damping),
        }
    }

    /// The collision, integrated.
    pub fn integrate(&self, kappa: f64, psi: f64, damping: f64) -> Result<Collision, Failure> {
        let contact = contact(kappa, psi, damping)?;
        let collision = match self.model {
            Model::Reset => Collider::default().collide(contact),
            Model::UnresetSpring => unreset::collide(contact).map(|made| made.collision),
        };
        let failed = |source: EngineError| Failure::Computation { kappa, psi, damping, source };
        collision.map_err(|error| failed(error.into()))
    }

    /// The largest elongation of the spring without damping.
    pub fn largest_spring(&self, kappa: f64, psi: f64) -> Result<f64, Failure> {
        let none = || Failure::Audit(format!("no spring at κ = {kappa:?}, ψ = {psi:?}"));
        match self.model {
            Model::Reset => largest::spring(&self.collide(kappa, psi, 0.0)?).ok_or_else(none),
            Model::UnresetSpring => unreset::collide(contact(kappa, psi, 0.0)?)
                .map(|made| made.largest_spring)
                .map_err(|error| Failure::Audit(error.to_string())),
        }
    }

    /// The switches over ψ at the stiffness of the figures, in both readings.
    ///
    /// Made by the first who asks, on that thread alone: who waits for it may be part of the same
    /// pool.
    pub fn lines(&self) -> Result<[&Line; 2], Stop> {
        let line = |index: usize, kappa| {
            let made = self.lines[index].get_or_init(|| line::line(self, kappa));
            made.as_ref().map_err(|doubt| Stop::Open(doubt.clone()))
        };
        Ok([line(0, PRINTED)?, line(1, READ)?])
    }
}

/// `of` each of `inputs`, in their order; in parallel.
///
/// # Errors
/// The first in that order.
pub fn each<T: Sync, U: Send>(
    inputs: &[T],
    of: impl Fn(&T) -> Result<U, Failure> + Send + Sync,
) -> Result<Vec<U>, Failure> {
    let results: Vec<_> = inputs.par_iter().map(of).collect();
    results.into_iter().collect()
}

/// Random collisions [κ, ψ, a]: κ from 0.05 to 1000 and, if damped, a from 0.001 to 1, evenly in
/// the logarithm; ψ from 0.01 to 3.
pub fn random(count: usize, seed: u64, damped: bool) -> Vec<[f64; 3]> {
    let mut random = Rng::with_seed(seed);
    let mut draw = || {
        let kappa = 0.05 * 20_000_f64.powf(random.f64());
        let psi = 0.01 + 2.99 * random.f64();
        [kappa, psi, if damped { 1e-3 * 1e3_f64.powf(random.f64()) } else { 0.0 }]
    };
    (0..count).map(|_| draw()).collect()
}

/// `count` numbers from `low` to `high`, evenly in the logarithm.
pub fn geometric(low: f64, high: f64, count: usize) -> impl Iterator<Item = f64> + Clone {
    (0..count).map(move |i| low * (high / low).powf(i as f64 / (count - 1) as f64))
}

/// The ratio g_t/g_n of the figures at ψ.
pub fn ratio(psi: f64) -> f64 {
    psi * MU / ALPHA
}

fn contact(kappa: f64, psi: f64, damping: f64) -> Result<Contact, Failure> {
    Contact::new(kappa, psi, damping).map_err(|error| Failure::Audit(error.to_string()))
}
