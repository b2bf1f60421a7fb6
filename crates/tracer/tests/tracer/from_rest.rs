//! A family of runs that start at rest, with a dimension that is known at run time.

use stickslip_solver::dynamic::DynamicSystem;
use stickslip_solver::{Direction, Dop853, Guard, Options};
use stickslip_tracer::{
    Atlas, AtlasOptions, Point, TraceOptions, Window,
    hybrid::{DynamicFamily, DynamicProblem, DynamicSetting, Itinerary},
    regions::VerifyOptions,
};

use crate::any::any;

/// Two masses between springs, the first of which is forced by a sin 0.7t. Both start at rest, so
/// that the second one moves like t⁵. The guard is its distance from a limit. The parameters are a
/// and the limit.
struct Chain(Point);

impl DynamicSystem for Chain {
    type Mode = ();

    fn field(&self, (): (), t: f64, y: &[f64], slope: &mut [f64]) {
        let force = self.0.x * (0.7 * t).sin();
        slope.copy_from_slice(&[y[1], y[2] - 2.0 * y[0] + force, y[3], y[0] - 2.0 * y[2]]);
    }

    fn guards(&self, (): ()) -> &[Guard] {
        const { &[Guard::new(Direction::Falling)] }
    }

    fn guard_values(&self, (): (), _: f64, y: &[f64], values: &mut [f64]) {
        values[0] = self.0.y - y[2];
    }
}

struct Chains;

impl DynamicProblem for Chains {
    type System = Chain;

    fn at(&self, point: &Point) -> Option<DynamicSetting<Chain>> {
        let (system, state) = (Chain(*point), vec![0.0; 4]);
        Some(DynamicSetting { system, mode: (), s: 0.0, state, end: 6.0 })
    }
}

/// The largest displacement of the second mass up to t = 6, for a = 1: its modes oscillate with 1
/// and √3.
fn largest() -> f64 {
    let (w, fast) = (0.7_f64, 3_f64.sqrt());
    let mode =
        |root: f64, t: f64| ((w * t).sin() - w / root * (root * t).sin()) / (root * root - w * w);
    let displacement = |t: f64| 0.5 * (mode(1.0, t) - mode(fast, t));
    let (mut low, mut high) = (3.0, 5.0);
    for _ in 0..100 {
        let (left, right) = ((2.0 * low + high) / 3.0, (low + 2.0 * high) / 3.0);
        if displacement(left) < displacement(right) { low = left } else { high = right }
    }
    displacement(low)
}

/// The motion is proportional to the force, so that the boundary is a line through the origin.
#[test]
fn a_family_from_rest_is_traced() {
    let options = Options::with_tolerance(1e-13);
    let family = any(DynamicFamily { problem: Chains, method: Dop853, options });
    let slope = largest();
    let window = Window { low: Point::new(0.9, 0.9 * slope), high: Point::new(1.1, 1.1 * slope) };
    let verify = VerifyOptions { random_points: 100, ..VerifyOptions::default() };
    let trace = TraceOptions { cells: 6, ..TraceOptions::default() };
    let options = AtlasOptions { trace, verify, ..AtlasOptions::default() };
    let atlas = Atlas::of(&family, &window, &options).unwrap();
    assert_eq!((&atlas.unresolved[..], atlas.objection()), (&[][..], None));
    let [curve] = atlas.plane.curves() else { panic!("{}", atlas.plane.curves().len()) };
    let off = curve.nodes.iter().map(|node| (node.point.y - slope * node.point.x).abs());
    let off = off.fold(0.0, f64::max);
    assert!(off < 1e-12, "{off:e}");
    let fires = |guards: &[usize]| Itinerary::Fires(guards.to_vec());
    let label = |y: f64| atlas.label(&Point::new(1.0, y * slope));
    assert_eq!(label(1.001), Some(&fires(&[])));
    assert_eq!(label(0.999), Some(&fires(&[0])));
}
