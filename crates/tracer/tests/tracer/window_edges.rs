//! Boundaries that meet, touch or run beside the edges of the window: a hair beyond, on the edge, a
//! hair inside, and in corners.

use stickslip_tracer::{
    Atlas, AtlasOf, AtlasOptions, Family, FreeRun, Point, TraceOptions, VertexKind, Window,
    regions::VerifyOptions,
};

use crate::any::any;
use crate::guards::{Failed, Guards, Label, Margin, SQUARE, exact};

/// The atlas of the functions, against which nothing may speak, and which is right at points of
/// every distance from the edges.
fn right(functions: Vec<fn(&Point) -> f64>) -> AtlasOf<Guards> {
    let family = any(Guards(functions));
    let verify = VerifyOptions { random_points: 2000, ..VerifyOptions::default() };
    let trace = TraceOptions { beyond: 1e-3, ..exact() };
    let options = AtlasOptions { trace, verify, ..AtlasOptions::default() };
    let atlas = Atlas::of(&family, &SQUARE, &options).unwrap();
    assert_eq!(atlas.unresolved, []);
    assert_eq!(atlas.plane.findings(), []);
    assert!(atlas.agrees());
    let Window { low, high } = SQUARE;
    let mut seen = 0;
    for step in 1..2000 {
        let along = low.y + f64::from(step) / 2000.0 * (high.y - low.y);
        for depth in [1e-6, 1e-4, 1e-2] {
            for point in [
                Point::new(low.x + depth, along),
                Point::new(high.x - depth, along),
                Point::new(along, low.y + depth),
                Point::new(along, high.y - depth),
            ] {
                if let Some(label) = atlas.label(&point) {
                    assert_eq!(*label, family.label(&point).unwrap(), "{point:?}");
                    seen += 1;
                }
            }
        }
    }
    assert!(seen > 23_900, "{seen}");
    atlas
}

/// Lines through (1 + d, 0.3), where d is so many billionths.
fn rising<const BILLIONTHS: i32>(p: &Point) -> f64 {
    p.y - 0.3 - 0.5 * (p.x - 1.0 - 1e-9 * f64::from(BILLIONTHS))
}

fn falling<const BILLIONTHS: i32>(p: &Point) -> f64 {
    p.y - 0.3 + 0.25 * (p.x - 1.0 - 1e-9 * f64::from(BILLIONTHS))
}

fn crossing<const BILLIONTHS: i32>() -> [usize; 2] {
    let atlas = right(vec![rising::<BILLIONTHS>, falling::<BILLIONTHS>]);
    [atlas.plane.curves().len(), atlas.plane.regions().len()]
}

#[test]
fn a_crossing_just_beyond_an_edge() {
    assert_eq!(crossing::<100_000>(), [2, 3]);
    assert_eq!(crossing::<1000>(), [2, 3]);
    assert_eq!(crossing::<100>(), [2, 3]);
    assert_eq!(crossing::<30>(), [2, 3]);
}

#[test]
fn a_crossing_on_an_edge() {
    let atlas = right(vec![rising::<0>, falling::<0>]);
    assert_eq!((atlas.plane.curves().len(), atlas.plane.regions().len()), (2, 3));
    let place = Point::new(1.0, 0.3);
    let at = |point: &Point| (point - place).norm() < 1e-11;
    let vertices = atlas.plane.vertices();
    let [there] = vertices.iter().filter(|vertex| at(&vertex.point)).collect::<Vec<_>>()[..] else {
        panic!("one vertex at the edge: {vertices:?}")
    };
    assert_eq!(there.kind, VertexKind::WindowEdge);
    assert!(there.margins.len() >= 2, "{there:?}");
}

#[test]
fn a_crossing_just_inside_an_edge() {
    assert_eq!(crossing::<-100>(), [4, 4]);
    assert_eq!(crossing::<-1000>(), [4, 4]);
    assert_eq!(crossing::<-100_000>(), [4, 4]);
}

/// Lines through (1 + d, 1 + d), where d is so many billionths.
fn steep<const BILLIONTHS: i32>(p: &Point) -> f64 {
    let d = 1e-9 * f64::from(BILLIONTHS);
    p.y - 1.0 - d - 2.0 * (p.x - 1.0 - d)
}

fn flat<const BILLIONTHS: i32>(p: &Point) -> f64 {
    let d = 1e-9 * f64::from(BILLIONTHS);
    p.y - 1.0 - d - 0.4 * (p.x - 1.0 - d)
}

