//! The plane in which points are located.

use std::f64::consts::TAU;

use stickslip::tracer::{Curve, Node, Point, Vertex, VertexKind, Window, regions::Subdivision};

const WINDOW: Window = Window { low: Point::new(0.0, 0.0), high: Point::new(1.0, 1.0) };

const WAVES: u32 = 20;

/// 40 curves of 4000 cubics in all, one above the other, each with an island.
#[must_use]
pub fn curves() -> (Vec<Curve<u32, u32>>, Vec<Vertex<u32>>) {
    let (mut curves, mut vertices) = (Vec::new(), Vec::new());
    for wave in 0..WAVES {
        let lift = (f64::from(wave) + 0.6) / f64::from(WAVES);
        let node = |i: u32| {
            let x = f64::from(i) / 100.0;
            let (sin, cos) = (9.0 * x).sin_cos();
            let (point, along) = (Point::new(x, lift + 0.015 * sin), Point::new(1.0, 0.135 * cos));
            Node { point, tangent: along.normalize() }
        };
        let nodes: Vec<Node> = (0..=100).map(node).collect();
        for end in [nodes[0], nodes[100]] {
            let (point, kind) = (end.point, VertexKind::WindowEdge);
            vertices.push(Vertex { point, kind, margins: vec![wave] });
        }
        let first = 2 * wave as usize;
        let ends = Some([first, first + 1]);
        curves.push(Curve { margin: wave, sides: [wave + 1, wave], nodes, ends });
        let node = |i: u32| {
            let (sin, cos) = (TAU * f64::from(i) / 100.0).sin_cos();
            let centre = Point::new((f64::from(wave) + 0.5) / f64::from(WAVES), lift - 0.025);
            let point = centre + 0.003 * Point::new(cos, sin);
            Node { point, tangent: Point::new(-sin, cos) }
        };
        let nodes = (0..100).map(node).collect();
        curves.push(Curve { margin: wave, sides: [WAVES + 1 + wave, wave], nodes, ends: None });
    }
    (curves, vertices)
}

/// The regions between them.
///
/// # Panics
/// There are not as many as there should be.
#[must_use]
pub fn subdivision(
    (curves, vertices): (Vec<Curve<u32, u32>>, Vec<Vertex<u32>>),
) -> Subdivision<u32, u32> {
    let plane = Subdivision::new(WINDOW, curves, vertices, 1e-7).expect("curves with a meaning");
    assert!(plane.findings().is_empty() && plane.regions().len() == 41, "{:?}", plane.findings());
    plane
}

/// Places all over it.
#[must_use]
pub fn points() -> Vec<Point> {
    let mut random = fastrand::Rng::with_seed(1);
    (0..10_000).map(|_| Point::new(random.f64(), random.f64())).collect()
}
