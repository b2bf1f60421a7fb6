//! Names of points at which two conditions hold together, all at the origin. Runs have a clock and
//! two guards; each fires once.

use std::fmt::Debug;

use stickslip_solver::margin::Margin;
use stickslip_solver::{Direction, Dop853, Guard, HybridSystem, Options, Start, State};
use stickslip_tracer::{
    Family, Point, Surveyor, TraceOptions, VertexKind, Window,
    hybrid::{HybridFamily, Itinerary},
    trace,
    tracing::SpecialPoint,
};

use crate::any::{any, any_system};

const END: f64 = 2.0;

/// The values of the guards at a time, a place of the plane, and the time at which the first one
/// fired, or 0.
type Values = fn(f64, &Point, f64) -> [f64; 2];

/// A run at a place of the plane. Its mode says which guards have fired, one bit each, and its
/// state is the time at which the first one did.
struct Run {
    values: Values,
    point: Point,
}

impl HybridSystem<1, 2> for Run {
    type Mode = usize;

    fn field(&self, _: usize, _s: f64, _: &State<1>) -> State<1> {
        State::from([0.0])
    }
    fn guards(&self, fired: usize) -> [Guard; 2] {
        let has_fired = [fired & 1, fired & 2].map(|bit| bit != 0);
        has_fired.map(|fired| if fired { Guard::OFF } else { Guard::new(Direction::Below) })
    }
    fn guard_values(&self, _: usize, s: f64, y: &State<1>) -> [f64; 2] {
        (self.values)(s, &self.point, y[0])
    }
    fn transition(&self, fired: usize, guard: usize, s: f64, y: &State<1>) -> (usize, State<1>) {
        (fired | (1 << guard), if guard == 0 { State::from([s]) } else { *y })
    }
}

/// All runs with these values of the guards.
fn family(values: Values) -> impl Family<Label = Itinerary, Margin = Margin, Error: Debug> {
    let problem = move |point: &Point| {
        let start = Start { mode: 0, s: 0.0, state: State::from([0.0]) };
        (any_system(Run { values, point: *point }), start)
    };
    let options = Options { rtol: 1e-13, atol: 1e-13, max_step: 0.25, ..Options::default() };
    any(HybridFamily { problem, method: Dop853, options, end: END })
}

/// The name of the vertex at the origin, how far it is from there, and the number of curves.
fn named(values: Values) -> (SpecialPoint, f64, usize) {
    let family = family(values);
    let window = Window { low: Point::new(-0.1, -0.11), high: Point::new(0.12, 0.1) };
    let network = trace(&family, &window, &TraceOptions::default()).unwrap();
    assert_eq!(network.unresolved, []);
    let inside = network.vertices.iter().filter(|vertex| vertex.kind != VertexKind::WindowEdge);
    let [vertex] = inside.collect::<Vec<_>>()[..] else { panic!("{:?}", network.vertices) };
    let [(_, name)] = network.special_points()[..] else { panic!("one name for one vertex") };
    (name, vertex.point.norm(), network.curves.len())
}

#[test]
fn two_extrema_that_graze_in_one_run() {
    let (name, off, curves) =
        named(|s, p, _| [(s - 0.5).powi(2) + p.y - p.x, (s - 1.5).powi(2) + p.y + 2.0 * p.x]);
    assert_eq!((name, curves), (SpecialPoint::DoubleGraze, 4));
    assert!(off < 1e-10, "{off:e}");
}

#[test]
fn two_events_at_the_end_of_the_run() {
    let (name, off, curves) =
        named(|s, p, _| [END + p.y - p.x - s, 2.0 * (END - s) + p.y + 2.0 * p.x]);
    assert_eq!(name, SpecialPoint::SimultaneousEvents);
    // Where both fire, they also swap their order: 2 (y − x) = y + 2 x.
    assert_eq!(curves, 5);
    assert!(off < 1e-10, "{off:e}");
}

/// Behind the graze of the first guard, where it fires at 1/2 − √−y, the least value of the second
/// one has a square root: it is x + √−y for y < 0 and x otherwise.
fn graze_behind_a_graze(s: f64, p: &Point, first: f64) -> [f64; 2] {
    let earlier = if first > 0.0 { 0.5 - first } else { 0.0 };
    [(s - 0.5).powi(2) + p.y, (s - 1.5).powi(2) + p.x + earlier]
}

#[test]
fn a_graze_behind_a_graze_touches_it() {
    let (name, off, curves) = named(graze_behind_a_graze);
    assert_eq!((name, curves), (SpecialPoint::Tangency, 4));
    assert!(off < 1e-12, "{off:e}");
}

/// The boundaries y = 0 and y = −x² touch beyond the window's edge x = −r. Between them both guards
/// fire, in a strip that is r² wide at the edge. Where that is too thin for an outline, the tracer
/// has to look beyond the edge.
#[test]
fn boundaries_that_touch_beyond_the_edge_are_both_there() {
    let family = family(graze_behind_a_graze);
    for beyond in [1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 0.0] {
        let window = Window { low: Point::new(-0.1, -0.03), high: Point::new(-beyond, 0.03) };
        let mut surveyor = Surveyor::default();
        if beyond < 1e-4 {
            surveyor.options.trace.beyond = 1e-3;
        }
        let atlas = surveyor.atlas(&family, &window).unwrap();
        assert_eq!(atlas.unresolved, [], "{beyond:e}");
        assert_eq!(atlas.plane.findings(), [], "{beyond:e}");
        assert_eq!(atlas.plane.regions().len(), 3, "{beyond:e}");
        for x in [-0.09_f64, -0.03, -0.011] {
            for (y, fired) in [(0.01, vec![1]), (-0.5 * x * x, vec![0, 1]), (-0.02, vec![0])] {
                let label = atlas.label(&Point::new(x, y)).cloned();
                assert_eq!(label, Some(Itinerary::Fires(fired)), "{beyond:e}: ({x}, {y})");
            }
        }
    }
}
