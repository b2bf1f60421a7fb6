//! Errors in curves and vertices are found by the subdivision, or by runs compared with it.

use std::f64::consts::TAU;

use stickslip_tracer::{
    Curve, Node, Point, Vertex, VertexKind,
    regions::{CurveSide, Finding, Origin, Subdivision, SubdivisionError, VerifyOptions, verify},
};

use crate::subdivision::planes::{
    KnownPlane, TOLERANCE, UNIT, circle, crossing_circles, even, inside, islands,
};

/// The findings of a plane.
fn findings(plane: &KnownPlane) -> Vec<Finding<i32>> {
    plane.subdivision().expect("curves with a meaning").findings().to_vec()
}

#[test]
fn a_deleted_curve_leaves_labels_that_disagree() {
    let mut plane = crossing_circles();
    plane.curves.remove(0);
    let found = findings(&plane);
    // The lens and the right lune are now one region, with the most frequent label or the least
    // one.
    assert!(
        found.iter().any(|finding| matches!(finding, Finding::Labels { vertex: Some(_), .. })),
        "{found:?}"
    );
}

/// A strip along an edge whose half width is below the tolerance is there if a run in it has its
/// label, and stays in doubt if not.
#[test]
fn a_thin_region_is_there_if_a_run_in_it_says_so() {
    const HEIGHT: f64 = 1.6 * TOLERANCE;
    let strip = |truth| {
        KnownPlane::new(truth)
            .vertex(0.0, HEIGHT, VertexKind::WindowEdge)
            .vertex(1.0, HEIGHT, VertexKind::WindowEdge)
            .curve(|s| [s, HEIGHT, 1.0, 0.0], even(0.0, 1.0, 8), [0, 1], Some([0, 1]))
    };
    let there = strip(|p| i32::from(p.y < HEIGHT));
    let missing = strip(|_| 0);
    let options = VerifyOptions { random_points: 1000, near_points: 0, ..VerifyOptions::default() };
    for (plane, stands) in [(there, 0), (missing, 1)] {
        let made = plane.subdivision().expect("curves with a meaning");
        let [Finding::Thin { region, .. }] = *made.findings() else {
            panic!("{:?}", made.findings())
        };
        assert_eq!(made.regions()[region].label, Some(1));
        let verification = verify(&made, &plane, &options).expect("distances in order");
        assert_eq!(verification.standing(&made).count(), stands);
        assert_eq!((verification.findings, verification.agrees()), (stands, stands == 0));
        assert!(verification.mismatches.is_empty());
    }
}

#[test]
fn a_swapped_label_is_named() {
    let mut plane = crossing_circles();
    plane.curves[1].sides.swap(0, 1);
    let found = findings(&plane);
    let named = |label, common| {
        found.iter().any(|finding| match finding {
            Finding::Labels { curves, labels, vertex: Some(_), .. } => {
                curves.contains(&1) && labels.contains(&label) && labels.contains(&common)
            }
            _ => false,
        })
    };
    assert!(found.len() == 2 && named(0, 1), "{found:?}");
}

#[test]
fn a_moved_vertex_is_named() {
    let mut plane = crossing_circles();
    plane.vertices[1].point.y += 1e-8;
    let found = findings(&plane);
    assert_eq!(found.len(), 4, "{found:?}");
    for finding in found {
        let Finding::EndAway { vertex: 1, distance, .. } = finding else { panic!("{finding:?}") };
        assert!((distance - 1e-8).abs() < 1e-12);
    }
}

#[test]
fn crossings_without_a_vertex_are_found() {
    let plane = KnownPlane::new(|_| 0)
        .curve(circle(0.4, 0.5, 0.25), even(0.0, TAU, 200), [1, 0], None)
        .curve(circle(0.6, 0.5, 0.25), even(0.0, TAU, 200), [2, 0], None);
    let found = findings(&plane);
    let crossings: Vec<Point> = found
        .iter()
        .filter_map(|finding| match finding {
            Finding::Crossing { curves, point } => {
                assert!(curves.contains(&Some(0)) && curves.contains(&Some(1)));
                Some(*point)
            }
            _ => None,
        })
        .collect();
    assert_eq!(crossings.len(), 2, "{found:?}");
    let half = 0.0525_f64.sqrt();
    for y in [0.5 - half, 0.5 + half] {
        let place = Point::new(0.5, y);
        assert!(crossings.iter().any(|point| (point - place).norm() < 1e-9), "{crossings:?}");
    }
}

