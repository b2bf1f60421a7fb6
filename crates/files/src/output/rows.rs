//! The rows of results and of switches in the CSV files of a batch.

use stickslip_model::{Collision, Estimate, Side};

use super::csv::Rows;

/// The columns of results, which follow the columns of the input.
pub const RESULTS: [&str; 7] =
    ["eps_n", "eps_t", "switch_count", "itinerary", "contact_time", "reversals", "status"];

/// The columns of estimates, which follow the columns of results if they are wanted.
pub const ESTIMATES: [&str; 3] = ["eps_t_error", "distance", "certain"];

/// The columns of results where points are located in an atlas.
pub const LOCATED: [&str; 4] = ["switch_count", "itinerary", "region", "distance"];

/// The columns of results where points are located in an atlas of a system of one's own.
pub const LOCATED_RUNS: [&str; 4] = ["event_count", "itinerary", "region", "distance"];

/// The columns of results where points are located in the regions of a periodic orbit.
pub const LOCATED_ORBITS: [&str; 4] = ["orbit_count", "orbits", "region", "distance"];

/// The columns of the file of switches.
pub const EVENTS: [&str; 8] =
    ["case", "index", "time", "time_left", "to", "side", "spring", "velocity"];

/// The status of a collision of bodies that stay together, and so have no restitution.
pub const ADHERES: &str = "adheres";

/// Writes the results of a collision with their `status`. They follow the fields of the input.
pub fn write_collision(rows: &mut Rows, collision: &Collision, status: &str) {
    if collision.adheres {
        rows.fields(["", ""]);
    } else {
        rows.number(collision.eps_n);
        rows.number(collision.eps_t());
    }
    rows.count(collision.switches.len());
    rows.field(collision.itinerary());
    rows.number(collision.contact_time);
    rows.count(collision.reversals);
    rows.field(if collision.adheres { ADHERES } else { status });
}

/// Writes the estimates of a collision. They follow its results.
pub fn write_estimate(rows: &mut Rows, estimate: &Estimate) {
    rows.number(estimate.eps_t_error);
    rows.number(estimate.distance);
    rows.field(if estimate.certain { "true" } else { "false" });
}

/// Writes the switches of the collision in row `case`.
pub fn write_switches(rows: &mut Rows, case: u64, collision: &Collision) {
    for (index, switch) in collision.switches.iter().enumerate() {
        rows.count(case);
        rows.count(index);
        rows.number(switch.time);
        rows.number(switch.time_left);
        rows.field(switch.to.name());
        rows.field(match switch.side {
            Side::Positive => "1",
            Side::Negative => "-1",
        });
        rows.number(switch.spring);
        rows.number(switch.velocity);
        rows.end();
    }
}
