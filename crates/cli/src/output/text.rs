//! A collision as tables for readers, and the parts of which such tables are made.

use std::io::{self, Write};

use stickslip_model::{Collision, Contact, Engine, Estimate, Switch};
use stickslip_solver::Statistics;

/// The number of digits that are shown. `--format json` shows all of them.
const DIGITS: usize = 10;

/// What is said of bodies that stay together.
pub const ADHERES: &str = "The bodies stay together, held by adhesion: there is no restitution, and \
                           the following is up to where that is certain.";

/// Writes `collision` as tables.
pub fn write(
    out: &mut dyn Write,
    engine: &Engine,
    collision: &Collision,
    (estimate, statistics): (Option<&Estimate>, Option<&Statistics>),
) -> io::Result<()> {
    let contact = &collision.contact;
    writeln!(
        out,
        "Collision with κ = {:?}, ψ = {:?}, damping a = {:?}, by {}",
        contact.kappa(),
        contact.psi(),
        contact.damping(),
        describe(engine)
    )?;
    law(out, contact)?;
    writeln!(out)?;
    if collision.switches.is_empty() {
        writeln!(out, "No switch.")?;
    } else {
        let header = ["", "time", "time left", "to", "side", "spring y", "velocity w"];
        let rows = collision.switches.iter().enumerate().map(|(index, switch)| row(index, switch));
        aligned(out, &std::iter::once(header.map(str::to_owned)).chain(rows).collect::<Vec<_>>())?;
    }
    writeln!(out)?;
    let [end, time] = if collision.adheres {
        writeln!(out, "{ADHERES}\n")?;
        ["velocity w there", "time until then"]
    } else {
        ["velocity w at the end", "contact time"]
    };
    let restitution =
        |value: f64| if collision.adheres { "none".to_owned() } else { number(value) };
    pairs(
        out,
        &[
            ("normal restitution ε_n", restitution(collision.eps_n)),
            ("tangential restitution ε_t", restitution(collision.eps_t())),
            (end, number(collision.final_velocity)),
            (time, number(collision.contact_time)),
            ("switches", collision.switches.len().to_string()),
            ("reversals of the motion", collision.reversals.to_string()),
            ("itinerary", explained(&collision.itinerary())),
        ],
    )?;
    if let Some(Estimate { eps_t_error, distance, certain }) = estimate {
        writeln!(out)?;
        pairs(
            out,
            &[
                ("expected error of ε_t", format!("{eps_t_error:.1e}")),
                ("distance from other switches", format!("{distance:.1e}")),
                ("itinerary is certain", if *certain { "yes" } else { "no" }.to_owned()),
            ],
        )?;
    }
    energy(out, collision)?;
    if let Some(statistics) = statistics {
        work(out, statistics)?;
    }
    Ok(())
}

/// An itinerary with what its characters mean.
pub fn explained(itinerary: &str) -> String {
    format!("{itinerary}  (a character a phase: + and - slip to either side, o stick)")
}

/// The method of `engine` with its tolerances.
pub fn describe(engine: &Engine) -> String {
    match engine.tolerances() {
        Some(tolerances) => {
            format!("{} (rtol {:?}, atol {:?})", engine.name(), tolerances.rtol, tolerances.atol)
        }
        None => "the exact solution".to_owned(),
    }
}

/// Writes the contact law, if it is not the paper's.
pub fn law(out: &mut dyn Write, contact: &Contact) -> io::Result<()> {
    /// A start whose tangential force differs by less than this part from its limit is worth a
    /// line.
    const NEAR: f64 = 0.01;
    if !contact.obeys_paper() {
        writeln!(out, "Law {}", contact.law().equations())?;
        writeln!(out, "Tangential damping b = {:?}", contact.tangential_damping())?;
    }
    if let Some(margin) = contact.start_margin().filter(|margin| margin.abs() < NEAR) {
        writeln!(
            out,
            "Near the border of stick and slip at the start: 1 - force/limit = {margin:.3e}"
        )?;
    }
    if let Some(layer) = contact.start_layer() {
        writeln!(
            out,
            "Badly conditioned: in steps, the force is turned over only when the overlap is {layer:.3e} \
             times that of the first step"
        )?;
    }
    Ok(())
}

