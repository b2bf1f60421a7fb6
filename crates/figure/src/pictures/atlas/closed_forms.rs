//! Closed forms in the picture of an atlas: the uppermost boundary, and the limits of boundaries
//! for vanishing ψ.

use stickslip_model::exact;
use stickslip_plane::atlas::{BoundaryKind, Frame};

use crate::canvas::Legend;
use crate::canvas::panel::Panel;
use crate::canvas::style::{self, CLOSED_FORM};
use crate::canvas::svg::Svg;

/// Height and half the width of the mark of a limit.
const LIMIT: (f64, f64) = (6.0, 3.5);
/// Width of the key of the uppermost boundary, and distance between the keys of the limits.
const KEYS: (f64, f64) = (28.0, 12.0);
/// From a higher ψ, boundaries need not lead to their limits.
const SMALL_PSI: f64 = 0.05;
/// The most limits that are drawn. More would be closer together than pixels.
const MOST_LIMITS: usize = 1000;

/// The closed forms that are in the picture. There are none with damping.
#[derive(Clone, Debug)]
pub struct ClosedForms {
    /// Points (κ, ψ) of the uppermost boundary; none if it is above or below the window.
    top: Vec<(f64, f64)>,
    /// κ at which boundaries end as ψ vanishes, with the kind of the boundary.
    limits: Vec<(BoundaryKind, f64)>,
}

impl ClosedForms {
    /// The closed forms in `window`, which `panel` shows.
    pub fn of(window: &Frame, panel: &Panel) -> Self {
        let Frame { damping, law, tangential_damping, .. } = *window;
        if damping != 0.0 || !law.acts_as_paper(damping, tangential_damping) {
            return Self { top: Vec::new(), limits: Vec::new() };
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let pixels = 0..=panel.frame.width as u32;
        let kappa = |pixel: u32| panel.value((panel.frame.left + f64::from(pixel), 0.0)).0;
        let top = pixels.map(|pixel| (kappa(pixel), exact::top_boundary(kappa(pixel))));
        // Farther up nothing shows, and coordinates would grow without limit.
        let mut top: Vec<_> = top.filter(|point| point.1 < 10.0 * panel.y.1).collect();
        if !top.iter().any(|point| (panel.y.0..=panel.y.1).contains(&point.1)) {
            top.clear();
        }
        let kind =
            |n| if n % 2 == 0 { BoundaryKind::StickGraze } else { BoundaryKind::EndOfContact };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let first = (window.kappa.low / exact::small_impact_boundary(1)).sqrt().max(1.0) as u32;
        let limits = (first..=u32::MAX)
            .map(|n| (kind(n), exact::small_impact_boundary(n)))
            .skip_while(|(_, kappa)| *kappa < window.kappa.low)
            .take_while(|(_, kappa)| *kappa <= window.kappa.high)
            .take(MOST_LIMITS)
            .filter(|_| window.psi.low <= SMALL_PSI);
        Self { top, limits: limits.collect() }
    }

    /// Whether nothing is in the picture.
    pub fn is_empty(&self) -> bool {
        self.top.is_empty() && self.limits.is_empty()
    }

    /// Draws the closed forms into `panel`.
    pub fn draw(&self, svg: &mut Svg, panel: &Panel) {
        svg.begin_inside(panel.frame);
        panel.curve(svg, self.top.iter().copied(), CLOSED_FORM);
        svg.end_inside();
        svg.begin_group("limits");
        for (kind, kappa) in &self.limits {
            arrow(svg, panel.place((*kappa, panel.y.0)), *kind);
        }
        svg.end_group();
    }

    /// Draws a row of the legend at a place.
    pub fn legend(&self, svg: &mut Svg, at: (f64, f64)) {
        let mut legend = Legend::new(at);
        if !self.top.is_empty() {
            legend.entry(svg, KEYS.0, "uppermost boundary, closed form", |svg, key| {
                let y = key.top + 0.5 * key.height;
                svg.line((key.left, y), (key.right(), y), CLOSED_FORM);
            });
        }
        let kinds = [(BoundaryKind::EndOfContact, "odd"), (BoundaryKind::StickGraze, "even")];
        let (kinds, parities): (Vec<_>, Vec<_>) = kinds
            .into_iter()
            .filter(|(kind, _)| self.limits.iter().any(|limit| limit.0 == *kind))
            .unzip();
        if kinds.is_empty() {
            return;
        }
        let parities = parities.join(" and ");
        let text = format!("κ_n = (nπ/2t_c)^2, limits of boundaries for vanishing ψ, n {parities}");
        let width = KEYS.1 * (kinds.len() - 1) as f64 + 2.0 * LIMIT.1;
        legend.entry(svg, width, &text, |svg, key| {
            let y = key.top + 0.5 * (key.height - LIMIT.0);
            for (index, kind) in kinds.into_iter().enumerate() {
                arrow(svg, (key.left + LIMIT.1 + KEYS.1 * index as f64, y), kind);
            }
        });
    }
}

/// Draws an arrow that points up to a place.
fn arrow(svg: &mut Svg, (x, y): (f64, f64), kind: BoundaryKind) {
    let (height, half) = LIMIT;
    let colour = style::boundary(kind).colour;
    svg.area([(x, y), (x + half, y + height), (x - half, y + height)], colour);
}
