//! The rows of results and of switches in the CSV files of a batch.

use std::io::Write;

use csv::{ByteRecord, Writer};
use stickslip_model::{Collision, Side, Switch};

use super::csv::number;

/// The columns of results, which follow the columns of the input.
pub const RESULTS: [&str; 7] =
    ["eps_n", "eps_t", "switch_count", "itinerary", "contact_time", "reversals", "status"];

/// The columns of results where points are located in an atlas.
pub const LOCATED: [&str; 4] = ["switch_count", "itinerary", "region", "distance"];

/// The columns of the file of switches.
pub const EVENTS: [&str; 8] =
    ["case", "index", "time", "time_left", "to", "side", "spring", "velocity"];

/// What a row of a batch says about its collision.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    eps_n: f64,
    eps_t: f64,
    switch_count: usize,
    itinerary: String,
    contact_time: f64,
    reversals: usize,
}

impl From<&Collision> for Summary {
    fn from(collision: &Collision) -> Self {
        Self {
            eps_n: collision.eps_n,
            eps_t: collision.eps_t(),
            switch_count: collision.switches.len(),
            itinerary: collision.itinerary(),
            contact_time: collision.contact_time,
            reversals: collision.reversals,
        }
    }
}

/// Writes the header: the columns of the input and of the results.
///
/// # Errors
/// `out` cannot be written.
pub fn write_header<W: Write>(out: &mut Writer<W>, input: &ByteRecord) -> csv::Result<()> {
    write_fields(out, input, RESULTS)
}

/// Writes a row: the fields of the input, then the results or the reason why there are none.
///
/// # Errors
/// `out` cannot be written.
pub fn write_row<W: Write>(
    out: &mut Writer<W>,
    input: &ByteRecord,
    result: Result<&Summary, &str>,
) -> csv::Result<()> {
    match result {
        Ok(summary) => {
            let [eps_n, eps_t, contact_time] =
                [summary.eps_n, summary.eps_t, summary.contact_time].map(number);
            let [switch_count, reversals] =
                [summary.switch_count, summary.reversals].map(|count| count.to_string());
            let itinerary = &summary.itinerary;
            let fields = [&eps_n, &eps_t, &switch_count, itinerary, &contact_time, &reversals];
            write_fields(out, input, fields.map(String::as_str).into_iter().chain(["ok"]))
        }
        Err(reason) => write_fields(out, input, [""; 6].into_iter().chain([reason])),
    }
}

/// Writes the switches of the collision in row `case`.
///
/// # Errors
/// `out` cannot be written.
pub fn write_switches<W: Write>(
    out: &mut Writer<W>,
    case: u64,
    switches: &[Switch],
) -> csv::Result<()> {
    let case = case.to_string();
    for (index, switch) in switches.iter().enumerate() {
        let side = match switch.side {
            Side::Positive => "1",
            Side::Negative => "-1",
        };
        let [time, time_left, spring, velocity] =
            [switch.time, switch.time_left, switch.spring, switch.velocity].map(number);
        let (index, to) = (index.to_string(), switch.to.to_string());
        out.write_record([&case, &index, &time, &time_left, &to, side, &spring, &velocity])?;
    }
    Ok(())
}

/// Writes a row: the fields of the input, then those of the results.
///
/// # Errors
/// `out` cannot be written.
pub fn write_fields<'a, W: Write>(
    out: &mut Writer<W>,
    input: &ByteRecord,
    results: impl IntoIterator<Item = &'a str>,
) -> csv::Result<()> {
    for field in input {
        out.write_field(field)?;
    }
    for field in results {
        out.write_field(field)?;
    }
    // This ends the row.
    out.write_record(None::<&[u8]>)
}
