//! Tracing by margins alone: crossings, touches, margins that are one, and what no run sees.

use std::convert::Infallible;

use stickslip_tracer::{
    Family, FreeRun, Point, TraceOptions, Window,
    regions::Subdivision,
    tracing::{Network, trace_by_margins},
};

/// Margins with names, each with the function of the plane that it is where it exists.
struct Shapes<L> {
    label: fn(&Point) -> L,
    margins: &'static [(&'static str, Value)],
}

/// A margin where it exists.
type Value = fn(&Point) -> Option<f64>;

impl<L: Clone + std::fmt::Debug + Ord + std::hash::Hash> Family for Shapes<L> {
    type Label = L;
    type Margin = &'static str;
    type Error = Infallible;

    fn label(&self, point: &Point) -> Result<L, Infallible> {
        Ok((self.label)(point))
    }

    fn margin(&self, point: &Point, margin: &&'static str) -> Result<Option<f64>, Infallible> {
        let own = self.margins.iter().find(|(name, _)| name == margin);
        Ok(own.and_then(|(_, value)| value(point)))
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<L, &'static str>, Infallible> {
        let values = self.margins.iter().map(|(name, value)| (*name, value(point)));
        let margins = values.filter_map(|(name, value)| value.map(|value| (name, value))).collect();
        Ok(FreeRun { label: (self.label)(point), margins })
    }
}

/// The regions of shapes in the square around the origin, without contradictions, and how often
/// each margin is a curve.
fn divided<L>(shapes: &Shapes<L>) -> (Subdivision<L, &'static str>, Vec<&'static str>)
where
    L: Clone + std::fmt::Debug + Ord + std::hash::Hash,
{
    let window = Window { low: Point::new(-1.0, -1.1), high: Point::new(1.2, 1.0) };
    let options = TraceOptions { cells: 8, ..TraceOptions::default() };
    let network = trace_by_margins(shapes, &window, &options).unwrap();
    let Network { curves, vertices, unresolved, .. } = network;
    assert!(unresolved.is_empty());
    let mut names: Vec<&str> = curves.iter().map(|curve| curve.margin).collect();
    names.sort_unstable();
    let plane = Subdivision::new(window, curves, vertices, 1e-9).unwrap();
    assert_eq!(plane.findings(), []);
    (plane, names)
}

#[test]
fn circles_and_a_ring() {
    let shapes = Shapes {
        label: |p| {
            let inside = |x: f64, radius: f64| (p - Point::new(x, 0.0)).norm() < radius;
            [inside(-0.2, 0.5), inside(0.3, 0.5), inside(0.05, 0.1)]
        },
        margins: &[
            ("left", |p| Some((p - Point::new(-0.2, 0.0)).norm_squared() - 0.25)),
            ("right", |p| Some((p - Point::new(0.3, 0.0)).norm_squared() - 0.25)),
            ("small", |p| Some((p - Point::new(0.05, 0.0)).norm_squared() - 0.01)),
        ],
    };
    let (plane, names) = divided(&shapes);
    assert_eq!(plane.regions().len(), 5);
    assert_eq!(names, ["left", "left", "right", "right", "small"]);
    // The circles cross at (0.05, ±√3/4).
    let heights = plane.vertices().iter().map(|vertex| vertex.point.y.abs());
    assert!(heights.map(|y| (y - 0.1875_f64.sqrt()).abs()).all(|error| error < 1e-11));
}

/// Below a bound that begins on another one with its tangent, the label is another one: the strip
/// between the two is narrower than labels can tell over a hundredth of the window.
#[test]
fn a_touch() {
    let shapes = Shapes {
        label: |p| match (p.y < 0.0, p.x > 0.0 && p.y < 3.5e-3 * p.x * p.x) {
            (true, _) => "below",
            (false, true) => "between",
            (false, false) => "above",
        },
        margins: &[
            ("line", |p| Some(p.y)),
            ("parabola", |p| (p.x > 0.0).then_some(p.y - 3.5e-3 * p.x * p.x)),
        ],
    };
    let (plane, names) = divided(&shapes);
    assert_eq!(plane.regions().len(), 3);
    assert_eq!(names, ["line", "line", "parabola"]);
    let inner = plane.vertices().iter().filter(|vertex| !vertex.kind.is_on_window());
    let inner: Vec<Point> = inner.map(|vertex| vertex.point).collect();
    assert!(matches!(inner[..], [touch] if touch.norm() < 1e-8));
}

/// Two margins are one function, one of them only in half of the window.
#[test]
fn one_function_with_two_names() {
    let shapes = Shapes {
        label: |p| p.x + 0.3 * p.y > 0.1,
        margins: &[
            ("half", |p| (p.y > 0.05).then_some(p.x + 0.3 * p.y - 0.1)),
            ("whole", |p| Some(0.1 - p.x - 0.3 * p.y)),
        ],
    };
    let (plane, names) = divided(&shapes);
    assert_eq!((plane.regions().len(), plane.curves().len()), (2, names.len()));
    assert!(names.contains(&"whole"));
}

/// A margin that vanishes where no run has its itinerary divides nothing.
#[test]
fn what_no_run_sees() {
    let shapes = Shapes {
        label: |p| p.x > 0.0 && p.y > 0.2,
        margins: &[("upright", |p| Some(p.x)), ("level", |p| Some(p.y - 0.2))],
    };
    let (plane, names) = divided(&shapes);
    assert_eq!(plane.regions().len(), 2);
    assert_eq!(names, ["level", "upright"]);
}
