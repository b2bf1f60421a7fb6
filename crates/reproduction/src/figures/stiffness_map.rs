//! Maps over stiffness and impact ratio, with the axis of stiffness read in both ways: what Figures
//! 3 and 4 have in common.

use std::sync::Arc;

use stickslip_figure::number;
use stickslip_figure::pictures::map::MapAxis;
use stickslip_plane::{Coordinates, Grid, GridAxis, Range};
use stickslip_studies::paper::{ALPHA, MOST_STIFFNESS, MU, REDUCTION, Reading};

use super::reproduction::Reproduction;
use super::section::ReportSection;
use super::sweep::Sweep;

/// The collisions of a figure, with its axis of stiffness read in one way.
pub struct StiffnessMap {
    pub reading: Reading,
    pub sweep: Arc<Sweep>,
}

impl StiffnessMap {
    /// Both readings, up to an impact ratio.
    pub fn both(reproduction: &Reproduction, most_ratio: f64) -> [Self; 2] {
        let axis = |high| GridAxis { range: Range { low: 0.0, high }, cells: reproduction.cells };
        Reading::ALL.map(|reading| {
            let sweep = Sweep::new(Grid::new(
                axis(reading.kappa(MOST_STIFFNESS)),
                axis(most_ratio),
                Coordinates::Ratio { reduction: REDUCTION, damping: 0.0 },
            ));
            Self { reading, sweep: Arc::new(sweep) }
        })
    }

    /// The axis of stiffness as the figure has it.
    pub fn axis(&self) -> MapAxis<'static> {
        MapAxis { name: self.reading.axis(), range: (0.0, MOST_STIFFNESS) }
    }

    /// A heading that names the reading.
    pub fn heading(&self, quantity: &str) -> String {
        format!("{quantity}, {}", self.reading.words())
    }

    /// `section` with the map in a file.
    pub fn filed(&self, section: ReportSection, figure: &str) -> ReportSection {
        let name = format!("{figure}_{}", self.reading.name());
        let title = self.heading("κ, ψ, g_t/g_n, ε_t and switches as arrays");
        section.with_map(&name, title, &self.sweep)
    }
}

/// A title with what all collisions of a figure have in common.
pub fn title(what: &str) -> String {
    format!("{what}, μ = {}, α = {}, a = 0", number(MU, 4), number(ALPHA, 4))
}
