//! Figure 5: the forces at the points a…o.

use serde_json::json;
use stickslip_model::Collision;

use super::course::{COLUMNS, first_and_last, followed, largest_compression, rows};
use super::figure3::title;
use super::points::{LetteredPoint, intervals, points};
use super::reproduction::Reproduction;
use super::section::Section;
use crate::error::StudyError;
use crate::paper::{ALPHA, MU, Reading, STIFFNESS};
use crate::study::{Cell, Column, Picture, Study, Table};
use stickslip_figure::number;
use stickslip_figure::pictures::gallery::{self, Exhibit, PANEL_WIDTH};

/// What it is about.
pub const TITLE: &str = "Figure 5: forces at the points a to o";

/// Computes it.
///
/// # Errors
/// Boundaries cannot be traced, or a collision cannot be computed.
pub fn run(reproduction: &Reproduction) -> Result<Section, StudyError> {
    let points = points(&intervals(reproduction, Reading::Axis)?)?;
    let (mut findings, mut tables, mut pictures) = (Vec::new(), Vec::new(), Vec::new());
    let mut summary = Vec::new();
    // The reading that matches the paper comes first.
    for reading in [Reading::Axis, Reading::Printed] {
        let exhibits = points.iter().map(|point| exhibit(reading, point));
        let exhibits = exhibits.collect::<Result<Vec<_>, _>>()?;
        findings.extend(self::findings(reading, &exhibits));
        let all = points.iter().zip(&exhibits);
        summary.extend(all.map(|(point, exhibit)| row(reading, point, &exhibit.collision)));
        tables.push(courses(reading, &exhibits));
        pictures.push(picture(reading, &exhibits));
    }
    let column = |name, meaning| Column { name, meaning };
    let table = Table {
        name: "figure5",
        title: "the collisions at the points".to_owned(),
        columns: vec![
            column("axis", "axis"),
            column("point", "point"),
            column("kappa", "κ of (24)"),
            column("ratio", "g_t/g_n"),
            column("switch_count", "switches"),
            column("itinerary", "phases"),
            column("first_switch", "first at"),
            column("last_switch", "last at"),
            column("reversals", "reversals"),
            column("eps_t", "ε_t"),
        ],
        rows: summary,
    };
    let json = json!({ "mu": MU, "alpha": ALPHA, "axis": STIFFNESS, "points": table.json() });
    tables.insert(0, table);
    let study = Study { name: "figure5", title: TITLE, findings, json, tables, pictures };
    Ok(Section { shown: vec!["figure5"], ..study.into() })
}

fn exhibit(reading: Reading, point: &LetteredPoint) -> Result<Exhibit, StudyError> {
    let (collision, history) = followed(reading, STIFFNESS, point.ratio)?;
    let count = collision.switches.len();
    let remark = format!("g_t/g_n = {}, {count} switches", number(point.ratio, 3));
    Ok(Exhibit { name: point.name.to_owned(), remark, collision, history })
}

fn row(reading: Reading, point: &LetteredPoint, collision: &Collision) -> Vec<Cell> {
    let [first, last] = first_and_last(collision);
    vec![
        Cell::Text(reading.axis().to_owned()),
        Cell::Text(point.name.to_owned()),
        Cell::Number(collision.contact.kappa()),
        Cell::Number(point.ratio),
        Cell::Count(collision.switches.len() as u64),
        Cell::Text(collision.itinerary()),
        Cell::Number(first),
        Cell::Number(last),
        Cell::Count(collision.reversals as u64),
        Cell::Number(collision.eps_t()),
    ]
}

fn findings(reading: Reading, exhibits: &[Exhibit]) -> Vec<String> {
    let late = |exhibit: &&Exhibit| {
        first_and_last(&exhibit.collision)[0] > largest_compression(&exhibit.collision)
    };
    let names = |exhibits: Vec<&Exhibit>| {
        let names: Vec<&str> = exhibits.iter().map(|exhibit| exhibit.name.as_str()).collect();
        names.join(", ")
    };
    let reading = reading.words();
    let mut findings = vec![format!(
        "With the {reading}, all switches fall in the decompression at {}.",
        names(exhibits.iter().filter(late).collect())
    )];
    let early = |exhibit: &&Exhibit| !exhibit.collision.switches.is_empty() && !late(exhibit);
    if let Some(Exhibit { name, collision, .. }) = exhibits.iter().find(early) {
        let (first, middle) = (first_and_last(collision)[0], largest_compression(collision));
        findings.push(format!(
            "At {name}, the first point of which that is not so, the first switch is at t = {}, {} before the largest compression.",
            number(first, 4),
            number(middle - first, 2)
        ));
    }
    let half =
        |exhibit: &&Exhibit| 2 * exhibit.collision.reversals == exhibit.collision.switches.len();
    findings.push(format!(
        "With the {reading}, the motion reverses half as often as the regime switches at {}, and not at the others.",
        names(exhibits.iter().filter(half).collect())
    ));
    findings
}

/// The names of tables and pictures must live as long as the program.
fn names(reading: Reading) -> &'static str {
    match reading {
        Reading::Printed => "figure5_printed",
        Reading::Axis => "figure5_axis",
    }
}

fn courses(reading: Reading, exhibits: &[Exhibit]) -> Table {
    let mut columns = vec![Column { name: "point", meaning: "point" }];
    columns.extend(COLUMNS);
    let rows = exhibits.iter().flat_map(|Exhibit { name, collision, history, .. }| {
        let name = Cell::Text(name.clone());
        let moments = rows(collision, history, PANEL_WIDTH).into_iter();
        moments.map(move |moment| [vec![name.clone()], moment].concat())
    });
    let title = format!("forces and velocity against time at the points, {}", reading.words());
    Table { name: names(reading), title, columns, rows: rows.collect() }
}

fn picture(reading: Reading, exhibits: &[Exhibit]) -> Picture {
    let kappa = number(reading.kappa(STIFFNESS), 4);
    let svg = gallery::draw(&title(&format!("κ = {kappa}")), exhibits);
    let caption = format!(
        "The tangential force F_t/μ (blue) and its limits ±F_n (black, dashed) at the points of Figure 4 for κ = {kappa}, the {}. \
         While sliding, the force is at one of the limits. The contact lasts t_c = {}, the largest compression is in the middle.",
        reading.words(),
        number(exhibits.first().map_or(f64::NAN, |exhibit| exhibit.collision.contact_time), 5)
    );
    Picture { name: names(reading), caption, svg }
}