#[test]
fn a_crossing_in_a_corner() {
    let atlas = right(vec![steep::<0>, flat::<0>]);
    assert_eq!((atlas.plane.curves().len(), atlas.plane.regions().len()), (2, 3));
    let corner = Point::new(1.0, 1.0);
    let there = atlas.plane.vertices().iter().filter(|vertex| vertex.point == corner);
    let kinds: Vec<VertexKind> = there.map(|vertex| vertex.kind).collect();
    assert_eq!(kinds, [VertexKind::WindowCorner]);
    for atlas in [right(vec![steep::<100>, flat::<100>]), right(vec![steep::<30>, flat::<30>])] {
        assert_eq!((atlas.plane.curves().len(), atlas.plane.regions().len()), (2, 3));
    }
    let inside = right(vec![steep::<-100>, flat::<-100>]);
    assert_eq!((inside.plane.curves().len(), inside.plane.regions().len()), (4, 4));
}

#[test]
fn a_boundary_along_an_edge_is_none() {
    let atlas = right(vec![|p| p.y - 1.0, |p| p.x - 0.2 - 0.1 * p.y]);
    assert_eq!((atlas.plane.curves().len(), atlas.plane.regions().len()), (1, 2));
    // Along two edges that meet in a corner.
    let atlas = right(vec![|p| p.y + 1.0, |p| p.x - 1.0, |p| p.x + p.y]);
    assert_eq!((atlas.plane.curves().len(), atlas.plane.regions().len()), (1, 2));
}

#[test]
fn boundaries_that_touch_just_beyond_an_edge() {
    let atlas = right(vec![|p| p.y - 0.3, |p| p.y - 0.3 - (p.x - 1.000_000_1).powi(2)]);
    assert_eq!((atlas.plane.curves().len(), atlas.plane.regions().len()), (2, 3));
    let atlas = right(vec![|p| p.y - 0.3, |p| p.y - 0.3 - (p.x - 1.0).powi(2)]);
    assert_eq!((atlas.plane.curves().len(), atlas.plane.regions().len()), (2, 3));
}

#[test]
fn circles_that_touch_an_edge() {
    // Up to 1e-7 of the edge, and up to 1e-7 beyond it.
    let inside =
        right(vec![|p| (p - Point::new(0.5, 0.0)).norm_squared() - 0.499_999_9 * 0.499_999_9]);
    assert_eq!((inside.plane.curves().len(), inside.plane.regions().len()), (1, 2));
    let beyond =
        right(vec![|p| (p - Point::new(0.5, 0.0)).norm_squared() - 0.500_000_1 * 0.500_000_1]);
    assert_eq!((beyond.plane.curves().len(), beyond.plane.regions().len()), (1, 2));
    assert!(inside.plane.curves()[0].ends.is_none() && beyond.plane.curves()[0].ends.is_some());
}

/// Two lines that cross at a depth below the upper edge, at a small angle to it and to each other.
struct Lines {
    depth: f64,
    slopes: [f64; 2],
}

impl Lines {
    /// The heights of a point above them.
    fn heights(&self, point: &Point) -> [f64; 2] {
        self.slopes.map(|slope| point.y - (1.0 - self.depth) - slope * (point.x - 0.2))
    }
}

impl Family for Lines {
    type Label = Label;
    type Margin = Margin;
    type Error = Failed;

    fn label(&self, point: &Point) -> Result<Label, Failed> {
        Ok(self.heights(point).map(|height| height < 0.0).to_vec())
    }

    fn margin(&self, point: &Point, margin: &Margin) -> Result<Option<f64>, Failed> {
        Ok(Some(self.heights(point)[margin.0]))
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<Label, Margin>, Failed> {
        let (label, heights) = (self.label(point)?, self.heights(point));
        let margin = |line: usize| ((line, label[..line].to_vec()), heights[line]);
        let margins = (0..2).filter(|&line| !label[line]).map(margin).collect();
        Ok(FreeRun { label, margins })
    }
}

/// At each depth both lines reach the edge within a few hundred depths of their crossing.
#[test]
fn a_sharp_crossing_just_inside_an_edge() {
    for (least, slopes) in [(3e-8, [-0.01, 0.01]), (4e-9, [0.01, 0.028])] {
        for tenths in 0..20 {
            let depth = least * 10_f64.powf(0.1 * f64::from(tenths));
            let family = any(Lines { depth, slopes });
            let atlas = Atlas::of(&family, &SQUARE, &AtlasOptions::default()).unwrap();
            let plane = &atlas.plane;
            assert_eq!(atlas.objection(), None, "{slopes:?}, {depth:e}");
            assert_eq!((plane.curves().len(), plane.regions().len()), (4, 4));
        }
    }
}
