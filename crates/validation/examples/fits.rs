//! Fits of contact laws: how often intervals hold the truth, and the measured impacts of
//! tests/data/oblique_impacts.json with every law.
//!
//! Run with `cargo run --release -p validation --example fits`; `-- coverage` and `-- laws` are its
//! two parts, and `-- laws 3` leaves out the first three laws.

use std::error::Error;
use std::time::Instant;

use rayon::prelude::*;
use stickslip::model::{Damping, Law, presets};
use stickslip::plane::{Range, progress};
use stickslip_practice::fit::{
    self, Datum, Fit, FitError, FitSettings, FittedBodies, Measured, Survey, Values,
};

#[allow(dead_code, reason = "the tests use more of it")]
#[path = "../../practice/tests/practice/oblique.rs"]
mod oblique;

/// Simulated experiments of each kind.
const SETS: usize = 1000;
/// Normal restitution, which neither experiment has.
const EPS_N: [f64; 2] = [1.0, 0.9];
/// The largest κ for laws that are integrated, without and with damping, which takes longest.
const INTEGRATED: [f64; 2] = [30.0, 10.0];

fn main() -> Result<(), Box<dyn Error>> {
    let part = std::env::args().nth(1);
    if part.as_deref() != Some("laws") {
        coverage()?;
    }
    if part.as_deref() != Some("coverage") {
        measured()?;
    }
    Ok(())
}

/// The measured impacts with every law. Laws without damping that differ in it only are one.
fn measured() -> Result<(), FitError> {
    println!(
        "law, data, ε_n: κ, μ, rms of e_t | pieces of κ | others with μ < 0.3, κ (rms) | seconds"
    );
    let skipped = std::env::args().nth(2).and_then(|count| count.parse().ok()).unwrap_or(0);
    for (law, names) in laws().into_iter().skip(skipped) {
        println!("{}", names.join(", "));
        let [alumina, benchmark] = [oblique::aluminium_oxide(law), oblique::benchmark(law)];
        for (name, (bodies, data)) in [("oxide", alumina), ("benchmark", benchmark)] {
            for eps_n in EPS_N {
                if law.damping == Damping::None && eps_n != 1.0 {
                    continue;
                }
                let start = Instant::now();
                let mut settings =
                    FitSettings { eps_n: Some(eps_n), ..FitSettings::new(bodies, data.clone()) };
                if !law.acts_as_paper(1.0 - eps_n, 0.0) {
                    settings.ranges.kappa.high = INTEGRATED[usize::from(eps_n < 1.0)];
                }
                let fit = Survey::new(&settings, progress::SILENT)?.fit()?;
                report((name, eps_n, start.elapsed().as_secs_f64()), &fit);
            }
        }
    }
    Ok(())
}

