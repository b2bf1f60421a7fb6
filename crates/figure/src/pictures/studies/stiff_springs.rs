//! The pictures of the study of stiff springs.

use stickslip_model::text::number;
use stickslip_studies::stiff_springs::limit::BOUND_FACTOR;
use stickslip_studies::stiff_springs::{LargestVelocity, MOST_RESOLVED, StiffSprings};

use super::Picture;
use crate::canvas::panel::Scale;
use crate::canvas::shape::Stroke;
use crate::canvas::style::{BLUE, GREEN, INK, PURPLE, SKY, VERMILION};
use crate::canvas::svg::Svg;
use crate::pictures::chart::{self, ChartAxis, LineChart, Mark, Series, Shape};

/// Colours, and shapes that distinguish series without colours.
const MARKS: [Mark; 4] = [
    Mark { shape: Shape::Disc, colour: BLUE },
    Mark { shape: Shape::Ring, colour: VERMILION },
    Mark { shape: Shape::Cross, colour: GREEN },
    Mark { shape: Shape::Square, colour: PURPLE },
];

const THEORY: Stroke = Stroke::full(INK, 1.4);
const PRINTED: Stroke = Stroke { colour: VERMILION, width: 1.6, dashes: "7 4" };
const CORRECTED: Stroke = Stroke { colour: PURPLE, width: 1.6, dashes: "2 3" };
const SINGLE: Stroke = Stroke::full(SKY, 0.9);

/// Draws the pictures of a study: final velocities and their bounds, the distance from the limit, F
/// of the inner problem, and numbers of switches.
pub fn draw(study: &StiffSprings) -> Vec<Picture> {
    let picture = Picture::new;
    vec![
        picture("asymptote_envelope", &envelope_caption(study), envelope(study)),
        picture(
            "asymptote_correction",
            "The distance of κ^{5/4}|w_final| from the constant of the inner problem, and the \
             coefficient of the next order times κ^{−5/4}.",
            correction(study),
        ),
        picture(
            "asymptote_profile",
            "F(phase) of the inner problem, and full collisions over one oscillation.",
            profile(study),
        ),
        picture(
            "asymptote_counts",
            "The number of switches over √κ t_c/π, and 2 min(t₁, t_c − t₁)/t_c from the time t₁ \
             of the first switch.",
            counts(study),
        ),
    ]
}

fn envelope_caption(study: &StiffSprings) -> String {
    let (low, high) = kappas(study);
    let stops = if low < MOST_RESOLVED && MOST_RESOLVED < high {
        format!(
            " The curve of |w_final| at ψ = {} ends at κ = {MOST_RESOLVED}: beyond, its single \
             oscillations cannot be told apart, and only their tops are shown.",
            study.single_psi
        )
    } else {
        String::new()
    };
    format!(
        "The largest |w_final| of the oscillation around each ψ, the limit Fκ^{{−5/4}} of the \
         inner problem, and the bound (27) with and without its factor.{stops}"
    )
}

fn kappas(study: &StiffSprings) -> (f64, f64) {
    (study.kappas[0], study.kappas[study.kappas.len() - 1])
}

fn kappa_axis(study: &StiffSprings) -> ChartAxis<'static> {
    ChartAxis { name: "scaled stiffness κ", range: kappas(study), scale: Scale::Logarithmic }
}

fn envelope(study: &StiffSprings) -> Svg {
    let (low, high) = kappas(study);
    let power = |name: &str, factor: f64, power: f64, stroke| {
        let points = study.kappas.iter().map(|kappa| (*kappa, factor * kappa.powf(power)));
        line(name, points.collect(), stroke)
    };
    let limit = format!("limit {} κ^{{−5/4}}", number(study.peak.velocity, 7));
    let mut series = vec![
        line(&format!("|w_{{final}}| at ψ = {}", study.single_psi), study.single.clone(), SINGLE),
        power("bound (27) as printed, 1/√κ", 1.0, -0.5, PRINTED),
        power("bound with its factor, (5/4)^{3/5}/√κ", BOUND_FACTOR, -0.5, CORRECTED),
        power(&limit, study.peak.velocity, -1.25, THEORY),
    ];
    series.retain(|series| !series.points.is_empty());
    series.extend(around_each_psi(study, |largest| largest.crest.velocity));
    chart::draw(&LineChart {
        title: "Final velocity and its bounds for stiff springs",
        x: kappa_axis(study),
        y: ChartAxis {
            name: "|w_{final}| = ψ|ε_t|",
            range: (0.1 * study.peak.velocity * high.powf(-1.25), 2.0 / low.sqrt()),
            scale: Scale::Logarithmic,
        },
        series,
    })
}

