//! A contact whose normal turns: two equal spheres whose overlap is not small beside their radii,
//! in the plane of their motion.
//!
//! In scaled units, with the vector r between the centres, its rate V, and the part s of the
//! reduced tangential velocity that the spins have:
//!
//! ```text
//! x = D − |r|    n = r/|r|    v = −V·n    w = (α/μ) V·t + s
//! dV/dt = F n − μQ t    ds/dt = −(1 − α) Q |r|/D
//! ```
//!
//! D is the distance at which they touch, and |r|/D the arm of the torque over the radius. With
//! small overlaps this is dv/dt = −F and dw/dt = −Q. Angular momentum is conserved:
//! |r| V·t − μ D s/(1 − α) does not change.
//!
//! With `synchronized_verlet` the normal force acts along the normal in the middle of the step, as
//! its velocity is measured, and the tangential force along the tangent at the end of the step.
//!
//! Source: LAMMPS, `granular_model.cpp` (as of pull request 4351, and as it runs in the version of
//! 22 July 2025), where history is kept in size as it is turned into the tangential plane. Müller
//! and Pöschel, Granular Matter 14, 115 (2012), have shown what turning changes without friction.

use stickslip_model::{Contact, Law, Normal, Reduction};
use stickslip_tracer::Point;

/// The greatest overlap without damping, friction and adhesion, in scaled units.
fn greatest(law: Law) -> f64 {
    match law.normal {
        Normal::Linear => 1.0,
        _ => 1.25_f64.powf(0.4),
    }
}

/// Where two spheres are that turn about each other.
pub(super) struct Turning {
    /// From one centre to the other, and its rate in the middle of the last step.
    apart: Point,
    rate: Point,
    /// The part of the reduced tangential velocity that the spins have.
    spin: f64,
    /// The distance at which they touch.
    distance: f64,
    reduction: Reduction,
    /// The normal and the tangent of the forces, which are not those of one moment if velocities
    /// are synchronized.
    axes: [Point; 2],
}

impl Turning {
    /// Spheres without spins that touch after the time `ahead`, with this greatest overlap over
    /// their distance.
    pub fn new(contact: &Contact, overlap: f64, reduction: Reduction, ahead: f64) -> Self {
        let distance = greatest(contact.law()) / overlap;
        let rate = Point::new(-1.0, contact.psi() * reduction.mu / reduction.alpha);
        let apart = Point::new(distance, 0.0) - rate * ahead;
        Self { apart, rate, spin: 0.0, distance, reduction, axes: [Point::x(), Point::y()] }
    }

    /// Moves the spheres by a step. Returns the overlap, its rate and the reduced tangential
    /// velocity, which are those of the normal in the middle of the step if it is `synchronized`.
    pub fn advance(&mut self, dt: f64, synchronized: bool) -> (f64, f64, f64) {
        let axes = |apart: Point| {
            let normal = apart.normalize();
            [normal, Point::new(-normal.y, normal.x)]
        };
        self.apart += self.rate * dt;
        let last = axes(self.apart);
        let half = self.apart - self.rate * (0.5 * dt);
        let [normal, tangent] = if synchronized { axes(half) } else { last };
        self.axes = [normal, last[1]];
        let Reduction { mu, alpha } = self.reduction;
        let w = alpha / mu * self.rate.dot(&tangent) + self.spin;
        (self.distance - self.apart.norm(), -self.rate.dot(&normal), w)
    }

    /// Whether they move apart.
    pub fn parts(&self) -> bool {
        self.apart.dot(&self.rate) > 0.0
    }

    /// Changes the velocities as forces change v and w of a normal that stands still.
    pub fn push(&mut self, v: f64, w: f64) {
        let [normal, tangent] = self.axes;
        self.rate += tangent * (self.reduction.mu * w) - normal * v;
        let arm = self.apart.norm() / self.distance * normal.perp(&tangent);
        self.spin += (1.0 - self.reduction.alpha) * w * arm;
    }

    /// The rate of the overlap and the reduced tangential velocity of the normal with which the
    /// contact began.
    pub fn velocities(&self) -> (f64, f64) {
        let Reduction { mu, alpha } = self.reduction;
        (-self.rate.x, alpha / mu * self.rate.y + self.spin)
    }
}
