//! Figure 4: the number of switches, with the points a…o.

use serde_json::json;

use super::figure3::{axis, data, sweep, title};
use super::points::{Interval, LetteredPoint, intervals, points};
use super::reproduction::{MOST_RATIO, Reproduction, summary};
use super::section::{DataFile, Section};
use crate::error::StudyError;
use crate::paper::{ALPHA, MU, Reading, STIFFNESS, ratio};
use crate::study::{Cell, Column, Picture, Study, Table};
use stickslip_figure::canvas::shape::Stroke;
use stickslip_figure::number;
use stickslip_figure::pictures::atlas::{boundaries, stroke};
use stickslip_figure::pictures::map::{self, MapPanel};
use stickslip_plane::atlas::VerifiedAtlas;

/// What it is about.
pub const TITLE: &str = "Figure 4: number of switches";

/// The file of the traced boundaries.
const ATLAS: &str = "figure4_boundaries.json";

/// Computes it.
///
/// # Errors
/// Boundaries cannot be traced, or it cannot be drawn.
pub fn run(reproduction: &Reproduction) -> Result<Section, StudyError> {
    let made = reproduction.boundaries()?;
    let lines =
        [intervals(reproduction, Reading::Printed)?, intervals(reproduction, Reading::Axis)?];
    let points = points(&lines[1])?;
    let sweeps = Reading::ALL.map(|reading| sweep(reproduction, reading, MOST_RATIO));

    let (mut files, mut objections) = (Vec::new(), Vec::new());
    for (reading, sweep) in Reading::ALL.into_iter().zip(&sweeps) {
        let (file, objection) = data(sweep, reading, "figure4");
        files.push(file);
        objections.extend(objection);
    }
    let title_of_atlas = "the traced boundaries as an atlas, for stickslip locate";
    let (file, objection) = DataFile::atlas(ATLAS, title_of_atlas, made);
    files.push(file);
    objections.extend(objection);

    let headings = Reading::ALL.map(|reading| format!("number of switches, {}", reading.words()));
    let panels = Reading::ALL.into_iter().zip(sweeps.iter().zip(&headings));
    let panels: Vec<MapPanel<'_>> = panels
        .map(|(reading, (sweep, heading))| MapPanel {
            horizontal: axis(reading),
            lines: drawn(made, reading),
            // From the lowest on.
            points: points.iter().rev().map(|p| (p.name, (STIFFNESS, p.ratio))).collect(),
            ..sweep.switches(heading)
        })
        .collect();
    let svg = map::draw(&title("number of switches"), &panels);
    let most = sweeps.each_ref().map(|sweep| sweep.most_switches());
    let table = table(&lines, &points);
    let study = Study {
        name: "figure4",
        title: TITLE,
        findings: findings(&lines, &points, most, made),
        json: json!({
            "mu": MU,
            "alpha": ALPHA,
            "axis": STIFFNESS,
            "most_switches": { "printed": most[0], "axis": most[1] },
            "line": table.json(),
        }),
        tables: vec![table],
        pictures: vec![Picture {
            name: "figure4",
            caption: caption(&lines[1], &points),
            svg: svg?,
        }],
    };
    Ok(Section { shown: vec!["figure4"], files, objections, ..study.into() })
}

/// The boundaries as lines of the picture.
fn drawn(made: &VerifiedAtlas, reading: Reading) -> Vec<(Stroke, Vec<(f64, f64)>)> {
    let scale = reading.kappa(1.0);
    let lines = boundaries(&made.atlas).into_iter().map(|(line, points)| {
        let points = points.into_iter().map(|(kappa, psi)| (kappa / scale, ratio(psi)));
        (Stroke { width: 1.2, ..stroke(line) }, points.collect())
    });
    lines.collect()
}

