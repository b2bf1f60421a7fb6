//! The study as tables.

use super::Measurement;
use super::limit::BOUND_FACTOR;
use super::points::{Measured, Restitution};
use super::profile::{Compared, Converged, Place};
use crate::study::Cell::{Count, Number, Text};
use crate::study::{Cell, Column, Table};

impl Measurement {
    pub fn tables(&self) -> Vec<Table> {
        let points = || self.points.iter().flatten();
        let peak = self.peak.velocity;
        let Self { profile, restitutions, .. } = self;
        vec![
            Table {
                name: "asymptote_envelope",
                title: "The largest |w_final| of the oscillation around each ψ".to_owned(),
                columns: ENVELOPE.to_vec(),
                rows: points().map(|point| envelope(point, peak)).collect(),
            },
            Table {
                name: "asymptote_restitution",
                title: "The largest |ε_t| from some ψ up to 2".to_owned(),
                columns: RESTITUTION.to_vec(),
                rows: restitutions.iter().flatten().map(restitution).collect(),
            },
            Table {
                name: "asymptote_counts",
                title: "The number of switches".to_owned(),
                columns: COUNTS.to_vec(),
                rows: points().map(counts).collect(),
            },
            Table {
                name: "asymptote_profile",
                title: "F(phase) of the inner problem".to_owned(),
                columns: PROFILE.to_vec(),
                rows: profile.curve.iter().map(place).collect(),
            },
            Table {
                name: "asymptote_collisions",
                title: "Full collisions over one oscillation beside F(phase)".to_owned(),
                columns: COLLISIONS.to_vec(),
                rows: profile.compared.iter().flatten().map(compared).collect(),
            },
            Table {
                name: "asymptote_convergence",
                title: "How F(phase) converges with the start and the coefficients of the phase"
                    .to_owned(),
                columns: CONVERGENCE.to_vec(),
                rows: profile.convergence.iter().map(converged).collect(),
            },
        ]
    }
}

const fn column(name: &'static str, meaning: &'static str) -> Column {
    Column { name, meaning }
}

const KAPPA: Column = column("kappa", "scaled stiffness κ");

const ENVELOPE: [Column; 11] = [
    KAPPA,
    column("psi", "impact ratio ψ that was asked for"),
    column("psi_largest", "ψ of the top of the oscillation around it"),
    column("w_final", "|w_final| there"),
    column("w_integrated", "the same by dop853"),
    column("w_scaled", "κ^{5/4} |w_final|"),
    column("w_theory", "F κ^{−5/4} with the largest F of the inner problem"),
    column("bound_printed", "1/√κ, the bound (27) as printed"),
    column("bound_corrected", "(5/4)^{3/5}/√κ"),
    column("last_onset", "√κ · (time left where the last stick phase starts)"),
    column("switch_count", "number of switches"),
];

fn envelope(point: &Measured, peak: f64) -> Vec<Cell> {
    let Measured { kappa, psi, crest, integrated, .. } = point;
    let bound = kappa.sqrt().recip();
    let numbers = [
        *kappa,
        *psi,
        crest.psi,
        crest.velocity,
        *integrated,
        point.scaled(),
        peak * kappa.powf(-1.25),
        bound,
        BOUND_FACTOR * bound,
        crest.last_onset,
    ];
    let count = Count(crest.switch_count as u64);
    numbers.into_iter().map(Number).chain([count]).collect()
}

const RESTITUTION: [Column; 6] = [
    KAPPA,
    column("range", "where the range of ψ starts, in words"),
    column("psi_lowest", "where it starts"),
    column("psi_largest", "ψ of the largest |ε_t|"),
    column("eps_t", "the largest |ε_t|"),
    column("bound_printed", "1/(ψ√κ) where the range starts, the bound (27) as printed"),
];

fn restitution(found: &Restitution) -> Vec<Cell> {
    let Restitution { kappa, from, lowest, largest } = found;
    let place = largest.map_or(f64::NAN, |crest| crest.psi);
    let bound = 1.0 / (lowest * kappa.sqrt());
    let [eps_t, place, bound] = [found.eps_t(), place, bound].map(Number);
    vec![Number(*kappa), Text(from.name()), Number(*lowest), place, eps_t, bound]
}

const COUNTS: [Column; 5] = [
    KAPPA,
    column("psi", "impact ratio ψ"),
    column("switch_count", "number of switches"),
    column("ratio", "that number over √κ t_c/π"),
    column("ratio_expected", "2 min(t₁, t_c − t₁)/t_c, where t₁ is the time of the first switch"),
];

fn counts(point: &Measured) -> Vec<Cell> {
    vec![
        Number(point.kappa),
        Number(point.psi),
        Count(point.switch_count as u64),
        Number(point.count_ratio),
        Number(point.count_expected),
    ]
}

const PROFILE: [Column; 3] = [
    column("phase", "phase of the onsets, in half swings"),
    column("last_onset", "σ where the last stick phase starts"),
    column("f", "F, the final velocity"),
];

fn place(place: &Place) -> Vec<Cell> {
    [place.phase, place.last_onset, place.velocity].map(Number).to_vec()
}

const COLLISIONS: [Column; 6] = [
    KAPPA,
    column("psi", "impact ratio ψ"),
    column("phase", "phase of the last onset"),
    column("w_scaled", "κ^{5/4} |w_final|"),
    column("f", "F of the inner problem at that phase"),
    column(
        "phase_ahead",
        "phase less √κ/π · (time left at the first switch), to the nearest whole number",
    ),
];

fn compared(compared: &Compared) -> Vec<Cell> {
    let Compared { kappa, psi, phase, velocity, inner, ahead } = *compared;
    [kappa, psi, phase, velocity, inner, ahead].map(Number).to_vec()
}

const CONVERGENCE: [Column; 3] = [
    column("start", "σ at which orbits start"),
    column("coefficients", "coefficients of the phase's series"),
    column(
        "difference",
        "largest difference of F at 16 phases from that with start 100 and 15 coefficients",
    ),
];

fn converged(converged: &Converged) -> Vec<Cell> {
    let Converged { start, coefficients, difference } = *converged;
    vec![Number(start), Count(coefficients as u64), Number(difference)]
}
