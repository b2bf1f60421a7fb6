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
    /// Margins that no run lists, two of which vanish together in a cusp.
    hidden: &'static [(&'static str, Value)],
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
        let mut all = self.margins.iter().chain(self.hidden);
        let own = all.find(|(name, _)| name == margin);
        Ok(own.and_then(|(_, value)| value(point)))
    }

    fn cusps(&self, _: &&'static str) -> Vec<[&'static str; 2]> {
        self.hidden.chunks(2).map(|pair| [pair[0].0, pair[1].0]).collect()
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
        hidden: &[],
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
        hidden: &[],
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
        hidden: &[],
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
        hidden: &[],
    };
    let (plane, names) = divided(&shapes);
    assert_eq!(plane.regions().len(), 2);
    assert_eq!(names, ["level", "upright"]);
}

/// The only vertex inside the window.
fn inner<L>(plane: &Subdivision<L, &'static str>) -> Point {
    let inner = plane.vertices().iter().filter(|vertex| !vertex.kind.is_on_window());
    let [vertex] = inner.collect::<Vec<_>>()[..] else { panic!("{:?}", plane.vertices()) };
    vertex.point
}

/// Where circles touch their gradients are parallel, from outside and from inside.
#[test]
fn circles_that_touch() {
    fn circle(p: &Point, x: f64, radius: f64) -> f64 {
        (p - Point::new(x, 0.1)).norm_squared() - radius * radius
    }
    let outside = Shapes {
        label: |p| [circle(p, -0.4, 0.4) < 0.0, circle(p, 0.3, 0.3) < 0.0],
        margins: &[
            ("left", |p| Some(circle(p, -0.4, 0.4))),
            ("right", |p| Some(circle(p, 0.3, 0.3))),
        ],
        hidden: &[],
    };
    let inside = Shapes {
        label: |p| [circle(p, 0.0, 0.6) < 0.0, circle(p, 0.3, 0.3) < 0.0],
        margins: &[
            ("large", |p| Some(circle(p, 0.0, 0.6))),
            ("small", |p| Some(circle(p, 0.3, 0.3))),
        ],
        hidden: &[],
    };
    for (shapes, x) in [(outside, 0.0), (inside, 0.6)] {
        let (plane, names) = divided(&shapes);
        assert_eq!((plane.regions().len(), names.len()), (3, 2));
        let off = (inner(&plane) - Point::new(x, 0.1)).norm();
        assert!(off < 1e-9, "{off:e}");
    }
}

/// Two margins end in a cusp, where the product of their square roots does. Smooth ones that vanish
/// there tell where it is.
#[test]
fn a_cusp_that_the_family_knows() {
    fn wedge(p: &Point, sign: f64) -> Option<f64> {
        let (x, y) = (p.x + 0.2 + 0.1 * p.y, p.y - 0.1);
        (x > 0.0 && y.abs() < 1.5 * x.powf(1.5)).then(|| x.powf(1.5) - sign * y)
    }
    let shapes = Shapes {
        label: |p| [1.0, -1.0].iter().all(|sign| wedge(p, *sign).is_some_and(|m| m > 0.0)),
        margins: &[("upper", |p| wedge(p, 1.0)), ("lower", |p| wedge(p, -1.0))],
        hidden: &[("along", |p| Some(p.x + 0.2 + 0.1 * p.y)), ("across", |p| Some(p.y - 0.1))],
    };
    let (plane, names) = divided(&shapes);
    assert_eq!((plane.regions().len(), names), (2, vec!["lower", "upper"]));
    let off = (inner(&plane) - Point::new(-0.21, 0.1)).norm();
    assert!(off < 1e-11, "{off:e}");
}

/// A bound has a square root in another margin, on which it begins with its tangent.
#[test]
fn a_bound_that_begins_on_a_graze() {
    fn graze(p: &Point) -> f64 {
        p.y + 0.02 + 0.3 * p.x * p.x
    }
    let shapes = Shapes {
        label: |p| {
            let r = graze(p);
            [r < 0.0, r < 0.0 && p.x - 0.03 + 7.0 * (-r).sqrt() > 0.0]
        },
        margins: &[
            ("graze", |p| Some(graze(p))),
            ("second", |p| {
                let r = graze(p);
                (r < 0.0).then(|| p.x - 0.03 + 7.0 * (-r).sqrt())
            }),
        ],
        hidden: &[],
    };
    let (plane, names) = divided(&shapes);
    assert_eq!((plane.regions().len(), names), (3, vec!["graze", "graze", "second"]));
    let off = (inner(&plane) - Point::new(0.03, -0.02 - 0.3 * 0.03 * 0.03)).norm();
    assert!(off < 1e-11, "{off:e}");
}

/// A circle leaves the window by less than a step is long.
#[test]
fn a_bulge_beyond_an_edge() {
    fn circle(p: &Point) -> f64 {
        (p - Point::new(0.7001, 0.1)).norm_squared() - 0.25
    }
    let shapes = Shapes {
        label: |p| circle(p) < 0.0,
        margins: &[("circle", |p| Some(circle(p)))],
        hidden: &[],
    };
    let (plane, names) = divided(&shapes);
    assert_eq!((plane.regions().len(), names), (2, vec!["circle"]));
    let height = (0.25_f64 - 0.4999 * 0.4999).sqrt();
    let heights = plane.vertices().iter().map(|vertex| (vertex.point.y - 0.1).abs());
    assert!(heights.map(|y| (y - height).abs()).all(|off| off < 1e-9));
    assert_eq!(plane.vertices().len(), 2);
}

/// A strip beside a circle that is narrower than labels are usually asked for. Only runs in it know
/// the margin of its other side.
#[test]
fn a_strip_along_a_line() {
    fn circles(p: &Point) -> [f64; 2] {
        [0.5, 0.5 - 1e-6].map(|radius| p.norm_squared() - radius * radius)
    }
    let shapes = Shapes {
        label: |p| circles(p).map(|value| value < 0.0),
        margins: &[
            ("outer", |p| Some(circles(p)[0])),
            ("inner", |p| {
                let [outer, inner] = circles(p);
                (outer < 0.0 && inner > -1e-7).then_some(inner)
            }),
        ],
        hidden: &[],
    };
    let (plane, names) = divided(&shapes);
    assert_eq!((plane.regions().len(), names), (3, vec!["inner", "outer"]));
}

/// The zeros of a known line are not searched for again.
#[test]
fn runs_of_a_closed_line() {
    let shapes = Shapes {
        label: |p| p.norm_squared() < 0.25,
        margins: &[("circle", |p| Some(p.norm_squared() - 0.25))],
        hidden: &[],
    };
    let window = Window { low: Point::new(-1.0, -1.1), high: Point::new(1.2, 1.0) };
    let options = TraceOptions { noise: 1e-16, ..TraceOptions::default() };
    let network = trace_by_margins(&shapes, &window, &options).unwrap();
    let work = network.statistics;
    let runs = work.free_runs + work.prescribed_runs;
    assert!(runs < 2500, "{runs} runs for {} nodes", work.nodes);
}
