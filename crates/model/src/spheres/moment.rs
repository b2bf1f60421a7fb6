//! A moment of a contact in SI units.

use super::encounter::Encounter;
use crate::engines::history::Snapshot;

/// A contact at one moment, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceSnapshot {
    /// Time since the start of contact in s.
    pub time_s: f64,
    /// Compression ξ in m, which is the overlap of the bodies.
    pub compression_m: f64,
    /// Rate of the compression in m/s: g_n at the start, negative while the bodies separate.
    pub normal_velocity_m_per_s: f64,
    /// Normal force F_n in N, which presses the bodies apart.
    pub normal_force_n: f64,
    /// Elongation ζ of the tangential spring in m; `None` in other laws than the paper's, where the
    /// force is not that of a spring of one stiffness.
    pub spring_m: Option<f64>,
    /// Tangential force F_t in N on the first body along t; |F_t| ≤ μ |F_n|.
    pub tangential_force_n: f64,
    /// Tangential velocity of the surfaces along t in m/s.
    pub velocity_m_per_s: f64,
}

impl Encounter {
    /// A moment of the collision of [`Self::contact`] in SI units. In a central impact nothing is
    /// tangential.
    ///
    /// ```
    /// use stickslip_model::Engine;
    /// use stickslip_model::spheres::{Body, Encounter, Material, Sphere, Surface};
    ///
    /// let steel = Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3:
    /// 7850.0 }; let surface = Surface { friction: 0.4, tangential_stiffness_kg_per_s2: 1e9,
    /// damping_time_s: 0.0 }; let sphere = Sphere::homogeneous(0.02, &steel);
    /// let encounter = Encounter::of_velocities(&sphere, &Body::Sphere(sphere), (20.0, 4.0),
    /// &surface)?; let history = Engine::Auto.history(encounter.contact())?;
    /// let middle = history.at(0.5 * history.duration()).ok_or("outside the contact")?;
    /// let middle = encounter.snapshot(&middle);
    /// assert!((middle.normal_force_n / encounter.impact.largest_normal_force_n() - 1.0).abs() <
    /// 1e-10);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn snapshot(&self, moment: &Snapshot) -> ForceSnapshot {
        let impact = &self.impact;
        let force_n = impact.force_unit_n();
        let tangential = |value: f64| if self.is_central() { 0.0 } else { value };
        let spring_m = impact.spring_m(tangential(moment.spring));
        ForceSnapshot {
            time_s: moment.time * impact.time_unit_s,
            compression_m: moment.compression * impact.length_unit_m(),
            normal_velocity_m_per_s: moment.normal_velocity * self.normal_m_per_s,
            normal_force_n: moment.normal_force * force_n,
            spring_m: impact.contact.obeys_paper().then_some(spring_m),
            tangential_force_n: impact.pair.surface.friction
                * force_n
                * tangential(moment.tangential_force),
            velocity_m_per_s: impact.velocity_m_per_s(tangential(moment.velocity)),
        }
    }
}
