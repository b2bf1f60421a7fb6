//! F(phase) of the inner problem, full collisions beside it, and how it converges.

use std::f64::consts::PI;

use stickslip_model::exact;
use stickslip_model::limits::inner;

use super::StiffSpringSettings;
use super::limit::{self, contact};
use crate::error::StudyError;

/// Stiffnesses at which collisions are compared, if they are within the interval of the study.
const COMPARED: [f64; 3] = [1e4, 1e6, 1e8];
/// Collisions over one oscillation.
const COLLISIONS: u32 = 48;
/// Points of the curve.
const CURVE: u32 = 256;
/// Phases at which convergence is measured.
const PHASES: u32 = 16;

/// F over the phase, with everything that it is compared with.
#[derive(Clone, Debug)]
pub struct Profile {
    /// The phase at which F is largest, between the one at which F is 0 and 1 less.
    pub peak_phase: f64,
    /// The phase at which F is 0.
    pub zero_phase: f64,
    /// F over one oscillation.
    pub curve: Vec<CurvePoint>,
    /// Full collisions, by stiffness.
    pub compared: Vec<Vec<ComparedCollision>>,
    /// The ψ around which these collisions are.
    pub compared_psi: f64,
    /// How F converges with the start and the number of coefficients.
    pub convergence: Vec<OtherStart>,
}

/// A point of the curve F(phase).
#[derive(Clone, Copy, Debug)]
pub struct CurvePoint {
    /// The phase of the last onset.
    pub phase: f64,
    /// σ where the last stick phase starts.
    pub last_onset: f64,
    /// F.
    pub velocity: f64,
}

/// A full collision beside the curve.
#[derive(Clone, Copy, Debug)]
pub struct ComparedCollision {
    /// The stiffness.
    pub kappa: f64,
    /// The impact ratio.
    pub psi: f64,
    /// The phase of its last onset, in the range of the curve.
    pub phase: f64,
    /// κ^{5/4} |w_final|.
    pub velocity: f64,
    /// F at the same phase.
    pub inner: f64,
    /// By how much the phase is ahead of √κ/π · (time left at the first switch), to the nearest
    /// whole number.
    pub ahead: f64,
}

/// F computed from another start, or with fewer coefficients.
#[derive(Clone, Copy, Debug)]
pub struct OtherStart {
    /// σ where the recursion starts.
    pub start: f64,
    /// The number of coefficients of the expansion at the start.
    pub coefficients: usize,
    /// The largest difference from F.
    pub difference: f64,
}

impl Profile {
    pub(super) fn measure(settings: &StiffSpringSettings) -> Result<Self, StudyError> {
        // An onset at the end itself is not one; this close to the end F is 1e-13.
        let zero_phase = within(inner::phase(1e-30), 1.0);
        let nearest =
            settings.psi.iter().min_by(|a, b| (*a - 1.0).abs().total_cmp(&(*b - 1.0).abs()));
        let compared_psi = nearest.copied().unwrap_or(1.0);
        let inside = settings.kappa.low..=settings.kappa.high;
        let kappas = COMPARED.iter().filter(|kappa| inside.contains(kappa));
        let compared = kappas.map(|kappa| oscillation(*kappa, compared_psi, zero_phase));
        Ok(Self {
            peak_phase: within(inner::phase(inner::peak().onset), zero_phase),
            zero_phase,
            curve: (0..=CURVE).map(|i| point(zero_phase - 1.0 + spaced(i, CURVE))).collect(),
            compared: compared.collect::<Result<_, _>>()?,
            compared_psi,
            convergence: convergence(),
        })
    }
}

/// `phase` shifted by a whole number: above `top` − 1, at most `top`.
fn within(phase: f64, top: f64) -> f64 {
    phase - (phase - top).ceil()
}

fn spaced(index: u32, count: u32) -> f64 {
    f64::from(index) / f64::from(count)
}

fn point(phase: f64) -> CurvePoint {
    let last = inner::last_half_swing(phase);
    CurvePoint {
        phase,
        last_onset: last.onset,
        velocity: last.final_velocity().unwrap_or(f64::NAN),
    }
}

/// Collisions evenly spread over one oscillation around `psi`.
fn oscillation(
    kappa: f64,
    psi: f64,
    zero_phase: f64,
) -> Result<Vec<ComparedCollision>, StudyError> {
    let width = limit::oscillation(kappa, psi);
    let across = (0..COLLISIONS).map(|i| psi + width * (spaced(i, COLLISIONS) - 0.5));
    let inside = across.filter(|psi| *psi > 0.0 && *psi < 2.0);
    let collisions = inside.map(|psi| {
        let collision = exact::collide(contact(kappa, psi)?)?;
        let [first, .., stick, _] = &collision.switches[..] else { return Ok(None) };
        let onset = kappa.sqrt() * stick.time_left;
        let phase = inner::phase(onset);
        let ahead = phase - kappa.sqrt() * first.time_left / PI;
        let inner = point(phase).velocity;
        let velocity = collision.final_velocity.abs() * kappa.powf(1.25);
        let (phase, ahead) = (within(phase, zero_phase), ahead - ahead.round());
        Ok(Some(ComparedCollision { kappa, psi, phase, velocity, inner, ahead }))
    });
    collisions.filter_map(Result::transpose).collect()
}

fn convergence() -> Vec<OtherStart> {
    let starts = [10.0, 20.0, 30.0, 50.0, 70.0, 200.0, 500.0, 1000.0];
    let coefficients = [1, 3, 7, 15];
    let all = coefficients.iter().flat_map(|count| starts.map(|start| (*count, start)));
    all.map(|(coefficients, start)| {
        let differences = (0..PHASES).map(|i| {
            let phase = spaced(i, PHASES);
            let from = inner::last_half_swing_from(phase, start, coefficients);
            (from.final_velocity().unwrap_or(f64::NAN) - point(phase).velocity).abs()
        });
        OtherStart { start, coefficients, difference: differences.fold(0.0, f64::max) }
    })
    .collect()
}
