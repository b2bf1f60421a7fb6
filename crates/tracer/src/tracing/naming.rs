//! The kinds of the vertices of a hybrid system.

use stickslip_solver::margin::{Margin, Place};

use crate::curve::VertexKind;
use crate::tracing::network::Network;
use crate::tracing::special_points::same_phase;

impl<Label> Network<Label, Margin> {
    /// Sets the kinds of the vertices inside the window by the margins of the curves that end
    /// there.
    ///
    /// Before this call, the kind of a vertex says how the tracer found it, but more curves may
    /// have come to end there since. A boundary that crosses another one goes on beyond it, so that
    /// at least four curves end at a [`VertexKind::Crossing`], whatever their margins are: even the
    /// minimum and the end of one phase may vanish independently of each other. Where fewer curves
    /// end, one boundary turns into another. The kind then depends on what vanishes on the curves:
    ///
    /// - a minimum and the end of the same phase: [`VertexKind::GrazeAtEnd`]
    /// - ends of the run only: [`VertexKind::VanishingPhase`]
    /// - anything else: [`VertexKind::Degenerate`]
    pub fn name_vertices(&mut self) {
        let mut arrivals: Vec<Vec<&Margin>> = vec![Vec::new(); self.vertices.len()];
        for curve in &self.curves {
            for end in curve.ends.into_iter().flatten() {
                arrivals[end].push(&curve.margin);
            }
        }
        for (vertex, margins) in self.vertices.iter_mut().zip(&arrivals) {
            let at_window = vertex.kind.is_on_window();
            if !at_window && !margins.is_empty() {
                vertex.kind = kind(margins);
            }
        }
    }
}

/// The kind of a vertex inside the window at which curves with these margins end.
fn kind(margins: &[&Margin]) -> VertexKind {
    let (ends, minima): (Vec<&Margin>, Vec<&Margin>) =
        margins.iter().copied().partition(|margin| margin.place == Place::End);
    let meets_end = |minimum: &&Margin| ends.iter().any(|end| same_phase(minimum, end));
    if margins.len() >= 4 {
        VertexKind::Crossing
    } else if minima.is_empty() {
        VertexKind::VanishingPhase
    } else if minima.iter().any(meets_end) {
        VertexKind::GrazeAtEnd
    } else {
        VertexKind::Degenerate
    }
}
