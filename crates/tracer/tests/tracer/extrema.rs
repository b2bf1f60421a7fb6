//! The places where curves are extremal in a coordinate.

use stickslip_tracer::{Point, tracing::Tracer};

use crate::any::any;
use crate::guards::{Guards, SQUARE, exact};

/// The places where the curves of `functions` are extremal in each coordinate, ordered by x + y.
fn extrema(functions: Vec<fn(&Point) -> f64>) -> [Vec<Point>; 2] {
    let family = any(Guards(functions));
    let mut tracer = Tracer::new(&family, &SQUARE, &exact()).unwrap();
    tracer.explore().unwrap();
    let found = tracer.extrema().unwrap();
    [0, 1].map(|axis| {
        let of_axis = found.iter().filter(|extremum| extremum.axis == axis);
        let mut points: Vec<Point> = of_axis.map(|extremum| extremum.point).collect();
        points.sort_by(|one, other| (one.x + one.y).total_cmp(&(other.x + other.y)));
        points
    })
}

/// Asserts that the points are those expected, to 1e-9.
fn assert_at(points: &[Point], expected: &[[f64; 2]]) {
    assert_eq!(points.len(), expected.len(), "{points:?}");
    for (point, expected) in points.iter().zip(expected) {
        let off = (point - Point::from(*expected)).norm();
        assert!(off < 1e-9, "{point:?} is {off:e} away from {expected:?}");
    }
}

#[test]
fn a_circle_has_two_extrema_in_each_coordinate() {
    let [x, y] = extrema(vec![|p| (p - Point::new(0.1, 0.2)).norm_squared() - 0.25]);
    assert_at(&x, &[[-0.4, 0.2], [0.6, 0.2]]);
    assert_at(&y, &[[0.1, -0.3], [0.1, 0.7]]);
    // Divided at two vertices, the circle has the same extrema.
    let [x, y] =
        extrema(vec![|p| (p - Point::new(0.1, 0.2)).norm_squared() - 0.25, |p| p.x - p.y + 0.05]);
    assert_at(&x, &[[-0.4, 0.2], [0.6, 0.2]]);
    assert_at(&y, &[[0.1, -0.3], [0.1, 0.7]]);
}

/// A small circle with a gradient that varies. The node of least x may be an extremum.
#[test]
fn extrema_of_a_small_circle() {
    let [x, y] = extrema(vec![|p| {
        (4.0 * p.x + p.y).exp() * ((p - Point::new(0.123, 0.456)).norm_squared() - 1e-6)
    }]);
    assert_at(&x, &[[0.122, 0.456], [0.124, 0.456]]);
    assert_at(&y, &[[0.123, 0.455], [0.123, 0.457]]);
}

#[test]
fn straight_lines_and_inflections_have_no_extrema() {
    let lines: Vec<fn(&Point) -> f64> =
        vec![|p| p.x - 0.2 + 1e-13 * (1e5 * p.y).sin(), |p| p.y + 0.3, |p| {
            p.y - 0.4 - (p.x - 0.6).powi(3)
        }];
    assert!(extrema(lines).iter().all(Vec::is_empty));
}
