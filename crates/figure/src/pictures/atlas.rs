//! The picture of an atlas: boundaries by kind, and the number of switches in each region.

use stickslip_model::exact;
use stickslip_plane::atlas::{Atlas, Frame, Kind, polyline, scaled, switch_count, traced};
use stickslip_tracer::{Location, Point, VertexKind};

use crate::canvas::number::number;
use crate::canvas::panel::{Edge, Panel, Scale};
use crate::canvas::shape::{Rectangle, Stroke};
use crate::canvas::style::{
    BOUNDARY_END, BOUNDARY_SLIP, BOUNDARY_STICK, CLOSED_FORM, FRAME, INK, SMALL, TEXT, TITLE,
};
use crate::canvas::svg::{Anchor, Svg, Words};
use crate::canvas::{Cells, place};

const WIDTH: f64 = 900.0;
const HEIGHT: f64 = 660.0;
const FRAME_AT: Rectangle = Rectangle { left: 72.0, top: 70.0, width: 810.0, height: 536.0 };
const TITLE_AT: (f64, f64) = (72.0, 22.0);
const LEGEND_Y: f64 = 50.0;
const SECOND_LEGEND_Y: f64 = 68.0;
/// What the second line of the legend takes.
const LINE: f64 = 18.0;
/// Height and half the width of the mark of a limit.
const LIMIT: (f64, f64) = (6.0, 3.5);
/// Half the side of a vertex's mark.
const MARK: f64 = 2.5;
/// Cells in which labels are placed, one to two pixels each.
const COLUMNS: u16 = 540;
const ROWS: u16 = 356;

/// Draws `atlas`.
#[must_use]
pub fn draw(atlas: &Atlas) -> Svg {
    let Atlas { frame, regions: map, .. } = atlas;
    let pair = |point: &Point| <(f64, f64)>::from(scaled(point));
    let vertices = |kinds: &[VertexKind]| {
        let of_kinds = map.vertices().iter().filter(|vertex| kinds.contains(&vertex.kind));
        of_kinds.map(|vertex| pair(&vertex.point)).collect()
    };
    let turns = [VertexKind::Degenerate, VertexKind::GrazeAtEnd, VertexKind::VanishingPhase];
    let counts = (0..map.regions().len()).map(|region| switch_count(atlas.itinerary(region)));
    let reduction = frame.ratio.map(|ratio| ratio.reduction);
    let (mu, alpha) = (reduction.map(|r| r.mu), reduction.map(|r| r.alpha));
    let parameters = [("a", Some(frame.damping)), ("μ", mu), ("α", alpha)];
    let parameters = parameters
        .iter()
        .filter_map(|(name, value)| value.map(|value| format!(", {name} = {}", number(value, 6))));
    let title: String =
        std::iter::once(format!("{} boundaries, {} regions", map.curves().len(), counts.len()))
            .chain(parameters)
            .collect();
    let picture = Contents {
        title: &title,
        kappa: (frame.kappa.low, frame.kappa.high),
        psi: (frame.psi.low, frame.psi.high),
        boundaries: boundaries(atlas),
        crossings: vertices(&[VertexKind::Crossing]),
        stops: vertices(&turns),
        counts: counts.collect(),
        closed_forms: (frame.damping == 0.0).then(|| closed_forms(frame)),
    };
    contents(&picture, |(kappa, psi)| match map.locate(&traced([kappa, psi])) {
        Location::Region(region) => Some(region),
        _ => None,
    })
}

/// The boundaries with points (κ, ψ), dense enough for straight lines between them.
#[must_use]
pub fn boundaries(atlas: &Atlas) -> Vec<(Kind, Vec<(f64, f64)>)> {
    let extent = atlas.regions.window().extent();
    let lines = atlas.regions.curves().iter().map(|curve| {
        (curve.margin, polyline(curve, &extent).into_iter().map(Into::into).collect())
    });
    lines.collect()
}

fn closed_forms(frame: &Frame) -> ClosedForms {
    /// From farther up, boundaries need not lead to their limits.
    const SMALL: f64 = 0.05;
    let limits = (1..)
        .map(|n| {
            let line = if n % 2 == 0 { Kind::StickGraze } else { Kind::EndOfContact };
            (line, exact::small_impact_boundary(n))
        })
        .skip_while(|(_, kappa)| *kappa < frame.kappa.low)
        .take_while(|(_, kappa)| *kappa <= frame.kappa.high)
        .filter(|_| frame.psi.low <= SMALL);
    ClosedForms { top: exact::top_boundary, limits: limits.collect() }
}

/// What is drawn.
#[derive(Clone, Debug)]
struct Contents<'a> {
    /// What holds for all of it.
    title: &'a str,
    /// κ from the left to the right edge.
    kappa: (f64, f64),
    /// ψ from the lower to the upper edge.
    psi: (f64, f64),
    /// Boundaries with points (κ, ψ), dense enough for straight lines between them.
    boundaries: Vec<(Kind, Vec<(f64, f64)>)>,
    /// Where boundaries cross or touch.
    crossings: Vec<(f64, f64)>,
    /// Where boundaries stop.
    stops: Vec<(f64, f64)>,
    /// The number of switches of each region.
    counts: Vec<usize>,
    /// What is known without tracing.
    closed_forms: Option<ClosedForms>,
}

/// Boundaries in closed form.
#[derive(Clone, Debug)]
struct ClosedForms {
    /// ψ of the uppermost boundary at κ.
    top: fn(f64) -> f64,
    /// κ at which boundaries end as ψ → 0, with their kinds.
    limits: Vec<(Kind, f64)>,
}

