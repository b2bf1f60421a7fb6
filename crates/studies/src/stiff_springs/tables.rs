//! The study as tables.

use super::StiffSprings;
use super::limit::BOUND_FACTOR;
use super::maxima::{LargestRestitution, LargestVelocity};
use super::profile::{ComparedCollision, CurvePoint, OtherStart};
use crate::study::Cell::Number;
use crate::study::{Cell, Column, Table};

impl StiffSprings {
    pub(super) fn tables(&self) -> Vec<Table> {
        let velocities = || self.velocities.iter().flatten();
        let peak = self.peak.velocity;
        let Self { profile, restitutions, .. } = self;
        let table = |name, title: &str, columns: &[Column], rows| {
            let (title, columns) = (title.to_owned(), columns.to_vec());
            Table { name, title, columns, rows }
        };
        vec![
            table(
                "asymptote_envelope",
                "The largest |w_final| of the oscillation around each ψ",
                &ENVELOPE,
                velocities().map(|largest| envelope(largest, peak)).collect(),
            ),
            table(
                "asymptote_restitution",
                "The largest |ε_t| from some ψ up to 2",
                &RESTITUTION,
                restitutions.iter().flatten().map(restitution).collect(),
            ),
            table(
                "asymptote_counts",
                "The number of switches",
                &COUNTS,
                velocities().map(counts).collect(),
            ),
            table(
                "asymptote_profile",
                "F(phase) of the inner problem",
                &PROFILE,
                profile.curve.iter().map(curve_point).collect(),
            ),
            table(
                "asymptote_collisions",
                "Full collisions over one oscillation beside F(phase)",
                &COLLISIONS,
                profile.compared.iter().flatten().map(compared).collect(),
            ),
            table(
                "asymptote_convergence",
                "How F(phase) converges with the start and the coefficients of the phase",
                &CONVERGENCE,
                profile.convergence.iter().map(other_start).collect(),
            ),
        ]
    }
}

const KAPPA: Column = Column::new("kappa", "scaled stiffness κ");
const PSI: Column = Column::new("psi", "impact ratio ψ");

const ENVELOPE: [Column; 11] = [
    KAPPA,
    Column::new("psi", "impact ratio ψ that was asked for"),
    Column::new("psi_largest", "ψ of the top of the oscillation around it"),
    Column::new("w_final", "|w_final| at this top"),
    Column::new("w_integrated", "the same by dop853"),
    Column::new("w_scaled", "κ^{5/4} |w_final|"),
    Column::new("w_theory", "F κ^{−5/4} with the largest F of the inner problem"),
    Column::new("bound_printed", "1/√κ, the bound (27) as printed"),
    Column::new("bound_corrected", "(5/4)^{3/5}/√κ"),
    Column::new("last_onset", "√κ · (time left where the last stick phase starts)"),
    Column::new("switch_count", "number of switches"),
];

fn envelope(largest: &LargestVelocity, peak: f64) -> Vec<Cell> {
    let LargestVelocity { kappa, psi, crest, integrated, .. } = largest;
    let bound = kappa.sqrt().recip();
    let numbers = [
        *kappa,
        *psi,
        crest.psi,
        crest.velocity,
        *integrated,
        largest.scaled(),
        peak * kappa.powf(-1.25),
        bound,
        BOUND_FACTOR * bound,
        crest.last_onset,
    ];
    numbers.into_iter().map(Number).chain([crest.switch_count.into()]).collect()
}

const RESTITUTION: [Column; 6] = [
    KAPPA,
    Column::new("range", "where the range of ψ starts, as a formula"),
    Column::new("psi_lowest", "ψ at which the range starts"),
    Column::new("psi_largest", "ψ of the largest |ε_t|"),
    Column::new("eps_t", "the largest |ε_t|"),
    Column::new("bound_printed", "1/(ψ√κ) where the range starts, the bound (27) as printed"),
];

fn restitution(found: &LargestRestitution) -> Vec<Cell> {
    let LargestRestitution { kappa, start, lowest, largest } = found;
    let psi = largest.map_or(f64::NAN, |crest| crest.psi);
    let bound = 1.0 / (lowest * kappa.sqrt());
    let [psi, eps_t, bound] = [psi, found.eps_t(), bound].map(Number);
    vec![Number(*kappa), start.name().into(), Number(*lowest), psi, eps_t, bound]
}

const COUNTS: [Column; 5] = [
    KAPPA,
    PSI,
    Column::new("switch_count", "number of switches"),
    Column::new("ratio", "this number over √κ t_c/π"),
    Column::new(
        "ratio_expected",
        "2 min(t₁, t_c − t₁)/t_c, where t₁ is the time of the first switch",
    ),
];

fn counts(point: &LargestVelocity) -> Vec<Cell> {
    let LargestVelocity { kappa, psi, switch_count, count_ratio, count_expected, .. } = *point;
    vec![kappa.into(), psi.into(), switch_count.into(), count_ratio.into(), count_expected.into()]
}

const PROFILE: [Column; 3] = [
    Column::new("phase", "phase of the onsets, in half swings"),
    Column::new("last_onset", "σ where the last stick phase starts"),
    Column::new("f", "F, the final velocity"),
];

fn curve_point(point: &CurvePoint) -> Vec<Cell> {
    [point.phase, point.last_onset, point.velocity].map(Number).to_vec()
}

const COLLISIONS: [Column; 6] = [
    KAPPA,
    PSI,
    Column::new("phase", "phase of the last onset"),
    Column::new("w_scaled", "κ^{5/4} |w_final|"),
    Column::new("f", "F of the inner problem at this phase"),
    Column::new(
        "phase_ahead",
        "phase minus √κ/π · (time left at the first switch), to the nearest whole number",
    ),
];

fn compared(compared: &ComparedCollision) -> Vec<Cell> {
    let ComparedCollision { kappa, psi, phase, velocity, inner, ahead } = *compared;
    [kappa, psi, phase, velocity, inner, ahead].map(Number).to_vec()
}

const CONVERGENCE: [Column; 3] = [
    Column::new("start", "σ at which orbits start"),
    Column::new("coefficients", "coefficients of the series of the phase"),
    Column::new(
        "difference",
        "largest difference of F at 16 phases from F with start 100 and 15 coefficients",
    ),
];

fn other_start(other: &OtherStart) -> Vec<Cell> {
    let OtherStart { start, coefficients, difference } = *other;
    vec![start.into(), coefficients.into(), difference.into()]
}
