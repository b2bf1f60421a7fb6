//! Figure 4: the number of switches, with the points a to o.

use serde_json::json;
use stickslip_figure::canvas::shape::Stroke;
use stickslip_figure::pictures::atlas::boundaries;
use stickslip_figure::pictures::map::{self, MapPanel};
use stickslip_figure::pictures::studies::Picture;
use stickslip_figure::{number, style};
use stickslip_plane::atlas::CollisionAtlas;
use stickslip_studies::paper::{ALPHA, MOST_RATIO_4, MOST_SWITCHES, MU, Reading, STIFFNESS, ratio};
use stickslip_studies::{Study, StudyColumn, StudyTable};

use super::boundaries::summary;
use super::points::{Interval, LetteredPoint, intervals, points};
use super::reproduction::Reproduction;
use super::section::ReportSection;
use super::section::{AXIS, KAPPA, PHASES, SWITCHES};
use super::stiffness_map::{StiffnessMap, title};
use crate::error::ReproductionError;

/// The title of the part.
pub const TITLE: &str = "Figure 4: number of switches";

/// The file of the traced boundaries.
const ATLAS: &str = "figure4_boundaries.json";

const COLUMNS: [StudyColumn; 7] = [
    AXIS,
    KAPPA,
    StudyColumn::headed("ratio_low", "g_t/g_n from", "g_t/g_n at the lower end of the interval"),
    StudyColumn::headed("ratio_high", "to", "g_t/g_n at the upper end of the interval"),
    SWITCHES,
    PHASES,
    StudyColumn::headed("points", "points", "the points of the figure inside the interval"),
];

/// The intervals between boundaries on the line of the points, in both readings.
type Lines = [Vec<Interval>; 2];

/// Computes the part.
///
/// # Errors
/// Boundaries cannot be traced, or the picture cannot be drawn.
pub fn run(reproduction: &Reproduction) -> Result<ReportSection, ReproductionError> {
    let verified = reproduction.boundaries()?;
    let lines =
        [intervals(reproduction, Reading::Printed)?, intervals(reproduction, Reading::Axis)?];
    let points = points(&lines[1])?;
    let maps = StiffnessMap::both(reproduction, MOST_RATIO_4);

    let headings = maps.each_ref().map(|map| map.heading("number of switches"));
    let panels = maps.iter().zip(&headings).map(|(map, heading)| MapPanel {
        horizontal: map.axis(),
        lines: drawn(verified, map.reading),
        // From the lowest on.
        points: points.iter().rev().map(|point| (point.name, (STIFFNESS, point.ratio))).collect(),
        ..map.sweep.switches(heading)
    });
    let svg = map::draw(&title("number of switches"), &panels.collect::<Vec<_>>())?;
    let most = maps.each_ref().map(|map| map.sweep.most_switches());
    let table = table(&lines, &points);
    let pictures = vec![Picture::new("figure4", &caption(&lines[1], &points), svg)];
    let study = Study {
        name: "figure4",
        title: TITLE,
        headlines: vec![headline(&lines)],
        findings: findings(&lines, &points, most, verified),
        json: json!({
            "mu": MU,
            "alpha": ALPHA,
            "axis": STIFFNESS,
            "most_switches": { "printed": most[0], "axis": most[1] },
            "line": table.json(),
        }),
        tables: vec![table],
    };
    let section = ReportSection { shown: vec!["figure4"], ..ReportSection::new(study, pictures) };
    let section = maps.iter().fold(section, |section, map| map.filed(section, "figure4"));
    let title = "the traced boundaries as an atlas, for stickslip locate";
    Ok(section.with_atlas(ATLAS, title, verified))
}

/// The boundaries as lines of the picture.
fn drawn(verified: &CollisionAtlas, reading: Reading) -> Vec<(Stroke, Vec<(f64, f64)>)> {
    let scale = reading.kappa(1.0);
    let lines = boundaries(verified).into_iter().map(|(line, points)| {
        let points = points.into_iter().map(|(kappa, psi)| (kappa / scale, ratio(psi)));
        (Stroke { width: 1.2, ..style::boundary(line) }, points.collect())
    });
    lines.collect()
}