/// Draws `atlas`; `region` tells the region at (κ, ψ), if it is in one.
fn contents(atlas: &Contents<'_>, region: impl Fn((f64, f64)) -> Option<usize>) -> Svg {
    let mut svg = Svg::new(WIDTH, HEIGHT, atlas.title);
    svg.words(TITLE_AT, Words::new(atlas.title, TITLE, Anchor::Start));
    legend(&mut svg);
    let wide = atlas.kappa.1 > 10.0 * atlas.kappa.0;
    let scales = (if wide { Scale::Logarithmic } else { Scale::Linear }, Scale::Linear);
    let lines = if atlas.closed_forms.is_some() { LINE } else { 0.0 };
    let frame =
        Rectangle { top: FRAME_AT.top + lines, height: FRAME_AT.height - lines, ..FRAME_AT };
    let panel = Panel { frame, x: atlas.kappa, y: atlas.psi, scales };
    if let Some(closed_forms) = &atlas.closed_forms {
        closed_forms.draw(&mut svg, &panel);
    }
    for line in [Kind::EndOfContact, Kind::StickGraze, Kind::SlipGraze] {
        svg.begin_group(name(line));
        for (_, points) in atlas.boundaries.iter().filter(|boundary| boundary.0 == line) {
            panel.curve(&mut svg, points.iter().copied(), stroke(line));
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
    atlas: &Contents<'_>,
    panel: &Panel,
    region: impl Fn((f64, f64)) -> Option<usize>,
) {
    let frame = &panel.frame;
    let cell = (frame.width / f64::from(COLUMNS), frame.height / f64::from(ROWS));
    let middle = |column: f64, row: f64| {
        (frame.left + (column + 0.5) * cell.0, frame.top + (row + 0.5) * cell.1)
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
    for label in place(cells, half_size).into_iter().filter(|label| label.value >= 0) {
        let at = middle(label.column as f64, label.row as f64);
        svg.words(at, Words::new(&text(label.value), SMALL, Anchor::Middle));
    }
    svg.end_group();
}

impl ClosedForms {
    fn draw(&self, svg: &mut Svg, panel: &Panel) {
        let Rectangle { left, width, .. } = panel.frame;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let pixels = 0..=width as u32;
        let at = |pixel: u32| panel.value((left + f64::from(pixel), 0.0)).0;
        let points = pixels.map(|pixel| (at(pixel), (self.top)(at(pixel))));
        svg.begin_inside(panel.frame);
        // Farther up nothing shows, and coordinates would grow without limit.
        let shown = points.filter(|point| point.1 < 10.0 * panel.y.1);
        panel.curve(svg, shown, CLOSED_FORM);
        svg.end_inside();
        svg.begin_group("limits");
        for (line, kappa) in &self.limits {
            limit(svg, panel.place((*kappa, panel.y.0)), *line);
        }
        svg.end_group();
        let (left, y) = (FRAME_AT.left, SECOND_LEGEND_Y);
        svg.line((left, y), (left + 28.0, y), CLOSED_FORM);
        let text = "uppermost boundary, closed form";
        svg.words((left + 34.0, y), Words::new(text, TEXT, Anchor::Start));
        if !self.limits.is_empty() {
            limit(svg, (left + 274.0, y - 0.5 * LIMIT.0), Kind::EndOfContact);
            limit(svg, (left + 286.0, y - 0.5 * LIMIT.0), Kind::StickGraze);
            let text = "κ_n = (nπ/2t_c)^2, limits of boundaries for vanishing ψ, n odd and even";
            svg.words((left + 298.0, y), Words::new(text, TEXT, Anchor::Start));
        }
    }
}

/// An arrow that points up to a place.
fn limit(svg: &mut Svg, (x, y): (f64, f64), line: Kind) {
    let (height, half) = LIMIT;
    svg.area([(x, y), (x + half, y + height), (x - half, y + height)], stroke(line).colour);
}

/// How a boundary is drawn.
#[must_use]
pub fn stroke(kind: Kind) -> Stroke {
    match kind {
        Kind::EndOfContact => BOUNDARY_END,
        Kind::StickGraze => BOUNDARY_STICK,
        Kind::SlipGraze => BOUNDARY_SLIP,
    }
}

fn name(kind: Kind) -> &'static str {
    match kind {
        Kind::EndOfContact => "end-of-contact",
        Kind::StickGraze => "stick-graze",
        Kind::SlipGraze => "slip-graze",
    }
}

fn mark((x, y): (f64, f64)) -> Rectangle {
    Rectangle { left: x - MARK, top: y - MARK, width: 2.0 * MARK, height: 2.0 * MARK }
}

fn legend(svg: &mut Svg) {
    let mut left = FRAME_AT.left;
    for (text, width, line) in [
        ("switch at the end of contact", 226.0, Kind::EndOfContact),
        ("graze while sticking", 174.0, Kind::StickGraze),
        ("graze while sliding", 168.0, Kind::SlipGraze),
    ] {
        svg.line((left, LEGEND_Y), (left + 28.0, LEGEND_Y), stroke(line));
        svg.words((left + 34.0, LEGEND_Y), Words::new(text, TEXT, Anchor::Start));
        left += width;
    }
    svg.fill(mark((left + 4.0, LEGEND_Y)), INK);
    svg.words((left + 12.0, LEGEND_Y), Words::new("crossing", TEXT, Anchor::Start));
    svg.outline(mark((left + 88.0, LEGEND_Y)), FRAME);
    svg.words((left + 96.0, LEGEND_Y), Words::new("other vertex", TEXT, Anchor::Start));
}
