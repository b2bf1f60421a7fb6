//! An impact as tables for readers.

use std::io::{self, Write};

use stickslip_model::Engine;
use stickslip_model::spheres::{ForceSwitch, ImpactReport, Vector3};
use stickslip_solver::Statistics;

use crate::output::text::{ADHERES, aligned, describe, explained, law, number, pairs, work};

/// Writes `impact` as tables.
pub fn write(
    out: &mut dyn Write,
    engine: &Engine,
    impact: &ImpactReport,
    statistics: Option<&Statistics>,
) -> io::Result<()> {
    let contact = &impact.collision.contact;
    writeln!(
        out,
        "Impact with κ = {:?}, ψ = {:?}, damping a = {:?}, by {}",
        contact.kappa(),
        impact.psi(),
        contact.damping(),
        describe(engine)
    )?;
    law(out, contact)?;
    writeln!(out)?;
    let ends = !impact.outcome.adheres;
    if ends {
        vectors(out, impact)?;
    }
    switches(out, &impact.outcome.switches)?;
    results(out, impact)?;
    if ends {
        energy(out, impact)?;
        observed(out, impact)?;
        comparison(out, impact)?;
    }
    statistics.map_or(Ok(()), |statistics| work(out, statistics))
}

fn vectors(out: &mut dyn Write, impact: &ImpactReport) -> io::Result<()> {
    let ImpactReport { encounter, outcome, .. } = impact;
    let row =
        |name: &str, v: &Vector3<f64>| [name.to_owned(), number(v.x), number(v.y), number(v.z)];
    let mut rows = vec![["", "x", "y", "z"].map(str::to_owned)];
    for (index, motion) in impact.spheres().iter().enumerate() {
        let name = |what| format!("spheres[{index}] after: {what}");
        rows.push(row(&name("velocity [m/s]"), &motion.velocity_m_per_s));
        rows.push(row(&name("spin [rad/s]"), &motion.spin_rad_per_s));
    }
    rows.push(row("impulse on spheres[0] [N s]", &outcome.impulse_n_s));
    rows.push(row("point of contact [m]", &encounter.contact_point_m));
    rows.push(row("normal n", &encounter.normal));
    if let Some(tangent) = &encounter.tangent {
        rows.push(row("tangent t", tangent));
    }
    aligned(out, &rows)?;
    writeln!(out)
}

fn switches(out: &mut dyn Write, switches: &[ForceSwitch]) -> io::Result<()> {
    if switches.is_empty() {
        return writeln!(out, "No switch.\n");
    }
    let header = [
        "",
        "time [s]",
        "time left [s]",
        "to",
        "side",
        "spring ζ [m]",
        "velocity [m/s]",
        "F_n [N]",
        "F_t [N]",
    ];
    let row = |(index, switch): (usize, &ForceSwitch)| {
        [
            index.to_string(),
            number(switch.time_s),
            number(switch.time_left_s),
            switch.to.to_string(),
            format!("{:+}", switch.side.sign()),
            switch.spring_m.map_or_else(|| "–".to_owned(), number),
            number(switch.velocity_m_per_s),
            number(switch.normal_force_n),
            number(switch.tangential_force_n),
        ]
    };
    let rows = switches.iter().enumerate().map(row);
    aligned(out, &std::iter::once(header.map(str::to_owned)).chain(rows).collect::<Vec<_>>())?;
    writeln!(out)
}

fn results(out: &mut dyn Write, impact: &ImpactReport) -> io::Result<()> {
    let ImpactReport { encounter, outcome, .. } = impact;
    if outcome.adheres {
        writeln!(out, "{ADHERES}\n")?;
    }
    let restitution = |value| if outcome.adheres { "none".to_owned() } else { optional(value) };
    pairs(
        out,
        &[
            ("normal velocity g_n [m/s]", number(encounter.normal_m_per_s)),
            ("tangential velocity g_t [m/s]", number(encounter.tangential_m_per_s)),
            ("normal restitution ε_n", restitution(Some(outcome.eps_n))),
            ("tangential restitution ε_t", restitution(outcome.eps_t)),
            ("contact time [s]", number(outcome.contact_time_s)),
            ("switches", outcome.switches.len().to_string()),
            ("reversals of the motion", impact.reversals().to_string()),
            ("itinerary", explained(&impact.itinerary())),
        ],
    )?;
    writeln!(out)
}

fn energy(out: &mut dyn Write, impact: &ImpactReport) -> io::Result<()> {
    let energy = &impact.outcome.energy;
    let [slip, stick] = if impact.collision.contact.obeys_paper() {
        ["taken by sliding [J]", "left in the spring [J]"]
    } else {
        ["taken by friction [J]", "lost to the spring in stick [J]"]
    };
    pairs(
        out,
        &[
            ("kinetic energy before [J]", number(energy.kinetic_before_j)),
            ("work of the wall [J]", number(energy.work_of_wall_j)),
            ("kinetic energy after [J]", number(energy.kinetic_after_j)),
            (slip, number(energy.sliding_j)),
            ("taken by damping [J]", number(energy.damping_j)),
            ("taken by the tangential dashpot [J]", number(energy.tangential_damping_j)),
            (stick, number(energy.spring_left_j)),
            ("left in the compression [J]", number(energy.compression_left_j)),
            ("unbalanced [J]", number(energy.unbalanced_j())),
        ],
    )?;
    writeln!(out)
}

fn observed(out: &mut dyn Write, impact: &ImpactReport) -> io::Result<()> {
    let observed = &impact.outcome.observed;
    pairs(
        out,
        &[
            ("β = −ε_t", optional(observed.beta)),
            ("patch: Ψ₁ = g_t/g_n", number(observed.patch_psi_1)),
            ("patch: Ψ₂ = ε_t g_t/g_n", number(observed.patch_psi_2)),
            ("patch: angle of impact [rad]", number(observed.patch_impact_angle_rad)),
            ("patch: angle of rebound [rad]", number(observed.patch_rebound_angle_rad)),
            ("centre: e_t", optional(observed.centre_e_t)),
            ("centre: angle of impact [rad]", number(observed.centre_impact_angle_rad)),
            ("centre: angle of rebound [rad]", number(observed.centre_rebound_angle_rad)),
            ("tangential / normal impulse", number(observed.impulse_ratio)),
        ],
    )?;
    writeln!(out)
}

fn comparison(out: &mut dyn Write, impact: &ImpactReport) -> io::Result<()> {
    let comparison = &impact.comparison;
    let of_law = |value: Option<f64>| value.map_or_else(|| "none in this law".to_owned(), number);
    let coulomb = match impact.outcome.eps_t {
        Some(_) => of_law(comparison.eps_t_coulomb),
        None => optional(None),
    };
    pairs(
        out,
        &[
            ("ε_n by its series", of_law(comparison.eps_n_series)),
            ("ε_n by a Padé approximant", of_law(comparison.eps_n_pade)),
            ("ε_t of pure Coulomb sliding", coulomb),
            ("Mindlin's stiffness [kg/s²]", of_law(comparison.mindlin_stiffness_kg_per_s2)),
            ("κ of Mindlin's stiffness", of_law(comparison.mindlin_kappa)),
            ("undamped compression [m]", number(comparison.undamped_compression_m)),
            ("undamped normal force [N]", number(comparison.undamped_normal_force_n)),
        ],
    )
}

fn optional(value: Option<f64>) -> String {
    value.map_or_else(|| "none: central impact".to_owned(), number)
}
