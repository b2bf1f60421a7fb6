//! Statements on the course of a collision: 19, 22.

use std::f64::consts::{FRAC_PI_2, TAU};

use stickslip_model::{Collision, Regime};
use stickslip_studies::paper::{RATIO_6, Reading, STIFFNESS, STIFFNESS_6, psi, ratio};
use stickslip_studies::search::maximum;

use super::statement::{Evidence, StatementFinding, StatementVerdict, Stop};
use super::statement::{digits, each, geometric};
use super::subject::Subject;
use crate::error::ReproductionError;

/// 19: the course of Fig. 6.
pub fn figure_6(subject: &Subject) -> Result<StatementFinding, Stop> {
    /// What counts as many, and as shortly after 1.
    const MANY: usize = 5;
    const SHORTLY: f64 = 1.1;
    let kappas = Reading::kappas(STIFFNESS_6);
    let mut evidence = Evidence::default();
    let mut matches = [false; 2];
    let mut sentences = Vec::new();
    for (kappa, matches) in kappas.into_iter().zip(&mut matches) {
        let collision = subject.collide(kappa, psi(RATIO_6), 0.0)?;
        let sliding = collision.itinerary().bytes().filter(|&phase| phase != b'o').count();
        let minimum = first_minimum(&collision).unwrap_or(f64::NAN);
        let switches = collision.switches.len();
        evidence = evidence
            .count(format!("switches at κ = {kappa}"), switches)
            .count(format!("sliding episodes at κ = {kappa}"), sliding)
            .number(format!("time of the first minimum of the velocity at {kappa}"), minimum);
        *matches = sliding >= MANY && minimum > 1.0 && minimum < SHORTLY;
        sentences.push(format!(
            "At κ = {kappa} there are {switches} switches, {sliding} sliding episodes, and the \
             velocity has its first minimum at t = {minimum:.4}. "
        ));
    }
    let explanation = format!(
        "{}Many is taken as {MANY} episodes or more, and shortly after 1 as up to {SHORTLY}. At \
         {STIFFNESS_6}/α = {} the axis of the figure is read as ακ.",
        sentences.concat(),
        kappas[1]
    );
    Ok(StatementFinding::by_reading(matches, evidence, explanation))
}

/// The first moment at which the tangential force turns from braking to driving. There y falls
/// through 0, which is possible only while sticking.
fn first_minimum(collision: &Collision) -> Option<f64> {
    let omega = collision.contact.kappa().sqrt();
    collision.switches.windows(2).find_map(|pair| {
        let (from, to) = (pair[0], pair[1]);
        // y = A cos(ωτ − δ) falls through 0 where ωτ − δ = π/2.
        let delta = (from.velocity / omega).atan2(from.spring);
        let after = (delta + FRAC_PI_2).rem_euclid(TAU) / omega;
        (from.to == Regime::Stick && from.time + after < to.time).then_some(from.time + after)
    })
}

/// 22: the elongation at the first switch grows as the ratio falls.
pub fn first_elongation(subject: &Subject) -> Result<StatementFinding, Stop> {
    const LOWEST: f64 = 0.01;
    const HIGHEST: f64 = 1.999;
    const SAMPLES: usize = 2000;
    let mut evidence = Evidence::default();
    let mut places = Vec::new();
    let mut exceptions = 0;
    for kappa in Reading::kappas(STIFFNESS) {
        let force = |psi: f64| -> Result<f64, ReproductionError> {
            let collision = subject.collide(kappa, psi, 0.0)?;
            Ok(collision.switches.first().map_or(0.0, |first| kappa * first.spring.abs()))
        };
        let samples: Vec<f64> = geometric(LOWEST, HIGHEST, SAMPLES).collect();
        let peak = maximum(&samples, force)?;
        let forces = each(&samples, |&psi| force(psi))?;
        let grows = |i: usize| forces[i] >= forces[i + 1];
        // Two samples on both sides of the peak may do either.
        let expected = |i: usize| match (samples[i] >= peak.at, samples[i + 1] <= peak.at) {
            (true, _) => grows(i),
            (_, true) => !grows(i),
            _ => true,
        };
        exceptions += (0..SAMPLES - 1).filter(|&i| !expected(i)).count();
        evidence = evidence
            .number(format!("ψ of the largest elongation at κ = {kappa}"), peak.at)
            .number(format!("κ times that elongation at {kappa}"), peak.value);
        places.push(peak.at);
    }
    let evidence = evidence
        .count("ψ sampled at each κ", SAMPLES)
        .count("neighbours that do not grow above and fall below the largest", exceptions);
    let lowest = places.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = places.iter().copied().fold(0.0, f64::max);
    let explanation = format!(
        "As ψ falls, the elongation at the first switch grows down to ψ = {} at κ = {STIFFNESS} and \
         {} at {STIFFNESS}/α, where the first switch comes at the largest compression, and shrinks \
         below. Of {SAMPLES} ψ from {LOWEST} to {HIGHEST} at each κ, {exceptions} neighbours say \
         otherwise.",
        digits(places[0], 7),
        digits(places[1], 7)
    );
    if exceptions > 0 {
        return Ok(StatementFinding::new(StatementVerdict::DoesNotHold, evidence, explanation));
    }
    if highest < 2.0 * LOWEST {
        return Ok(StatementFinding::new(StatementVerdict::Holds, evidence, explanation));
    }
    if lowest > 0.99 * HIGHEST {
        return Ok(StatementFinding::new(StatementVerdict::DoesNotHold, evidence, explanation));
    }
    let [highest, ratio] = [highest, ratio(highest)].map(|value| digits(value, 4));
    let condition = format!("above ψ = {highest}, that is g_t/g_n = {ratio} in the figures");
    Ok(StatementFinding::under(condition, evidence, explanation))
}