fn findings(
    lines: &[Vec<Interval>; 2],
    points: &[LetteredPoint],
    most: [i32; 2],
    made: &VerifiedAtlas,
) -> Vec<String> {
    let axis_value = number(STIFFNESS, 4);
    let mut findings = vec![format!(
        "The paper has up to eight switches at {} = {axis_value}. With the {} there are at most {} there, and {} in the whole plane.",
        Reading::Printed.axis(),
        Reading::Printed.words(),
        counts(&lines[0]).into_iter().max().unwrap_or(0),
        most[0],
    )];
    for (reading, line) in Reading::ALL.into_iter().zip(lines) {
        let counts: Vec<String> = counts(line).iter().map(ToString::to_string).collect();
        findings.push(format!(
            "κ = {}, the {}: the numbers for falling g_t/g_n are {}.",
            number(reading.kappa(STIFFNESS), 4),
            reading.words(),
            counts.join(" ")
        ));
    }
    let counts = counts(&lines[1]);
    let first_most = counts.iter().position(|count| Some(count) == counts.iter().max());
    let after = first_most.map_or(0..0, |first| first + 1..counts.len());
    let rises = after.filter(|&index| counts[index] > counts[index - 1]);
    let rises: Vec<&str> = rises.map(|index| points[index].name).collect();
    findings.push(format!(
        "From its largest value on, the number falls with the ratio, with brief rises by two at {}.",
        rises.join(", ")
    ));
    findings.push(summary(made));
    findings
}

fn counts(line: &[Interval]) -> Vec<usize> {
    line.iter().map(|interval| interval.collision.switches.len()).collect()
}

fn caption(line: &[Interval], points: &[LetteredPoint]) -> String {
    let nameless = points.iter().zip(line).find(|(point, _)| point.name == "n'");
    let share = |interval: &Interval| (interval.ratios[1] - interval.ratios[0]) / MOST_RATIO;
    let nameless = nameless.map_or_else(String::new, |(point, interval)| {
        format!(
            "{}, from g_t/g_n = {} to {} or {} % of the height of the figure, has no letter in the paper",
            point.name,
            number(interval.ratios[0], 3),
            number(interval.ratios[1], 3),
            number(100.0 * share(interval), 2)
        )
    });
    format!(
        "The number of switches, with the traced boundaries: full where a switch falls on the end of contact, dashed where the \
         spring touches its limit, dotted where sliding all but sticks. The points stand in the middle of the intervals between \
         boundaries on the line {} = {}. The paper has {} letters, and the line crosses {} regions. What the paper says of \
         its points decides which is which: at b, c and d all switches fall in the decompression, at e the first one just before \
         the largest compression, j is a brief rise by two, o has two switches. From above, a to n are the first regions in turn; \
         {nameless}; o is the last one. To the left the points are at the same ratios.",
        Reading::Axis.axis(),
        number(STIFFNESS, 4),
        points.len() - 1,
        line.len(),
    )
}

/// All intervals of both lines, with the points in them.
fn table(lines: &[Vec<Interval>; 2], points: &[LetteredPoint]) -> Table {
    let column = |name, meaning| Column { name, meaning };
    let row = |reading: Reading, interval: &Interval| {
        let inside = |point: &&LetteredPoint| {
            interval.ratios[0] < point.ratio && point.ratio < interval.ratios[1]
        };
        let names: Vec<&str> = points.iter().filter(inside).map(|point| point.name).collect();
        vec![
            Cell::Text(reading.axis().to_owned()),
            Cell::Number(reading.kappa(STIFFNESS)),
            Cell::Number(interval.ratios[0]),
            Cell::Number(interval.ratios[1]),
            Cell::Count(interval.collision.switches.len() as u64),
            Cell::Text(interval.collision.itinerary()),
            Cell::Text(names.join(" ")),
        ]
    };
    let rows = Reading::ALL.into_iter().zip(lines);
    Table {
        name: "figure4",
        title: format!("intervals between boundaries at {} on the axis", number(STIFFNESS, 4)),
        columns: vec![
            column("axis", "axis"),
            column("kappa", "κ of (24)"),
            column("ratio_low", "g_t/g_n above"),
            column("ratio_high", "below"),
            column("switch_count", "switches"),
            column("itinerary", "phases"),
            column("points", "points"),
        ],
        rows: rows
            .flat_map(|(reading, line)| line.iter().map(move |interval| row(reading, interval)))
            .collect(),
    }
}
