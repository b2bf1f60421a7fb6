//! The picture of an atlas: boundaries by kind, and the number of switches in each region.

use super::label::{self, Cells};
use super::panel::{Edge, Panel, Scale};
use super::style::{BOUNDARY_END, BOUNDARY_SLIP, BOUNDARY_STICK, FRAME, INK, SMALL, TEXT, TITLE};
use super::svg::{Anchor, Rectangle, Stroke, Svg, Words};

/// What is drawn.
#[derive(Clone, Debug)]
pub struct Atlas<'a> {
    /// What holds for all of it.
    pub title: &'a str,
    /// κ from the left to the right edge.
    pub kappa: (f64, f64),
    /// ψ from the lower to the upper edge.
    pub psi: (f64, f64),
    /// Boundaries with points (κ, ψ), dense enough for straight lines between them.
    pub boundaries: Vec<(Line, Vec<(f64, f64)>)>,
    /// Where boundaries cross or touch.
    pub crossings: Vec<(f64, f64)>,
    /// Where boundaries stop.
    pub stops: Vec<(f64, f64)>,
    /// The number of switches of each region.
    pub counts: Vec<usize>,
}

/// The kinds of boundaries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Line {
    /// A switch falls on the end of contact.
    EndOfContact,
    /// A touch while sticking.
    StickGraze,
    /// A touch while sliding.
    SlipGraze,
}

const WIDTH: f64 = 900.0;
const HEIGHT: f64 = 660.0;
const FRAME_AT: Rectangle = Rectangle { left: 72.0, top: 70.0, width: 810.0, height: 536.0 };
const TITLE_AT: (f64, f64) = (72.0, 22.0);
const LEGEND_Y: f64 = 50.0;
/// Half the side of a vertex's mark.
const MARK: f64 = 2.5;
/// Cells in which labels are placed, one to two pixels each.
const COLUMNS: u16 = 540;
const ROWS: u16 = 356;

/// Draws `atlas`; `region` tells the region at (κ, ψ), if it is in one.
pub fn draw(atlas: &Atlas<'_>, region: impl Fn((f64, f64)) -> Option<usize>) -> Svg {
    let mut svg = Svg::new(WIDTH, HEIGHT, atlas.title);
    svg.words(TITLE_AT, Words::new(atlas.title, TITLE, Anchor::Start));
    legend(&mut svg);
    let wide = atlas.kappa.1 > 10.0 * atlas.kappa.0;
    let scales = (if wide { Scale::Logarithmic } else { Scale::Linear }, Scale::Linear);
    let panel = Panel { frame: FRAME_AT, x: atlas.kappa, y: atlas.psi, scales };
    for line in [Line::EndOfContact, Line::StickGraze, Line::SlipGraze] {
        svg.begin_group(line.name());
        for (_, points) in atlas.boundaries.iter().filter(|boundary| boundary.0 == line) {
            panel.curve(&mut svg, points.iter().copied(), line.stroke());
        }
        svg.end_group();
    }
    svg.begin_group("vertices");
    for crossing in &atlas.crossings {
        svg.fill(mark(panel.place(*crossing)), INK);
    }
    for stop in &atlas.stops {
        svg.fill(mark(panel.place(*stop)), "#FFFFFF");
        svg.outline(mark(panel.place(*stop)), FRAME);
    }
    svg.end_group();
    labels(&mut svg, atlas, &panel, region);
    panel.border(&mut svg);
    for edge in [Edge::Bottom, Edge::Left] {
        panel.ticks(&mut svg, edge, true);
    }
    panel.name(&mut svg, Edge::Bottom, 38.0, "scaled stiffness κ");
    panel.name(&mut svg, Edge::Left, 52.0, "ψ = (α/μ) g_t/g_n");
    svg
}

/// The number of switches in each region that has room for it.
fn labels(
    svg: &mut Svg,
    atlas: &Atlas<'_>,
    panel: &Panel,
    region: impl Fn((f64, f64)) -> Option<usize>,
) {
    let cell = (FRAME_AT.width / f64::from(COLUMNS), FRAME_AT.height / f64::from(ROWS));
    let middle = |column: f64, row: f64| {
        (FRAME_AT.left + (column + 0.5) * cell.0, FRAME_AT.top + (row + 0.5) * cell.1)
    };
    let mut values = Vec::with_capacity(usize::from(COLUMNS) * usize::from(ROWS));
    for row in 0..ROWS {
        for column in 0..COLUMNS {
            let index = region(panel.value(middle(f64::from(column), f64::from(row))));
            values.push(index.and_then(|index| i32::try_from(index).ok()).unwrap_or(-1));
        }
    }
    let text = |value: i32| {
        let count = usize::try_from(value).ok().and_then(|index| atlas.counts.get(index));
        count.map(ToString::to_string).unwrap_or_default()
    };
    // Figures are 0.64 of the font size wide and 0.73 high.
    let half_size = |value: i32| {
        let digits = text(value).len() as f64;
        ((0.32 * SMALL * digits + 2.0) / cell.0, (0.365 * SMALL + 2.0) / cell.1)
    };
    let cells = Cells { columns: usize::from(COLUMNS), values: &values };
    svg.begin_group("regions");
    for label in label::place(cells, half_size).into_iter().filter(|label| label.value >= 0) {
        let at = middle(label.column as f64, label.row as f64);
        svg.words(at, Words::new(&text(label.value), SMALL, Anchor::Middle));
    }
    svg.end_group();
}

impl Line {
    fn name(self) -> &'static str {
        match self {
            Self::EndOfContact => "end-of-contact",
            Self::StickGraze => "stick-graze",
            Self::SlipGraze => "slip-graze",
        }
    }

    fn stroke(self) -> Stroke {
        match self {
            Self::EndOfContact => BOUNDARY_END,
            Self::StickGraze => BOUNDARY_STICK,
            Self::SlipGraze => BOUNDARY_SLIP,
        }
    }
}

fn mark((x, y): (f64, f64)) -> Rectangle {
    Rectangle { left: x - MARK, top: y - MARK, width: 2.0 * MARK, height: 2.0 * MARK }
}

fn legend(svg: &mut Svg) {
    let mut left = FRAME_AT.left;
    for (text, width, line) in [
        ("switch at the end of contact", 226.0, Line::EndOfContact),
        ("graze while sticking", 174.0, Line::StickGraze),
        ("graze while sliding", 168.0, Line::SlipGraze),
    ] {
        svg.line((left, LEGEND_Y), (left + 28.0, LEGEND_Y), line.stroke());
        svg.words((left + 34.0, LEGEND_Y), Words::new(text, TEXT, Anchor::Start));
        left += width;
    }
    svg.fill(mark((left + 4.0, LEGEND_Y)), INK);
    svg.words((left + 12.0, LEGEND_Y), Words::new("crossing", TEXT, Anchor::Start));
    svg.outline(mark((left + 88.0, LEGEND_Y)), FRAME);
    svg.words((left + 96.0, LEGEND_Y), Words::new("other vertex", TEXT, Anchor::Start));
}
