//! Planes with known answers: the curves are parametrised, and explicit functions give the labels.

use std::convert::Infallible;
use std::f64::consts::{PI, TAU};

use stickslip_tracer::{
    Curve, Family, FreeRun, Node, Point, Vertex, VertexKind, Window,
    regions::{Subdivision, SubdivisionError},
};

pub const TOLERANCE: f64 = 1e-10;
pub const UNIT: Window = Window { low: Point::new(0.0, 0.0), high: Point::new(1.0, 1.0) };

/// A plane that is divided by curves, with the label that is true at each point.
#[derive(Clone)]
pub struct KnownPlane {
    pub curves: Vec<Curve<i32, usize>>,
    pub vertices: Vec<Vertex<usize>>,
    pub truth: fn(&Point) -> i32,
}

impl KnownPlane {
    pub fn new(truth: fn(&Point) -> i32) -> Self {
        Self { curves: Vec::new(), vertices: Vec::new(), truth }
    }

    /// Adds a vertex.
    pub fn vertex(mut self, x: f64, y: f64, kind: VertexKind) -> Self {
        self.vertices.push(Vertex { point: Point::new(x, y), kind, margins: Vec::new() });
        self
    }

    /// Adds a curve. At each of the `parameters`, `along` gives a node (x, y) and its derivatives
    /// (x′, y′). `sides` are the labels on the left and on the right.
    pub fn curve(
        mut self,
        along: impl Fn(f64) -> [f64; 4],
        parameters: impl Iterator<Item = f64>,
        sides: [i32; 2],
        ends: Option<[usize; 2]>,
    ) -> Self {
        let nodes = parameters
            .map(|s| {
                let [x, y, dx, dy] = along(s);
                Node { point: Point::new(x, y), tangent: Point::new(dx, dy).normalize() }
            })
            .collect();
        self.curves.push(Curve { margin: self.curves.len(), sides, nodes, ends });
        self
    }

    pub fn subdivision(&self) -> Result<Subdivision<i32, usize>, SubdivisionError> {
        Subdivision::new(UNIT, self.curves.clone(), self.vertices.clone(), TOLERANCE)
    }
}

impl Family for KnownPlane {
    type Label = i32;
    type Margin = usize;
    type Error = Infallible;

    fn label(&self, point: &Point) -> Result<i32, Infallible> {
        Ok((self.truth)(point))
    }

