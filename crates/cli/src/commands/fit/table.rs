//! A fit as tables for readers.

use std::io::{self, Write};

use stickslip_model::Tangential;
use stickslip_practice::fit::{
    ConfidenceInterval, Fit, FittedCourse, Free, IntervalPiece, Measured, Mindlin, Minimum,
};

use crate::output::text::{aligned, number, pairs};

/// Writes `fit` as tables.
pub fn write(out: &mut dyn Write, fit: &Fit) -> io::Result<()> {
    let of_data = match fit.data {
        1 => "1 datum".to_owned(),
        count => format!("{count} data"),
    };
    writeln!(out, "Fit of {of_data}, law {}", fit.law.equations())?;
    match fit.speed_m_per_s {
        Some(speed) => {
            let speed = number(speed);
            writeln!(out, "κ and the damping are those of normal incidence at {speed} m/s")?;
        }
        None => writeln!(out, "κ and the damping are those of normal incidence")?,
    }
    let errors = if fit.estimated_errors { "estimated from the residuals" } else { "those given" };
    let first = &fit.minima[0].values;
    pairs(
        out,
        &[
            ("alpha", format!("{:.6}", fit.alpha)),
            ("damping", format!("{:.6}", first.damping)),
            ("eps_n", format!("{:.6}", fit.eps_n)),
            ("errors", errors.to_owned()),
        ],
    )?;
    writeln!(out, "\nMinima, the best one first")?;
    minima(out, fit)?;
    writeln!(out, "\nIntervals that hold the true value in {} of cases", fit.level)?;
    for interval in &fit.intervals {
        writeln!(out, "{}", line(fit, interval))?;
    }
    writeln!(out, "\nWhat the data decide")?;
    for interval in &fit.intervals {
        writeln!(out, "{}", interval.verdict())?;
    }
    if let Some(mindlin) = &fit.mindlin {
        writeln!(out, "\n{}", of_mindlin(fit, mindlin))?;
    }
    writeln!(out)?;
    residuals(out, fit)?;
    fit.course.as_ref().map_or(Ok(()), |course| boundaries(out, course))
}

fn minima(out: &mut dyn Write, fit: &Fit) -> io::Result<()> {
    let stiffness = stiffness_name(fit);
    let dashpot = fit.minima.iter().any(|minimum| minimum.values.tangential_damping != 0.0);
    let mut header = vec!["kappa".to_owned()];
    header.extend(fit.speed_m_per_s.map(|_| stiffness.to_owned()));
    header.push("mu".to_owned());
    header.extend(dashpot.then(|| "tangential_damping".to_owned()));
    header.push("misfit".to_owned());
    let squares = |minimum: &Minimum| minimum.root_mean_squares.clone();
    header
        .extend(squares(&fit.minima[0]).iter().map(|it| format!("rms {}", it.quantity.heading())));
    header.push(String::new());
    let rows = fit.minima.iter().map(|minimum| {
        let values = &minimum.values;
        let mut row = vec![format!("{:.6}", values.kappa)];
        row.extend(minimum.stiffness.map(|stiffness| format!("{stiffness:.6e}")));
        row.push(format!("{:.6}", values.mu));
        row.extend(dashpot.then(|| format!("{:.6}", values.tangential_damping)));
        row.push(format!("{:.6}", minimum.misfit));
        row.extend(squares(minimum).iter().map(|it| format!("{:.5}", it.quantity.shown(it.value))));
        row.push(if minimum.at_end_of_range { "at an end" } else { "" }.to_owned());
        row
    });
    columns(out, &std::iter::once(header).chain(rows).collect::<Vec<_>>())
}

/// Writes as many columns as there are, aligned to the right.
fn columns(out: &mut dyn Write, rows: &[Vec<String>]) -> io::Result<()> {
    let count = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..count).map(width).collect();
    for row in rows {
        let cells = row.iter().zip(&widths).map(|(cell, width)| format!("{cell:>width$}"));
        writeln!(out, "{}", cells.collect::<Vec<_>>().join("  ").trim_end())?;
    }
    Ok(())
}