/// Circles that overlap by less than the distance of two nodes. Away from the overlap all labels
/// are right.
#[test]
fn short_overlaps_are_found_and_narrow_gaps_are_not_overlaps() {
    for angle in even(0.0, TAU, 24) {
        for overlap in [1e-3, 1e-6, 1e-8, -1e-8, -1e-6, -1e-3] {
            let (sin, cos) = angle.sin_cos();
            let apart = 0.3 - overlap;
            let plane = KnownPlane::new(|_| 0)
                .curve(circle(0.5, 0.5, 0.2), even(0.0, TAU, 200), [1, 0], None)
                .curve(
                    circle(0.5 + apart * cos, 0.5 + apart * sin, 0.1),
                    even(0.0, TAU, 200),
                    [2, 0],
                    None,
                );
            let found = findings(&plane);
            let crossing = |finding: &Finding<i32>| matches!(finding, Finding::Crossing { .. });
            if overlap > 0.0 {
                assert!(found.iter().any(crossing), "{angle} {overlap}: {found:?}");
            } else {
                assert!(found.is_empty(), "{angle} {overlap}: {found:?}");
            }
        }
    }
}

#[test]
fn curves_that_leave_the_window_are_found() {
    let plane =
        KnownPlane::new(|_| 0).curve(circle(0.1, 0.5, 0.2), even(0.0, TAU, 100), [1, 0], None);
    let found = findings(&plane);
    let half = 0.03_f64.sqrt();
    for y in [0.5 - half, 0.5 + half] {
        let near = |point: &Point| (point - Point::new(0.0, y)).norm() < 1e-9;
        let crossing = |finding: &Finding<i32>| matches!(finding, Finding::Crossing { curves: [Some(0), None], point } if near(point));
        assert!(found.iter().any(crossing), "{found:?}");
    }
}

#[test]
fn dangling_ends_are_found() {
    let line = |s: f64| [s, 0.5, 1.0, 0.0];
    let plane = KnownPlane::new(|_| 0)
        .vertex(0.0, 0.5, VertexKind::WindowEdge)
        .vertex(0.7, 0.5, VertexKind::Degenerate)
        .curve(line, even(0.0, 0.7, 3), [1, 0], Some([0, 1]));
    let found = findings(&plane);
    assert!(found.contains(&Finding::Dangling { curve: 0, vertex: 1 }), "{found:?}");
    let same = |finding: &Finding<i32>| matches!(finding, Finding::SidesNotApart { curve: 0, .. });
    assert!(found.iter().any(same), "{found:?}");
    assert!(found.iter().any(|finding| matches!(finding, Finding::Labels { .. })), "{found:?}");
}

#[test]
fn a_curve_given_twice_is_found() {
    let mut plane = islands();
    plane.curves.push(plane.curves[1].clone());
    assert!(!findings(&plane).is_empty());
}

/// Also where it is vertical, which is hardest at x = 0, where doubles are closest to each other.
#[test]
fn a_curve_given_twice_is_found_where_it_is_vertical() {
    for x in [0.3, 0.5] {
        let ring = circle(x, 0.5, 0.3);
        let mut plane = KnownPlane::new(|_| 0).curve(ring, even(0.0, TAU, 200), [1, 0], None);
        plane.curves.push(plane.curves[0].clone());
        let found = plane.subdivision().map(|made| !made.findings().is_empty());
        assert!(found.unwrap_or(true), "{x}");
    }
    let steep = |s: f64| [0.1 + 1e-7 * s, s, 1e-7, 1.0];
    let mut plane = KnownPlane::new(|_| 0)
        .vertex(0.1, 0.0, VertexKind::WindowEdge)
        .vertex(0.1 + 1e-7, 1.0, VertexKind::WindowEdge)
        .curve(steep, even(0.0, 1.0, 2), [1, 0], Some([0, 1]));
    plane.curves.push(plane.curves[0].clone());
    assert!(!findings(&plane).is_empty());
}

#[test]
fn vertices_that_are_not_where_their_kind_says_are_found() {
    let plane = KnownPlane::new(|_| 0).vertex(0.0 + 1e-6, 0.5, VertexKind::WindowEdge);
    assert_eq!(findings(&plane), [Finding::VertexOffWindow { vertex: 0 }]);
}

