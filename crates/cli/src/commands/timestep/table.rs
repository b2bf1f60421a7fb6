//! Errors of time steps as tables for readers.

use std::io::{self, Write};

use stickslip_model::Contact;
use stickslip_practice::time_steps::{
    Seconds, SteppedQuantity, TimeStepErrors, TimeStepRow, TimeSteps,
};

use crate::output::text::{aligned, pairs};

/// Writes the errors as tables.
///
/// # Errors
/// `out` cannot be written.
pub fn write(
    out: &mut dyn Write,
    result: &TimeSteps,
    seconds: Option<&Seconds>,
    wanted: Option<f64>,
) -> io::Result<()> {
    let phases = result.phases;
    write!(out, "Errors in time steps, scheme {}, {phases} start phases, ", result.scheme.name())?;
    if result.overlap > 0.0 {
        write!(out, "overlap {:?} of the distance of the centres, ", result.overlap)?;
    }
    match &result.contacts[..] {
        [contact] => writeln!(
            out,
            "1 impact: κ = {:?}, ψ = {:?}, damping a = {:?}",
            contact.kappa(),
            contact.psi(),
            contact.damping()
        )?,
        contacts => writeln!(out, "{} impacts", contacts.len())?,
    }
    if let Some(contact) = result.contacts.first().filter(|contact| !contact.obeys_paper()) {
        writeln!(out, "Law {}", contact.law().equations())?;
        writeln!(out, "Tangential damping b = {:?}", contact.tangential_damping())?;
    }
    let overturned = result.contacts.iter().filter(|it| it.start_layer().is_some()).count();
    if overturned > 0 {
        writeln!(
            out,
            "Badly conditioned: in {overturned} of the impacts the force is turned over at once, \
             which steps reach slowly"
        )?;
    }
    for quantity in SteppedQuantity::ALL {
        writeln!(out)?;
        let header = [name(quantity), "dt/t_c", "median", "rms", "largest", "κ", "ψ", "status"];
        let rows = result.rows.iter().map(|row| line(result, quantity, row));
        let header = std::iter::once(header.map(str::to_owned));
        aligned(out, &header.chain(rows).collect::<Vec<_>>())?;
    }
    if let Some(seconds) = seconds {
        in_seconds(out, seconds, result)?;
    }
    wanted.map_or(Ok(()), |wanted| largest(out, wanted, seconds, result))
}

fn name(quantity: SteppedQuantity) -> &'static str {
    match quantity {
        SteppedQuantity::TangentialRestitution => "ε_t",
        SteppedQuantity::NormalRestitution => "ε_n",
        SteppedQuantity::Energy => "energy",
    }
}

/// A row of a table: the errors, and the impact with the largest.
fn line(result: &TimeSteps, quantity: SteppedQuantity, row: &TimeStepRow) -> [String; 8] {
    let errors = row.errors(quantity);
    let number = |of: fn(TimeStepErrors) -> f64| {
        errors.map_or_else(|| "none".to_owned(), |errors| format!("{:.2e}", of(errors)))
    };
    let worst = errors.and_then(|errors| result.contacts.get(errors.worst.contact));
    let parameter = |value: Option<f64>| value.map_or_else(String::new, |it| format!("{it:.4}"));
    let status = match (row.unfinished, row.unstable) {
        (0, 0) => row.status.name().to_owned(),
        (0, count) | (count, _) => {
            let all = result.contacts.len() * result.phases;
            format!("{}: {count} of {all}", row.status.name())
        }
    };
    [
        format!("t_c/dt = {:?}", row.steps_per_contact),
        format!("{:.3e}", 1.0 / row.steps_per_contact),
        number(|errors| errors.median),
        number(|errors| errors.root_mean_square),
        number(|errors| errors.worst.error),
        parameter(worst.map(Contact::kappa)),
        parameter(worst.map(Contact::psi)),
        status,
    ]
}

fn in_seconds(out: &mut dyn Write, seconds: &Seconds, result: &TimeSteps) -> io::Result<()> {
    let Seconds { contact_time_s, rayleigh_time_s } = seconds;
    writeln!(out)?;
    pairs(
        out,
        &[
            ("undamped contact time t_c [s]", format!("{contact_time_s:.4e}")),
            ("Rayleigh time [s]", format!("{rayleigh_time_s:.4e}")),
        ],
    )?;
    writeln!(out)?;
    let header = ["", "dt [s]", "dt/Rayleigh time"].map(str::to_owned);
    let rows = result.rows.iter().map(|row| {
        let step = seconds.step_s(row.steps_per_contact);
        [
            format!("t_c/dt = {:?}", row.steps_per_contact),
            format!("{step:.4e}"),
            format!("{:.4}", step / rayleigh_time_s),
        ]
    });
    aligned(out, &std::iter::once(header).chain(rows).collect::<Vec<_>>())
}

fn largest(
    out: &mut dyn Write,
    wanted: f64,
    seconds: Option<&Seconds>,
    result: &TimeSteps,
) -> io::Result<()> {
    writeln!(
        out,
        "\nLargest dt/t_c of these with errors up to {wanted:?}, as at all shorter ones"
    )?;
    let lines = SteppedQuantity::ALL.map(|quantity| {
        let step = result.largest_step(quantity, wanted);
        let text = step.map_or_else(
            || "none".to_owned(),
            |step| {
                let in_seconds =
                    seconds.map(|it| format!(", dt = {:.4e} s", it.contact_time_s * step));
                format!("{step:?}{}", in_seconds.unwrap_or_default())
            },
        );
        (name(quantity), text)
    });
    pairs(out, &lines)
}
