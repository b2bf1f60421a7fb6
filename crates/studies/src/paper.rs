//! Facts of the paper: friction, inertia and axes of its figures, and the two readings of the axis
//! that they call κ.
//!
//! No other module has a number of its own for them.

use stickslip_model::Reduction;
use stickslip_model::spheres::Material;

/// Friction and inertia of all figures: μ = 0.4, homogeneous spheres.
pub const REDUCTION: Reduction = Reduction::HOMOGENEOUS;
/// Coefficient of friction μ of all figures.
pub const MU: f64 = REDUCTION.mu;
/// Tangential inertia α of all figures.
pub const ALPHA: f64 = REDUCTION.alpha;

/// The value on the axis of stiffness of the points a to o of Figure 4, and of Figure 5.
pub const STIFFNESS: f64 = 18.0;
/// The number of switches there as g_t/g_n falls, counted in the panels of Figure 5.
pub const SWITCHES: &str = "0 2 4 6 8 6 8 6 4 6 4 2 4 2 4 2";
/// The largest of these numbers.
pub const MOST_SWITCHES: usize = 8;
/// The end of the axis of stiffness in Figures 3 and 4.
pub const MOST_STIFFNESS: f64 = 20.0;
/// The largest velocities in Figure 2, in m/s.
pub const MOST_VELOCITY_M_PER_S: f64 = 200.0;
/// The end of the axis of ε_t in Figure 2.
pub const LEAST_EPS_T_2: f64 = -0.6;
/// The largest g_t/g_n in Figure 3.
pub const MOST_RATIO_3: f64 = 3.5;
/// The largest g_t/g_n in Figure 4.
pub const MOST_RATIO_4: f64 = 4.0;
/// The value on the axis of stiffness in Figure 6.
pub const STIFFNESS_6: f64 = 100.0;
/// The g_t/g_n of Figure 6.
pub const RATIO_6: f64 = 0.3;

/// The material of the steel spheres of Figure 2 and of footnote 2, whose Y = 210 MPa is a misprint
/// for GPa.
pub const STEEL: Material =
    Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3: 7850.0 };
/// The radius of these spheres.
pub const STEEL_RADIUS_M: f64 = 0.02;
/// Their tangential stiffness k_t.
pub const STEEL_STIFFNESS_KG_PER_S2: f64 = 1e12;

/// What the axis of stiffness of Figures 3 to 6 shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reading {
    /// κ of equation (24), as the axis is called.
    Printed,
    /// ακ, the reading with which the figures agree.
    Axis,
}

impl Reading {
    /// Both readings.
    pub const ALL: [Self; 2] = [Self::Printed, Self::Axis];

    /// The name of the reading in the names of files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Printed => "printed",
            Self::Axis => "axis",
        }
    }

    /// The quantity that the axis shows.
    pub fn axis(self) -> &'static str {
        match self {
            Self::Printed => "κ",
            Self::Axis => "ακ",
        }
    }

    /// The reading in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Printed => "axis read as κ of (24)",
            Self::Axis => "axis read as ακ",
        }
    }

    /// κ of equation (24) where the axis shows `value`.
    pub fn kappa(self, value: f64) -> f64 {
        match self {
            Self::Printed => value,
            Self::Axis => value / ALPHA,
        }
    }

    /// κ of equation (24) where the axis shows `value`, in both readings.
    pub fn kappas(value: f64) -> [f64; 2] {
        Self::ALL.map(|reading| reading.kappa(value))
    }
}

/// ψ at the impact ratio g_t/g_n.
pub fn psi(ratio: f64) -> f64 {
    REDUCTION.psi(ratio)
}

/// The impact ratio g_t/g_n at ψ.
pub fn ratio(psi: f64) -> f64 {
    REDUCTION.ratio(psi)
}
