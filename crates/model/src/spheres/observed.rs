//! The quantities that experiments and DEM codes report of a collision, under their names.

use nalgebra::Vector3;

use super::encounter::{Encounter, Motion, direction, tangential};

/// A collision in the quantities of experiments.
///
/// *Patch* quantities describe the surfaces at the point of contact. *Centre* quantities describe
/// the relative motion of the centres, which is what a camera sees of spheres without marks; with a
/// wall, they describe the motion relative to the wall. Angles are measured from the normal, in
/// rad. They are positive on the side to which the motion before the contact points: a negative
/// angle is a motion thrown back.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Observed {
    /// β = −ε_t, the tangential restitution of Walton (1993) and Foerster, Louge, Chang and Allia
    /// (Phys. Fluids 6, 1108, 1994): 1 is full reversal, −1 no friction.
    pub beta: Option<f64>,
    /// Ψ₁ = g_t/g_n before the contact (Foerster et al. 1994), the tangent of
    /// [`Self::patch_impact_angle_rad`].
    pub patch_psi_1: f64,
    /// Ψ₂ = ε_t g_t/g_n, tangential velocity after over normal velocity before the contact (same
    /// source).
    pub patch_psi_2: f64,
    /// Angle atan(g_t/g_n) of the patch at impact.
    pub patch_impact_angle_rad: f64,
    /// Angle atan(ε_t g_t/(ε_n g_n)) of the patch after the contact.
    pub patch_rebound_angle_rad: f64,
    /// Tangential velocity of the centre after over that before the contact, e_t of Kharaz, Gorham
    /// and Salman (Powder Technol. 120, 281, 2001), along the velocity before; `None` if there is
    /// no velocity before.
    pub centre_e_t: Option<f64>,
    /// Angle of the motion of the centre at impact.
    pub centre_impact_angle_rad: f64,
    /// Angle of the motion of the centre after the contact, in the plane of the motion before. If
    /// the centre had no tangential motion before, it is in the plane of n and t.
    pub centre_rebound_angle_rad: f64,
    /// Tangential impulse divided by normal impulse. It is at most μ, and equal to μ if there is
    /// sliding in one direction throughout the contact.
    pub impulse_ratio: f64,
}

impl Observed {
    pub(crate) fn new(
        encounter: &Encounter,
        eps_n: f64,
        eps_t: Option<f64>,
        after: &[Motion; 2],
    ) -> Self {
        let Encounter { normal, normal_m_per_s, tangential_m_per_s, .. } = encounter;
        let alpha = encounter.impact.pair.alpha;
        let after_m_per_s = eps_t.unwrap_or(0.0) * tangential_m_per_s;
        let rebound_m_per_s = eps_n * normal_m_per_s;

        let relative = |motions: [&Motion; 2]| {
            tangential(&(motions[0].velocity_m_per_s - motions[1].velocity_m_per_s), normal)
        };
        let before = encounter.partners.each_ref().map(|partner| &partner.motion);
        let speed = before.iter().map(|motion| motion.velocity_m_per_s.norm()).sum::<f64>();
        let centre_before = direction(&relative(before), speed);
        let along: Vector3<f64> =
            centre_before.map(|(along, _)| along).or(encounter.tangent).unwrap_or_default();
        let centre_m_per_s = centre_before.map_or(0.0, |(_, speed)| speed);
        let centre_after_m_per_s = relative([&after[0], &after[1]]).dot(&along);
        Self {
            beta: eps_t.map(|eps_t| -eps_t),
            patch_psi_1: tangential_m_per_s / normal_m_per_s,
            patch_psi_2: after_m_per_s / normal_m_per_s,
            patch_impact_angle_rad: tangential_m_per_s.atan2(*normal_m_per_s),
            patch_rebound_angle_rad: after_m_per_s.atan2(rebound_m_per_s),
            centre_e_t: centre_before.map(|_| centre_after_m_per_s / centre_m_per_s),
            centre_impact_angle_rad: centre_m_per_s.atan2(*normal_m_per_s),
            centre_rebound_angle_rad: centre_after_m_per_s.atan2(rebound_m_per_s),
            impulse_ratio: alpha * (tangential_m_per_s - after_m_per_s).abs()
                / ((1.0 + eps_n) * normal_m_per_s),
        }
    }
}