/// The reading of the axis with which the figures agree.
fn headline(lines: &Lines) -> String {
    let [printed, axis] = lines.each_ref().map(|line| counts(line).into_iter().max().unwrap_or(0));
    let conclusion = if printed != MOST_SWITCHES && axis == MOST_SWITCHES {
        "The figures of the paper are drawn over ακ, not over the κ of its equation (24)"
    } else {
        "The numbers of switches do not tell over which stiffness the figures of the paper are drawn"
    };
    format!(
        "{conclusion}. Where their axis shows {at} they have up to {MOST_SWITCHES} switches; there are \
         up to {printed} at κ = {at} and up to {axis} at ακ = {at}.",
        at = number(STIFFNESS, 4)
    )
}

fn findings(
    lines: &Lines,
    points: &[LetteredPoint],
    most: [i32; 2],
    verified: &CollisionAtlas,
) -> Vec<String> {
    let mut findings = vec![format!(
        "The paper has up to {MOST_SWITCHES} switches at {} = {}. With the {} there are at most {} \
         there, and {} in the whole plane.",
        Reading::Printed.axis(),
        number(STIFFNESS, 4),
        Reading::Printed.words(),
        counts(&lines[0]).into_iter().max().unwrap_or(0),
        most[0],
    )];
    for (reading, line) in Reading::ALL.into_iter().zip(lines) {
        let counts: Vec<String> = counts(line).iter().map(ToString::to_string).collect();
        findings.push(format!(
            "At κ = {}, the {}, the numbers of switches for falling g_t/g_n are {}.",
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
        "From its largest value on, this number falls with the ratio, with brief rises by two at {}.",
        rises.join(", ")
    ));
    findings.push(summary(verified));
    findings
}

fn counts(line: &[Interval]) -> Vec<usize> {
    line.iter().map(|interval| interval.collision.switches.len()).collect()
}

fn caption(line: &[Interval], points: &[LetteredPoint]) -> String {
    let nameless = points.iter().zip(line).find(|(point, _)| point.name == "n'");
    let share = |interval: &Interval| (interval.ratios[1] - interval.ratios[0]) / MOST_RATIO_4;
    let nameless = nameless.map_or_else(String::new, |(point, interval)| {
        format!(
            "{}, from g_t/g_n = {} to {} or {} % of the height of the figure, has no letter in the \
             paper",
            point.name,
            number(interval.ratios[0], 3),
            number(interval.ratios[1], 3),
            number(100.0 * share(interval), 2)
        )
    });
    format!(
        "The number of switches, with the traced boundaries: full where a switch falls on the end of \
         contact, dashed where the spring touches its limit, dotted where sliding all but sticks. The \
         points stand in the middle of the intervals between boundaries on the line {} = {}. The paper \
         has {} letters, and the line crosses {} regions. What the paper says of its points decides \
         which is which: at b, c and d all switches fall in the decompression, at e the first one just \
         before the largest compression, j is a brief rise by two, o has two switches. From above, a \
         to n are the first regions in turn; {nameless}; o is the last one. In the first map the \
         points are at the same ratios.",
        Reading::Axis.axis(),
        number(STIFFNESS, 4),
        points.len() - 1,
        line.len(),
    )
}

/// All intervals of both lines, with the points in them.
fn table(lines: &Lines, points: &[LetteredPoint]) -> StudyTable {
    let mut rows = Vec::new();
    for (reading, line) in Reading::ALL.into_iter().zip(lines) {
        for Interval { ratios: [low, high], collision } in line {
            let inside = |point: &&LetteredPoint| *low < point.ratio && point.ratio < *high;
            let names: Vec<&str> = points.iter().filter(inside).map(|point| point.name).collect();
            rows.push(vec![
                reading.axis().into(),
                reading.kappa(STIFFNESS).into(),
                (*low).into(),
                (*high).into(),
                collision.switches.len().into(),
                collision.itinerary().into(),
                names.join(" ").into(),
            ]);
        }
    }
    StudyTable {
        name: "figure4",
        title: format!("Intervals between boundaries at {} on the axis", number(STIFFNESS, 4)),
        columns: COLUMNS.to_vec(),
        rows,
    }
}
