//! Vertices of known kinds. Each guard is a cubic in u, for u from −1/2 to 1/2. It fires when it
//! falls through zero and, after it has fired, when it rises again.

use stickslip_solver::margin::Margin;
use stickslip_solver::{Direction, Dop853, Guard, HybridSystem, Options, Start, State};
use stickslip_tracer::{
    Point, TraceOptions, VertexKind, Window,
    hybrid::{HybridFamily, Itinerary, Problem},
    trace,
    tracing::{Network, SpecialPoint},
};

use crate::any::{AnySystem, any, any_system};

/// The coefficients of the cubic guard at every point.
struct CubicGuards(fn(&Point) -> [f64; 4]);

/// A run of u with a cubic guard.
struct CubicGuard([f64; 4]);

impl HybridSystem<1, 2> for CubicGuard {
    /// How often the guard has fired.
    type Mode = usize;

    fn field(&self, _fired: usize, _s: f64, _y: &State<1>) -> State<1> {
        State::from([1.0])
    }

    fn guards(&self, fired: usize) -> [Guard; 2] {
        let own = Guard::new(Direction::Falling).from_zero(u32::from(fired > 0));
        [Guard::new(Direction::Below).terminal(), own]
    }

    fn guard_values(&self, fired: usize, _s: f64, y: &State<1>) -> [f64; 2] {
        let ([a, b, c, d], u) = (self.0, y[0]);
        [0.5 - u, sign(fired) * (a + u * (b + u * (c + u * d)))]
    }

    fn guard_rates(&self, fired: usize, _s: f64, y: &State<1>) -> [f64; 2] {
        let ([_, b, c, d], u) = (self.0, y[0]);
        [-1.0, sign(fired) * (b + u * (2.0 * c + u * 3.0 * d))]
    }

    fn transition(&self, fired: usize, _: usize, _s: f64, y: &State<1>) -> (usize, State<1>) {
        (fired + 1, *y)
    }
}

fn sign(fired: usize) -> f64 {
    if fired.is_multiple_of(2) { 1.0 } else { -1.0 }
}

impl Problem<1, 2> for CubicGuards {
    type System = AnySystem<1>;

    fn at(&self, point: &Point) -> (AnySystem<1>, Start<usize, 1>) {
        let start = Start { mode: 0, s: 0.0, state: State::from([-0.5]) };
        (any_system(CubicGuard((self.0)(point))), start)
    }
}

/// The network of a cubic guard, with its kinds of vertices.
fn network(cubic: fn(&Point) -> [f64; 4]) -> Network<Itinerary, Margin> {
    let options = Options { rtol: 1e-14, atol: 1e-14, max_step: 0.1, ..Options::default() };
    let problem = CubicGuards(cubic);
    let family = any(HybridFamily { problem, method: Dop853, options, end: 2.0 });
    let window = Window { low: Point::new(-0.1, -0.11), high: Point::new(0.12, 0.1) };
    let mut network = trace(&family, &window, &TraceOptions::default()).unwrap();
    assert_eq!(network.unresolved, []);
    network.name_vertices();
    network
}

/// The vertices inside the window, without those at its edge, and the number of curves.
fn vertices(cubic: fn(&Point) -> [f64; 4]) -> (Vec<(VertexKind, Point)>, usize) {
    let network = network(cubic);
    let inside = network.vertices.iter().filter(|vertex| vertex.kind != VertexKind::WindowEdge);
    (inside.map(|vertex| (vertex.kind, vertex.point)).collect(), network.curves.len())
}

/// The names of the vertices inside the window.
fn names(cubic: fn(&Point) -> [f64; 4]) -> Vec<SpecialPoint> {
    network(cubic).special_points().into_iter().map(|(_, name)| name).collect()
}

/// Asserts that there is one vertex, at the origin, and `of` curves.
fn assert_single(
    (vertices, curves): (Vec<(VertexKind, Point)>, usize),
    kind: VertexKind,
    of: usize,
) {
    assert_eq!((vertices.len(), curves), (1, of), "{vertices:?}");
    assert_eq!(vertices[0].0, kind);
    assert!(vertices[0].1.norm() < 1e-8, "{vertices:?}");
}

/// The guard y + (1/2 + x − u)²: its minimum y leaves through the end at x = 0.
#[test]
fn a_minimum_that_leaves_through_the_end_is_a_graze_at_the_end() {
    let parabola = |p: &Point| [p.y + (0.5 + p.x).powi(2), -1.0 - 2.0 * p.x, 1.0, 0.0];
    assert_single(vertices(parabola), VertexKind::GrazeAtEnd, 3);
    assert_eq!(names(parabola), [SpecialPoint::GrazeAtEnd]);
}

/// The guard y (1/2 + u)² + (1/2 − u)(x + 6 (u + 0.1)²). Its value at the end is y. Where y
/// vanishes, its minimum vanishes with x.
#[test]
fn a_minimum_and_an_end_of_one_phase_cross() {
    let cubic = |p: &Point| [0.25 * p.y + 0.5 * p.x + 0.03, p.y - p.x + 0.54, p.y + 1.8, -6.0];
    assert_single(vertices(cubic), VertexKind::Crossing, 4);
    assert_eq!(names(cubic), [SpecialPoint::Crossing]);
}

/// The guard y − x u − 4u³. For x < 0 it has a minimum and a maximum. They merge at x = 0, and
/// vanish there for y = 0.
#[test]
fn a_minimum_that_merges_with_a_maximum_is_degenerate() {
    let cubic = |p: &Point| [p.y, -p.x, 0.0, -4.0];
    let names = names(cubic);
    assert!(!names.is_empty() && names.iter().all(|name| *name == SpecialPoint::Cusp), "{names:?}");
    let (vertices, curves) = vertices(cubic);
    assert_eq!(curves, 2);
    // Each branch may have an end of its own there, because margins are cubic in the distance. The
    // measured distance is 6e-8.
    for (kind, point) in vertices {
        assert_eq!(kind, VertexKind::Degenerate);
        assert!(point.norm() < 1.2e-7, "{point:?}");
    }
}