fn correction(study: &StiffSprings) -> Svg {
    let (low, high) = kappas(study);
    let law = |kappa: f64| -study.peak.correction * kappa.powf(-1.25);
    let points = study.kappas.iter().map(|kappa| (*kappa, law(*kappa)));
    let name = format!("next order, {} κ^{{−5/4}}", number(-study.peak.correction, 6));
    let mut series = vec![line(&name, points.collect(), THEORY)];
    series.extend(around_each_psi(study, |largest| study.peak.velocity - largest.scaled()));
    chart::draw(&LineChart {
        title: "Distance of the largest final velocity from its limit",
        x: kappa_axis(study),
        y: ChartAxis {
            name: "F − κ^{5/4} |w_{final}|",
            range: (0.3 * law(high), 3.0 * law(low)),
            scale: Scale::Logarithmic,
        },
        series,
    })
}

/// Marks at `value` over κ, for each ψ.
fn around_each_psi(study: &StiffSprings, value: impl Fn(&LargestVelocity) -> f64) -> Vec<Series> {
    let all = study.velocities.iter().zip(MARKS);
    all.map(|(by_kappa, mark)| {
        let name = format!("largest around ψ = {}", by_kappa[0].psi);
        marks(&name, by_kappa.iter().map(|largest| (largest.kappa, value(largest))), mark)
    })
    .collect()
}

fn profile(study: &StiffSprings) -> Svg {
    let profile = &study.profile;
    let curve = profile.curve.iter().map(|point| (point.phase, point.velocity));
    let mut series = vec![line("inner problem", curve.collect(), THEORY)];
    for (collisions, mark) in profile.compared.iter().zip(MARKS) {
        let Some(first) = collisions.first() else { continue };
        let name = format!("κ = {}", number(first.kappa, 3));
        series.push(marks(&name, collisions.iter().map(|c| (c.phase, c.velocity)), mark));
    }
    chart::draw(&LineChart {
        title: "F(phase): the scaled final velocity of stiff collisions",
        x: ChartAxis {
            name: "phase φ of the last onset, in half swings",
            range: (profile.zero_phase - 1.0, profile.zero_phase),
            scale: Scale::Linear,
        },
        y: ChartAxis { name: "F = κ^{5/4} |w_{final}|", range: (0.0, 5.0), scale: Scale::Linear },
        series,
    })
}

fn counts(study: &StiffSprings) -> Svg {
    let mut series = Vec::new();
    for (by_kappa, mark) in study.velocities.iter().zip(MARKS) {
        let expected = by_kappa.iter().map(|found| (found.kappa, found.count_expected));
        let stroke = Stroke { colour: mark.colour, width: 1.2, dashes: "6 4" };
        series.push(line("", expected.collect(), stroke));
        let counts = by_kappa.iter().map(|found| (found.kappa, found.count_ratio));
        series.push(marks(&format!("ψ = {}", by_kappa[0].psi), counts, mark));
    }
    let ratios = study.velocities.iter().flatten().map(|found| found.count_ratio);
    let highest = ratios.fold(1.0, f64::max);
    chart::draw(&LineChart {
        title: "Number of switches over √κ t_c/π; dashed: 2 min(t_1, t_c − t_1)/t_c",
        x: kappa_axis(study),
        y: ChartAxis {
            name: "switches/(√κ t_c/π)",
            range: (0.0, 1.1 * highest),
            scale: Scale::Linear,
        },
        series,
    })
}

fn line(name: &str, points: Vec<(f64, f64)>, stroke: Stroke) -> Series {
    Series { name: name.to_owned(), points, line: Some(stroke), mark: None }
}

fn marks(name: &str, points: impl Iterator<Item = (f64, f64)>, mark: Mark) -> Series {
    Series { name: name.to_owned(), points: points.collect(), line: None, mark: Some(mark) }
}