#[test]
fn a_missing_island_is_found_by_runs_and_traced_again() {
    let whole = islands();
    let mut plane = whole.clone();
    let island: Curve<i32, usize> = plane.curves.remove(1);
    plane.curves[0].sides = [2, 0];
    let made = plane.subdivision().expect("curves with a meaning");
    assert!(made.findings().is_empty());
    let options = VerifyOptions::default();
    let first = verify(&made, &plane, &options).expect("distances in order");
    assert!(!first.agrees());
    // Between the two points of every bracket a boundary is missing.
    let brackets = first.brackets();
    assert_eq!(brackets.len(), first.mismatches.len());
    for [agreeing, other] in &brackets {
        assert_ne!((plane.truth)(agreeing), (plane.truth)(other));
    }
    let share = 0.09 * std::f64::consts::PI;
    assert!(first.wrong_area_bound > share && first.wrong_area_bound < share + 0.03);
    assert!(first.tried_area < 1e-5);

    let mut curves = made.curves().to_vec();
    curves[0].sides = [2, 1];
    curves.push(island);
    let vertices = made.vertices().to_vec();
    let last = Subdivision::new(*made.window(), curves, vertices, TOLERANCE).expect("meaning");
    let again = VerifyOptions { seed: 2, ..options };
    assert!(verify(&last, &whole, &again).expect("in order").agrees());
    assert_eq!(last.regions().len(), 3);
}

#[test]
fn a_misplaced_curve_is_found_beside_it() {
    let mut plane = islands();
    plane.truth = |p| inside(p, 0.5, 0.5, 0.3 + 1e-6) + inside(p, 0.4, 0.6, 1e-3);
    let made = plane.subdivision().expect("curves with a meaning");
    let verification = verify(&made, &plane, &VerifyOptions::default()).expect("in order");
    assert!(!verification.mismatches.is_empty());
    for mismatch in &verification.mismatches {
        assert!(matches!(
            mismatch.checkpoint.origin,
            Origin::Near { curve: 1, side: CurveSide::Right, distance } if distance < 1.001e-6
        ));
    }
}

#[test]
fn verification_is_the_same_every_time() {
    let plane = crossing_circles();
    let made = plane.subdivision().expect("curves with a meaning");
    let mut wrong = plane.clone();
    wrong.truth = |p| inside(p, 0.4, 0.5, 0.26);
    let run = || verify(&made, &wrong, &VerifyOptions::default()).expect("in order");
    assert_eq!(run(), run());
    let other = VerifyOptions { seed: 2, ..VerifyOptions::default() };
    assert_ne!(run(), verify(&made, &wrong, &other).expect("in order"));
}

#[test]
fn input_without_meaning_is_refused_by_name() {
    let refused = |change: fn(&mut KnownPlane)| {
        let mut plane = crossing_circles();
        change(&mut plane);
        plane.subdivision().map(|_| ()).expect_err("no meaning")
    };
    assert_eq!(
        refused(|plane| plane.curves[2].nodes.truncate(1)),
        SubdivisionError::Nodes { curve: 2, count: 1 }
    );
    assert_eq!(
        refused(|plane| plane.curves[2].nodes[3].point.x = f64::NAN),
        SubdivisionError::Node { curve: 2, node: 3 }
    );
    assert_eq!(
        refused(|plane| plane.curves[1].nodes[0].tangent *= 2.0),
        SubdivisionError::Node { curve: 1, node: 0 }
    );
    assert_eq!(
        refused(|plane| plane.curves[0].ends = Some([0, 9])),
        SubdivisionError::End { curve: 0, vertex: 9, count: 2 }
    );
    assert_eq!(
        refused(|plane| plane.vertices[1].point.y = f64::INFINITY),
        SubdivisionError::Vertex { vertex: 1 }
    );
    let made = crossing_circles().subdivision().expect("curves with a meaning");
    let options = VerifyOptions { nearest: 1.0, farthest: 0.5, ..VerifyOptions::default() };
    let error = verify(&made, &crossing_circles(), &options).expect_err("out of order");
    assert_eq!(error, SubdivisionError::Distances { nearest: 1.0, farthest: 0.5 });
    let vertex: Vertex<usize> = made.vertices()[0].clone();
    assert!(vertex.margins.is_empty() && made.tolerance() == TOLERANCE);
}

/// Curves between two vertices that are one place, as far as the tolerance tells, do not keep the
/// others from dividing the window.
#[test]
fn curves_without_length_are_left_out() {
    let mut plane = crossing_circles();
    let place = plane.vertices[0].point;
    let short = |tangent: Point| Curve {
        margin: 7,
        sides: [1, 2],
        nodes: vec![Node { point: place, tangent }; 2],
        ends: Some([0, 0]),
    };
    plane.curves.insert(0, short(Point::new(1.0, 0.0)));
    plane.curves.insert(3, short(Point::new(0.0, 1.0)));
    let refused = plane.subdivision().unwrap_err();
    assert_eq!(refused, SubdivisionError::NoLength { curve: 0 });
    let (made, left_out) =
        Subdivision::leaving_out(UNIT, &plane.curves, &plane.vertices, TOLERANCE).unwrap();
    assert_eq!(left_out, [0, 3]);
    assert_eq!((made.regions().len(), made.findings()), (4, &[][..]));
}