    fn margin(&self, _: &Point, _: &usize) -> Result<Option<f64>, Infallible> {
        Ok(None)
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<i32, usize>, Infallible> {
        Ok(FreeRun { label: (self.truth)(point), margins: Vec::new() })
    }
}

/// `count` + 1 parameters, spread evenly from `from` to `to`.
pub fn even(from: f64, to: f64, count: u32) -> impl Iterator<Item = f64> {
    (0..=count).map(move |i| from + (to - from) * f64::from(i) / f64::from(count))
}

/// `count` + 1 parameters from 0 to `to`, dense near 0.
fn graded(to: f64, count: u32) -> impl Iterator<Item = f64> {
    even(0.0, 1.0, count).map(move |s| to * s * s)
}

/// A circle, parametrised by the angle.
pub fn circle(x: f64, y: f64, radius: f64) -> impl Fn(f64) -> [f64; 4] {
    move |s| {
        let (sin, cos) = s.sin_cos();
        [x + radius * cos, y + radius * sin, -radius * sin, radius * cos]
    }
}

/// 1 if the point is inside the circle, else 0.
pub fn inside(point: &Point, x: f64, y: f64, radius: f64) -> i32 {
    i32::from((point - Point::new(x, y)).norm() < radius)
}

/// Two circles. The label is 1 in the first, 2 in the second and 3 in both.
pub fn crossing_circles() -> KnownPlane {
    let half = 0.0525_f64.sqrt();
    let angle = half.atan2(0.1);
    KnownPlane::new(|p| inside(p, 0.4, 0.5, 0.25) + 2 * inside(p, 0.6, 0.5, 0.25))
        .vertex(0.5, 0.5 - half, VertexKind::Crossing)
        .vertex(0.5, 0.5 + half, VertexKind::Crossing)
        .curve(circle(0.4, 0.5, 0.25), even(-angle, angle, 60), [3, 2], Some([0, 1]))
        .curve(circle(0.4, 0.5, 0.25), even(angle, TAU - angle, 160), [1, 0], Some([1, 0]))
        .curve(circle(0.6, 0.5, 0.25), even(PI - angle, PI + angle, 60), [3, 1], Some([1, 0]))
        .curve(
            circle(0.6, 0.5, 0.25),
            even(PI + angle, 3.0 * PI - angle, 160),
            [2, 0],
            Some([0, 1]),
        )
}

/// A circle, and a smaller one that touches it from inside or from outside in the direction
/// `angle`.
///
/// `truth` is right for the angle 0 only.
pub fn touching_circles(angle: f64, within: bool) -> KnownPlane {
    let (sin, cos) = angle.sin_cos();
    let (touch, middle) = (0.25, if within { 0.15 } else { 0.35 });
    let start = if within { angle } else { angle + PI };
    let truth: fn(&Point) -> i32 = if within {
        |p| inside(p, 0.5, 0.5, 0.25) + inside(p, 0.65, 0.5, 0.1)
    } else {
        |p| inside(p, 0.5, 0.5, 0.25) + 2 * inside(p, 0.85, 0.5, 0.1)
    };
    KnownPlane::new(truth)
        .vertex(0.5 + touch * cos, 0.5 + touch * sin, VertexKind::Degenerate)
        .curve(circle(0.5, 0.5, 0.25), even(angle, angle + TAU, 200), [1, 0], Some([0, 0]))
        .curve(
            circle(0.5 + middle * cos, 0.5 + middle * sin, 0.1),
            even(start, start + TAU, 130),
            if within { [2, 1] } else { [2, 0] },
            Some([0, 0]),
        )
}

/// The cusp (y − 0.5)² = (x − 0.3)³. The label is 1 between the branches.
pub fn cusp() -> KnownPlane {
    let reach = 0.7_f64.sqrt();
    let rise = reach * reach * reach;
    let branch =
        |sign: f64| move |s: f64| [0.3 + s * s, 0.5 + sign * s * s * s, 2.0, 3.0 * sign * s];
    // The branches leave the window at the upper and at the lower side, at s = 0.5^(1/3).
    assert!(rise > 0.5);
    let s = 0.5_f64.cbrt();
    KnownPlane::new(|p| {
        let x = p.x - 0.3;
        i32::from(x > 0.0 && (p.y - 0.5).powi(2) < x.powi(3))
    })
    .vertex(0.3, 0.5, VertexKind::Degenerate)
    .vertex(0.3 + s * s, 1.0, VertexKind::WindowEdge)
    .vertex(0.3 + s * s, 0.0, VertexKind::WindowEdge)
    .curve(branch(1.0), graded(s, 500), [0, 1], Some([0, 1]))
    .curve(branch(-1.0), graded(s, 500), [1, 0], Some([0, 2]))
}

/// The cusp with both coordinates exchanged. Its branches leave the vertex upwards, both with a
/// vertical tangent.
pub fn upright_cusp() -> KnownPlane {
    let mut plane = cusp();
    plane.truth = |p| {
        let y = p.y - 0.3;
        i32::from(y > 0.0 && (p.x - 0.5).powi(2) < y.powi(3))
    };
    let exchange = |point: &mut Point| *point = Point::new(point.y, point.x);
    for vertex in &mut plane.vertices {
        exchange(&mut vertex.point);
    }
    for curve in &mut plane.curves {
        curve.sides.reverse();
        for node in &mut curve.nodes {
            exchange(&mut node.point);
            exchange(&mut node.tangent);
        }
    }
    plane
}

/// The figure of eight y² = x² − x⁴, scaled by 0.4 about the middle of the window. The label is 1
/// in the right lobe and 2 in the left one.
pub fn figure_of_eight() -> KnownPlane {
    let along = |s: f64| {
        let (sin, cos) = s.sin_cos();
        [0.5 + 0.4 * sin, 0.5 + 0.4 * sin * cos, cos, cos * cos - sin * sin]
    };
    KnownPlane::new(|p| {
        let (x, y) = ((p.x - 0.5) / 0.4, (p.y - 0.5) / 0.4);
        let inside = y * y < x * x - x.powi(4);
        i32::from(inside) * if x > 0.0 { 1 } else { 2 }
    })
    .vertex(0.5, 0.5, VertexKind::Crossing)
    .curve(along, even(0.0, PI, 800), [0, 1], Some([0, 0]))
    .curve(along, even(PI, TAU, 800), [2, 0], Some([0, 0]))
}

/// An island with radius 1e-3 and label 2 in another one with radius 0.3 and label 1. The curve of
/// the first repeats its first node as its last node, that of the second does not.
pub fn islands() -> KnownPlane {
    KnownPlane::new(|p| inside(p, 0.5, 0.5, 0.3) + inside(p, 0.4, 0.6, 1e-3))
        .curve(circle(0.4, 0.6, 1e-3), even(0.3, 0.3 + TAU, 60), [2, 1], None)
        .curve(circle(0.5, 0.5, 0.3), even(0.1, 0.1 + TAU * 199.0 / 200.0, 199), [1, 0], None)
}

/// Two waves 1e-6 apart, from the left side of the window to the right one. The labels are 2, 1 and
/// 0, from above.
pub fn close_curves() -> KnownPlane {
    let wave = |lift: f64| {
        move |x: f64| [x, 0.5 + lift + 0.1 * (6.0 * x).sin(), 1.0, 0.6 * (6.0 * x).cos()]
    };
    let end = 0.5 + 0.1 * 6.0_f64.sin();
    KnownPlane::new(|p| {
        let y = p.y - 0.5 - 0.1 * (6.0 * p.x).sin();
        i32::from(y > 0.0) + i32::from(y > 1e-6)
    })
    .vertex(0.0, 0.5, VertexKind::WindowEdge)
    .vertex(1.0, end, VertexKind::WindowEdge)
    .vertex(0.0, 0.5 + 1e-6, VertexKind::WindowEdge)
    .vertex(1.0, end + 1e-6, VertexKind::WindowEdge)
    .curve(wave(0.0), even(0.0, 1.0, 700), [1, 0], Some([0, 1]))
    .curve(wave(1e-6), even(0.0, 1.0, 700), [2, 1], Some([2, 3]))
}

/// A wave from corner to corner, a circle around a corner, and a circle that touches the left side
/// of the window from inside.
pub fn edges_and_corner() -> KnownPlane {
    let wave = |x: f64| {
        let angle = PI * x;
        [x, x * x + 0.1 * angle.sin(), 1.0, 2.0 * x + 0.1 * PI * angle.cos()]
    };
    KnownPlane::new(|p| {
        let above = i32::from(p.y > p.x * p.x + 0.1 * (PI * p.x).sin());
        above + 2 * inside(p, 1.0, 0.0, 0.4) + 4 * inside(p, 0.15, 0.7, 0.15)
    })
    .vertex(0.0, 0.0, VertexKind::WindowCorner)
    .vertex(1.0, 1.0, VertexKind::WindowCorner)
    .vertex(1.0, 0.4, VertexKind::WindowEdge)
    .vertex(0.6, 0.0, VertexKind::WindowEdge)
    .vertex(0.0, 0.7, VertexKind::WindowEdge)
    .curve(wave, even(0.0, 1.0, 400), [1, 0], Some([0, 1]))
    .curve(circle(1.0, 0.0, 0.4), even(0.5 * PI, PI, 60), [2, 0], Some([2, 3]))
    .curve(circle(0.15, 0.7, 0.15), even(PI, 3.0 * PI, 160), [5, 1], Some([4, 4]))
}

/// A line that ends beside a corner, and two waves that begin beside each other on the left side of
/// the window and meet inside. The parts of the window's boundary between these ends are hardly
/// longer than the tolerance.
pub fn short_frame_parts() -> KnownPlane {
    const SHORT: f64 = 1.5 * TOLERANCE;
    let line = |s: f64| [1.0 - SHORT - 0.2 * s, 1.0 - s, -0.2, -1.0];
    let wave = |sign: f64| {
        move |x: f64| {
            let half = 0.5 * SHORT * (1.0 - 2.0 * x) + 0.05 * (TAU * x).sin();
            let slope = 0.05 * TAU * (TAU * x).cos() - SHORT;
            [x, 0.3 + sign * half, 1.0, sign * slope]
        }
    };
    KnownPlane::new(|p| {
        let half = 0.5 * SHORT * (1.0 - 2.0 * p.x) + 0.05 * (TAU * p.x).sin();
        let between = p.x < 0.5 && (p.y - 0.3).abs() < half;
        i32::from(p.x - 0.8 + SHORT > 0.2 * p.y) + 2 * i32::from(between)
    })
    .vertex(1.0 - SHORT, 1.0, VertexKind::WindowEdge)
    .vertex(0.8 - SHORT, 0.0, VertexKind::WindowEdge)
    .vertex(0.0, 0.3 - 0.5 * SHORT, VertexKind::WindowEdge)
    .vertex(0.0, 0.3 + 0.5 * SHORT, VertexKind::WindowEdge)
    .vertex(0.5, 0.3, VertexKind::Crossing)
    .curve(line, even(0.0, 1.0, 10), [1, 0], Some([0, 1]))
    .curve(wave(-1.0), even(0.0, 0.5, 100), [2, 0], Some([2, 4]))
    .curve(wave(1.0), even(0.0, 0.5, 100), [0, 2], Some([3, 4]))
}

/// Three curves that meet closer to the lower side than the tolerance. The shortest leads there,
/// with the rounding of its nodes.
pub fn vertex_beside_the_frame() -> KnownPlane {
    const HIGH: f64 = 0.3 * TOLERANCE;
    let right = |s: f64| [0.5 + 0.2 * s, HIGH + (1.0 - HIGH) * s, 0.2, 1.0 - HIGH];
    let left = |s: f64| [0.5 - 0.5 * s, HIGH + (0.4 - HIGH) * s, -0.5, 0.4 - HIGH];
    let down = |s: f64| [0.5 - 3e-13 * (PI * s).sin(), HIGH * (1.0 - s), 0.0, -1.0];
    KnownPlane::new(|p| match p {
        _ if p.x > 0.5 + 0.2 * p.y => 2,
        _ if p.y < 0.4 - 0.8 * p.x => 0,
        _ => 1,
    })
    .vertex(0.5, HIGH, VertexKind::Crossing)
    .vertex(0.7, 1.0, VertexKind::WindowEdge)
    .vertex(0.0, 0.4, VertexKind::WindowEdge)
    .vertex(0.5, 0.0, VertexKind::WindowEdge)
    .curve(right, even(0.0, 1.0, 10), [1, 2], Some([0, 1]))
    .curve(left, even(0.0, 1.0, 10), [0, 1], Some([0, 2]))
    .curve(down, even(0.0, 1.0, 2), [2, 0], Some([0, 3]))
}

/// Three upright lines that cross three level ones. Vertices lie above each other, and pieces have
/// no extent in x.
pub fn grid() -> KnownPlane {
    let at = |i: usize| 0.25 * i as f64;
    let mut plane = KnownPlane::new(|p| {
        let field = |x: f64| i32::from(x > 0.25) + i32::from(x > 0.5) + i32::from(x > 0.75);
        field(p.x) + 4 * field(p.y)
    });
    for j in 0..=4 {
        for i in 0..=4 {
            let edge = [i, j].iter().any(|k| k % 4 == 0);
            let kind = if edge { VertexKind::WindowEdge } else { VertexKind::Crossing };
            plane = plane.vertex(at(i), at(j), kind);
        }
    }
    for line in 1..4 {
        for part in 0..4_usize {
            let (label, across) =
                ([line, part].map(|k| i32::try_from(k).expect("small")), at(line));
            let level = move |s: f64| [s, across, 1.0, 0.0];
            let upright = move |s: f64| [across, s, 0.0, 1.0];
            let ends = |stride: usize, other: usize| {
                let first = line * stride + part * other;
                Some([first, first + other])
            };
            let below = label[1] + 4 * label[0] - 4;
            let left = label[0] - 1 + 4 * label[1];
            let span = || even(at(part), at(part + 1), 3);
            plane = plane.curve(level, span(), [below + 4, below], ends(5, 1)).curve(
                upright,
                span(),
                [left, left + 1],
                ends(1, 5),
            );
        }
    }
    plane
}

/// The plane with errors like those of a trace: every node is moved by up to `distance`, and every
/// tangent is turned by up to `angle`.
pub fn disturbed(mut plane: KnownPlane, distance: f64, angle: f64, seed: u64) -> KnownPlane {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut up_to = |size: f64| size * (2.0 * random.f64() - 1.0);
    for node in plane.curves.iter_mut().flat_map(|curve| &mut curve.nodes) {
        let normal = Point::new(-node.tangent.y, node.tangent.x);
        node.point += up_to(distance) * normal;
        node.tangent = (node.tangent + up_to(angle) * normal).normalize();
    }
    plane
}