/// Every law that has a name, with its names.
fn laws() -> Vec<(Law, Vec<&'static str>)> {
    let mut laws: Vec<(Law, Vec<&'static str>)> = Vec::new();
    for preset in presets::ALL {
        match laws.iter_mut().find(|(law, _)| *law == preset.law) {
            Some((_, names)) => names.push(preset.name),
            None => laws.push((preset.law, vec![preset.name])),
        }
    }
    laws
}

fn report((name, eps_n, seconds): (&str, f64, f64), fit: &Fit) {
    let best = &fit.minima[0];
    let rms = |minimum: &fit::Minimum| minimum.root_mean_squares[0].value;
    let pieces = fit.intervals[0].pieces.iter().flatten();
    let pieces: Vec<_> =
        pieces.map(|piece| format!("{:.2} to {:.2}", piece.low, piece.high)).collect();
    let others = fit.minima[1..].iter().filter(|it| it.values.mu < 0.3 && !it.at_end_of_range);
    let others: Vec<_> = others
        .take(5)
        .map(|other| format!("{:.1} ({:.3})", other.values.kappa, rms(other)))
        .collect();
    println!(
        "  {name}, {eps_n}: {:.3}, {:.4}, {:.4} | {} | {} | {seconds:.0}",
        best.values.kappa,
        best.values.mu,
        rms(best),
        pieces.join(", "),
        others.join(", ")
    );
    if let Some(mindlin) = &fit.mindlin {
        let best = &mindlin.best;
        println!(
            "    Mindlin's κ = {:.3}: μ = {:.4}, rms {:.4}, excluded: {:?}",
            best.values.kappa,
            best.values.mu,
            rms(best),
            mindlin.excluded
        );
    }
}

/// A kind of simulated experiment.
struct Kind {
    name: &'static str,
    values: Values,
    quantity: Measured,
    angles_deg: &'static [f64],
    noise: f64,
    /// Whether the fit knows the noise.
    known: bool,
    level: f64,
    kappa: Range,
}

fn coverage() -> Result<(), FitError> {
    const ANGLES: &[f64] = &[5.0, 12.0, 20.0, 28.0, 36.0, 45.0, 60.0];
    let values = |kappa, mu| Values { kappa, mu, tangential_damping: 0.0, damping: 0.0 };
    let plain = Kind {
        name: "ε_t, known errors",
        values: values(6.0, 0.2),
        quantity: Measured::EpsT,
        angles_deg: ANGLES,
        noise: 0.02,
        known: true,
        level: 0.95,
        kappa: Range { low: 0.5, high: 40.0 },
    };
    let kinds = [
        Kind { name: "ε_t, known errors, level 0.68", level: 0.68, ..plain },
        Kind { name: "ε_t, estimated errors", known: false, ..plain },
        Kind { name: "ε_t, stiffer", values: values(25.0, 0.2), ..plain },
        Kind { name: "rebound angles", quantity: Measured::ReboundAngle, noise: 0.01, ..plain },
        Kind {
            name: "like the aluminium-oxide sphere",
            values: values(2.8666, 0.09368),
            quantity: Measured::CentreRestitution,
            angles_deg: &[2.03, 3.93, 9.63, 20.08, 30.22, 39.3, 49.55, 59.84],
            noise: 0.0325,
            known: false,
            kappa: Range { low: 0.1, high: 150.0 },
            ..plain
        },
        plain,
    ];
    println!(
        "{SETS} simulated experiments each: intervals that hold κ, μ; of several pieces; κ of the best within 20 %; seconds"
    );
    for kind in &kinds {
        simulate(kind)?;
    }
    Ok(())
}

fn simulate(kind: &Kind) -> Result<(), FitError> {
    let start = Instant::now();
    let Kind { values, quantity, noise, known, .. } = *kind;
    let bodies = FittedBodies::scaled(Law::PAPER, 2.0 / 7.0, &values)?;
    let angles: Vec<f64> = kind.angles_deg.iter().map(|angle| angle.to_radians()).collect();
    let exact = fit::predicted(&bodies, 1.0, quantity, &angles)?;
    let error = known.then_some(noise);
    let data = angles.iter().zip(&exact);
    let data = data.map(|(angle, value)| Datum::at_angle(*angle, 1.0, quantity, *value, error));
    let mut settings = FitSettings::new(bodies, data.collect());
    settings.ranges.kappa = kind.kappa;
    settings.level = kind.level;
    let survey = Survey::new(&settings, progress::SILENT)?;
    let fits = (0..SETS).into_par_iter().map(|set| {
        // Each set has numbers of its own, whatever the order.
        let mut random = fastrand::Rng::with_seed(20_261_124 + set as u64);
        let noisy = exact.iter().map(|value| value + noise * normal(&mut random));
        survey.fit_of(&noisy.collect::<Vec<f64>>())
    });
    let fits: Vec<Result<Fit, FitError>> = fits.collect();
    let fits: Vec<Fit> = fits.into_iter().collect::<Result<_, _>>()?;
    let count = |holds: &dyn Fn(&Fit) -> bool| fits.iter().filter(|fit| holds(fit)).count();
    println!(
        "{}: {}, {}; {}; {}; {:.0}",
        kind.name,
        count(&|fit| fit.intervals[0].holds(values.kappa) == Some(true)),
        count(&|fit| fit.intervals[1].holds(values.mu) == Some(true)),
        count(&|fit| fit.intervals[0].pieces.as_ref().is_some_and(|pieces| pieces.len() > 1)),
        count(&|fit| (fit.minima[0].values.kappa / values.kappa - 1.0).abs() < 0.2),
        start.elapsed().as_secs_f64()
    );
    Ok(())
}

/// A normal random number, by Box and Muller.
fn normal(random: &mut fastrand::Rng) -> f64 {
    let radius = (-2.0 * (1.0 - random.f64()).ln()).sqrt();
    radius * (std::f64::consts::TAU * random.f64()).cos()
}
