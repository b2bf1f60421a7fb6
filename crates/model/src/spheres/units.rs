//! The scaled units of an impact.

use stickslip_contact::{Damping, Law, Normal};

/// The units of an impact: of time in s, of length in m, and the scaled damping a of a damping time
/// of 1 s.
pub(super) struct Units {
    /// β^{−2/5} g_n^{−1/5} for Hertz' force, β^{−1/2} for a linear one.
    pub time: f64,
    /// g_n times that.
    pub length: f64,
    /// The scaled damping.
    pub damping_per_s: f64,
}

impl Units {
    /// The units under a law with β, the elastic constant over the effective mass.
    pub fn new(law: Law, beta: f64, normal_m_per_s: f64) -> Self {
        let time = match law.normal {
            Normal::Hertz => 1.0 / (beta.powf(0.4) * normal_m_per_s.powf(0.2)),
            Normal::Linear => 1.0 / beta.sqrt(),
        };
        let length = normal_m_per_s * time;
        let damping_per_s = match (law.normal, law.damping) {
            (_, Damping::None) => 0.0,
            (Normal::Hertz, Damping::Viscoelastic) => 1.0 / time,
            (_, Damping::Linear) => beta * time,
            (_, Damping::Viscoelastic) => beta * time * length.sqrt(),
            (_, Damping::Tsuji) => beta * time * length.sqrt().sqrt(),
        };
        Self { time, length, damping_per_s }
    }
}
