//! Networks whose curves are known in closed form.

use std::f64::consts::TAU;

use stickslip_tracer::{Point, TraceError, TraceOptions, VertexKind, Window, trace};

use crate::any::any;
use crate::guards::{Guards, SQUARE, assert_on, circle, exact, has_vertex, length, traced};

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
    for curve in &network.curves {
        assert_eq!(curve.ends, Some([0, 0]));
        let (x, radius) = if curve.margin.0 == 0 { (-0.4, 0.4) } else { (0.3, 0.3) };
        assert_on(curve, circle(x, 0.1, radius));
    }
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
    for curve in &network.curves {
        // To first order, the distance is the value divided by the length of the gradient. If the
        // gradient is below 1e-4, rounding errors of 1e-16 limit the accuracy to 1e-12.
        let distance = |p: &Point| {
            let (x, y) = (p.x - 0.05, p.y + 0.03);
            let square = x * x + y * y;
            let gradient = Point::new(4.0 * square * x - x, 4.0 * square * y + y);
            (square * square - 0.5 * (x * x - y * y)) / gradient.norm().max(1e-4)
        };
        assert_on(curve, distance);
    }
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
    assert!((length(&network.curves[0]) - TAU * 1e-3).abs() < 1e-8);
}

/// Ovals of Cassini: two closed curves of one margin, up to 1.6 cells of the grid apart. Of places
/// next to them, only one need be closer to zero than all its neighbours.
#[test]
fn two_small_islands_side_by_side() {
    fn ovals(point: &Point, apart: f64) -> f64 {
        let one = Point::new(0.123, 0.234);
        let other = one + Point::new(1.0, 0.3) * apart;
        let square = |centre: Point| (point - centre).norm_squared() / (apart * apart);
        square(one) * square(other) - 0.01
    }
    let families: [fn(&Point) -> f64; 5] = [
        |p| ovals(p, 0.1),
        |p| ovals(p, 0.05),
        |p| ovals(p, 0.03),
        |p| ovals(p, 0.02),
        |p| ovals(p, 0.01),
    ];
    for (index, family) in families.into_iter().enumerate() {
        let network = traced(vec![family], &SQUARE);
        assert_eq!((network.curves.len(), network.vertices.len()), (2, 0), "{index}");
    }
}

/// Two circles of radius 0.5 overlap in a lens that is 1e-7 thick and 4e-4 long. On both circles it
/// lies between two nodes.
#[test]
fn a_thin_lens() {
    let network = traced(
        vec![|p| (p - Point::new(-0.5, 0.03)).norm_squared() - 0.25, |p| {
            (p - Point::new(0.5 - 1e-7, 0.03)).norm_squared() - 0.25
        }],
        &Window { low: Point::new(-1.1, -1.0), high: Point::new(1.1, 1.0) },
    );
    assert_eq!((network.curves.len(), network.vertices.len()), (4, 2));
    for curve in &network.curves {
        let x = if curve.margin.0 == 0 { -0.5 } else { 0.5 - 1e-7 };
        assert_on(curve, circle(x, 0.03, 0.5));
    }
    let half = (0.25 - (0.5 - 0.5e-7_f64).powi(2)).sqrt();
    for y in [0.03 + half, 0.03 - half] {
        has_vertex(&network, VertexKind::Crossing, -0.5e-7, y);
    }
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

/// The cubics between all nodes are as close to their boundaries as the options ask, also where the
/// curvature changes within a step and up to vertices.
#[test]
fn wavy_boundaries_that_cross() {
    let functions: Vec<fn(&Point) -> f64> = vec![
        |p| (9.0 * p.x + 2.0 * (5.0 * p.y).sin()).sin() + 0.3 * p.y,
        |p| (8.0 * p.y - 1.5 * (6.0 * p.x).cos()).cos() - 0.2 * p.x * p.y,
        |p| p.y - 0.5 * (7.0 * p.x).sin() - 0.4 * (13.0 * p.x).cos(),
    ];
    let network = traced(functions.clone(), &SQUARE);
    assert!(network.curves.len() > 100, "{}", network.curves.len());
    for curve in &network.curves {
        let function = functions[curve.margin.0];
        let distance = |p: &Point| {
            let step = |x, y| function(&(p + Point::new(x, y))) - function(&(p - Point::new(x, y)));
            function(p) * 2e-6 / Point::new(step(1e-6, 0.0), step(0.0, 1e-6)).norm()
        };
        assert_on(curve, distance);
    }
}

#[test]
fn bad_input_is_named() {
    let family = any(Guards(vec![|p| p.x]));
    let options = TraceOptions { max_step: 0.5, ..exact() };
    let error = trace(&family, &SQUARE, &options).unwrap_err();
    assert_eq!(error.to_string(), "max_step = 0.5 is out of range; expected above 0 to 0.25");
    let empty = Window { low: Point::new(0.0, 0.0), high: Point::new(1.0, 0.0) };
    let error = trace(&family, &empty, &exact()).unwrap_err();
    assert_eq!(error, TraceError::Window { window: empty });
    let nothing = any(Guards(vec![|p| if p.x > 0.5 { f64::NAN } else { 1.0 }]));
    let error = trace(&nothing, &SQUARE, &exact()).unwrap_err();
    assert!(matches!(error, TraceError::NotANumber { point } if point.x > 0.5));
}

/// The work of a trace, including the search for boundaries, is at most eleven runs for each node
/// on a simple curve; 10.4 were measured.
#[test]
fn runs_of_a_trace() {
    let plain = |cells| {
        let options = TraceOptions { cells, ..exact() };
        let family = any(Guards(vec![|p| p.y - 0.2 * (4.0 * p.x).sin() - 0.1 * p.x * p.x]));
        trace(&family, &SQUARE, &options).unwrap()
    };
    let network = plain(2);
    assert_eq!(network.curves.len(), 1);
    let work = network.statistics;
    let runs = work.free_runs + work.prescribed_runs;
    assert!(runs < 11 * work.nodes, "{runs} runs for {} nodes", work.nodes);
}
