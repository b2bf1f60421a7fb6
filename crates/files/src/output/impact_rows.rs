//! The rows of results and of switches of impacts in the CSV files of a batch. The names are those
//! of the JSON of one impact.

use stickslip_model::Side;
use stickslip_model::spheres::{ForceSwitch, ImpactReport};

use super::csv::Rows;
use super::rows::ADHERES;

/// The columns of results that every impact has, before those of the spheres.
const RESULTS: [&str; 9] = [
    "kappa",
    "psi",
    "damping",
    "eps_n",
    "eps_t",
    "contact_time_s",
    "switch_count",
    "reversals",
    "itinerary",
];

/// The columns of each sphere.
const SPHERES: [[&str; 6]; 2] = [
    [
        "spheres[0].velocity_m_per_s[0]",
        "spheres[0].velocity_m_per_s[1]",
        "spheres[0].velocity_m_per_s[2]",
        "spheres[0].spin_rad_per_s[0]",
        "spheres[0].spin_rad_per_s[1]",
        "spheres[0].spin_rad_per_s[2]",
    ],
    [
        "spheres[1].velocity_m_per_s[0]",
        "spheres[1].velocity_m_per_s[1]",
        "spheres[1].velocity_m_per_s[2]",
        "spheres[1].spin_rad_per_s[0]",
        "spheres[1].spin_rad_per_s[1]",
        "spheres[1].spin_rad_per_s[2]",
    ],
];

/// The columns after those of the spheres.
const ACCOUNT: [&str; 16] = [
    "patch_impact_angle_rad",
    "patch_rebound_angle_rad",
    "centre_e_t",
    "centre_impact_angle_rad",
    "centre_rebound_angle_rad",
    "impulse_ratio",
    "kinetic_before_j",
    "kinetic_after_j",
    "work_of_wall_j",
    "sliding_j",
    "damping_j",
    "tangential_damping_j",
    "spring_left_j",
    "compression_left_j",
    "unbalanced_j",
    "status",
];

/// The columns of the file of switches.
pub const EVENTS: [&str; 10] = [
    "case",
    "index",
    "time_s",
    "time_left_s",
    "to",
    "side",
    "spring_m",
    "velocity_m_per_s",
    "normal_force_n",
    "tangential_force_n",
];

/// The columns of results of impacts of so many spheres, one or two.
pub fn names(spheres: usize) -> Vec<&'static str> {
    let spheres = SPHERES.into_iter().take(spheres).flatten();
    RESULTS.into_iter().chain(spheres).chain(ACCOUNT).collect()
}

/// Writes the results of an impact with its `status`. They follow the fields of the input.
pub fn write(rows: &mut Rows, impact: &ImpactReport, status: &str) {
    let outcome = &impact.outcome;
    let contact = &impact.collision.contact;
    rows.number(contact.kappa());
    rows.number(impact.psi());
    rows.number(contact.damping());
    if outcome.adheres {
        return write_adhering(rows, impact);
    }
    rows.number(outcome.eps_n);
    optional(rows, outcome.eps_t);
    rows.number(outcome.contact_time_s);
    rows.count(outcome.switches.len());
    rows.count(impact.reversals());
    rows.field(impact.itinerary());
    for motion in impact.spheres() {
        motion.velocity_m_per_s.iter().for_each(|value| rows.number(*value));
        motion.spin_rad_per_s.iter().for_each(|value| rows.number(*value));
    }
    let observed = &outcome.observed;
    rows.number(observed.patch_impact_angle_rad);
    rows.number(observed.patch_rebound_angle_rad);
    optional(rows, observed.centre_e_t);
    rows.number(observed.centre_impact_angle_rad);
    rows.number(observed.centre_rebound_angle_rad);
    rows.number(observed.impulse_ratio);
    let energy = &outcome.energy;
    rows.number(energy.kinetic_before_j);
    rows.number(energy.kinetic_after_j);
    rows.number(energy.work_of_wall_j);
    rows.number(energy.sliding_j);
    rows.number(energy.damping_j);
    rows.number(energy.tangential_damping_j);
    rows.number(energy.spring_left_j);
    rows.number(energy.compression_left_j);
    rows.number(energy.unbalanced_j());
    rows.field(status);
}

/// Writes what there is behind the parameters of bodies that stay together.
fn write_adhering(rows: &mut Rows, impact: &ImpactReport) {
    let outcome = &impact.outcome;
    rows.fields(["", ""]);
    rows.number(outcome.contact_time_s);
    rows.count(outcome.switches.len());
    rows.count(impact.reversals());
    rows.field(impact.itinerary());
    let empty = impact.spheres().len() * SPHERES[0].len() + ACCOUNT.len() - 1;
    (0..empty).for_each(|_| rows.field(""));
    rows.field(ADHERES);
}

/// Writes the switches of the impact in row `case`.
pub fn write_switches(rows: &mut Rows, case: u64, switches: &[ForceSwitch]) {
    for (index, switch) in switches.iter().enumerate() {
        rows.count(case);
        rows.count(index);
        rows.number(switch.time_s);
        rows.number(switch.time_left_s);
        rows.field(switch.to.name());
        rows.field(match switch.side {
            Side::Positive => "1",
            Side::Negative => "-1",
        });
        optional(rows, switch.spring_m);
        rows.number(switch.velocity_m_per_s);
        rows.number(switch.normal_force_n);
        rows.number(switch.tangential_force_n);
        rows.end();
    }
}

fn optional(rows: &mut Rows, value: Option<f64>) {
    match value {
        Some(value) => rows.number(value),
        None => rows.field(""),
    }
}
