//! The study as tables.

use super::StiffSprings;
use super::limit::BOUND_FACTOR;
use super::maxima::{LargestRestitution, LargestVelocity};
use super::profile::{ComparedCollision, CurvePoint, OtherStart};
use crate::study::Cell::Number;
use crate::study::{Cell, StudyColumn, StudyTable};

impl StiffSprings {
    pub(super) fn tables(&self) -> Vec<StudyTable> {
        let velocities = || self.velocities.iter().flatten();
        let peak = self.peak.velocity;
        let Self { profile, restitutions, .. } = self;
        let table = |name, title: &str, columns: &[StudyColumn], rows| {
            let (title, columns) = (title.to_owned(), columns.to_vec());
            StudyTable { name, title, columns, rows }
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

const KAPPA: StudyColumn = StudyColumn::new("kappa", "scaled stiffness κ");
const PSI: StudyColumn = StudyColumn::new("psi", "impact ratio ψ");

const ENVELOPE: [StudyColumn; 11] = [
    KAPPA,
    StudyColumn::new("psi", "impact ratio ψ that was asked for"),
    StudyColumn::new("psi_largest", "ψ of the top of the oscillation around it"),
    StudyColumn::new("w_final", "|w_final| at this top"),
    StudyColumn::new("w_integrated", "the same by dop853"),
    StudyColumn::new("w_scaled", "κ^{5/4} |w_final|"),
    StudyColumn::new("w_theory", "F κ^{−5/4} with the largest F of the inner problem"),
    StudyColumn::new("bound_printed", "1/√κ, the bound (27) as printed"),
    StudyColumn::new("bound_corrected", "(5/4)^{3/5}/√κ"),
    StudyColumn::new("last_onset", "√κ · (time left where the last stick phase starts)"),
    StudyColumn::new("switch_count", "number of switches"),
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

const RESTITUTION: [StudyColumn; 6] = [
    KAPPA,
    StudyColumn::new("range", "where the range of ψ starts, as a formula"),
    StudyColumn::new("psi_lowest", "ψ at which the range starts"),
    StudyColumn::new("psi_largest", "ψ of the largest |ε_t|"),
    StudyColumn::new("eps_t", "the largest |ε_t|"),
    StudyColumn::new("bound_printed", "1/(ψ√κ) where the range starts, the bound (27) as printed"),
];

fn restitution(found: &LargestRestitution) -> Vec<Cell> {
    let LargestRestitution { kappa, start, lowest, largest } = found;
    let psi = largest.map_or(f64::NAN, |crest| crest.psi);
    let bound = 1.0 / (lowest * kappa.sqrt());
    let [psi, eps_t, bound] = [psi, found.eps_t(), bound].map(Number);
    vec![Number(*kappa), start.name().into(), Number(*lowest), psi, eps_t, bound]
}

const COUNTS: [StudyColumn; 5] = [
    KAPPA,
    PSI,
    StudyColumn::new("switch_count", "number of switches"),
    StudyColumn::new("ratio", "this number over √κ t_c/π"),
    StudyColumn::new(
        "ratio_expected",
        "2 min(t₁, t_c − t₁)/t_c, where t₁ is the time of the first switch",
    ),
];

fn counts(point: &LargestVelocity) -> Vec<Cell> {
    let LargestVelocity { kappa, psi, switch_count, count_ratio, count_expected, .. } = *point;
    vec![kappa.into(), psi.into(), switch_count.into(), count_ratio.into(), count_expected.into()]
}

const PROFILE: [StudyColumn; 3] = [
    StudyColumn::new("phase", "phase of the onsets, in half swings"),
    StudyColumn::new("last_onset", "σ where the last stick phase starts"),
    StudyColumn::new("f", "F, the final velocity"),
];

fn curve_point(point: &CurvePoint) -> Vec<Cell> {
    [point.phase, point.last_onset, point.velocity].map(Number).to_vec()
}

const COLLISIONS: [StudyColumn; 6] = [
    KAPPA,
    PSI,
    StudyColumn::new("phase", "phase of the last onset"),
    StudyColumn::new("w_scaled", "κ^{5/4} |w_final|"),
    StudyColumn::new("f", "F of the inner problem at this phase"),
    StudyColumn::new(
        "phase_ahead",
        "phase minus √κ/π · (time left at the first switch), to the nearest whole number",
    ),
];

fn compared(compared: &ComparedCollision) -> Vec<Cell> {
    let ComparedCollision { kappa, psi, phase, velocity, inner, ahead } = *compared;
    [kappa, psi, phase, velocity, inner, ahead].map(Number).to_vec()
}

const CONVERGENCE: [StudyColumn; 3] = [
    StudyColumn::new("start", "σ at which orbits start"),
    StudyColumn::new("coefficients", "coefficients of the series of the phase"),
    StudyColumn::new(
        "difference",
        "largest difference of F at 16 phases from F with start 100 and 15 coefficients",
    ),
];

fn other_start(other: &OtherStart) -> Vec<Cell> {
    let OtherStart { start, coefficients, difference } = *other;
    vec![start.into(), coefficients.into(), difference.into()]
}
