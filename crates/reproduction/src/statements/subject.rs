//! What is audited: a model of the spring, and the lines of one stiffness that several statements
//! need.

use std::sync::OnceLock;

use stickslip_model::Collision;
use stickslip_studies::paper::{Reading, STIFFNESS};

use super::line::{Line, line};
use super::spring::Spring;
use super::statement::Stop;
use crate::error::ReproductionError;

/// What is audited.
pub struct Subject {
    pub spring: Spring,
    lines: [OnceLock<Result<Line, Stop>>; 2],
}

impl Subject {
    pub fn new(spring: Spring) -> Self {
        Self { spring, lines: Default::default() }
    }

    /// A subject whose lines are these.
    #[cfg(test)]
    pub fn with_lines(spring: Spring, lines: [Result<Line, Stop>; 2]) -> Self {
        Self { spring, lines: lines.map(OnceLock::from) }
    }

    /// The collision, by the exact solution where there is one.
    ///
    /// # Errors
    /// [`ReproductionError`]: the collision cannot be computed.
    pub fn collide(
        &self,
        kappa: f64,
        psi: f64,
        damping: f64,
    ) -> Result<Collision, ReproductionError> {
        self.spring.collide(kappa, psi, damping)
    }

    /// The collision, integrated.
    ///
    /// # Errors
    /// [`ReproductionError`]: the collision cannot be computed.
    pub fn integrate(
        &self,
        kappa: f64,
        psi: f64,
        damping: f64,
    ) -> Result<Collision, ReproductionError> {
        self.spring.integrate(kappa, psi, damping)
    }

    /// The switches over ψ at the stiffness of the figures, in both readings.
    ///
    /// The first test that asks makes a line, on its thread alone: other threads that wait for the
    /// line may be part of the same pool.
    ///
    /// # Errors
    /// [`Stop::Open`]: the boundaries are in doubt. [`Stop::Failed`]: a collision cannot be
    /// computed.
    pub fn lines(&self) -> Result<[&Line; 2], Stop> {
        let [printed, axis] = Reading::kappas(STIFFNESS);
        Ok([self.line(0, printed)?, self.line(1, axis)?])
    }

    fn line(&self, index: usize, kappa: f64) -> Result<&Line, Stop> {
        self.lines[index].get_or_init(|| line(self.spring, kappa)).as_ref().map_err(Stop::clone)
    }
}
