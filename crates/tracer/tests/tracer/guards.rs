//! Families whose guards are functions of the parameters, with assertions about their networks.

use stickslip_tracer::{
    Curve, Family, FreeRun, Point, TraceOptions, VertexKind, Window, trace, tracing::Network,
};

use crate::any::any;

/// Guards in their order. Each fires where its function is negative. The itinerary of a margin says
/// which of the guards before it fired. A free run has the margins of the guards that did not fire.
pub struct Guards(pub Vec<fn(&Point) -> f64>);

/// Whether each guard fired.
pub type Label = Vec<bool>;
/// The index of the guard, and whether each guard before it fired.
pub type Margin = (usize, Vec<bool>);

/// A run failed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("a run failed")]
pub struct Failed;

impl Family for Guards {
    type Label = Label;
    type Margin = Margin;
    type Error = Failed;

    fn label(&self, point: &Point) -> Result<Label, Failed> {
        Ok(self.0.iter().map(|function| function(point) < 0.0).collect())
    }

    fn margin(&self, point: &Point, margin: &Margin) -> Result<Option<f64>, Failed> {
        Ok(Some(self.0[margin.0](point)))
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<Label, Margin>, Failed> {
        let label = self.label(point)?;
        let margins = (0..self.0.len())
            .filter(|&i| !label[i])
            .map(|i| ((i, label[..i].to_vec()), self.0[i](point)))
            .collect();
        Ok(FreeRun { label, margins })
    }
}

pub const SQUARE: Window = Window { low: Point::new(-1.0, -1.0), high: Point::new(1.0, 1.0) };

/// Options for functions whose only error is rounding.
pub fn exact() -> TraceOptions {
    TraceOptions { noise: 1e-16, ..TraceOptions::default() }
}

/// The network of the functions, whose curves must end at their vertices.
pub fn traced(functions: Vec<fn(&Point) -> f64>, window: &Window) -> Network<Label, Margin> {
    let network = trace(&any(Guards(functions)), window, &exact()).unwrap();
    assert_eq!(network.unresolved, []);
    for curve in &network.curves {
        let nodes = &curve.nodes;
        assert!(nodes.len() > 1);
        if let Some([start, end]) = curve.ends {
            assert!((nodes[0].point - network.vertices[start].point).norm() < 1e-10);
            assert!((nodes[nodes.len() - 1].point - network.vertices[end].point).norm() < 1e-10);
        } else {
            assert_eq!(nodes[0], nodes[nodes.len() - 1]);
        }
    }
    network
}

/// The place θ on the cubic of a piece, whose handles are those of an arc of a circle.
pub fn cubic<M>(curve: &Curve<Label, M>, piece: usize, theta: f64) -> Point {
    let (a, d) = (curve.nodes[piece], curve.nodes[piece + 1]);
    let half = (0.5 * (1.0 + a.tangent.dot(&d.tangent).min(1.0))).sqrt();
    let handle = 2.0 / 3.0 * (d.point - a.point).norm() / (1.0 + half);
    let (b, c) = (a.point + a.tangent * handle, d.point - d.tangent * handle);
    let rest = 1.0 - theta;
    a.point * rest.powi(3)
        + b * (3.0 * rest * rest * theta)
        + c * (3.0 * rest * theta * theta)
        + d.point * theta.powi(3)
}

/// Asserts that the nodes are within 1e-12 of a curve, and the cubics between them within 2e-10.
/// `distance` is the signed distance from the curve.
pub fn assert_on<M>(curve: &Curve<Label, M>, distance: impl Fn(&Point) -> f64) {
    let (mut nodes, mut pieces) = (0.0_f64, 0.0_f64);
    for node in &curve.nodes {
        nodes = nodes.max(distance(&node.point).abs());
    }
    for piece in 0..curve.nodes.len() - 1 {
        for i in 1..20 {
            let point = cubic(curve, piece, f64::from(i) / 20.0);
            pieces = pieces.max(distance(&point).abs());
        }
    }
    assert!(nodes < 1e-12, "nodes {nodes:e}");
    assert!(pieces < 2e-10, "pieces {pieces:e}");
}

/// The length of a curve.
pub fn length<M>(curve: &Curve<Label, M>) -> f64 {
    (0..curve.nodes.len() - 1)
        .flat_map(|piece| (0..32).map(move |i| (piece, f64::from(i) / 32.0)))
        .map(|(piece, theta)| {
            (cubic(curve, piece, theta + 1.0 / 32.0) - cubic(curve, piece, theta)).norm()
        })
        .sum()
}

/// Asserts that a vertex of this kind is at (x, y).
pub fn has_vertex(network: &Network<Label, Margin>, kind: VertexKind, x: f64, y: f64) {
    let place = Point::new(x, y);
    let found = network
        .vertices
        .iter()
        .any(|vertex| vertex.kind == kind && (vertex.point - place).norm() < 1e-10);
    assert!(found, "{kind:?} at {x}, {y} is not in {:?}", network.vertices);
}

/// The signed distance from a circle.
pub fn circle(x: f64, y: f64, radius: f64) -> impl Fn(&Point) -> f64 {
    move |p| (p - Point::new(x, y)).norm() - radius
}
