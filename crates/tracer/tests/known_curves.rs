//! Networks of families whose boundaries are known in closed form.

use std::convert::Infallible;
use std::f64::consts::TAU;

use stickslip_tracer::{
    Curve, Family, FreeRun, Network, Point, TraceOptions, VertexKind, Window, trace,
};

/// One guard a function, asked in order: it fires where the function is negative. A margin's itinerary is what the guards before it
/// did; the free run leaves the margins of those that did not fire.
struct Guards(Vec<fn(&Point) -> f64>);

type Label = Vec<bool>;
type Margin = (usize, Vec<bool>);

impl Family for Guards {
    type Label = Label;
    type Margin = Margin;
    type Error = Infallible;

    fn label(&self, point: &Point) -> Result<Label, Infallible> {
        Ok(self.0.iter().map(|function| function(point) < 0.0).collect())
    }

    fn margin(&self, point: &Point, margin: &Margin) -> Result<Option<f64>, Infallible> {
        Ok(Some(self.0[margin.0](point)))
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<Label, Margin>, Infallible> {
        let label = self.label(point)?;
        let margins = (0..self.0.len())
            .filter(|&i| !label[i])
            .map(|i| ((i, label[..i].to_vec()), self.0[i](point)))
            .collect();
        Ok(FreeRun { label, margins })
    }
}

const SQUARE: Window = Window { low: Point::new(-1.0, -1.0), high: Point::new(1.0, 1.0) };

/// The functions are exact to rounding, so nothing is noise.
fn exact() -> TraceOptions {
    TraceOptions { noise: 1e-16, ..TraceOptions::default() }
}

fn traced(functions: Vec<fn(&Point) -> f64>, window: &Window) -> Network<Label, Margin> {
    let network = trace(&Guards(functions), window, &exact()).unwrap();
    assert_eq!(network.unresolved, []);
    for curve in &network.curves {
        let pair = &curve.nodes;
        assert!(pair.len() > 1);
        if let Some([start, end]) = curve.ends {
            assert!((pair[0].point - network.vertices[start].point).norm() < 1e-10);
            assert!((pair[pair.len() - 1].point - network.vertices[end].point).norm() < 1e-10);
        } else {
            assert_eq!(pair[0], pair[pair.len() - 1]);
        }
    }
    eprintln!(
        "{} curves, {} vertices, {:?}",
        network.curves.len(),
        network.vertices.len(),
        network.statistics
    );
    for curve in &network.curves {
        eprintln!(
            "  {:?} {:?} {} nodes {:?} {:?}",
            curve.margin,
            curve.ends,
            curve.nodes.len(),
            curve.nodes[0].point.as_slice(),
            curve.nodes[curve.nodes.len() - 1].point.as_slice()
        );
    }
    for vertex in &network.vertices {
        eprintln!("  {:?} {:?}", vertex.kind, vertex.point.as_slice());
    }
    network
}

/// The cubic of a piece at θ, handles as for an arc of a circle.
fn cubic<M>(curve: &Curve<Label, M>, piece: usize, theta: f64) -> Point {
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

/// Asserts that nodes are within 1e-12 and the cubics between them within 2e-10 of the curve with this signed distance.
fn assert_on<M>(curve: &Curve<Label, M>, distance: impl Fn(&Point) -> f64) {
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
    eprintln!("nodes {nodes:e} pieces {pieces:e}");
    assert!(nodes < 1e-12, "nodes {nodes:e}");
    assert!(pieces < 2e-10, "pieces {pieces:e}");
}

fn length<M>(curve: &Curve<Label, M>) -> f64 {
    (0..curve.nodes.len() - 1)
        .flat_map(|piece| (0..32).map(move |i| (piece, f64::from(i) / 32.0)))
        .map(|(piece, theta)| {
            (cubic(curve, piece, theta + 1.0 / 32.0) - cubic(curve, piece, theta)).norm()
        })
        .sum()
}

fn has_vertex(network: &Network<Label, Margin>, kind: VertexKind, x: f64, y: f64) {
    let place = Point::new(x, y);
    let found = network
        .vertices
        .iter()
        .any(|vertex| vertex.kind == kind && (vertex.point - place).norm() < 1e-10);
    assert!(found, "{kind:?} at {x}, {y} is not in {:?}", network.vertices);
}

fn circle(x: f64, y: f64, radius: f64) -> impl Fn(&Point) -> f64 {
    move |p| (p - Point::new(x, y)).norm() - radius
}

#[test]
fn a_closed_circle() {
    let network = traced(vec![|p| (p - Point::new(0.1, 0.2)).norm_squared() - 0.25], &SQUARE);
    assert_eq!((network.curves.len(), network.vertices.len()), (1, 0));
    let curve = &network.curves[0];
    assert_eq!(curve.ends, None);
    assert_on(curve, circle(0.1, 0.2, 0.5));
    assert!((length(curve) - TAU * 0.5).abs() < 1e-5);
    let runs = network.statistics.free_runs + network.statistics.prescribed_runs;
    assert!(curve.nodes.len() < 100, "{}", curve.nodes.len());
    assert!(runs < 2500, "{runs}");
}

#[test]
fn crossing_circles() {
    let network = traced(
        vec![|p| (p - Point::new(-0.3, 0.0)).norm_squared() - 0.25, |p| {
            (p - Point::new(0.3, 0.0)).norm_squared() - 0.25
        }],
        &SQUARE,
    );
    assert_eq!((network.curves.len(), network.vertices.len()), (4, 2));
    has_vertex(&network, VertexKind::Crossing, 0.0, 0.4);
    has_vertex(&network, VertexKind::Crossing, 0.0, -0.4);
    for curve in &network.curves {
        let x = if curve.margin.0 == 0 { -0.3 } else { 0.3 };
        assert_on(curve, circle(x, 0.0, 0.5));
    }
}

#[test]
fn circles_that_touch() {
    let network = traced(
        vec![|p| (p - Point::new(-0.4, 0.1)).norm_squared() - 0.16, |p| {
            (p - Point::new(0.3, 0.1)).norm_squared() - 0.09
        }],
        &SQUARE,
    );
    assert_eq!((network.curves.len(), network.vertices.len()), (2, 1));
    has_vertex(&network, VertexKind::Crossing, 0.0, 0.1);
    assert!(network.curves.iter().all(|curve| curve.ends == Some([0, 0])));
}

#[test]
fn a_circle_that_touches_from_inside() {
    let network = traced(
        vec![|p| (p - Point::new(0.0, 0.1)).norm_squared() - 0.36, |p| {
            (p - Point::new(0.3, 0.1)).norm_squared() - 0.09
        }],
        &SQUARE,
    );
    assert_eq!((network.curves.len(), network.vertices.len()), (2, 1));
    has_vertex(&network, VertexKind::Crossing, 0.6, 0.1);
}

#[test]
fn a_cusp() {
    let network = traced(
        vec![|p| (p.y - 0.1) * (p.y - 0.1) - (p.x + 0.2) * (p.x + 0.2) * (p.x + 0.2)],
        &SQUARE,
    );
    assert_eq!((network.curves.len(), network.vertices.len()), (2, 3));
    has_vertex(&network, VertexKind::Degenerate, -0.2, 0.1);
    has_vertex(&network, VertexKind::WindowEdge, 0.9_f64.powf(2.0 / 3.0) - 0.2, 1.0);
    has_vertex(&network, VertexKind::WindowEdge, 1.1_f64.powf(2.0 / 3.0) - 0.2, -1.0);
}

#[test]
fn a_figure_of_eight() {
    let network = traced(
        vec![|p| {
            let (x, y) = (p.x - 0.05, p.y + 0.03);
            (x * x + y * y).powi(2) - 0.5 * (x * x - y * y)
        }],
        &SQUARE,
    );
    assert_eq!((network.curves.len(), network.vertices.len()), (2, 1));
    has_vertex(&network, VertexKind::Degenerate, 0.05, -0.03);
}

#[test]
fn a_small_island() {
    let network = traced(
        vec![|p| {
            let (x, y) = (p.x - 0.123, p.y - 0.456);
            x * x + y * y + 0.3 * x * y * y - 1e-6
        }],
        &SQUARE,
    );
    assert_eq!((network.curves.len(), network.vertices.len()), (1, 0));
    assert_eq!(network.curves[0].ends, None);
}

#[test]
fn parallel_lines_a_millionth_apart() {
    let network = traced(vec![|p| p.y - 0.3 * p.x, |p| p.y - 0.3 * p.x - 1e-6], &SQUARE);
    assert_eq!((network.curves.len(), network.vertices.len()), (2, 4));
    has_vertex(&network, VertexKind::WindowEdge, -1.0, -0.3);
    has_vertex(&network, VertexKind::WindowEdge, 1.0, 0.3 + 1e-6);
}

#[test]
fn a_line_through_a_corner() {
    let network = traced(vec![|p| p.y - 0.5 * p.x + 0.5], &SQUARE);
    assert_eq!((network.curves.len(), network.vertices.len()), (1, 2));
    has_vertex(&network, VertexKind::WindowEdge, 1.0, 0.0);
    has_vertex(&network, VertexKind::WindowCorner, -1.0, -1.0);
    assert!((length(&network.curves[0]) - 5.0_f64.sqrt()).abs() < 1e-10);
}