fn row(index: usize, switch: &Switch) -> [String; 7] {
    [
        index.to_string(),
        number(switch.time),
        number(switch.time_left),
        switch.to.to_string(),
        format!("{:+}", switch.side.sign()),
        number(switch.spring),
        number(switch.velocity),
    ]
}

fn energy(out: &mut dyn Write, collision: &Collision) -> io::Result<()> {
    let ledger = &collision.energy;
    let [taken, left] = if collision.contact.obeys_paper() {
        ["taken by sliding, damping", "left in spring, compression"]
    } else {
        ["taken by friction, damping", "lost to the spring, left in compression"]
    };
    writeln!(out)?;
    let dashpot = (ledger.tangential_damping != 0.0)
        .then(|| entry("taken by the tangential dashpot", ledger.tangential_damping, 0.0));
    let rows = [
        ["energy".to_owned(), "tangential".to_owned(), "normal".to_owned()],
        entry("at impact", ledger.tangential_initial, ledger.normal_initial),
        entry("motion at the end", ledger.tangential_final, ledger.normal_final),
        entry(taken, ledger.sliding, ledger.damping),
    ];
    let rest = [
        entry(left, ledger.spring_left, ledger.compression_left),
        entry("unbalanced", ledger.tangential_unbalanced(), ledger.normal_unbalanced()),
    ];
    let rows: Vec<_> = rows.into_iter().chain(dashpot).chain(rest).collect();
    aligned(out, &rows)
}

fn entry(name: &str, tangential: f64, normal: f64) -> [String; 3] {
    [name.to_owned(), number(tangential), number(normal)]
}

/// Writes a blank line and the work of the integrator.
pub fn work(out: &mut dyn Write, statistics: &Statistics) -> io::Result<()> {
    writeln!(out)?;
    pairs(
        out,
        &[
            ("steps accepted", statistics.accepted.to_string()),
            ("steps rejected for their error", statistics.rejected.to_string()),
            ("steps too coarse for a guard", statistics.too_coarse.to_string()),
            ("steps repeated to end on a switch", statistics.resteps.to_string()),
            ("evaluations of the right-hand side", statistics.field.to_string()),
            ("evaluations of the guards", statistics.guards.to_string()),
            ("guards isolated in full", statistics.isolations.to_string()),
            ("touches without a switch", statistics.grazings.to_string()),
        ],
    )
}

/// Writes names on the left, with their values after them.
pub fn pairs(out: &mut dyn Write, lines: &[(&str, String)]) -> io::Result<()> {
    let width = lines.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    lines.iter().try_for_each(|(name, value)| writeln!(out, "{name:<width$}  {value}"))
}

/// Writes columns: the first is aligned to the left, the others to the right.
pub fn aligned<const N: usize>(out: &mut dyn Write, rows: &[[String; N]]) -> io::Result<()> {
    let width =
        |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: [usize; N] = std::array::from_fn(width);
    for row in rows {
        write!(out, "{:<width$}", row[0], width = widths[0])?;
        for (cell, width) in row.iter().zip(widths).skip(1) {
            write!(out, "  {cell:>width$}")?;
        }
        writeln!(out)?;
    }
    Ok(())
}

/// `value` with [`DIGITS`] significant digits, and with an exponent if it is very small or large.
pub fn number(value: f64) -> String {
    let rounded = format!("{value:.*e}", DIGITS - 1);
    // The exponent is that of the rounded number: 9.9999999999 is shown as 10.00000000.
    let exponent: i32 =
        rounded.split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or(0);
    match usize::try_from(9 - exponent) {
        Ok(decimals) if exponent >= -3 => format!("{value:.decimals$}"),
        _ => rounded,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_ten_significant_digits() {
        for (value, expected) in [
            (0.0, "0.000000000"),
            (1.0, "1.000000000"),
            (-0.0151, "-0.01510000000"),
            (9.99999999999, "10.00000000"),
            (123456.789, "123456.7890"),
            (1.5e-7, "1.500000000e-7"),
            (-2.5e12, "-2.500000000e12"),
        ] {
            assert_eq!(number(value), expected);
        }
    }

    #[test]
    fn columns_are_aligned() {
        let mut out = Vec::new();
        let rows = [["a".to_owned(), "ψ".to_owned()], ["long".to_owned(), "1.5".to_owned()]];
        aligned(&mut out, &rows).unwrap();
        assert_eq!(String::from_utf8(out).unwrap(), "a       ψ\nlong  1.5\n");
    }
}
