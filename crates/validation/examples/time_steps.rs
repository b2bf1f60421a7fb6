//! Errors of time steps, against those of LAMMPS (tests/data/lammps_laws.json).
//!
//! For each law and step: median and largest of the root mean square over start phases of the error
//! of ε_t, and the largest relative difference of it, and of the worst error, from what LAMMPS' own
//! collisions have.
//!
//! Run with `cargo run --release -p validation --example time_steps`.

use std::collections::BTreeMap;
use std::error::Error;
use std::fs;

use serde_json::Value;
use stickslip::model::Engine;
use stickslip::plane::progress;
use stickslip_practice::time_steps::{self, TimeStepSettings};

#[path = "../../../tests/common/lammps.rs"]
#[expect(dead_code, reason = "contacts with adhesion are compared in the tests")]
mod lammps;

/// The steps for which LAMMPS' errors are known.
const STEPS: [(&str, f64); 4] = [("20", 20.0), ("50", 50.0), ("100", 100.0), ("200", 200.0)];

/// One case at one step.
struct Compared {
    /// The root mean square here.
    error: f64,
    /// Relative differences from LAMMPS of the root mean square and the worst error.
    differences: [f64; 2],
    /// Whether the difference is that of the two true values, and above 5 %.
    offset: bool,
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/lammps_laws.json");
    let file: Value = serde_json::from_str(&fs::read_to_string(path)?)?;
    let cases = file["cases"].as_array().ok_or("no cases")?;
    println!("law, t_c/dt: median, largest rms | largest difference of rms, of worst | by offset");
    let mut laws = BTreeMap::<(&str, usize), Vec<Compared>>::new();
    for case in cases {
        let law = case["law"].as_str().ok_or("no law")?;
        for (index, step) in STEPS.into_iter().enumerate() {
            laws.entry((law, index)).or_default().push(compared(case, step)?);
        }
    }
    for ((law, index), compared) in &laws {
        report(law, STEPS[*index].0, &compared.iter().collect::<Vec<_>>());
    }
    for (index, (name, _)) in STEPS.into_iter().enumerate() {
        let all = laws.iter().filter(|((_, at), _)| *at == index);
        report("all", name, &all.flat_map(|(_, compared)| compared).collect::<Vec<_>>());
    }
    Ok(())
}

fn compared(case: &Value, (name, steps): (&str, f64)) -> Result<Compared, Box<dyn Error>> {
    let number = |value: &Value| value.as_f64().ok_or("no number");
    let contact = lammps::contact(case);
    let settings = TimeStepSettings {
        contacts: vec![contact],
        steps_per_contact: vec![steps],
        ..TimeStepSettings::default()
    };
    let result = time_steps::run(&settings, progress::SILENT)?;
    let errors = result.rows[0].eps_t.ok_or("no errors")?;
    let expected = &case["time_step"][name];
    let (rms, worst) = (number(&expected["rms"])?, number(&expected["max"])?);
    let exact = Engine::Auto.collide(contact)?.0.eps_t();
    let between = (errors.root_mean_square - rms).abs();
    Ok(Compared {
        error: errors.root_mean_square,
        differences: [between / rms, (errors.worst.error - worst).abs() / worst],
        // Four digits are known of LAMMPS' errors.
        offset: between > 0.05 * rms
            && between <= (exact + number(&case["eps_t"])?).abs() + 5e-4 * rms,
    })
}

fn report(law: &str, steps: &str, compared: &[&Compared]) {
    let mut errors: Vec<f64> = compared.iter().map(|compared| compared.error).collect();
    errors.sort_by(f64::total_cmp);
    let others = || compared.iter().filter(|compared| !compared.offset);
    let largest = |at: usize| others().map(|it| it.differences[at]).fold(0.0, f64::max);
    println!(
        "{law}, {steps}: {:.4}, {:.4} | {:.4}, {:.4} | {}",
        errors[errors.len() / 2],
        errors[errors.len() - 1],
        largest(0),
        largest(1),
        compared.len() - others().count()
    );
}
