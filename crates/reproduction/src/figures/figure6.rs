//! Figure 6: forces and velocity with a stiff spring.

use serde_json::json;
use stickslip_figure::number;
use stickslip_figure::pictures::collision::{self, PANEL_WIDTH};
use stickslip_figure::pictures::course::Course;
use stickslip_figure::pictures::studies::Picture;
use stickslip_model::Collision;
use stickslip_model::history::History;
use stickslip_studies::paper::{ALPHA, MU, RATIO_6, Reading, STIFFNESS_6};
use stickslip_studies::{Study, StudyColumn, StudyTable};

use super::course::{followed, rows};
use super::reproduction::Reproduction;
use super::section::ReportSection;
use super::section::{AXIS, COURSE, EPS_T, KAPPA, PHASES, RATIO, SWITCHES};
use crate::error::ReproductionError;

/// The title of the part.
pub const TITLE: &str = "Figure 6: a stiff spring";

const FIRST_MINIMUM: StudyColumn = StudyColumn::headed(
    "first_minimum",
    "first minimum",
    "scaled time of the velocity's first minimum",
);
const COLUMNS: [StudyColumn; 7] = [AXIS, KAPPA, RATIO, SWITCHES, PHASES, FIRST_MINIMUM, EPS_T];

/// Computes the part.
///
/// # Errors
/// A collision cannot be computed.
pub fn run(_: &Reproduction) -> Result<ReportSection, ReproductionError> {
    let (mut findings, mut summary) = (Vec::new(), Vec::new());
    let (mut tables, mut pictures) = (Vec::new(), Vec::new());
    let mut minima = Vec::new();
    for reading in Reading::ALL {
        let name = match reading {
            Reading::Printed => "figure6_printed",
            Reading::Axis => "figure6_axis",
        };
        let (collision, history) = followed(reading, STIFFNESS_6, RATIO_6)?;
        let kappa = number(collision.contact.kappa(), 4);
        let minimum = first_minimum(&collision, &history);
        minima.extend(minimum);
        let switches = collision.switches.len();
        findings.push(format!(
            "At κ = {kappa}, the {}, there are {switches} switches and {} sliding episodes, and the \
             velocity has its first minimum at t = {}.",
            reading.words(),
            switches / 2 + 1,
            minimum.map_or_else(|| "no time".to_owned(), |time| number(time, 3))
        ));
        summary.push(vec![
            reading.axis().into(),
            collision.contact.kappa().into(),
            RATIO_6.into(),
            switches.into(),
            collision.itinerary().into(),
            minimum.unwrap_or(f64::NAN).into(),
            collision.eps_t().into(),
        ]);
        tables.push(StudyTable {
            name,
            title: format!("Forces and velocity against time, κ = {kappa}"),
            columns: COURSE.to_vec(),
            rows: rows(&collision, &history, PANEL_WIDTH),
        });
        pictures.push(Picture {
            name: name.to_owned(),
            caption: format!(
                "Forces and velocity at g_t/g_n = {} and κ = {kappa}, the {}.",
                number(RATIO_6, 4),
                reading.words()
            ),
            svg: collision::draw(&collision, &history),
        });
    }
    let late = match minima.iter().filter(|time| **time > 1.0).count() {
        0 => "In neither reading is this minimum",
        1 => "In one of the readings this minimum is",
        _ => "In both readings this minimum is",
    };
    findings.push(format!(
        "The paper has many sliding episodes, and the first minimum shortly after t = 1. {late} after \
         t = 1."
    ));
    let table = StudyTable {
        name: "figure6",
        title: "The collisions".to_owned(),
        columns: COLUMNS.to_vec(),
        rows: summary,
    };
    let json = json!({ "mu": MU, "alpha": ALPHA, "axis": STIFFNESS_6, "collisions": table.json() });
    tables.insert(0, table);
    let headlines = Vec::new();
    let study = Study { name: "figure6", title: TITLE, headlines, findings, json, tables };
    Ok(ReportSection { shown: vec!["figure6"], ..ReportSection::new(study, pictures) })
}

/// The first moment at which the force on the motion turns from braking to driving. There the
/// velocity is least.
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
