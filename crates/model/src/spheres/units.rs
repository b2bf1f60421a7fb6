//! The scaled units of an impact.

use stickslip_contact::{Damping, Law, Normal};

/// The units of an impact: of time in s, and of length in m.
pub(super) struct Units {
    law: Law,
    /// The elastic constant over the effective mass.
    beta: f64,
    /// β^{−2/5} g_n^{−1/5} for Hertz' force, β^{−1/2} for a linear one.
    pub time: f64,
    /// g_n times that.
    pub length: f64,
}

impl Units {
    /// The units under a law with β, the elastic constant over the effective mass.
    pub fn new(law: Law, beta: f64, normal_m_per_s: f64) -> Self {
        let time = match law.normal {
            Normal::Hertz | Normal::Dmt | Normal::Jkr => {
                1.0 / (beta.powf(0.4) * normal_m_per_s.powf(0.2))
            }
            Normal::Linear => 1.0 / beta.sqrt(),
        };
        Self { law, beta, time, length: normal_m_per_s * time }
    }

    /// The scaled damping a of a damping time in s, to which it is proportional; of a hysteretic
    /// force, of k₂/k₁ − 1, or of its growth with the greatest overlap in 1/m, or of 1/v_y in s/m.
    pub fn damping(&self, damping_time_s: f64) -> f64 {
        let &Self { law, beta, time, length } = self;
        match (law.normal, law.damping) {
            (_, Damping::None) => 0.0,
            (_, Damping::Linear) => beta * damping_time_s * time,
            (Normal::Linear, Damping::Viscoelastic) => beta * damping_time_s * time * length.sqrt(),
            (_, Damping::Viscoelastic) => damping_time_s / time,
            (_, Damping::Hysteretic) => damping_time_s,
            (_, Damping::Yielding) => damping_time_s * length / time,
            (Normal::Linear, Damping::Hardening) => damping_time_s * length,
            (_, Damping::Hardening) => damping_time_s * 1.25_f64.powf(0.4) * length,
            (_, Damping::Tsuji) => beta * damping_time_s * time * length.sqrt().sqrt(),
        }
    }
}
