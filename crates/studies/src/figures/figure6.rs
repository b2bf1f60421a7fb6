//! Figure 6: forces and velocity with a stiff spring.

use serde_json::json;
use stickslip_model::{Collision, History};

use super::course::{COLUMNS, followed, rows};
use super::reproduction::Reproduction;
use super::section::Section;
use crate::error::StudyError;
use crate::paper::{ALPHA, MU, Reading};
use crate::study::{Cell, Column, Picture, Study, Table};
use stickslip_figure::number;
use stickslip_figure::pictures::collision::{self, PANEL_WIDTH};
use stickslip_figure::pictures::course::Course;

/// What it is about.
pub const TITLE: &str = "Figure 6: a stiff spring";

/// The value on the axis of stiffness, and g_t/g_n.
const STIFFNESS: f64 = 100.0;
const RATIO: f64 = 0.3;

/// Computes it.
///
/// # Errors
/// A collision cannot be computed.
pub fn run(_: &Reproduction) -> Result<Section, StudyError> {
    let (mut findings, mut summary) = (Vec::new(), Vec::new());
    let (mut tables, mut pictures) = (Vec::new(), Vec::new());
    let mut minima = Vec::new();
    for reading in Reading::ALL {
        let name = match reading {
            Reading::Printed => "figure6_printed",
            Reading::Axis => "figure6_axis",
        };
        let (collision, history) = followed(reading, STIFFNESS, RATIO)?;
        let kappa = number(collision.contact.kappa(), 4);
        let minimum = first_minimum(&collision, &history);
        minima.extend(minimum);
        let switches = collision.switches.len();
        findings.push(format!(
            "κ = {kappa}, the {}: {switches} switches, {} sliding episodes, and the first minimum of the velocity at t = {}.",
            reading.words(),
            switches / 2 + 1,
            minimum.map_or_else(|| "no time".to_owned(), |time| number(time, 3))
        ));
        summary.push(vec![
            Cell::Text(reading.axis().to_owned()),
            Cell::Number(collision.contact.kappa()),
            Cell::Number(RATIO),
            Cell::Count(switches as u64),
            Cell::Text(collision.itinerary()),
            Cell::Number(minimum.unwrap_or(f64::NAN)),
            Cell::Number(collision.eps_t()),
        ]);
        tables.push(Table {
            name,
            title: format!("forces and velocity against time, κ = {kappa}"),
            columns: COLUMNS.to_vec(),
            rows: rows(&collision, &history, PANEL_WIDTH),
        });
        pictures.push(Picture {
            name,
            caption: format!(
                "Forces and velocity at g_t/g_n = {} and κ = {kappa}, the {}.",
                number(RATIO, 4),
                reading.words()
            ),
            svg: collision::draw(&collision, &history),
        });
    }
    let late = match minima.iter().filter(|time| **time > 1.0).count() {
        0 => "neither reading has",
        1 => "one of the readings has",
        _ => "both readings have",
    };
    findings.push(format!(
        "The paper has many sliding episodes, and the first minimum shortly after t = 1; {late} it after t = 1."
    ));
    let column = |name, meaning| Column { name, meaning };
    let table = Table {
        name: "figure6",
        title: "the collisions".to_owned(),
        columns: vec![
            column("axis", "axis"),
            column("kappa", "κ of (24)"),
            column("ratio", "g_t/g_n"),
            column("switch_count", "switches"),
            column("itinerary", "phases"),
            column("first_minimum", "first minimum at"),
            column("eps_t", "ε_t"),
        ],
        rows: summary,
    };
    let json = json!({ "mu": MU, "alpha": ALPHA, "axis": STIFFNESS, "collisions": table.json() });
    tables.insert(0, table);
    let study = Study { name: "figure6", title: TITLE, findings, json, tables, pictures };
    Ok(Section { shown: vec!["figure6"], ..study.into() })
}

/// When the force on the motion first turns from braking to driving forward: there the velocity is
/// least.
fn first_minimum(collision: &Collision, history: &History) -> Option<f64> {
    let course = Course::new(collision, history, PANEL_WIDTH);
    let turn = course
        .samples()
        .windows(2)
        .find(|pair| pair[0].tangential_force < 0.0 && pair[1].tangential_force > 0.0)?;
    let (mut before, mut after) = (turn[0].time, turn[1].time);
    loop {
        let middle = f64::midpoint(before, after);
        if middle <= before || middle >= after {
            return Some(middle);
        }
        if history.at(middle)?.tangential_force < 0.0 { before = middle } else { after = middle }
    }
}
