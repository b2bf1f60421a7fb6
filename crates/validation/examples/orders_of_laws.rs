//! The order of convergence of both methods by contact law.
//!
//! For every contact law that has a name, without damping and with damping 0.2 and tangential
//! damping 0.5, contacts with κ = 18 and 63 and ψ = 0.1, 0.2, … 1.9 are integrated in fixed steps
//! of s, with switches located. Contacts whose itinerary is another at ψ (1 ± 0.003) are left out,
//! since their errors are those of a graze. The truth is the exact solution where there is one,
//! otherwise Dormand–Prince 8(5,3) at a tolerance of 1e-15.
//!
//! Run with `cargo run --release -p validation --example orders_of_laws -- [PART]`; with PART only
//! laws whose names contain it.

use std::error::Error;

use rayon::prelude::*;
use stickslip::model::{
    Collider, Collision, CollisionError, Contact, Damping, Engine, Law, linear, presets,
};
use stickslip::solver::method::{Order, fit_order};
use stickslip::solver::{EmbeddedPair, Options, StepSize};

/// Steps in an octave.
const PER_OCTAVE: i32 = 4;
/// The coarsest step.
const COARSEST: f64 = 0.25;

fn main() -> Result<(), Box<dyn Error>> {
    let part = std::env::args().nth(1).unwrap_or_default();
    println!("law, a: contacts | truth | dopri5: order of w, of switch times (steps) | dop853");
    let mut seen = Vec::new();
    for preset in presets::ALL.iter().filter(|preset| preset.name.contains(&part)) {
        for (damping, tangential) in [(0.0, 0.0), (0.2, 0.5)] {
            let law = preset.law;
            if seen.contains(&(law, damping)) || (damping > 0.0 && law.damping == Damping::None) {
                continue;
            }
            seen.push((law, damping));
            let truth = references(law, damping, tangential)?;
            let exact = truth.iter().all(|truth| has_exact(&truth.contact));
            let [dopri5, dop853] = EmbeddedPair::ALL.map(|pair| orders(pair, &truth));
            let kind = if exact { "exact" } else { "dop853" };
            println!("{}, {damping}: {} | {kind} | {dopri5} | {dop853}", preset.name, truth.len());
        }
    }
    Ok(())
}

fn has_exact(contact: &Contact) -> bool {
    linear::solves(contact) || (contact.obeys_paper() && contact.damping() == 0.0)
}

/// The true collisions of a law whose itineraries do not change nearby.
fn references(law: Law, damping: f64, tangential: f64) -> Result<Vec<Collision>, Box<dyn Error>> {
    let mut kept = Vec::new();
    for kappa in [18.0, 63.0] {
        for tenths in 1..20 {
            let at = |part: f64| -> Result<Collision, Box<dyn Error>> {
                let psi = part * f64::from(tenths) / 10.0;
                let contact = Contact::new(kappa, psi, damping)?.with_law(law, tangential)?;
                Ok(truth(contact)?)
            };
            let [below, on, above] = [at(0.997)?, at(1.0)?, at(1.003)?];
            let itinerary = on.itinerary();
            if [below, above].iter().all(|beside| beside.itinerary() == itinerary) {
                kept.push(on);
            }
        }
    }
    Ok(kept)
}

fn truth(contact: Contact) -> Result<Collision, CollisionError> {
    if has_exact(&contact) {
        Ok(Engine::Exact.collide(contact)?.0)
    } else {
        Ok(Collider::with_tolerances(EmbeddedPair::Dop853, 1e-15, 1e-15).collide(contact)?)
    }
}

/// The errors in steps of one size: root mean squares of w and of the times of switches; NaN where
/// switches are others.
fn errors(pair: EmbeddedPair, step: f64, truth: &[Collision]) -> [f64; 2] {
    let options = Options { step_size: StepSize::Fixed(step), ..Options::default() };
    let collider = Collider::unrefined(pair, options);
    let (mut velocities, mut times) = (Vec::new(), Vec::new());
    for truth in truth {
        let found = match collider.collide(truth.contact) {
            Ok(found) if found.itinerary() == truth.itinerary() => found,
            other => {
                if std::env::var_os("VERBOSE").is_some() {
                    let other = other.map(|found| found.itinerary());
                    let (contact, itinerary) = (truth.contact, truth.itinerary());
                    let (kappa, psi) = (contact.kappa(), contact.psi());
                    println!("    {step:.3e}: {other:?} for {itinerary} at κ {kappa} ψ {psi}");
                }
                return [f64::NAN; 2];
            }
        };
        velocities.push(found.final_velocity - truth.final_velocity);
        let pairs = found.switches.iter().zip(&truth.switches);
        times.extend(pairs.map(|(found, truth)| found.time - truth.time));
    }
    [velocities, times].map(|errors| {
        (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt()
    })
}

fn orders(pair: EmbeddedPair, truth: &[Collision]) -> String {
    let octaves = if pair == EmbeddedPair::Dop853 { 7 } else { 10 };
    let steps: Vec<_> = (0..=octaves * PER_OCTAVE)
        .map(|i| COARSEST * 0.5_f64.powf(f64::from(i) / f64::from(PER_OCTAVE)))
        .collect();
    let errors: Vec<_> = steps.par_iter().map(|step| errors(pair, *step, truth)).collect();
    if std::env::var_os("VERBOSE").is_some() {
        for (step, errors) in steps.iter().zip(&errors) {
            println!("    {step:.3e} {:.2e} {:.2e}", errors[0], errors[1]);
        }
    }
    let fit = |which: usize| {
        let series: Vec<_> = steps.iter().zip(&errors).map(|(h, e)| (*h, e[which])).collect();
        match fit_order(&series, 4.0) {
            Some(Order { order, standard_error, coarsest, finest, .. }) => {
                format!("{order:.2} ± {standard_error:.2} ({coarsest:.0e} to {finest:.0e})")
            }
            None => "none".to_owned(),
        }
    };
    format!("{}, {}", fit(0), fit(1))
}
