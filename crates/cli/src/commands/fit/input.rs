//! The input of a particle code that a fit makes.

use stickslip_practice::fit::{Fit, FitError, FittedBodies};
use stickslip_practice::inputs::{self, Code};
use stickslip_practice::time_steps::{self, TimeStepSettings};

use crate::error::Failure;
use crate::shared::threads::ThreadsArguments;

/// The angles from the normal, in degrees, of the impacts whose errors are told.
const ANGLES: [f64; 8] = [10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0];
/// Steps in the undamped contact time.
const STEPS: [f64; 4] = [20.0, 50.0, 100.0, 200.0];

/// The lines with which `code` computes the contacts of the best fit, with the errors of its time
/// steps as comments.
pub fn of(
    fit: &Fit,
    bodies: &FittedBodies,
    code: Code,
    threads: ThreadsArguments,
) -> Result<String, Failure> {
    let pair = fit.best_pair(bodies)?;
    let (Some(pair), Some(speed)) = (pair, fit.speed_m_per_s) else {
        let reason = "--write needs constants in SI units; expected with --bodies";
        return Err(Failure::Usage(reason.to_owned()));
    };
    let lines = inputs::lines(code, &pair).map_err(Failure::Usage)?;
    let impacts = ANGLES.map(|angle| {
        let (sine, cosine) = angle.to_radians().sin_cos();
        pair.impact(speed * cosine, speed * sine)
    });
    let impacts: Vec<_> = impacts.into_iter().collect::<Result<_, _>>().map_err(FitError::from)?;
    let unit = impacts[0].time_unit_s * time_steps::undamped_contact_time(pair.law);
    let settings = TimeStepSettings {
        contacts: impacts.iter().map(|impact| impact.contact).collect(),
        steps_per_contact: STEPS.to_vec(),
        ..TimeStepSettings::default()
    };
    let errors = threads.with_steps(|report| time_steps::run(&settings, report))??;
    let comment = match code {
        Code::Lammps | Code::Liggghts | Code::Yade => "#",
        Code::Mfix => "!",
        Code::Mercury => "//",
    };
    let mut told = vec![
        format!(
            "effective mass {:?} kg, effective radius {:?} m, in SI units",
            pair.effective_mass_kg, pair.effective_radius_m
        ),
        format!("errors of eps_t in steps of LAMMPS, {speed} m/s at 10 to 80 degrees:"),
    ];
    for row in &errors.rows {
        let step = unit / row.steps_per_contact;
        let Some(eps_t) = &row.eps_t else { continue };
        told.push(format!(
            "dt = {step:.4e} s (t_c/{}): median {:.1e}, largest {:.1e}",
            row.steps_per_contact, eps_t.median, eps_t.worst.error
        ));
    }
    let told: Vec<_> = told.iter().map(|line| format!("{comment} {line}")).collect();
    Ok(told.join("\n") + "\n" + &lines)
}
