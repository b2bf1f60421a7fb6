//! Figure 5: the forces at the points a to o.

use serde_json::json;
use stickslip_figure::number;
use stickslip_figure::pictures::gallery::{self, Exhibit, PANEL_WIDTH};
use stickslip_figure::pictures::studies::Picture;
use stickslip_model::Collision;
use stickslip_studies::paper::{ALPHA, MU, Reading, STIFFNESS};
use stickslip_studies::{Cell, Study, StudyColumn, StudyTable};

use super::course::{first_and_last, followed, largest_compression, rows};
use super::points::{LetteredPoint, intervals, points};
use super::reproduction::Reproduction;
use super::section::ReportSection;
use super::section::{AXIS, COURSE, EPS_T, KAPPA, PHASES, POINT, RATIO, SWITCHES};
use super::stiffness_map::title;
use crate::error::ReproductionError;

/// The title of the part.
pub const TITLE: &str = "Figure 5: forces at the points a to o";

const COLUMNS: [StudyColumn; 10] = [
    AXIS,
    POINT,
    KAPPA,
    RATIO,
    SWITCHES,
    PHASES,
    StudyColumn::headed("first_switch", "first switch", "scaled time of the first switch"),
    StudyColumn::headed("last_switch", "last switch", "scaled time of the last switch"),
    StudyColumn::headed("reversals", "reversals", "number of reversals of the motion"),
    EPS_T,
];

/// Computes the part.
///
/// # Errors
/// Boundaries cannot be traced, or a collision cannot be computed.
pub fn run(reproduction: &Reproduction) -> Result<ReportSection, ReproductionError> {
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
    let table = StudyTable {
        name: "figure5",
        title: "The collisions at the points".to_owned(),
        columns: COLUMNS.to_vec(),
        rows: summary,
    };
    let json = json!({ "mu": MU, "alpha": ALPHA, "axis": STIFFNESS, "points": table.json() });
    tables.insert(0, table);
    let headlines = Vec::new();
    let study = Study { name: "figure5", title: TITLE, headlines, findings, json, tables };
    Ok(ReportSection { shown: vec!["figure5"], ..ReportSection::new(study, pictures) })
}

fn exhibit(reading: Reading, point: &LetteredPoint) -> Result<Exhibit, ReproductionError> {
    let (collision, history) = followed(reading, STIFFNESS, point.ratio)?;
    let count = collision.switches.len();
    let remark = format!("g_t/g_n = {}, {count} switches", number(point.ratio, 3));
    Ok(Exhibit { name: point.name.to_owned(), remark, collision, history })
}

fn row(reading: Reading, point: &LetteredPoint, collision: &Collision) -> Vec<Cell> {
    let [first, last] = first_and_last(collision);
    vec![
        reading.axis().into(),
        point.name.into(),
        collision.contact.kappa().into(),
        point.ratio.into(),
        collision.switches.len().into(),
        collision.itinerary().into(),
        first.into(),
        last.into(),
        collision.reversals.into(),
        collision.eps_t().into(),
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
            "At {name}, the first point where this is not so, the first switch is at t = {}, {} before \
             the largest compression.",
            number(first, 4),
            number(middle - first, 2)
        ));
    }
    let half =
        |exhibit: &&Exhibit| 2 * exhibit.collision.reversals == exhibit.collision.switches.len();
    findings.push(format!(
        "With the {reading}, the motion reverses half as often as the regime switches at {}, and not \
         at the others.",
        names(exhibits.iter().filter(half).collect())
    ));
    findings
}

/// The name of the table and of the picture of a reading.
fn name(reading: Reading) -> &'static str {
    match reading {
        Reading::Printed => "figure5_printed",
        Reading::Axis => "figure5_axis",
    }
}

fn courses(reading: Reading, exhibits: &[Exhibit]) -> StudyTable {
    let rows = exhibits.iter().flat_map(|Exhibit { name, collision, history, .. }| {
        let moments = rows(collision, history, PANEL_WIDTH).into_iter();
        moments.map(move |moment| [vec![name.as_str().into()], moment].concat())
    });
    StudyTable {
        name: name(reading),
        title: format!("Forces and velocity against time at the points, {}", reading.words()),
        columns: [&[POINT], &COURSE[..]].concat(),
        rows: rows.collect(),
    }
}

fn picture(reading: Reading, exhibits: &[Exhibit]) -> Picture {
    let kappa = number(reading.kappa(STIFFNESS), 4);
    let svg = gallery::draw(&title(&format!("κ = {kappa}")), exhibits);
    let caption = format!(
        "The tangential force F_t/μ (blue) at the points of Figure 4, and its limits F_n (black, full) \
         and −F_n (black, dashed), for κ = {kappa}, the {}. While sliding, the force is at one of the \
         limits. The contact lasts t_c = {}; the largest compression is in the middle.",
        reading.words(),
        number(exhibits.first().map_or(f64::NAN, |exhibit| exhibit.collision.contact_time), 5)
    );
    Picture::new(name(reading), &caption, svg)
}