fn stiffness_name(fit: &Fit) -> &'static str {
    match fit.law.tangential {
        Tangential::Constant => "k_t [kg/s²]",
        Tangential::Mindlin => "K [kg/(s² √m)]",
    }
}

/// The pieces of an interval, and of that of the stiffness in SI units.
fn line(fit: &Fit, interval: &ConfidenceInterval) -> String {
    let name = interval.parameter.name();
    let Some(pieces) = &interval.pieces else {
        return format!("{name}: none, since there are no more data than free numbers");
    };
    let ends = |unit: f64| {
        let piece = |piece: &IntervalPiece| {
            let IntervalPiece { low, high, from_end_of_range, to_end_of_range } = piece;
            let end = |is: &bool| if *is { " (end of range)" } else { "" };
            let shown = |value: f64| {
                if unit == 1.0 { format!("{value:.6}") } else { format!("{:.6e}", value / unit) }
            };
            let (from, to) = (end(from_end_of_range), end(to_end_of_range));
            format!("{}{from} to {}{to}", shown(*low), shown(*high))
        };
        pieces.iter().map(piece).collect::<Vec<_>>().join(" or ")
    };
    let in_si = fit.kappa_of_unit_stiffness.filter(|_| interval.parameter == Free::Kappa);
    let in_si = in_si.map(|unit| format!("\n{}: {}", stiffness_name(fit), ends(unit)));
    format!("{name}: {}{}", ends(1.0), in_si.unwrap_or_default())
}

fn of_mindlin(fit: &Fit, mindlin: &Mindlin) -> String {
    let best = &mindlin.best;
    let rms = |minimum: &Minimum| {
        let squares = minimum.root_mean_squares.iter();
        let squares = squares.filter(|it| it.quantity != Measured::EpsN);
        squares
            .map(|it| format!("{:.5}", it.quantity.shown(it.value)))
            .collect::<Vec<_>>()
            .join(", ")
    };
    let text = format!(
        "Mindlin's stiffness of the materials, κ = {:.6}: best μ = {:.6}, misfit {:.6}, rms {} \
         instead of {}",
        best.values.kappa,
        best.values.mu,
        best.misfit,
        rms(best),
        rms(&fit.minima[0])
    );
    match mindlin.excluded {
        Some(true) => format!("Warning: {text}; it is outside the interval of κ"),
        Some(false) => format!("{text}; it is in the interval of κ"),
        None => text,
    }
}

fn residuals(out: &mut dyn Write, fit: &Fit) -> io::Result<()> {
    let header = ["quantity", "line", "angle [°]", "measured", "error", "fit", "residual"];
    let rows = fit.residuals.iter().map(|residual| {
        let datum = &residual.datum;
        let shown = |value: f64| format!("{:.5}", datum.quantity.shown(value));
        [
            datum.quantity.heading().to_owned(),
            datum.row.to_string(),
            format!("{:.3}", datum.angle_rad().to_degrees()),
            shown(datum.value),
            datum.error.map_or_else(String::new, shown),
            shown(residual.predicted),
            shown(residual.residual),
        ]
    });
    let header = std::iter::once(header.map(str::to_owned));
    aligned(out, &header.chain(rows).collect::<Vec<_>>())
}

fn boundaries(out: &mut dyn Write, course: &FittedCourse) -> io::Result<()> {
    let [low, high] = [course.angles_rad.low, course.angles_rad.high].map(f64::to_degrees);
    writeln!(out, "\nSwitches of the best fit from {low:.3}° to {high:.3}°")?;
    if let Some(reason) = &course.untraced {
        return writeln!(out, "not traced: {reason}");
    }
    if course.boundaries.is_empty() {
        writeln!(out, "the same everywhere")?;
    } else {
        writeln!(out, "(a character a phase: + and - slip to either side, o stick)")?;
    }
    for boundary in &course.boundaries {
        let (angle, below, above) =
            (boundary.angle_rad.to_degrees(), &boundary.below, &boundary.above);
        writeln!(out, "{angle:.6}°: {below} below, {above} above")?;
    }
    if !course.resolved {
        writeln!(out, "In doubt: the tracer could not explain everything that it saw")?;
    }
    Ok(())
}
